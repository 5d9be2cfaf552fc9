"""Groups agree with scipy's, whatever the order of labels."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from skinfab.mesh.joined import joined


def by_search(a: np.ndarray, b: np.ndarray, count: int) -> tuple[int, np.ndarray]:
    groups, label = connected_components(coo_array((np.ones(len(a)), (a, b)), shape=(count, count)), directed=False)
    return int(groups), label


@given(st.data(), st.integers(1, 60))
def test_the_same_groups_as_a_search(data: st.DataObject, count: int) -> None:
    pairs = np.array(data.draw(st.lists(st.tuples(*[st.integers(0, count - 1)] * 2), max_size=80)), dtype=np.int64).reshape(-1, 2)
    groups, label = joined(*pairs.T, count)
    wanted, search = by_search(*pairs.T, count)
    assert groups == wanted and np.array_equal(label, search)


def test_nothing_to_join() -> None:
    none = np.zeros(0, dtype=np.int64)
    assert joined(none, none, 0)[0] == 0
    assert joined(none, none, 3)[1].tolist() == [0, 1, 2]


@pytest.mark.parametrize("order", ["up", "down", "shuffled", "star"])
def test_long_chains_and_stars(order: str) -> None:
    n = 20_000
    at = np.arange(n) if order != "down" else np.arange(n)[::-1].copy()
    if order == "shuffled":
        at = np.random.default_rng(0).permutation(n)
    a, b = (at[:-1], at[1:]) if order != "star" else (np.full(n - 1, n - 1), np.arange(n - 1))
    assert joined(a, b, n)[0] == 1
    assert joined(a[: n // 2], b[: n // 2], n)[0] == n - n // 2
