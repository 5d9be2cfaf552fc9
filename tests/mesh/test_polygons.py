"""Triangulations keep the area, the winding and the border of the polygon."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.mesh.polygons import triangulate


def _area(ring: np.ndarray) -> float:
    x, y = ring[:, 0], ring[:, 1]
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2)


@given(st.lists(st.floats(1, 10), min_size=4, max_size=40), st.floats(0, 6))
def test_star_shaped_polygons(radii: list[float], tilt: float) -> None:
    angle = 2 * np.pi * np.arange(len(radii)) / len(radii)
    flat = np.column_stack([radii * np.cos(angle), radii * np.sin(angle)])
    V = np.column_stack([flat[:, 0], flat[:, 1] * np.cos(tilt), flat[:, 1] * np.sin(tilt)])
    n = len(V)
    F = triangulate(V, np.arange(n), np.array([n]))
    mesh = Mesh(V, F)
    assert len(F) == n - 2
    np.testing.assert_allclose(mesh.area, _area(flat), rtol=1e-9)  # nothing folded: it would count twice
    np.testing.assert_allclose(mesh.face_cross.sum(axis=0) / 2, _area(flat) * np.array([0, -np.sin(tilt), np.cos(tilt)]), atol=1e-6)
    (loop,) = mesh.topology.boundary_loops
    assert np.roll(loop, -int(np.argmin(loop))).tolist() == list(range(n))


def test_mixed_sizes_keep_their_order() -> None:
    V = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]])
    F = triangulate(V, np.array([1, 4, 2, 0, 1, 2, 3]), np.array([3, 4]))
    assert F.tolist() == [[1, 4, 2], [0, 1, 2], [0, 2, 3]]


def test_a_huge_polygon_that_is_not_convex_is_refused() -> None:
    n = 10_002
    angle, radius = 2 * np.pi * np.arange(n) / n, np.where(np.arange(n) % 2, 2.0, 1.0)
    V = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle])
    with pytest.raises(InputError, match="10002 corners"):
        triangulate(V, np.arange(n), np.array([n]))
