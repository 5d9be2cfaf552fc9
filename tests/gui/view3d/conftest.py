"""A small document, and a window that shows it."""

from dataclasses import replace

import numpy as np
import pytest

from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import SeamMarks, Skin, Source

COLUMNS, ROWS, STEP = 24, 12, 5.0


def sheet(first: int, last: int, name: str) -> Piece:
    """Columns `first` to `last` of the wall below, flat as they are."""
    i, j = np.meshgrid(np.arange(first, last + 1), np.arange(ROWS + 1), indexing="ij")
    vertices = (i * (ROWS + 1) + j).ravel()
    cell = np.add.outer(np.arange(last - first) * (ROWS + 1), np.arange(ROWS)).ravel()
    F = np.concatenate([np.column_stack([cell, cell + ROWS + 1, cell + ROWS + 2]), np.column_stack([cell, cell + ROWS + 2, cell + 1])])
    count, start = COLUMNS * ROWS, first * ROWS
    faces = np.concatenate([start + np.arange(len(cell)), count + start + np.arange(len(cell))])
    order = np.argsort(faces)
    return Piece(name, faces[order], vertices, F[order], STEP * np.column_stack([(i - first).ravel(), j.ravel()]).astype(float))


@pytest.fixture
def skin() -> Skin:
    """A wall of 120 x 60 mm in the plane y = 0, seen from the front: P1 left, P2 right, a seam between them, a spiral on P2.

    One edge of the seam is locked, one edge on P1 forbidden, some faces of P1 are painted.
    """
    i, j = (a.ravel() for a in np.meshgrid(np.arange(COLUMNS + 1), np.arange(ROWS + 1), indexing="ij"))
    V = STEP * np.column_stack([i, 0 * i, j]).astype(float)
    cell = np.add.outer(np.arange(COLUMNS) * (ROWS + 1), np.arange(ROWS)).ravel()
    F = np.concatenate([np.column_stack([cell, cell + ROWS + 1, cell + ROWS + 2]), np.column_stack([cell, cell + ROWS + 2, cell + 1])])
    middle = COLUMNS // 2 * (ROWS + 1) + np.arange(ROWS + 1)
    seams = np.column_stack([middle[:-1], middle[1:]])
    preference = np.zeros(len(F), dtype=np.int8)
    preference[:10], preference[20:30] = 1, -1
    forbidden = np.array([[3 * (ROWS + 1) + 2, 4 * (ROWS + 1) + 2]])
    marks = SeamMarks(seams[:1], forbidden, preference)
    sensor = Sensor("C1", "P2", make_pattern("contact-spiral", {"s": 20}), 30.0, 30.0, 0.0, 0)
    bare = Skin(Mesh(V, F, "wall"), Source("wall.obj", "0" * 64, "mm", 1.0), seams, (sheet(0, 12, "P1"), sheet(12, 24, "P2")), (sensor,))
    return replace(bare, marks=marks)
