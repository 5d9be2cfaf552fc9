"""Holes: filled for the solve only, so that a flat annulus stays as it is and every bent one lies flat without a flip."""

import numpy as np
import pytest
import shapes

from skinfab.errors import InputError
from skinfab.flatten.distortion import measure, singular_values
from skinfab.flatten.holes import fill_holes, flatten_filled
from skinfab.mesh.topology import Topology


def annulus(columns: int = 48, rows: int = 8, height: float = 0.0):
    """Radii 1 to 2, closed round; the inner border, with fewer mm but as many vertices, is lifted by `height`."""
    i, j = np.meshgrid(np.arange(columns), np.arange(rows + 1))
    a, r = 2 * np.pi * i.ravel() / columns, 1 + j.ravel() / rows
    V = np.stack([r * np.cos(a), r * np.sin(a), height * (2 - r)], axis=1)
    i, j = i[:-1].ravel(), j[:-1].ravel()
    here, right = j * columns + i, j * columns + (i + 1) % columns
    F = np.stack([np.stack([here, right + columns, right], axis=-1), np.stack([here, here + columns, right + columns], axis=-1)], axis=1)
    return V, F.reshape(-1, 3)


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("mesh", [shapes.holed(), annulus()], ids=["two holes", "annulus"])
def test_what_is_flat_stays_as_it_is(mesh, unit: float) -> None:
    V, F = unit * mesh[0], mesh[1]
    uv = flatten_filled(V, F)
    assert uv.shape == (len(V), 2)
    np.testing.assert_allclose(singular_values(V, F, uv), 1, atol=1e-9)
    assert measure(V, F, uv).mean == pytest.approx(4, abs=1e-9)


def test_the_border_is_the_longest_loop_in_mm() -> None:
    V, F = annulus()
    W, G = fill_holes(V, F)
    np.testing.assert_allclose(W[len(V) :], [[0, 0, 0]], atol=1e-12)
    filled = Topology(G)
    assert filled.euler == 1 and set(filled.boundary_loops[0]) == set(range(8 * 48, 9 * 48))
    np.testing.assert_array_equal(W[: len(V)], V)
    np.testing.assert_array_equal(G[: len(F)], F)


def test_the_fans_run_as_their_neighbours_do() -> None:
    """No edge is run through twice in the same direction."""
    _, G = fill_holes(*shapes.holed())
    ways = np.concatenate([G[:, [0, 1]], G[:, [1, 2]], G[:, [2, 0]]])
    assert len(np.unique(ways, axis=0)) == len(ways)


@pytest.mark.parametrize("height", [0.3, 1.0])
def test_a_bent_annulus_has_no_flip_and_keeps_its_symmetry(height: float) -> None:
    V, F = annulus(height=height)
    uv = flatten_filled(V, F)
    figures = measure(V, F, uv)
    assert figures.flipped == 0 and figures.overlap_mm2 == 0
    radius = np.linalg.norm(uv - uv[:48].mean(axis=0), axis=1).reshape(9, 48)
    np.testing.assert_allclose(radius, radius.mean(axis=1, keepdims=True) * np.ones(48), rtol=1e-9)
    assert (np.diff(radius.mean(axis=1)) > 0).all()


def test_a_disk_is_left_alone() -> None:
    V, F = shapes.wavy()
    W, G = fill_holes(V, F)
    assert W is V and G is F


@pytest.mark.parametrize("mesh", [shapes.sphere(), shapes.torus()], ids=["sphere", "torus"])
def test_what_stays_no_disk_is_named(mesh) -> None:
    with pytest.raises(InputError, match="only a disk can be flattened"):
        flatten_filled(*mesh)
