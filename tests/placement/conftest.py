"""Small pieces made by hand."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece

Sheet = tuple[Mesh, Piece]


def sheet(
    width: float, height: float, *, step: float = 5.0, without: Callable | None = None, slit: bool = False, scale: float = 1.0
) -> Sheet:
    """A flat rectangle and its piece, `scale` times as large in the plane.

    `without(centres)` says which triangles to leave out; `slit` opens the vertical middle line from below to
    half the height, without width.
    """
    nx, ny = round(width / step), round(height / step)
    x, y = np.meshgrid(np.linspace(0, width, nx + 1), np.linspace(0, height, ny + 1))
    flat = np.column_stack([x.ravel(), y.ravel()])
    a = (np.arange(ny)[:, None] * (nx + 1) + np.arange(nx)).ravel()
    F = np.concatenate([np.column_stack([a, a + 1, a + nx + 2]), np.column_stack([a, a + nx + 2, a + nx + 1])])
    if without is not None:
        F = F[~without(flat[F].mean(axis=1))]
    vertices = np.arange(len(flat))
    if slit:
        on = np.flatnonzero(np.isclose(flat[:, 0], width / 2) & (flat[:, 1] < height / 2 - 1e-9))
        copy = np.arange(len(flat))
        copy[on] = len(flat) + np.arange(len(on))
        right = flat[F].mean(axis=1)[:, 0] > width / 2
        F = np.where(right[:, None], copy[F], F)
        vertices = np.concatenate([vertices, on])
    used, compact = np.unique(F, return_inverse=True)
    vertices, pieceF = vertices[used], compact.reshape(-1, 3)
    mesh = Mesh(np.column_stack([flat, np.zeros(len(flat))]), vertices[pieceF], "sheet")
    return mesh, Piece("P1", np.arange(len(F)), vertices, pieceF, scale * flat[vertices])


@pytest.fixture(name="sheet")
def sheet_fixture() -> Callable[..., Sheet]:
    return sheet


@pytest.fixture
def cube_net() -> Callable[[float], Sheet]:
    """A cube of 12 triangles, cut along seven edges and unfolded into a cross."""

    def build(side: float) -> Sheet:
        cells = {(1, 0): "bottom", (1, 1): "front", (1, 2): "top", (1, 3): "back", (0, 1): "left", (2, 1): "right"}
        corner: dict[tuple[int, int], int] = {}
        F, UV, space = [], [], []

        def fold(i: int, j: int) -> tuple[float, float, float]:
            # Roll the cross up: rows wrap round the x axis, columns fold back at the front face.
            if (j in (1, 2)) and i in (0, 3):
                return (0.0 if i == 0 else 1.0, {1: 0.0, 2: 1.0}[j], 1.0)
            ring = {0: (0.0, 1.0), 1: (0.0, 0.0), 2: (1.0, 0.0), 3: (1.0, 1.0), 4: (0.0, 1.0)}[j]
            return (float(i - 1), *ring)

        for i, j in cells:
            ids = []
            for at in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                if at not in corner:
                    corner[at] = len(UV)
                    UV.append(at)
                    space.append(fold(*at))
                ids.append(corner[at])
            F += [[ids[0], ids[1], ids[2]], [ids[0], ids[2], ids[3]]]
        V, vertices = np.unique(np.array(space), axis=0, return_inverse=True)
        pieceF = np.array(F)
        return Mesh(side * V, vertices[pieceF], "cube"), Piece(
            "P1", np.arange(12), vertices.ravel().astype(np.int64), pieceF, side * np.array(UV, dtype=float)
        )

    return build
