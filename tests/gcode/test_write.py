"""Nothing faulty reaches the disk, and what does is the same bytes every time."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gcode.emit import emit
from gcode.plan import Plan
from gcode.printer import Nozzle, Printer
from gcode.program import Extrude
from gcode.write import checked_text, write_gcode, write_previews, write_skin
from skinfab.errors import InputError, RefusedError
from skinfab.material import load_material
from skinfab.mesh.model import Mesh
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.pieces import Piece
from skinfab.placement.lifted import Lifted
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source


def test_written_whole_with_its_summary(planned: Plan, printer: Printer, tmp_path: Path) -> None:
    target = tmp_path / "P1.gcode"
    summary = write_gcode(planned.program, target, printer=printer)
    assert target.read_text() == emit(planned.program, printer)
    assert (summary.lines, summary.arcs) == (target.read_text().count("\n"), 6)
    lines = write_gcode(planned.program, target, printer=printer, arcs="lines")
    assert lines.arcs == 0 and lines.lines > summary.lines
    assert lines.ink_mm3 == pytest.approx(summary.ink_mm3)
    assert target.read_text() == emit(planned.program, printer, arcs="lines")


def test_a_skin_without_sensors_says_which_are_only_off(skin: Skin, tmp_path: Path) -> None:
    bare = replace(skin, sensors=())
    with pytest.raises(InputError, match=r"this skin has no sensor, so there is nothing to print; place one first$"):
        write_skin(bare, tmp_path)
    off = tuple(Lifted(sensor, skin.pieces[0]) for sensor in skin.sensors)
    names = ", ".join(sensor.id for sensor in skin.sensors)
    said = f"no sensor in place, so there is nothing to print; .* off \\({names}\\) and .* in the window, cut so that .* again"
    with pytest.raises(InputError, match=said):
        write_skin(replace(bare, lifted=off), tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_faulty_program_is_refused_and_not_written(planned: Plan, printer: Printer, tmp_path: Path) -> None:
    target = tmp_path / "P1.gcode"
    small = replace(printer, bed=replace(printer.bed, size=(150.0, 350.0)))
    with pytest.raises(
        RefusedError, match=r"piece P1 was not written: line \d+, pattern C\d: it reaches X.* the bed ends at X150.0000; move"
    ) as fault:
        write_gcode(planned.program, target, printer=small)
    assert fault.value.exit_status == 3 and "more like this" in str(fault.value)
    assert list(tmp_path.iterdir()) == []
    fast = [replace(s, speed=100.0) if isinstance(s, Extrude) else s for s in planned.program.steps]
    with pytest.raises(RefusedError, match="lower F to"):
        write_gcode(replace(planned.program, steps=tuple(fast)), target, printer=printer)
    assert list(tmp_path.iterdir()) == []


def test_a_printer_without_arcs_refuses_native_ones(planned: Plan, printer: Printer) -> None:
    flat = replace(printer, arcs=False)
    with pytest.raises(RefusedError, match="--arcs lines"):
        checked_text(planned.program, printer=flat)
    assert "\nG3 " not in checked_text(planned.program, printer=flat, arcs="lines")[0]


SPIRAL = ContactSpiral(n=3, x=2.0, b=3.0, l=6.0, s=22.0)


@pytest.fixture
def skin(make_piece: Callable[[float, float], Piece]) -> Skin:
    mesh = Mesh(np.array([[0, 0, 0], [120, 0, 0], [120, 100, 0], [0, 100, 0]], dtype=float), np.array([[0, 1, 2], [0, 2, 3]]))
    one = make_piece(120, 100)
    pieces = one, replace(one, id="P2"), replace(one, id="P3")
    sensors = (
        Sensor("C1", "P1", SPIRAL, 20, 30, 0.3, 0),
        Sensor("C2", "P1", SPIRAL, 70, 60, 0.3, 1),
        Sensor("C3", "P3", SPIRAL, 40, 40, 1.0, 2),
    )
    return Skin(mesh, Source("a.obj", "0", "mm", 1.0), np.empty((0, 2), dtype=np.int64), pieces, sensors)


def test_a_skin_gives_a_file_for_each_piece_with_sensors(skin: Skin, printer: Printer, tmp_path: Path) -> None:
    written = write_skin(skin, tmp_path / "new" / "gcode")
    assert [w.file.name for w in written] == ["P1.gcode", "P3.gcode"]
    assert written[0].plan.offset == (115.0, 125.0)
    first = [w.file.read_bytes() for w in written]
    assert [w.file.read_bytes() for w in write_skin(skin, tmp_path / "again")] == first
    flat = write_skin(skin, tmp_path / "flat", printer=replace(printer, arcs=False))
    assert [w.summary.arcs for w in flat] == [0, 0]


def test_one_bad_piece_keeps_all_files_away(skin: Skin, printer: Printer, tmp_path: Path) -> None:
    outside = replace(skin, sensors=(*skin.sensors, Sensor("C4", "P3", SPIRAL, 600, 20, 0.0, 3)))
    with pytest.raises(RefusedError, match=r"C4 .* piece P3"):
        write_skin(outside, tmp_path / "gcode")
    slow = replace(printer, pump=replace(printer.pump, flow_min=2.5))
    with pytest.raises(RefusedError, match=r"piece P1 was not written: line \d+, pattern C\d: its flow is 2.017"):
        write_skin(skin, tmp_path / "gcode", printer=slow)
    assert not (tmp_path / "gcode").exists()


def test_a_nozzle_that_would_meet_the_wall_keeps_all_files_away(skin: Skin, printer: Printer, tmp_path: Path) -> None:
    near = replace(skin, sensors=(*skin.sensors, Sensor("C4", "P2", SPIRAL, 4.0, 20, 0.0, 3)))
    written = write_skin(near, tmp_path / "fine", printer=printer)
    assert len(written) == 3 and len(write_previews(near, written, tmp_path / "fine")) == 3
    thick = replace(printer, nozzle=Nozzle(2.5, 0.2))
    with pytest.raises(RefusedError, match=r"piece P2 was not written: line \d+, pattern C4: at X\S+ Y\S+ Z1.60 the nozzle's axis is"):
        write_skin(near, tmp_path / "gcode", printer=thick)
    assert not (tmp_path / "gcode").exists()


def test_a_skin_without_sensors_and_a_folder_that_is_none(skin: Skin, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no sensor"):
        write_skin(replace(skin, sensors=()), tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot write"):
        write_skin(skin, tmp_path / "file")


def test_a_whole_skin_with_pads_gets_its_print_overruns(skin: Skin, printer: Printer, tmp_path: Path) -> None:
    plain = write_skin(skin, tmp_path / "plain", printer=printer)
    inked = replace(printer, process=replace(printer.process, print_overrun=1.0))
    written = write_skin(skin, tmp_path / "inked", printer=inked)
    assert all(s.pattern.pad == 3.0 for s in skin.sensors) and [w.plan.warnings for w in written] == [(), ()]
    more = [w.summary.ink_mm3 - p.summary.ink_mm3 for w, p in zip(written, plain, strict=True)]
    area = load_material(skin.material).ink.bead_area_mm2
    assert more == pytest.approx([2 * area, area], rel=1e-3)  # 1 mm of bead for each of two sensors and of one
