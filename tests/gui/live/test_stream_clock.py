import math

import numpy as np

from gui.live.stream_clock import StreamClock


def test_a_device_that_runs_keeps_its_own_even_times():
    clock = StreamClock(live=True)
    jitter = np.random.default_rng(0).uniform(0, 0.05, 100)
    assert np.allclose([clock.at(7 + k / 100, 1e9 + k / 100 + jitter[k]) for k in range(100)], np.arange(100) / 100, atol=1e-6)


def test_a_board_that_was_unplugged_leaves_a_hole_as_long_as_it_was_gone():
    clock = StreamClock(live=True)
    for k in range(10):
        clock.at(5 + k, 100 + k)
    assert clock.at(0.0, 119.0) == 19.0 and math.isclose(clock.at(0.5, 119.5), 19.5)


def test_a_log_has_no_other_times_than_its_own_and_they_only_grow():
    clock = StreamClock(live=False)
    found = [clock.at(t, 0.0) for t in (3.0, 4.0, 4.0, math.nan, 1.0, 2.0, 3.0)]
    assert found[0] == 0.0 and (np.diff(found) > 0).all() and found[1] == 1.0
    assert math.isclose(found[-1] - found[-2], 1.0)
