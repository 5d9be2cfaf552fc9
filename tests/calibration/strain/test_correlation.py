"""Sums by FFT against the same sums written out, and what is left against numpy's own least squares."""

import numpy as np
import pytest

from calibration.strain.correlation import DEGREE, STEP_S, Pair, Sums, between, bottom, least, powers_of, total


def pair(seed: int = 0, n: int = 300, m: int = 200, ahead: int = 0) -> Pair:
    rng = np.random.default_rng(seed)
    angle = 45 + 30 * np.sin(np.arange(n) / 25) + rng.standard_normal(n)
    return Pair(0.0, angle, rng.random(n) > 0.1, ahead * STEP_S, rng.standard_normal(m), rng.random(m) > 0.1)


@pytest.mark.parametrize("ahead", [0, 40, -60])
def test_left_over_is_what_least_squares_leaves(ahead: int) -> None:
    made = pair(ahead=ahead)
    X = powers_of(made, 3.0, 10.0, 80.0)
    grid = np.arange(max(-30, ahead - 80), 120 + min(ahead, 0), 7)  # at least 100 samples in common: fewer see a part of the curve
    found = Sums.of(made, X, grid)
    for at, lag in enumerate(grid.tolist()):
        i = np.arange(len(made.reading))
        j = i + made.offset - lag
        both = (j >= 0) & (j < len(made.angle)) & made.reading_counts
        i, j = i[both], j[both]
        known = X[j, 0] > 0
        i, j = i[known], j[known]
        assert found.n[at] == pytest.approx(len(i))
        left = np.linalg.lstsq(X[j], made.reading[i], rcond=None)[1][0]
        assert found.unexplained()[at] == pytest.approx(left / np.sum((made.reading[i] - made.reading[i].mean()) ** 2), rel=1e-6)


def test_lags_without_anything_in_common_explain_nothing() -> None:
    made = pair()
    found = Sums.of(made, powers_of(made, 0.0, 10.0, 80.0), np.array([-400, 0, 900]))
    assert found.n.round(6).tolist()[::2] == [0, 0] and np.isfinite(found.unexplained()).tolist() == [False, True, False]


def test_behind_slack_an_angle_is_known_once_the_slack_was_used_up() -> None:
    made = Pair(0.0, np.arange(10.0), np.arange(10) != 7, 0.0, np.zeros(10), np.ones(10, bool))
    assert powers_of(made, 2.0, 0.0, 9.0)[:, 0].tolist() == [0, 0, 0, 0, 1, 1, 1, 0, 1, 1]
    assert powers_of(made, 0.0, 0.0, 9.0)[:, 0].tolist() == [1, 1, 1, 1, 1, 1, 1, 0, 1, 1]


def test_parts_add_up() -> None:
    made = pair()
    X, grid = powers_of(made, 0.0, 10.0, 80.0), np.arange(5)
    parts = []
    for half in (slice(0, 90), slice(90, 200)):
        counts = np.zeros(200, bool)
        counts[half] = made.reading_counts[half]
        parts.append(Sums.of(Pair(0.0, made.angle, made.angle_known, 0.0, made.reading, counts), X, grid))
    whole, added = Sums.of(made, X, grid), total(parts)
    np.testing.assert_allclose(added.A, whole.A, atol=1e-9)
    np.testing.assert_allclose(added.unexplained(), whole.unexplained(), rtol=1e-9)
    assert whole.curves().shape == (5, DEGREE + 1)


def test_parabolas_are_exact_on_parabolas() -> None:
    profile = (np.arange(9) - 4.3) ** 2 + 0.5
    assert between(profile, 4) == pytest.approx(0.3) and bottom(profile, 4) == pytest.approx(0.5)
    assert between(profile, 0) == 0 and bottom(profile, 0) == profile[0]
    np.testing.assert_allclose(least(profile[:, None] * np.ones(3)), 0.5)
    assert least(profile[::-1][:4, None])[0] == profile[::-1][:4].min()  # falls to its end: nothing is made up beyond
