"""The sparse Cholesky against numpy, its reuse, and its counters."""

from types import SimpleNamespace

import numpy as np
import pytest
from cvxopt import cholmod
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csc_array

from skinfab import linalg
from skinfab.linalg import Cholesky, NotPositiveDefiniteError


def definite(seed: int, n: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    a = rng.standard_normal((n, n)) * (rng.random((n, n)) < 0.3)
    return a @ a.T + np.eye(n)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.integers(1, 30), st.integers(1, 4))
def test_solves_as_numpy_does(seed: int, n: int, columns: int) -> None:
    A = definite(seed, n)
    b = np.random.default_rng(seed).standard_normal((n, columns))
    solver = Cholesky(csc_array(A))  # the whole matrix does as well as its lower triangle
    np.testing.assert_allclose(solver.solve(b), np.linalg.solve(A, b), rtol=1e-8, atol=1e-10)
    np.testing.assert_allclose(Cholesky(csc_array(np.tril(A))).solve(b[:, 0]), np.linalg.solve(A, b[:, 0]), rtol=1e-8, atol=1e-10)
    assert (solver.factorisations, solver.solves) == (1, 1)


def test_right_hand_sides_are_left_alone() -> None:
    b = np.arange(3.0)
    Cholesky(csc_array(2 * np.eye(3))).solve(b)
    np.testing.assert_array_equal(b, [0, 1, 2])


def test_refactors_without_analysing_again(monkeypatch: pytest.MonkeyPatch) -> None:
    done = []

    def symbolic(matrix):
        done.append("symbolic")
        return cholmod.symbolic(matrix)

    watched = SimpleNamespace(options=cholmod.options, symbolic=symbolic, numeric=cholmod.numeric, solve=cholmod.solve)
    monkeypatch.setattr(linalg, "cholmod", watched)
    A, b = definite(0, 12), np.ones(12)
    lower = csc_array(np.tril(A))
    lower.sort_indices()
    solver = Cholesky(lower)
    for k in (2.0, 3.0):
        solver.refactor(k * lower.data)
        np.testing.assert_allclose(solver.solve(b), np.linalg.solve(k * A, b), rtol=1e-9)
    assert (done, solver.factorisations, solver.solves) == (["symbolic"], 3, 2)


def test_entries_that_are_zero_now_may_be_something_later() -> None:
    lower = csc_array((np.array([2.0, 0.0, 2.0]), np.array([0, 1, 1]), np.array([0, 2, 3])), shape=(2, 2))
    solver = Cholesky(lower)
    solver.refactor(np.array([2.0, 1.0, 2.0]))
    np.testing.assert_allclose(solver.solve(np.array([3.0, 3.0])), [1, 1])


@pytest.mark.parametrize("bad", [-1.0, 0.0])
def test_says_when_it_is_not_positive_definite(bad: float) -> None:
    with pytest.raises(NotPositiveDefiniteError, match="not positive definite"):
        Cholesky(csc_array(np.diag([1.0, bad, 1.0]) + np.diag([1e-300, 1e-300], -1)))
    solver = Cholesky(csc_array(np.eye(3)))
    with pytest.raises(NotPositiveDefiniteError, match="not positive definite"):
        solver.refactor(np.array([1.0, bad, 1.0]))
    solver.refactor(np.full(3, 2.0))  # and may be used again
    np.testing.assert_allclose(solver.solve(np.ones(3)), 0.5)
