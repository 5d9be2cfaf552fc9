"""What BFF refuses or names: boundaries that cannot be or were not met, and meshes that are no disk."""

import numpy as np
import pytest
import shapes

from skinfab.errors import InputError, RefusedError
from skinfab.flatten.bff import BffSolver, flatten_disk
from skinfab.flatten.bff_curve import close_curve, scaled_lengths, turning_of


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda s: s.scale(np.zeros(7)), r"scale factors are 48 finite numbers, .* shape \(7,\)"),
        (lambda s: s.scale(np.full(48, np.nan)), "scale factors are 48 finite numbers"),
        (lambda s: s.lengths(np.r_[np.ones(47), 0]), "boundary edge 47 has length 0 mm in the target lengths"),
        (
            lambda s: s.lengths(np.r_[10 * s.lengths_mm.sum(), s.lengths_mm[1:]]),
            "edge 0 has length .* in the target lengths, the others together .*; no closed curve",
        ),
        (lambda s: s.angles(np.zeros(48)), "sum to 0 rad; a closed curve turns by 2 pi"),
        (lambda s: s.curve(np.zeros((2, 2))), r"three or more finite points .* \(2, 2\)"),
        (lambda s: s.curve(np.array([[0.0, 0], [0, 1], [1, 1]])), "counter-clockwise"),
    ],
    ids=["count", "not a number", "no length", "a length too long", "angles", "two points", "clockwise"],
)
def test_a_boundary_that_cannot_be_is_named(call, says: str) -> None:
    with pytest.raises(InputError, match=says):
        call(BffSolver(*shapes.wavy()))


def random_turning(solver: BffSolver, size: float) -> np.ndarray:
    turning = size * np.random.default_rng(0).standard_normal(len(solver.boundary))
    return turning + (2 * np.pi - turning.sum()) / len(turning)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda s: s.angles(random_turning(s, 0.5)), r"\d+ of 288 triangles come out upside down with these turning angles"),
        (lambda s: s.lengths(s.lengths_mm * np.r_[20, np.ones(47)]), r"the boundary closes only with edge \d+ \d+ % off its length"),
        (
            lambda s: s.lengths(s.lengths_mm * np.where(np.arange(48) % 4 == 0, 20, 1)),
            r"\d+ of 288 triangles come out upside down with these lengths",
        ),
    ],
    ids=["angles", "length", "lengths"],
)
def test_a_boundary_that_was_not_met_or_turns_triangles_over_is_refused(call, says: str) -> None:
    with pytest.raises(RefusedError, match=says):
        call(BffSolver(*shapes.wavy()))


def comb(teeth: int = 6, depth: float = 0.5):
    """A sheet with a row of sharp teeth on one side."""
    V, F = shapes.grid(teeth, 4)
    k = np.arange(teeth)
    tips = np.column_stack([(k + 0.5) / teeth, np.full(teeth, -depth), np.zeros(teeth)])
    return np.vstack([V, tips]), np.vstack([F, np.column_stack([k, len(V) + k, k + 1])])


def test_edges_that_would_run_backwards_are_refused() -> None:
    """Turned like a circle the teeth's edges all but vanish, and closing the curve takes more than is left of them."""
    V, F = comb()
    solver = BffSolver(V, F)
    turning = np.full(len(solver.boundary), 2 * np.pi / len(solver.boundary))
    plain = close_curve(scaled_lengths(solver.lengths_mm, solver.scale_of(turning)), turning)
    assert np.abs(turning_of(plain) - turning).max() > 3
    with pytest.raises(RefusedError, match=r"closes only with edges that run backwards: its turning is off by 3\.14 rad"):
        solver.angles(turning)


def pair(V, F):
    return np.vstack([V, V + 9]), np.vstack([F, F + len(V)])


@pytest.mark.parametrize(
    ("mesh", "says"),
    [
        (shapes.sphere(), "1 components, 0 boundary loops, Euler number 2"),
        (shapes.torus(), "1 components, 0 boundary loops, Euler number 0"),
        (shapes.holed(), "3 boundary loops, Euler number -1"),
        (pair(*shapes.wavy()), "2 components, 2 boundary loops"),
        ((np.vstack([shapes.wavy()[0], [9, 9, 9]]), shapes.wavy()[1]), "1 unused vertices"),
    ],
    ids=["sphere", "torus", "holes", "two components", "unused vertex"],
)
def test_what_is_no_disk_is_named(mesh, says: str) -> None:
    with pytest.raises(InputError, match=f"only a disk can be flattened: this has .*{says}.*; cut it first"):
        flatten_disk(*mesh)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_coordinates_that_are_no_numbers_are_named(value: float) -> None:
    V, F = shapes.wavy()
    V[77, 1] = value
    with pytest.raises(InputError, match="vertex 77 "):
        flatten_disk(V, F)
