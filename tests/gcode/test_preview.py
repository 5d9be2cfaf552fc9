"""The tool path's picture: every move in its role's colour, arcs as they are, to scale."""

import math
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gcode.emit import emit
from gcode.plan import Plan, plan
from gcode.preview import ROLES, draw_toolpath, strokes
from gcode.printer import Printer, load_printer
from gcode.program import Extrude, Prime, Retract
from gcode.trace import trace
from skinfab.errors import InputError
from skinfab.material import Material
from skinfab.paths import Line
from skinfab.paths import Path as InkPath

SVG = "{http://www.w3.org/2000/svg}"


def test_roles_of_a_plan(planned: Plan, printer: Printer) -> None:
    drawn = list(strokes(trace(emit(planned.program, printer)), printer))
    steps = planned.program.steps
    count = Counter(s.role for s in drawn)
    assert count["print"] == sum(isinstance(s, Extrude) for s in steps)
    assert count["prime"] == sum(isinstance(s, Prime) for s in steps) == count["retract"] == sum(isinstance(s, Retract) for s in steps)
    assert count["overrun"] == 4 and count["travel"] >= 2
    # The hairpin ends beside its own line, so its end overrun is cut short: to 0.3 mm, as the plan says.
    assert [w for w in planned.warnings if "end overrun cut from 1 to 0.3 mm" in w] == list(planned.warnings) and len(planned.warnings) == 2
    assert sum(s.shape.length for s in drawn if s.role == "overrun") == pytest.approx(2 * (1 + 0.3), abs=1e-3)
    assert {round(s.width, 2) for s in drawn if s.role == "print"} == {0.79}  # the bead's
    assert {s.pattern for s in drawn if s.role == "print"} == {"C1", "C2"}


@pytest.mark.parametrize("name", ["ender5plus-vipro", "generic-marlin", "generic-grbl"])
def test_roles_are_the_same_on_every_printer(name: str, make_piece: Callable, make_sensor: Callable, hairpin, material: Material) -> None:  # type: ignore[no-untyped-def]
    printer = replace(load_printer(name), process=load_printer().process)
    planned = plan(make_piece(120, 100), [make_sensor("C1", hairpin, 20, 20)], printer=printer, material=material)
    count = Counter(s.role for s in strokes(trace(emit(planned.program, printer), spindle=printer.spindle), printer))
    assert (count["overrun"], count["prime"], count["retract"]) == (2, 1, 1) and count["print"] >= 5


def test_ink_beyond_a_path_is_told_from_it(make_piece: Callable, make_sensor: Callable, printer: Printer, material: Material) -> None:
    long = replace(printer, process=replace(printer.process, print_overrun=2.0, print_overrun_end=3.0))
    sensors = [make_sensor(name, InkPath((Line((0, 0), (20, 0)),)), 30, y) for name, y in (("A", 20), ("B", 40))]
    planned = plan(make_piece(120, 100), sensors, printer=long, material=material)
    drawn = list(strokes(trace(emit(planned.program, long)), long))
    assert [s.role for s in drawn if s.role.startswith("print")] == ["print-overrun", "print", "print-overrun"] * 2
    assert sum(s.shape.length for s in drawn if s.role == "print-overrun") == pytest.approx(2 * 5.0, abs=1e-3)
    assert {round(s.width, 2) for s in drawn if s.role == "print-overrun"} == {0.79}
    assert all(s.role != "print-overrun" for s in strokes(trace(emit(planned.program, long).replace("; print-overrun\n", "")), long))


@pytest.mark.parametrize("kind", ["protanopia", "deuteranopia", "tritanopia", "none"])
def test_roles_are_told_apart_with_any_colour_vision(kind: str) -> None:
    """Each two colours by ten times what is just seen (CIELAB), as Machado et al. (2009) simulate each blindness."""
    seen = {
        "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
        "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
        "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
        "none": np.eye(3),
    }[kind]
    srgb = np.array([[int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)] for colour, _ in ROLES.values()])
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    xyz = np.clip(linear @ np.transpose(seen), 0, 1) @ np.transpose(
        [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    )
    f = np.cbrt(np.maximum(xyz / [0.9505, 1.0, 1.089], 216 / 24389))
    lab = np.stack([116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], axis=1)
    apart = np.linalg.norm(lab[:, None] - lab[None], axis=2)[np.triu_indices(len(lab), 1)]
    assert apart.min() > 10.0


def drawing(text: str, printer: Printer, folder: Path, **more: object) -> ET.Element:
    draw_toolpath(text, folder / "a.svg", printer=printer, **more)  # type: ignore[arg-type]
    return ET.parse(folder / "a.svg").getroot()


def test_the_picture_has_true_arcs_to_scale(planned: Plan, printer: Printer, tmp_path: Path) -> None:
    root = drawing(emit(planned.program, printer), printer, tmp_path, title="Tool path of <P1>")
    assert root.get("width") == root.get("viewBox").split()[2] + "mm"  # one unit is a millimetre
    groups = {g.get("class"): g for g in root.iter(f"{SVG}g") if g.get("class")}
    assert set(groups) == set(ROLES) - {"print-overrun", "cleaning"}
    for role, group in groups.items():
        assert group.get("stroke") == ROLES[role][0]
    arcs = sum(path.get("d").count("A") for path in groups["print"].iter(f"{SVG}path"))
    assert arcs == 2 * (2 + 4)  # a half turn in two parts, a full circle in four
    words = [t.text for t in root.iter(f"{SVG}text")]
    assert words[0] == "Tool path of <P1>" and any(w.startswith("print: ") for w in words)


def test_arcs_turn_the_right_way(printer: Printer, tmp_path: Path) -> None:
    """Endpoints, radius and flag of SVG, drawn with y up: the middle of each arc is where ours is."""
    head = "G90\nM83\nM302 P1\nG0 Z10 F300\nG0 X100 Y100\nG0 Z1.6\n"
    for code, side in (("G2", 1.0), ("G3", -1.0)):
        root = drawing(head + f"{code} X102 Y100 I1 J0 E10 F240", printer, tmp_path)
        d = next(p.get("d") for p in root.iter(f"{SVG}path") if "A" in p.get("d", ""))
        first = d.split("A")[1].split()
        # The first of two quarter turns ends at the middle of the half turn.
        assert float(first[5]) == 101.0 and float(first[6]) == pytest.approx(100 + side)
        assert first[4] == ("0" if code == "G2" else "1")


def test_the_wall_is_drawn_where_the_piece_lies(planned: Plan, printer: Printer, tmp_path: Path) -> None:
    edges = np.array([[[0.0, 0.0], [120.0, 0.0]], [[120.0, 0.0], [120.0, 100.0]]])
    root = drawing(emit(planned.program, printer), printer, tmp_path, outline=edges, shift=planned.offset)
    (wall,) = [p for p in root.iter(f"{SVG}path") if p.get("class") == "wall"]
    assert wall.get("d") == "M115 125L235 125 M235 125L235 225"
    width, height = (float(v) for v in root.get("viewBox").split()[2:])
    assert width == pytest.approx(120 + 16) and height > 100  # the park, 110 mm away, does not widen it


def test_other_peoples_files_and_files_without_ink(printer: Printer, tmp_path: Path) -> None:
    assert drawing("G28\nG0 X5 Y5 F600\nG0 X9", printer, tmp_path).tag == f"{SVG}svg"
    assert math.isfinite(float(drawing("; nothing", printer, tmp_path).get("viewBox").split()[3]))
    with pytest.raises(InputError, match="line 1: cannot read"):
        drawing("hello", printer, tmp_path)
