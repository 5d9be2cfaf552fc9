"""The bridge: exact there and back, saturation flagged and never a number, and a reading at rest that outliers do not move."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.readout.bridge import QuarterBridge, at_rest, relative

ADC = QuarterBridge(3.3, 150.0, 0.5, 2.0, 1.65, 0.0, 3.3)


@given(
    resistance=st.floats(1.0, 1e4),
    series=st.floats(10.0, 1e3),
    reference=st.floats(0, 1),
    gain=st.floats(0.5, 100) | st.floats(-100, -0.5),
    offset=st.floats(-2, 2),
)
def test_exact_there_and_back(resistance: float, series: float, reference: float, gain: float, offset: float) -> None:
    bridge = QuarterBridge(3.3, series, reference, gain, offset)
    back, saturated = bridge.resistance(bridge.voltage(np.array([resistance])))
    # A part p of the supply is known to some 1e-16; the resistance is series p / (1 - p).
    assert not saturated[0] and math.isclose(
        back[0], resistance, rel_tol=1e-15 * (10 + (1 + resistance / series) * (1 + series / resistance) * 10)
    )


def test_a_linearised_bridge_is_wrong_where_this_is_not() -> None:
    """A sensor whose resistance doubles, as at 41 % strain: the small-signal formula 4 dU / U gives a third less."""
    bridge = QuarterBridge(3.3, 100.0)
    voltage = bridge.voltage(np.array(200.0))
    assert bridge.resistance(voltage)[0] == pytest.approx(200.0)
    assert 4 * voltage / 3.3 == pytest.approx(2 / 3)


@pytest.mark.parametrize("resistance", [0.0, 20.0, 5000.0, math.inf])
def test_beyond_the_range_is_saturated_and_no_number(resistance: float) -> None:
    back, saturated = ADC.resistance(ADC.voltage(np.array([resistance, 150.0])))
    assert saturated.tolist() == [True, False] and math.isnan(back[0]) and back[1] == pytest.approx(150.0)


def test_open_and_shorted_sensors_without_a_converter() -> None:
    bridge = QuarterBridge(3.3, 100.0)
    back, saturated = bridge.resistance(bridge.voltage(np.array([0.0, math.inf])))
    assert saturated.all() and np.isnan(back).all()
    back, saturated = bridge.resistance(np.array([math.nan]))
    assert np.isnan(back).all() and not saturated.any()  # not read at all: that is for the frame's validity to say


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"supply_v": 0.0}, "supply is 0"),
        ({"series_kohm": -1.0}, "series resistor is -1"),
        ({"series_kohm": math.nan}, "series resistor is nan"),
        ({"reference": 1.5}, "reference is 1.5"),
        ({"gain": 0.0}, "gain is 0"),
        ({"low_v": 1.0, "high_v": 1.0}, "no range"),
    ],
)
def test_a_bridge_that_is_none(change: dict[str, float], says: str) -> None:
    with pytest.raises(InputError, match=says):
        QuarterBridge(**({"supply_v": 3.3, "series_kohm": 100.0} | change))


def test_relative_change() -> None:
    assert relative(np.array([[1.0, 4.0]]), np.array([2.0, 2.0])).tolist() == [[-0.5, 1.0]]


def test_the_first_still_window_counts() -> None:
    moving, still = np.linspace(0, 10, 200), np.full(100, 10.0)
    found = at_rest(np.concatenate([moving, still, moving[::-1], np.zeros(100)]), 100.0)
    assert (found.level, found.still) == (10.0, True) and 1.7 < found.at_s <= 2.0  # before that, 0.2 s move by 10 % of the span


def test_where_nothing_rests_the_stillest_window_is_said() -> None:
    found = at_rest(np.concatenate([np.linspace(0, 8, 100), np.linspace(8, 9, 20), np.linspace(9, 17, 100)]), 100.0)
    assert not found.still and found.at_s == pytest.approx(1.0, abs=0.02) and found.moved == pytest.approx(1 / 17, rel=0.1)


def test_a_spike_in_the_still_window_does_not_move_the_level() -> None:
    readings = np.concatenate([np.full(100, 2.0), np.linspace(2, 4, 100)])
    readings[5] = 2.09  # within what still is
    assert at_rest(readings, 100.0).level == 2.0


def test_gaps_are_no_rest() -> None:
    readings = np.concatenate([np.full(15, np.nan), np.full(50, 3.0), np.linspace(3, 5, 50)])
    assert at_rest(readings, 100.0).at_s == pytest.approx(0.15)
    with pytest.raises(InputError, match="without a gap"):
        at_rest(np.where(np.arange(100) % 10 == 0, np.nan, 1.0), 100.0)
    for nothing in (np.zeros(0), np.full(30, np.nan)):
        with pytest.raises(InputError, match="no readings"):
            at_rest(nothing, 100.0)


def test_a_constant_log_is_at_rest() -> None:
    assert at_rest(np.full(10, 7.0), 100.0).still
