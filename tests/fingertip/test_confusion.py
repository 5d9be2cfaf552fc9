"""Confusions: counts that add up, an accuracy with its interval, and a picture."""

from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.confusion import Confusion, grouped_accuracy


def test_rows_are_what_it_was() -> None:
    found = Confusion.of(["a", "a", "b", "c"], ["a", "c", "b", "b"], ("a", "b", "c"))
    assert found.counts.tolist() == [[1, 0, 1], [0, 1, 0], [0, 1, 0]]
    assert found.accuracy.value == 0.5 and 0.1 < found.accuracy.low < 0.5 < found.accuracy.high < 0.9
    assert (found + found).accuracy.low > found.accuracy.low  # twice the cases, narrower
    assert found.facts()["counts"] == found.counts.tolist() and found.facts()["accuracy"]["value"] == 0.5


def test_of_nothing_nothing_is_known() -> None:
    assert Confusion.of([], [], ("a", "b")).facts()["accuracy"] == {"value": None, "low": 0.0, "high": 1.0}


def test_what_cannot_be_counted() -> None:
    with pytest.raises(InputError, match="1 decisions on 2 cases"):
        Confusion.of(["a", "a"], ["a"], ("a",))
    with pytest.raises(InputError, match="class 'z' is none of 'a'"):
        Confusion.of(["a"], ["z"], ("a",))
    with pytest.raises(InputError, match="together"):
        Confusion.of([], [], ("a",)) + Confusion.of([], [], ("b",))


def test_people_who_differ_widen_the_interval() -> None:
    right = np.array([True] * 50 + [False] * 50)
    people = [k // 10 for k in range(100)]
    mixed = [k % 10 for k in range(100)]
    apart, together = grouped_accuracy(right, people), grouped_accuracy(right, mixed)
    assert apart.value == together.value == 0.5 and apart.high - apart.low > together.high - together.low


def test_the_picture(tmp_path: Path) -> None:
    Confusion.of(["one", "one", "two"], ["one", "two", "two"], ("one", "two", "three")).draw(
        tmp_path / "c.png", title="test", simulated=True
    )
    assert (tmp_path / "c.png").read_bytes()[:4] == b"\x89PNG" and len(list(tmp_path.iterdir())) == 1
