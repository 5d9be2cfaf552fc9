"""A piece with two sensors, its program, and that laid out over time."""

import numpy as np
import pytest

from gcode.piece import PieceProgram, piece_program
from gcode.printer import load_printer
from gui.toolpath.timeline import Timeline, timeline
from skinfab.material import load_material
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source


@pytest.fixture(scope="session")
def printed() -> Skin:
    """Two plates of 60 x 40 mm; two sensors on the first, one on the second."""
    V = np.array([[0.0, 0, 0], [60, 0, 0], [60, 40, 0], [0, 40, 0], [120, 0, 0], [120, 40, 0]])
    F = np.array([[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]])
    UV = np.array([[0.0, 0], [60, 0], [60, 40], [0, 40]])
    local = np.array([[0, 1, 2], [0, 2, 3]])
    pieces = (Piece("P1", np.array([0, 1]), np.arange(4), local, UV), Piece("P2", np.array([2, 3]), np.array([1, 4, 5, 2]), local, UV))
    spiral = make_pattern("contact-spiral", {"s": 12})
    places = (("C1", "P1", 15.0), ("C2", "P1", 40.0), ("C3", "P2", 20.0))
    sensors = tuple(Sensor(id, piece, spiral, x, 20.0, 0.0, k) for k, (id, piece, x) in enumerate(places))
    return Skin(Mesh(V, F), Source("plate.obj", "0" * 64, "mm", 1.0), np.array([[1, 2]]), pieces, sensors)


def program_of(skin: Skin, printer: str) -> PieceProgram:
    return piece_program(skin, "P1", printer=load_printer(printer), material=load_material())


@pytest.fixture(scope="session", params=["ender5plus-vipro", "generic-grbl"])
def program(printed: Skin, request: pytest.FixtureRequest) -> PieceProgram:
    """For Marlin and for GRBL."""
    return program_of(printed, request.param)


@pytest.fixture(scope="session")
def line(program: PieceProgram) -> Timeline:
    return timeline(program)


@pytest.fixture(scope="session")
def marlin(printed: Skin) -> Timeline:
    return timeline(program_of(printed, "ender5plus-vipro"))
