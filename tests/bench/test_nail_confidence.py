"""Confidence beside what is right: each trial in one range, and a sentence of the table's numbers."""

import pytest

from skinfab.bench.nail_confidence import EDGES, measure, sentence
from skinfab.fingertip.nail.protocol import Protocol

SMALL = Protocol(participants=6, training=5, rounds=8, estimates=1, samples=64)


def test_it_is_as_sure_as_it_is_right_and_more_is_right_where_it_is_surer() -> None:
    whole, *ranges = measure(SMALL, ("edges4",))
    assert (whole.low, whole.high) == (0.0, 1.0) and whole.trials == sum(row.trials for row in ranges) == 6 * 4 * 8
    assert all(100 * row.low <= row.confidence <= 100 * row.high and row.low in EDGES for row in ranges)
    assert whole.percent == pytest.approx(sum(row.trials * row.percent for row in ranges) / whole.trials)
    assert abs(whole.confidence - whole.percent) < 5  # 10 by likelihood and five folds
    assert ranges[-1].percent > ranges[0].percent + 15


def test_the_sentence_is_the_tables() -> None:
    row = {"test": "pins6", "low": 0.0, "high": 1.0, "trials": 10, "confidence": 90.0, "percent": 80.0}
    parts = [
        row | {"high": 0.5, "trials": 4, "confidence": 40.0, "percent": 50.0},
        row | {"low": 0.9, "trials": 6, "confidence": 95.0, "percent": 100.0},
    ]
    assert "90.0 % of pins6 where 80.0 % are right (in like ranges 7.0 points apart)" in sentence([row, *parts])
