"""Do conditions differ? Against the textbook's sums, in both branches, and where nothing can be said."""

import itertools

import numpy as np
import pytest
from scipy import stats

from skinfab.errors import InputError
from skinfab.fingertip.nail.statistics import compare


def normal_scores(n: int, shift: tuple[float, ...]) -> dict[str, np.ndarray]:
    """Participants whose accuracies are as normal as they can be, each condition in another order of them."""
    ideal = stats.norm.ppf((np.arange(n) + 0.5) / n)
    rng = np.random.default_rng(4)
    return {f"c{k}": 60 + s + 5 * rng.permutation(ideal) for k, s in enumerate(shift)}


def test_the_anova_is_the_textbooks() -> None:
    data = normal_scores(10, (0.0, 3.0, 12.0))
    x = np.column_stack(list(data.values()))
    n, k = x.shape
    between = n * ((x.mean(axis=0) - x.mean()) ** 2).sum() / (k - 1)
    rest = ((x - x.mean(axis=0) - x.mean(axis=1, keepdims=True) + x.mean()) ** 2).sum() / ((k - 1) * (n - 1))
    found = compare(data)
    assert found.method == "repeated-measures ANOVA" and found.dof == (2, 18) and found.normality_p > 0.9
    assert found.statistic == pytest.approx(between / rest)
    assert found.sphericity_p > 0.05 and found.p == pytest.approx(stats.f.sf(between / rest, 2, 18))
    for pair in found.pairs:
        assert pair.p == pytest.approx(min(3 * stats.ttest_rel(data[pair.a], data[pair.b]).pvalue, 1.0))
    assert {(pair.a, pair.b) for pair in found.differing()} >= {("c0", "c2")}
    assert "F(2, 18)" in str(found)


def test_where_sphericity_fails_greenhouse_and_geisser_correct_p() -> None:
    rng = np.random.default_rng(0)
    ideal = stats.norm.ppf((np.arange(12) + 0.5) / 12)
    wild, still = 30 * ideal, 0.5 * rng.permutation(ideal)
    data = {"a": still, "b": still[::-1] + 0.2, "c": wild + 12, "d": 0.5 * rng.permutation(ideal)}
    found = compare(data)
    assert found.method == "repeated-measures ANOVA" and found.sphericity_p < 0.05
    centre = np.eye(4) - 0.25
    S = centre @ np.cov(np.column_stack(list(data.values())).T) @ centre
    epsilon = np.trace(S) ** 2 / (3 * (S**2).sum())
    assert epsilon < 0.5  # so that it counts
    assert found.p == pytest.approx(stats.f.sf(found.statistic, *(epsilon * np.array(found.dof))), abs=1e-3)


def test_a_condition_that_is_not_normal_leads_to_friedman_and_nemenyi() -> None:
    data = normal_scores(10, (0.0, 3.0, 12.0))
    data["c1"] = np.array([100.0] * 9 + [20.0])
    found = compare(data)
    assert found.method == "Friedman" and found.normality_p < 0.05 and found.dof == (2,)
    expected = stats.friedmanchisquare(*data.values())
    assert (found.statistic, found.p) == pytest.approx((expected.statistic, expected.pvalue))
    ranks = np.column_stack([stats.rankdata(row) for row in np.column_stack(list(data.values()))]).T.mean(axis=0)
    for pair, (i, j) in zip(found.pairs, itertools.combinations(range(3), 2), strict=True):
        q = abs(ranks[i] - ranks[j]) / np.sqrt(3 * 4 / (6 * 10)) * np.sqrt(2)
        assert pair.p == pytest.approx(stats.studentized_range.sf(q, 3, np.inf), abs=1e-6)


def test_a_condition_that_never_varies_is_not_called_normal() -> None:
    data = normal_scores(10, (0.0, 3.0, 12.0)) | {"always": np.full(10, 100.0)}
    found = compare(data)
    assert found.method == "Friedman" and np.isnan(found.normality_p)


def test_two_conditions_that_are_alike_do_not_differ() -> None:
    data = normal_scores(10, (0.0, 30.0, 12.0))
    found = compare(data | {"twin": data["c0"]})
    assert next(pair.p for pair in found.pairs if (pair.a, pair.b) == ("c0", "twin")) == 1.0


def test_pairs_do_not_count_where_the_whole_says_nothing() -> None:
    found = compare(normal_scores(10, (0.0, 0.5, 0.3)))
    assert found.p > 0.05 and found.differing() == ()


@pytest.mark.parametrize(
    ("data", "says"),
    [
        ({"a": np.zeros(2), "b": np.ones(2), "c": np.ones(2)}, "2 participants in 3"),
        ({"a": np.zeros(9), "b": np.ones(9)}, "9 participants in 2"),
        ({}, "0 participants"),
        ({"a": np.zeros(9), "b": np.ones(8), "c": np.ones(9)}, "not every condition"),
        ({"a": np.ones(9), "b": np.ones(9), "c": np.ones(9)}, "nothing to compare"),
    ],
)
def test_what_cannot_be_compared_is_said(data: dict[str, np.ndarray], says: str) -> None:
    with pytest.raises(InputError, match=says):
        compare(data)
