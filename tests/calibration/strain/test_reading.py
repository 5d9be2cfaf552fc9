"""Frames to angles: late by the filter's delay and no more, and no angle where nothing was said."""

import math

import numpy as np
import pytest

from calibration.strain.curve import fit_curve
from calibration.strain.document import SensorCalibration
from calibration.strain.models import CurveModel
from calibration.strain.reading import AngleReader, frame_rate
from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Frame, Stream

ANGLES = np.linspace(10, 80, 300)
U0 = 2.5
MADE = SensorCalibration(CurveModel(fit_curve(ANGLES, 2e-3 * ANGLES + 2e-5 * ANGLES**2, degree=2)), "U", "PIP", U0, 10, 80, {}, "", {})
STREAM = Stream("one", (Channel("other"), Channel("U")), 100.0)


def frame(time: float, angle: float, *, valid: bool = True, saturated: bool = False) -> Frame:
    reading = U0 * (1 + 2e-3 * angle + 2e-5 * angle**2)
    return Frame(time, time, 0, np.array([np.nan, reading]), np.array([False, valid]), np.array([False, saturated]))


def test_a_ramp_comes_late_by_the_delay() -> None:
    reader = AngleReader(MADE, STREAM)
    got = [reader.step(frame(k / 100, 20 + 0.2 * k)) for k in range(250)]
    assert got[0].angle == pytest.approx(20, abs=1e-3)  # the inverse curve is a table
    late = [20 + 0.2 * k - each.angle for k, each in enumerate(got)][100:]
    assert np.allclose(late, 20 * reader.delay_s, atol=0.06)
    assert not any(each.outside or each.fault for each in got)


def test_nothing_said_is_no_angle_and_does_not_stay() -> None:
    reader = AngleReader(MADE, STREAM)
    got = [reader.step(frame(k / 100, 50, valid=k != 20, saturated=k == 30)) for k in range(60)]
    assert [(k, each.fault) for k, each in enumerate(got) if each.fault] == [(20, "not valid"), (30, "saturated")]
    assert all(math.isnan(got[k].angle) for k in (20, 30))
    assert all(each.angle == pytest.approx(50) for k, each in enumerate(got) if k not in (20, 30))


def test_after_a_gap_the_filter_begins_anew() -> None:
    reader = AngleReader(MADE, STREAM)
    for k in range(50):
        reader.step(frame(k / 100, 20))
    assert reader.step(frame(5.0, 70)).angle == pytest.approx(70)  # and not what it was five seconds ago


def test_frames_out_of_order_are_passed_over() -> None:
    reader = AngleReader(MADE, STREAM)
    reader.step(frame(1.0, 30))
    assert reader.step(frame(0.5, 60)).fault == reader.step(frame(1.0, 60)).fault == "not after the one before"
    assert reader.step(frame(math.nan, 60)).fault == "no time"


def test_outside_is_flagged() -> None:
    assert AngleReader(MADE, STREAM).step(frame(0, 120)).outside


def test_a_channel_that_is_not_there() -> None:
    with pytest.raises(InputError, match="no channel 'V'"):
        AngleReader(MADE, STREAM, channel="V")


def test_the_rate() -> None:
    assert frame_rate(STREAM, np.zeros(0)) == 100
    unknown = Stream("one", ())
    assert frame_rate(unknown, np.array([0, 0.02, 0.04, 0.04, 3])) == 50
    for times in (np.zeros(0), np.zeros(5)):
        with pytest.raises(InputError, match="how many frames"):
            frame_rate(unknown, times)
