"""A skin whose every figure is known in closed form: a box's side wall, rolled open."""

from collections.abc import Iterator

import numpy as np
import pytest

from skinfab.flatten.distortion import Distortion, measure
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.report import preview
from skinfab.skin import Skin, Source

#: Before tests/conftest.py makes it small.
DPI = 150

SIDE, HEIGHT, STEPS = 60.0, 50.0, 8


def wall_skin(*, file: str = "wall.obj") -> Skin:
    """Four square walls of 60 x 50 mm, cut open along one upright edge; flat without any distortion."""
    t = np.linspace(0, 1, STEPS + 1)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]) * SIDE
    ring = np.vstack([square[k] + t[:-1, None] * (square[k + 1] - square[k]) for k in range(4)])
    n, levels = len(ring), np.linspace(0, HEIGHT, STEPS + 1)
    V = np.vstack([np.c_[ring, np.full(n, z)] for z in levels])
    along = np.linspace(0, 4 * SIDE, n + 1)
    UV = np.vstack([np.c_[along, np.full(n + 1, z)] for z in levels])
    vertices = np.concatenate([np.append(np.arange(n), 0) + k * n for k in range(STEPS + 1)])
    k = (np.arange(STEPS)[:, None] * (n + 1) + np.arange(n)).ravel()
    F = np.vstack([np.c_[k, k + 1, k + n + 2], np.c_[k, k + n + 2, k + n + 1]])
    seam = np.arange(STEPS + 1) * n
    sensors = (
        Sensor("S1", "P1", make_pattern("strain-lines", {"l1": 60, "l2": 54, "b": 6}), 90.0, 20.0, 0.0, 0),
        Sensor("C1", "P1", make_pattern("contact-spiral", {"n": 3, "x": 1.7, "b": 1.5, "l": 3, "s": 15}), 20.0, 20.0, 0.5, 1),
    )
    piece = Piece("P1", np.arange(len(F)), vertices, F, UV)
    mesh = Mesh(V, vertices[F], "wall")
    return Skin(mesh, Source(file, "ab" * 32, "mm", 1.0), np.c_[seam[:-1], seam[1:]], (piece,), sensors)


@pytest.fixture(scope="module", autouse=True)
def previews_in_full() -> Iterator[None]:
    """As users have them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(preview, "_DPI", DPI)
        yield


@pytest.fixture
def skin() -> Skin:
    return wall_skin()


@pytest.fixture
def distortions(skin: Skin) -> list[Distortion]:
    return [measure(piece.V(skin.mesh), piece.F, piece.UV) for piece in skin.pieces]
