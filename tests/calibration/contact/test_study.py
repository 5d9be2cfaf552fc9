"""How good the detector is, and that the usual ways are worse on the same trials (docs/contact.md: on seeds kept apart)."""

import pytest

from calibration.contact.objects import OBJECTS
from calibration.contact.score import Score
from calibration.contact.simulator import simulate
from calibration.contact.study import DETECTORS, figures, judge


@pytest.fixture(scope="module")
def scores() -> dict[str, list[Score]]:
    return judge([simulate(name, seed=seed) for name in OBJECTS for seed in range(200, 205)])


def test_precision_recall_and_false_alarms(scores: dict[str, list[Score]]) -> None:
    ours = figures(scores["cusum"])
    assert ours.precision.low > 0.94 and ours.recall.low > 0.95, (ours.precision, ours.recall)
    assert ours.false_alarms.low <= 0.1 and ours.sign > 0.99
    assert 0 < ours.start_s < 0.05 and ours.end_p95_s < 0.1
    assert ours.true > 750 and ours.trials == 25


def test_the_usual_ways_are_worse(scores: dict[str, list[Score]]) -> None:
    assert tuple(scores) == DETECTORS
    ours, fixed, high = (figures(scores[name]) for name in DETECTORS)
    assert ours.precision.low > fixed.precision.high > high.precision.high
    assert ours.recall.low > fixed.recall.high > high.recall.high


def test_nothing_found_is_no_error_of_nothing() -> None:
    nothing = figures([Score(true=3, found=0, right=0, right_sign=0, false_alarms=0, minutes=1.0, start_errors=(), end_errors=())])
    assert nothing.recall.value == 0 and nothing.precision.value != nothing.precision.value and nothing.sign != nothing.sign
