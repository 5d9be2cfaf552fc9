"""What is shown and judged beforehand is what is written."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gcode.emit import step_lines
from gcode.piece import PieceProgram, piece_program
from gcode.printer import Nozzle, load_printer
from gcode.program import Comment, Extrude, Prime
from gcode.write import write_skin
from skinfab.errors import InputError, RefusedError
from skinfab.material import load_material
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source

MATERIAL = load_material()


@pytest.fixture
def skin() -> Skin:
    V = np.array([[0.0, 0, 0], [60, 0, 0], [60, 40, 0], [0, 40, 0]])
    F = np.array([[0, 1, 2], [0, 2, 3]])
    pieces = (Piece("P1", np.array([0, 1]), np.arange(4), F, V[:, :2]),)
    sensors = tuple(Sensor(f"C{k}", "P1", make_pattern("contact-spiral", {"s": 12}), 15.0 + 25 * k, 20.0, 0.0, k) for k in range(2))
    return Skin(Mesh(V, F), Source("plate.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), dtype=int), pieces, sensors)


def of(skin: Skin, printer: str = "ender5plus-vipro", **options: object) -> PieceProgram:
    return piece_program(skin, "P1", printer=load_printer(printer), material=MATERIAL, **options)  # type: ignore[arg-type]


@pytest.mark.parametrize("printer", ["ender5plus-vipro", "generic-grbl"])
@pytest.mark.parametrize("arcs", [None, "native", "lines"])
def test_its_text_is_the_file(skin: Skin, printer: str, arcs: str | None, tmp_path: Path) -> None:
    shown = of(skin, printer, arcs=arcs)
    write_skin(skin, tmp_path, arcs=arcs, printer=load_printer(printer))  # type: ignore[arg-type]
    assert shown.text.encode() == (tmp_path / "P1.gcode").read_bytes()
    assert shown.judge().findings == ()


@pytest.mark.parametrize("printer", ["ender5plus-vipro", "generic-grbl"])
def test_each_step_has_its_lines(skin: Skin, printer: str) -> None:
    shown = of(skin, printer)
    text = ["", *shown.text.split("\n")]
    lines = step_lines(shown.program, shown.printer)
    assert lines.shape == (len(shown.program.steps), 2) and (lines[1:, 0] == lines[:-1, 1] + 1).all()
    assert text[lines[0, 0] - 1] == "; begin" and text[lines[-1, 1] + 1] == "; end"
    for step, (first, last) in zip(shown.program.steps, lines, strict=True):
        if isinstance(step, Comment):
            assert text[first] == f"; {step.text}" and first == last
        elif isinstance(step, Extrude):
            assert f"X{step.shape.end[0]:.4f} Y{step.shape.end[1]:.4f}" in text[last]
        elif isinstance(step, Prime) and shown.printer.spindle:
            assert [line.split()[0] for line in text[first : last + 1]] == ["M3", "G4", "M5"]


def test_faults_are_shown_not_refused(skin: Skin, tmp_path: Path) -> None:
    thick = replace(load_printer(), nozzle=Nozzle(outer_radius=9.0, clearance=0.2))
    shown = piece_program(skin, "P1", printer=thick, material=MATERIAL)
    assert any("wall" in finding.what for finding in shown.judge().findings)
    with pytest.raises(RefusedError):
        write_skin(skin, tmp_path, printer=thick)


def test_refused(skin: Skin) -> None:
    with pytest.raises(InputError, match="no piece 'P9'"):
        piece_program(skin, "P9", printer=load_printer(), material=MATERIAL)
    with pytest.raises(InputError, match="piece P1 has no sensor"):
        of(replace(skin, sensors=()))
    plain = replace(load_printer(), arcs=False)
    with pytest.raises(RefusedError, match="draws no arcs"):
        piece_program(skin, "P1", printer=plain, material=MATERIAL, arcs="native")
    assert "\nG2 " not in piece_program(skin, "P1", printer=plain, material=MATERIAL).text
