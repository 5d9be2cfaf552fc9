"""Each part for itself: the same bytes as the commands write, whole or not at all, files known beforehand."""

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gcode import export
from gcode.write import write_skin
from skinfab.document import save_skin
from skinfab.errors import InputError, RefusedError
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source


@pytest.fixture(scope="module")
def skin() -> Skin:
    """Two plates of 60 x 40 mm, bent along their seam; two sensors on the first."""
    V = np.array([[0.0, 0, 0], [60, 0, 0], [60, 40, 0], [0, 40, 0], [60, 0, 60], [60, 40, 60]])
    F = np.array([[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]])
    UV = np.array([[0.0, 0], [60, 0], [60, 40], [0, 40]])
    local = np.array([[0, 1, 2], [0, 2, 3]])
    pieces = (Piece("P1", np.array([0, 1]), np.arange(4), local, UV), Piece("P2", np.array([2, 3]), np.array([1, 4, 5, 2]), local, UV))
    spiral = make_pattern("contact-spiral", {"s": 12})
    sensors = tuple(Sensor(id, "P1", spiral, x, 20.0, 0.0, k) for k, (id, x) in enumerate((("C1", 15.0), ("C2", 40.0))))
    return Skin(Mesh(V, F), Source("bent.obj", "0" * 64, "mm", 1.0), np.array([[1, 2]]), pieces, sensors)


def tree(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


@pytest.mark.parametrize("arcs", [None, "native", "lines"])
def test_gcode_is_what_the_command_writes(skin: Skin, arcs: str | None, tmp_path: Path) -> None:
    told = export.export_gcode(skin=skin, folder=tmp_path / "a", arcs=arcs)  # type: ignore[arg-type]
    write_skin(skin, tmp_path / "b", arcs=arcs)  # type: ignore[arg-type]
    assert tree(tmp_path / "a") == tree(tmp_path / "b")
    assert told.files == (tmp_path / "a" / "P1.gcode",) and export.files_of("gcode", skin) == ("P1.gcode",)


def test_moulds_are_what_the_command_writes(skin: Skin, tmp_path: Path) -> None:
    told = export.export_moulds(skin=skin, folder=tmp_path / "a")
    save_skin(skin, tmp_path / "bent.skin")
    command = [sys.executable, "-m", "skinfab", "mould", str(tmp_path / "bent.skin"), "-o", str(tmp_path / "b")]
    subprocess.run(command, check=True, capture_output=True)
    assert tree(tmp_path / "a") == tree(tmp_path / "b")
    assert [p.name for p in told.files] == list(export.files_of("moulds", skin)) == ["P1.stl", "P2.stl"]


def test_everything_is_what_make_writes(skin: Skin, tmp_path: Path) -> None:
    seen: list[float] = []
    told = export.export_everything(skin=skin, folder=tmp_path / "a", progress=lambda fraction, label: seen.append(fraction))
    save_skin(skin, tmp_path / "bent.skin")
    command = [sys.executable, "-m", "skinfab", "make", str(tmp_path / "bent.skin"), "-o", str(tmp_path / "b")]
    subprocess.run(command, check=True, capture_output=True)
    mine, theirs = tree(tmp_path / "a"), tree(tmp_path / "b")
    assert set(mine) == set(theirs) == set(export.files_of("everything", skin))
    assert sorted(str(p.relative_to(tmp_path / "a")) for p in told.files) == sorted(mine)
    differ = {name for name in mine if mine[name] != theirs[name]}
    assert differ <= {"report.json", "report.html", "preview.png"}  # they say how long it took
    reports = [json.loads(each["report.json"]) for each in (mine, theirs)]
    for report in reports:
        del report["timing_s"], report["peak_rss_mb"]
    assert reports[0] == reports[1]
    (bare,) = [text for text in told.notes if "P2" in text]
    assert bare.startswith("piece P2 has no sensor") and bare in reports[0]["warnings"]
    assert seen == sorted(seen) and seen[-1] == 1.0


def test_without_sensors_everything_but_gcode(skin: Skin, tmp_path: Path) -> None:
    bare = replace(skin, sensors=())
    export.export_everything(skin=bare, folder=tmp_path)
    assert set(tree(tmp_path)) == set(export.files_of("everything", bare))
    assert not any(name.startswith("gcode/") for name in tree(tmp_path))


def test_a_part_leaves_the_rest_of_an_earlier_run(skin: Skin, tmp_path: Path) -> None:
    """report.json lists moulds and G-code of all pieces: none of these may go because one part is made anew."""
    export.export_everything(skin=skin, folder=tmp_path)
    before = tree(tmp_path)
    export.export_gcode(skin=skin, folder=tmp_path)
    assert tree(tmp_path) == {**before, "P1.gcode": before["gcode/P1.gcode"]}
    # Everything, on the other hand, tidies up as make does.
    export.export_everything(skin=replace(skin, sensors=()), folder=tmp_path)
    assert "gcode/P1.gcode" not in tree(tmp_path)


def test_other_files_of_the_kind_are_told(skin: Skin, tmp_path: Path) -> None:
    (tmp_path / "P7.gcode").write_text("G28")
    told = export.export_gcode(skin=skin, folder=tmp_path)
    assert "also holds P7.gcode" in told.notes[-1] and (tmp_path / "P7.gcode").read_text() == "G28"


@pytest.mark.parametrize("kind", ["svg", "dxf", "pdf", "obj"])
def test_a_drawing_is_that_of_make(skin: Skin, kind: str, tmp_path: Path) -> None:
    told = export.export_drawing(skin=skin, kind=kind, path=tmp_path / f"mine.{kind}")  # type: ignore[arg-type]
    if "all" not in MADE:
        MADE["all"] = tmp_path / "all"
        export.export_everything(skin=skin, folder=MADE["all"])
    assert told.files[0].read_bytes() == (MADE["all"] / f"flat.{kind}").read_bytes()


#: Made once.
MADE: dict[str, Path] = {}


def test_the_report_is_one_page(skin: Skin, tmp_path: Path) -> None:
    told = export.export_report(skin=skin, path=tmp_path / "r.html")
    assert set(tree(tmp_path)) == {"r.html"} and told.files == (tmp_path / "r.html",)
    page = told.files[0].read_text()
    assert "P1" in page and "data:image/png" in page


def faulty(skin: Skin) -> Skin:
    """A sensor lies beside its piece."""
    return replace(skin, sensors=(replace(skin.sensors[0], x=1.0), *skin.sensors[1:]))


@pytest.mark.parametrize("what", ["gcode", "everything"])
def test_a_faulty_skin_writes_nothing(skin: Skin, what: str, tmp_path: Path) -> None:
    target = tmp_path / "out"
    with pytest.raises(RefusedError, match="C1"):
        getattr(export, f"export_{what}")(skin=faulty(skin), folder=target)
    with pytest.raises(RefusedError, match="C1"):
        export.export_report(skin=faulty(skin), path=tmp_path / "r.html")
    assert list(tmp_path.iterdir()) == []


def test_what_cannot_be_written_is_a_sentence(skin: Skin, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    with pytest.raises(InputError, match="in the way"):
        export.export_gcode(skin=skin, folder=tmp_path / "file")
    with pytest.raises(InputError, match="no sensor"):
        export.export_gcode(skin=replace(skin, sensors=()), folder=tmp_path / "out")
    for kind in ("svg", "pdf"):
        with pytest.raises(InputError, match="gone"):
            export.export_drawing(skin=skin, kind=kind, path=tmp_path / "gone" / f"a.{kind}")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="gone"):
        export.export_report(skin=skin, path=tmp_path / "gone" / "r.html")
    with pytest.raises(ValueError, match="no drawing 'png'"):
        export.export_drawing(skin=skin, kind="png", path=tmp_path / "a.png")  # type: ignore[arg-type]
    tiny = replace(skin.pieces[0], UV=skin.pieces[0].UV * 1e-3)
    with pytest.raises(InputError, match="too small to be cast"):
        export.export_moulds(skin=replace(skin, pieces=(tiny,), sensors=()), folder=tmp_path / "out")
    assert tree(tmp_path) == {"file": b"x"}
