"""A piece, sensors of plain lines and arcs, and strategies for paths that use every kind of segment."""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import strategies as st

from gcode.emit import emit
from gcode.geometry import shape_of
from gcode.plan import plan
from gcode.printer import Printer, load_printer
from gcode.program import Comment, Extrude, Prime, Program, Retract, Travel
from skinfab.material import Material, load_material
from skinfab.paths import Arc, Line, Path
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor

AREA = 0.484  # mm^2


@dataclass(frozen=True)
class Given:
    """Stands in for a pattern: any path at all."""

    drawn: Path

    def path(self) -> Path:
        return self.drawn

    def printed_path(self) -> Path:
        return self.drawn


@st.composite
def paths(draw: st.DrawFn) -> Path:
    """Up to six lines and arcs end to end, turned anyhow, somewhere within 350 mm."""
    at, segments = np.zeros(2), []
    for _ in range(draw(st.integers(1, 6))):
        heading = draw(st.floats(-math.pi, math.pi))
        ahead = np.array([math.cos(heading), math.sin(heading)])
        if draw(st.booleans()):
            segments.append(Line(at, at + draw(st.floats(1e-3, 60)) * ahead))
        else:
            radius = draw(st.floats(0.02, 40))
            sweep = draw(st.floats(0.01, 2 * math.pi)) * draw(st.sampled_from((-1, 1)))
            segments.append(Arc(at - radius * ahead, radius, heading, sweep))
        at = segments[-1].end
    shift = draw(st.tuples(st.floats(0, 350), st.floats(0, 350)))
    return Path(tuple(segments)).transformed(angle=draw(st.floats(-math.pi, math.pi)), shift=shift)


def program_of(path: Path, *, speed: float = 4.0) -> Program:
    """A path printed as it is, with everything a pattern has around it."""
    shapes = [shape_of(s) for s in path.segments]
    extrusions = [Extrude(s, AREA * s.length, speed) for s in shapes]
    around = (
        Comment("pattern C1"),
        Travel(z=10.0, speed=5.0),
        Travel(*shapes[0].start, speed=100.0),
        Travel(z=1.6, speed=5.0),
        Prime(0.5, 1.0),
    )
    return Program("P1", (*around, *extrusions, Retract(0.5, 1.0), Travel(z=10.0, speed=5.0)))


@pytest.fixture(scope="session")
def any_path() -> st.SearchStrategy[Path]:
    return paths()


@pytest.fixture(scope="session")
def any_program() -> st.SearchStrategy[Program]:
    return st.builds(program_of, paths(), speed=st.floats(0.01, 300))


@pytest.fixture(scope="session")
def make_program() -> Callable[[Path], Program]:
    return program_of


@pytest.fixture(scope="session")
def printer() -> Printer:
    return load_printer()


@pytest.fixture(scope="session")
def material() -> Material:
    return load_material()


@pytest.fixture(scope="session")
def make_piece() -> Callable[[float, float], Piece]:
    def rectangle(width: float, depth: float) -> Piece:
        corners = np.array([[0, 0], [width, 0], [width, depth], [0, depth]], dtype=float)
        return Piece("P1", np.array([0, 1]), np.arange(4), np.array([[0, 1, 2], [0, 2, 3]]), corners)

    return rectangle


@pytest.fixture(scope="session")
def make_sensor() -> Callable[..., Sensor]:
    def sensor(id: str, path: Path, x: float, y: float, angle: float = 0.0, piece: str = "P1") -> Sensor:
        return Sensor(id, piece, Given(path), x, y, angle, 0)  # type: ignore[arg-type]

    return sensor


@pytest.fixture(scope="session")
def hairpin() -> Path:
    """60 mm out, a half turn of radius 5, 60 mm back, and nine tenths of a circle at the end, short of its own ink."""
    return Path(
        (
            Line((0, 0), (60, 0)),
            Arc((60, 5), 5.0, -math.pi / 2, math.pi),
            Line((60, 10), (0, 10)),
            Arc((0, 13), 3.0, -math.pi / 2, -1.8 * math.pi),
        )
    )


@pytest.fixture(scope="session")
def planned(make_piece: Callable, make_sensor: Callable, hairpin: Path, printer: Printer, material: Material):  # type: ignore[no-untyped-def]
    """Two hairpins on one piece."""
    sensors = [make_sensor("C1", hairpin, 20, 20), make_sensor("C2", hairpin, 30, 60, 0.2)]
    return plan(make_piece(120, 100), sensors, printer=printer, material=material)


#: What can be wrong with a file that still looks like one: a pattern in its text, and what to put there.
FAULTS = {
    "an arc off the bed": (r"^G3 X\S+ Y\S+ I\S+ J\S+", r"G2 X195.0000 Y155.0000 I-400.0000 J5.0000"),
    "a wrong radius": (r"^(G3 \S+ \S+ \S+) J\S+", r"\1 J4.0000"),
    "a wrong sign of E": (r"^(G1 X\S+ Y\S+) E", r"\1 E-"),
    "G90 after M83": (r"^M83.*$", "M83\nG90"),
}


@pytest.fixture(scope="session")
def faulty(planned, printer: Printer) -> Callable[[str], str]:  # type: ignore[no-untyped-def]
    """The text of the two hairpins with one planted fault of that name."""

    def text(fault: str) -> str:
        changed, count = re.subn(*FAULTS[fault], emit(planned.program, printer), count=1, flags=re.MULTILINE)
        assert count == 1
        return changed

    return text


@pytest.fixture(scope="session")
def peers_spiral() -> str:
    """A contact spiral as TSDF begins it: its lead stops at x = l, although the circle it joins meets y = 0 elsewhere."""
    lead, s, b, x0, y0 = 6.0, 22.0, 3.0, 100.0, 100.0
    return (
        "G21\nG90\nM83\nM302 P1\nG28 X Y\nG0 Z10 F300\n"
        f"G0 X{x0:.4f} Y{y0:.4f} F6000\nG0 Z1.6 F300\n"
        f"G1 X{x0 + lead:.4f} Y{y0:.4f} E24 F240\n"
        f"G3 X{x0 + lead + s:.4f} Y{y0 + b / 2:.4f} I{s / 2:.4f} J{b / 2:.4f} E132 F240\n"
        "G0 Z10 F300\n"
    )
