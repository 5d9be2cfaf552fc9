"""One clock: times that only grow, whatever the device's does, and the same however the frames come."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibration.contact.clock import Clock, longest_hole, on_one_clock
from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Recording, Stream

TIME = np.arange(1000) / 100


def log(time: np.ndarray, rate_hz: float = 100.0) -> Recording:
    return Recording.of_values(Stream("skin", (Channel("S1"),), rate_hz), np.ones((len(time), 1)), device_time=time)


@given(st.lists(st.floats(-1e3, 1e3) | st.just(float("nan")), max_size=60), st.integers(0, 60))
def test_times_grow_and_come_out_the_same_in_pieces(times: list[float], cut: int) -> None:
    time = np.array(times)
    whole, pieces = Clock(10.0), Clock(10.0)
    out = whole.of(time)
    np.testing.assert_array_equal(out, np.concatenate([pieces.of(time[:cut]), pieces.of(time[cut:])]))
    assert whole.set_back == pieces.set_back
    assert (np.diff(out[np.isfinite(out)]) > 0).all()
    np.testing.assert_array_equal(Clock(10.0).of(out[np.isfinite(out)]), out[np.isfinite(out)])  # what grows is left alone


def test_a_device_that_begins_anew_goes_on() -> None:
    time = TIME.copy()
    time[600:] -= time[600]
    found, (back,) = on_one_clock(log(time))
    # Frames of a second tell that it is no late one; they say nothing, and from then on times go on as they did.
    assert np.isnan(found[600:700]).all() and found[700:] == pytest.approx(TIME[700:], abs=1e-9)
    assert (back.frame, back.read, back.taken) == (700, pytest.approx(1.0), pytest.approx(7.0))
    assert "before frame 701, which says 1.00 s: from there on 6.00 s are added" in str(back)


@pytest.mark.parametrize("late", [[500], [500, 501, 502], [500, 503, 504]])
def test_late_frames_and_doubled_ones_say_nothing_and_set_no_clock(late: list[int]) -> None:
    time = TIME.copy()
    time[late] = time[np.array(late) - 40]
    time[800] = time[799]
    found, back = on_one_clock(log(time))
    gone = [*late, 800]
    assert back == () and np.isnan(found[gone]).all() and (np.delete(found, gone) == np.delete(TIME, gone)).all()


def test_one_frame_from_the_future_costs_a_second() -> None:
    time = TIME.copy()
    time[500] += 1e6
    found, (back,) = on_one_clock(log(time))
    assert np.isnan(found[501:601]).all() and np.diff(found[601:]) == pytest.approx(0.01) and back.frame == 601


def test_a_time_that_stands_still_is_none() -> None:
    with pytest.raises(InputError, match="the time stands still"):
        on_one_clock(log(np.zeros(100), 0.0))


def test_a_slow_stream_has_longer_holes() -> None:
    assert longest_hole(1000.0) == longest_hole(10.0) == 1.0 and longest_hole(0.5) == 20.0
