"""Ears cut off: only they, all of them, and a rectangle then has room for what is left."""

import numpy as np
import pytest
import shapes

from skinfab.errors import InputError, RefusedError
from skinfab.flatten.bff import BffSolver
from skinfab.flatten.distortion import measure
from skinfab.flatten.ears import cut_ears
from skinfab.mesh.topology import Topology


def ears_of(F: np.ndarray) -> int:
    edges = np.sort(np.stack([F, np.roll(F, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    _, which, times = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    return int(((times[which.reshape(-1)].reshape(-1, 3) == 1).sum(axis=1) > 1).sum())


def ragged() -> tuple[np.ndarray, np.ndarray]:
    """A sheet with two rows of teeth on it: an ear on an ear."""
    V, F = shapes.grid(8, 6)
    teeth = np.column_stack([np.arange(8) / 8 + 0.06, np.full(8, -0.1), np.zeros(8)])
    tips = teeth + np.array([0.03, -0.1, 0])
    k = np.arange(8)
    first, second = np.column_stack([k, 63 + k, k + 1]), np.column_stack([k, 71 + k, 63 + k])
    return np.vstack([V, teeth, tips]), np.vstack([F, first, second])


@pytest.mark.parametrize("mesh", [shapes.wavy(), shapes.cone_sheet(), ragged()], ids=["square", "cone", "teeth on teeth"])
def test_no_ear_is_left_and_the_rest_is_the_same_surface(mesh) -> None:
    V, F = mesh
    W, G, kept = cut_ears(V, F)
    assert ears_of(F) > 0 == ears_of(G) and Topology(G).euler == 1
    np.testing.assert_array_equal(V[kept], W)
    assert {tuple(t) for t in kept[G].tolist()} <= {tuple(t) for t in F.tolist()}
    assert len(F) - len(G) <= 2 * 8 + 2


def test_without_ears_nothing_changes() -> None:
    V, F = shapes.cap(6)
    W, G, kept = cut_ears(V, F)
    assert (W == V).all() and (G == F).all() and (kept == np.arange(len(V))).all()


def test_a_square_without_its_ears_lies_in_a_rectangle() -> None:
    rectangle = np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]])
    V, F = shapes.wavy(20)
    with pytest.raises(RefusedError, match=r"cut_ears"):
        BffSolver(V, F).curve(rectangle)
    V, F, _ = cut_ears(V, F)
    assert measure(V, F, BffSolver(V, F).curve(rectangle)).flipped == 0


def test_a_strip_has_nothing_else() -> None:
    with pytest.raises(InputError, match="each of the 10 triangles hangs on the border"):
        cut_ears(*shapes.grid(5, 1))
