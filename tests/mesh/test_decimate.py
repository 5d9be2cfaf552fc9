"""Decimation: fewer triangles of the same disk, every fine vertex accounted for, whatever the unit."""

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.mesh.decimate import decimate
from skinfab.mesh.topology import Topology


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
def test_the_same_disk_in_any_unit(unit: float) -> None:
    V, F = shapes.wavy(40)
    few, same = decimate(V, F, faces=200), decimate(V * unit + 3 * unit, F, faces=200)
    assert np.array_equal(few.F, same.F) and np.array_equal(few.onto, same.onto)
    np.testing.assert_allclose(same.V / unit - 3, few.V, atol=1e-6)
    top = Topology(few.F)
    assert 190 <= len(few.F) <= 200 and top.euler == 1 and len(top.boundary_loops) == 1 and top.is_oriented_manifold
    assert np.array_equal(top.used_vertices, np.arange(len(few.V)))


@settings(max_examples=15, deadline=None)
@given(st.integers(6, 30), st.integers(3, 12), st.floats(0, 0.5))
def test_every_fine_vertex_goes_into_a_coarse_one_nearby(n: int, fewer: int, height: float) -> None:
    V, F = shapes.wavy(n, height)
    few = decimate(V, F, faces=len(F) // fewer)
    assert np.array_equal(np.unique(few.onto), np.arange(len(few.V)))
    # A collapse goes to a neighbour: what goes into one vertex is connected, so each coarse vertex has a patch of the mesh.
    size = np.bincount(few.onto, minlength=len(few.V)).max()
    edge = np.linalg.norm(V[F[:, 0]] - V[F[:, 1]], axis=1).max()
    assert np.linalg.norm(few.V[few.onto] - V, axis=1).max() <= size * edge


def test_triangles_are_those_of_the_collapsed_corners() -> None:
    """Where two collapses gave a triangle the same corner twice it is gone; what is left is F through the map."""
    V, F = shapes.cap(12, 1.2)
    few = decimate(V, F, faces=150)
    G = few.onto[F]
    G = G[(G[:, 0] != G[:, 1]) & (G[:, 1] != G[:, 2]) & (G[:, 2] != G[:, 0])]
    assert np.array_equal(few.F, G)


def test_a_part_that_would_vanish_is_said() -> None:
    V, F = shapes.wavy(30)
    speck = np.array([[0.0, 0, 40], [1e-3, 0, 40], [0, 1e-3, 40]])
    with pytest.raises(InputError, match=r"1801 triangles cannot be brought down to 1: parts of the surface vanish"):
        decimate(np.vstack([V, speck]), np.vstack([F, len(V) + np.arange(3)]), faces=1)
