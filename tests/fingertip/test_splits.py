"""Splits: every group on one side, every row judged once, and folds about equally large."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.fingertip.splits import group_folds, leave_one_out, require_apart


@given(st.lists(st.integers(0, 9), min_size=2, max_size=60), st.integers(2, 6), st.integers(0, 3))
def test_groups_stay_whole(groups: list[int], k: int, seed: int) -> None:
    if len(set(groups)) < k:
        with pytest.raises(InputError, match="cannot be split"):
            group_folds(groups, k=k)
        return
    splits = group_folds(groups, k=k, seed=seed)
    assert sorted(np.concatenate([test for _, test in splits]).tolist()) == list(range(len(groups)))
    for train, test in splits:
        require_apart(groups, train, test)
        assert len(test) and sorted([*train, *test]) == list(range(len(groups)))
    sizes = [len(test) for _, test in splits]
    assert max(sizes) - min(sizes) <= max(np.bincount(groups))


def test_each_class_is_spread_over_the_folds() -> None:
    classes = np.repeat(["a", "b", "c"], 10)
    for _, test in group_folds(range(30), k=5, strata=classes.tolist()):
        assert sorted(classes[test]) == ["a", "a", "b", "b", "c", "c"]
    naive = [sorted(classes[test]) for _, test in group_folds(range(30), k=5)]
    assert any(each != ["a", "a", "b", "b", "c", "c"] for each in naive)


def test_the_seed_decides() -> None:
    tests = [[test.tolist() for _, test in group_folds(range(20), k=4, seed=seed)] for seed in (0, 0, 1)]
    assert tests[0] == tests[1] != tests[2]


def test_one_left_out_at_a_time() -> None:
    splits = leave_one_out(["x", "y", "x", "z"])
    assert [test.tolist() for _, test in splits] == [[0, 2], [1], [3]]


def test_what_cannot_be_split() -> None:
    with pytest.raises(InputError, match="1 group "):
        leave_one_out(["x", "x"])
    with pytest.raises(InputError, match="cannot be split into 1 parts"):
        group_folds(["x", "y"], k=1)


def test_a_random_split_is_refused() -> None:
    with pytest.raises(InputError, match="group 7 is both"):
        require_apart([7, 7, 8], np.array([0, 2]), np.array([1]))
