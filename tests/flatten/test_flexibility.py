"""Half a solve with a factor, on few rows of the load, is what the whole inverse gives."""

import numpy as np
import pytest
import shapes

from skinfab.errors import SkinfabError
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.flexibility import Flexibility
from skinfab.flatten.isometric import IsometricSolver
from skinfab.linalg import Cholesky, LowerTriangle


def inverse(solver: IsometricSolver, UV: np.ndarray) -> np.ndarray:
    lower = solver.hessian(UV)[0].toarray()
    return np.linalg.inv(lower + np.tril(lower, -1).T)


@pytest.mark.parametrize("seed", range(3))
def test_as_the_whole_inverse_gives(seed: int) -> None:
    V, F = shapes.random_disk(seed)
    UV, solver, rng = flatten_isometric(V, F), IsometricSolver(V, F), np.random.default_rng(seed)
    gives, dense = solver.flexibility(UV), inverse(solver, UV)
    for rows, columns in ((1, 1), (6, 4), (2 * len(V), 2)):
        at = rng.choice(2 * len(V), rows, replace=False)
        loads = rng.normal(size=(rows, columns))
        # Rigid motions give way almost without end: forces in balance alone are told well, others are told as well as the ridge is.
        want = loads.T @ dense[np.ix_(at, at)] @ loads
        np.testing.assert_allclose(gives.energy(at, loads), want, rtol=0, atol=1e-6 * np.abs(want).max())
        want = dense[:, at] @ loads[:, 0]
        np.testing.assert_allclose(gives.displacement(at, loads[:, 0]), want, rtol=0, atol=1e-6 * np.abs(want).max())


def test_a_factor_taken_apart_is_made_anew() -> None:
    factor = Cholesky(LowerTriangle(np.array([4.0, 2.0, 3.0]), np.array([0, 1, 1]), np.array([0, 0, 1]), 2))
    Flexibility.of(factor)
    with pytest.raises(SkinfabError, match="taken apart"):
        factor.solve(np.array([8.0, 7.0]))
    factor.refactor(np.array([4.0, 2.0, 3.0]))
    np.testing.assert_allclose(factor.solve(np.array([8.0, 7.0])), [1.25, 1.5])
    assert factor.factorisations == 2


def test_it_outlives_the_next_refinement() -> None:
    V, F = shapes.random_disk(1)
    UV, solver = flatten_isometric(V, F), IsometricSolver(V, F)
    at, load = np.array([3, 8]), np.eye(2)
    gives = solver.flexibility(UV)
    before = gives.energy(at, load)
    assert solver.refine(UV * 1.1).converged
    np.testing.assert_array_equal(gives.energy(at, load), before)
