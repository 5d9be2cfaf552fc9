"""The leading pairs' energies are those of the systems that they are, solved one by one."""

import numpy as np
import pytest

from skinfab.seams.leading import leading_energies


@pytest.mark.parametrize("pairs", [1, 4, 9])
def test_as_solved_one_by_one(pairs: int) -> None:
    rng = np.random.default_rng(pairs)
    M, b = rng.standard_normal((2 * pairs, 2 * pairs)), rng.standard_normal(2 * pairs)
    A = M @ M.T + 0.1 * np.eye(2 * pairs)
    alone = [b[:k] @ np.linalg.solve(A[:k, :k], b[:k]) / 2 for k in range(2, 2 * pairs + 1, 2)]
    assert leading_energies(A, b) == pytest.approx(alone, rel=1e-6)


def test_from_where_it_is_not_positive_nothing_is_known() -> None:
    A = np.diag([2.0, 2, 2, -2, 2, 2])
    assert np.isnan(leading_energies(A, np.ones(6))).tolist() == [False, True, True]
