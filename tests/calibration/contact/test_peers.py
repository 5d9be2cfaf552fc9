"""The usual ways do what they are known for, so that a comparison with them is fair."""

import numpy as np
import pytest

from calibration.contact.peers import fixed_threshold, high_pass
from skinfab.readout.frame import Channel, Recording, Stream

TIME = np.arange(2000) / 100


def skin(change: np.ndarray) -> Recording:
    noise = 0.004 * np.random.default_rng(0).standard_normal(2000)
    return Recording.of_values(Stream("one", (Channel("S1"),), 100.0), (50 * (1 + change + noise))[:, None], device_time=TIME)


def test_a_plain_contact_is_found_by_both() -> None:
    log = skin(np.where((TIME > 5) & (TIME < 6), 0.3, 0.0))
    (only,) = fixed_threshold(log)
    assert (only.start, only.end) == pytest.approx((5.03, 6.01), abs=0.02) and only.strength == pytest.approx(0.3, abs=0.02)
    assert high_pass(log)[0].start == pytest.approx(5.03, abs=0.02)


def test_a_channel_that_reads_nothing_at_rest_is_left_out() -> None:
    log = skin(np.where(TIME < 4, np.nan, 0.3))
    assert fixed_threshold(log) == [] and high_pass(log) == []


def test_what_lasts_has_no_end() -> None:
    (only,) = fixed_threshold(skin(np.where(TIME > 5, -0.2, 0.0)))
    assert only.lasting and only.sign == -1
