"""The critical gain, against theory, against the joint as simulated, and as what is refused."""

import math

import numpy as np
import pytest

from calibration.control.controller import Input, JointController
from calibration.control.margin import AUTO, critical_gain, judged, play_describing_function
from calibration.finger.simulated import Finger, FingerSensor, Plant
from calibration.strain.curve import Curve
from calibration.strain.document import SensorCalibration
from calibration.strain.models import CurveModel
from calibration.strain.play import play
from skinfab.errors import InputError, RefusedError

DELAYS = (0.03, 0.05, 0.1, 0.2)
LINE = Curve(-5000.0, 5000.0, np.array([-0.5, 0.5]))


def line(play_deg: float = 0.0) -> FingerSensor:
    """A sensor whose slope is the same everywhere."""
    return FingerSensor("line", LINE, play_deg, 0.0, 1.65)


def calibration(curve: Curve, u0: float = 1.65) -> SensorCalibration:
    return SensorCalibration(CurveModel(curve), "U", "A", u0, curve.low, curve.high, {}, "", {})


def swings(gain: float, delay: float, play_deg: float) -> bool:
    """Does the joint, let go far from its target, after 80 s still swing as much as after 60?"""
    plant = Plant(line(play_deg), delay_s=delay, low=-math.inf, high=math.inf)
    finger, still, one = Finger(plant, seed=0, angle=100.0), Finger(plant, seed=0, angle=0.0), Input(calibration(LINE))
    controller = JointController(one, one, law="p", gain=gain, limit_deg_s=1e12)
    angles, speed = [], 0.0
    for k in range(8000):
        shown = finger.step(k / 100, speed)
        speed = controller.step(k / 100, still.step(k / 100, 0.0), shown).speed
        angles.append(finger.angle)
        if abs(finger.angle) > 2000:
            return True
    return float(np.ptp(angles[-500:])) > max(0.95 * float(np.ptp(angles[5500:6000])), 1e-6)


def test_theory() -> None:
    found = [critical_gain(lag_s=0.1, delay_s=delay).gain for delay in DELAYS]
    assert found == pytest.approx([35, 21.5, 11.3, 6.1], rel=0.01)
    # Without a lag: a delayed integrator is stable up to pi / 2 over the delay.
    assert critical_gain(lag_s=0.0, delay_s=0.1).gain == pytest.approx(math.pi / 0.2)


@pytest.mark.parametrize("delay", DELAYS)
def test_simulation_confirms_it(delay: float) -> None:
    critical = critical_gain(lag_s=0.1, delay_s=delay, period_s=0.01).gain
    assert not swings(0.97 * critical, delay, 0.0) and swings(1.03 * critical, delay, 0.0)


@pytest.mark.parametrize("delay", DELAYS)
def test_simulation_confirms_it_with_play(delay: float) -> None:
    """A describing function knows the first harmonic alone: a fifth is as near as it comes, and on the safe side."""
    critical = critical_gain(lag_s=0.1, delay_s=delay, period_s=0.01, play=True).gain
    assert 1.2 * critical < critical_gain(lag_s=0.1, delay_s=delay, period_s=0.01).gain  # the plain theory would call that stable
    assert not swings(critical, delay, 6.0) and swings(1.2 * critical, delay, 6.0)


def test_describing_function_is_the_first_harmonic_of_play() -> None:
    for amplitude in (1.05, 1.5, 2.0, 5.0):
        phase = 2 * np.pi * np.arange(20000) / 10000
        out = play(amplitude * np.sin(phase), 1.0)[10000:]
        found = 2 * np.mean(out * np.exp(-1j * phase[10000:])) * 1j / amplitude
        assert play_describing_function(np.array([amplitude]))[0] == pytest.approx(found, abs=1e-3)


def test_no_delay_no_limit() -> None:
    with pytest.raises(InputError, match="without any delay every gain is stable"):
        critical_gain(lag_s=0.1, delay_s=0.0)
    with pytest.raises(InputError, match="may be negative"):
        critical_gain(lag_s=-0.1, delay_s=0.05)


def test_gains_are_judged_where_the_sensor_is_steepest() -> None:
    bent = Input(calibration(Curve(10.0, 80.0, np.array([0.0, 0.1, 0.4]))))  # twice to 6 / 4 as steep at the end as on the whole
    times = {"lag_s": 0.1, "delay_s": 0.05, "period_s": 0.01}
    auto = judged(bent, "p", None, **times)
    assert auto.sure == pytest.approx(1 / 0.155)
    assert (
        auto.steepness == pytest.approx(1.5) and auto.ratio == pytest.approx(AUTO) and auto.sentence.endswith("gain margin 3.00 (9.5 dB)")
    )
    assert judged(bent, "full", None, **times).gain == pytest.approx(1.5 * auto.gain)
    limit = auto.gain * AUTO
    assert judged(bent, "p", 0.99 * limit, **times).ratio > 1
    with pytest.raises(RefusedError, match=f"give less than {limit:.3g}, or --force"):
        judged(bent, "p", 1.01 * limit, **times)
    assert judged(bent, "p", 1.01 * limit, **times, force=True).ratio < 1
