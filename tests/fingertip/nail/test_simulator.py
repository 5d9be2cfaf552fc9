"""The simulated finger's readings: what they hold, how touches scatter, what is clipped, and that all of it is repeatable."""

import math
from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.nail.finger import Finger
from skinfab.fingertip.nail.patterns import EDGES4, PINS6
from skinfab.fingertip.nail.simulator import (
    FORCE_N,
    RATE_HZ,
    Scene,
    nail_frames,
    participant,
    phasors,
    readings,
    record,
    running,
    touch,
)

QUIET = Scene(noise_g=0.0, noise_dps=0.0)


@pytest.fixture(scope="module")
def finger() -> Finger:
    return participant(np.random.default_rng(2))


def test_readings_are_gravity_and_the_answer_at_the_drive(finger: Finger) -> None:
    rng = np.random.default_rng(0)
    touches = [touch(EDGES4[k], rng, QUIET) for k in range(3)] + [touch(None, rng, QUIET)]
    for each, answer, values in zip(touches, phasors(finger, touches), readings(finger, touches, rng, scene=QUIET), strict=True):
        turn = np.exp(2j * math.pi * each.drive_hz * np.arange(len(values)) / RATE_HZ)
        found, left, *_ = np.linalg.lstsq(np.stack([np.ones(len(values)), turn.real, -turn.imag], axis=1), values, rcond=None)
        assert left.max() < 1e-12  # nothing else is in them
        np.testing.assert_allclose(found[0], [0, 0, 1, 0, 0, 0], atol=1e-9)
        measured = found[1] + 1j * found[2]
        phase = measured[4] / answer[4]
        assert abs(phase) == pytest.approx(1.0)
        np.testing.assert_allclose(measured, answer * phase, atol=1e-9)


def test_touches_scatter_as_stated() -> None:
    rng, scene = np.random.default_rng(0), Scene()
    many = [touch(PINS6[0], rng, scene) for _ in range(3000)]
    off = np.array([(each.x_mm - PINS6[0].x_mm, each.y_mm - PINS6[0].y_mm) for each in many])
    np.testing.assert_allclose(off.mean(axis=0), 0.0, atol=4 * scene.place_mm / math.sqrt(len(many)))
    np.testing.assert_allclose(off.std(axis=0), scene.place_mm, rtol=0.06)
    turned = [touch(EDGES4[0], rng, scene).angle_rad - EDGES4[0].angle_rad for _ in range(3000)]
    assert np.std(turned) == pytest.approx(scene.turn_rad, rel=0.06)
    force = np.array([each.force_n for each in many]) / FORCE_N
    assert force.min() == pytest.approx(0.8) and force.max() == pytest.approx(1.2)  # the paper's 80 to 120 g


def test_nothing_is_touched_with_no_force_anywhere() -> None:
    air = touch(None, np.random.default_rng(0))
    assert air.force_n == 0.0 and math.isnan(air.x_mm) and math.isnan(air.angle_rad)


def test_in_the_air_the_answer_is_that_of_the_finger_alone(finger: Finger) -> None:
    rng = np.random.default_rng(0)
    z = phasors(replace(finger, contact_n_per_m=0.0), [touch(EDGES4[0], rng)])
    np.testing.assert_allclose(phasors(finger, [touch(None, rng)]), z)


def test_the_air_is_as_loud_as_in_the_paper_and_turns_least_about_x() -> None:
    """About 2.0 G and 250 deg/s at most; more about y than about x (figure 3), and more about z than about x (figure 4)."""
    alike = replace(QUIET, person_scatter=0.0)
    rng = np.random.default_rng(0)
    peak = np.abs(phasors(participant(rng, alike), [touch(None, rng, alike)]))[0]
    assert 1.5 < peak[:3].max() < 2.6 and 190 < peak[3:].max() < 330
    assert peak[3] < peak[4] and peak[3] < peak[5]


def test_what_is_clipped_is_flagged(finger: Finger) -> None:
    scene = replace(QUIET, range_dps=60.0)
    rng = np.random.default_rng(0)
    made = record(finger, [touch(None, rng, scene)], rng, scene=scene)[0]
    assert np.abs(made.values[:, 3:]).max() == 60.0
    assert made.saturated[:, 4].any() and not made.saturated[:, :3].any()
    np.testing.assert_array_equal(made.saturated, np.abs(made.values) >= [4.0] * 3 + [60.0] * 3)


def test_a_motor_that_slows_down_does(finger: Finger) -> None:
    rng = np.random.default_rng(0)
    values = readings(finger, [touch(None, rng, QUIET)], rng, samples=14_000, scene=QUIET, drift_hz_per_s=-2.0)[0, :, 4]
    spectra = np.abs(np.fft.rfft(values.reshape(2, 7000) * np.hanning(7000), n=1 << 16))
    first, second = spectra.argmax(axis=1) * RATE_HZ / (1 << 16)
    assert second - first == pytest.approx(-2.0 * 5.0, abs=0.5)


def test_a_motor_that_runs_on_keeps_its_phase_from_touch_to_touch(finger: Finger) -> None:
    rng = np.random.default_rng(0)
    same = [touch(EDGES4[0], rng, QUIET)] * 3
    whole = readings(finger, same[:1], rng, samples=300, scene=QUIET, begun=np.array([0.3]))[0]
    parts = readings(finger, same, rng, samples=100, scene=QUIET, begun=running(same[0].drive_hz, 100, 3, begun=0.3))
    np.testing.assert_allclose(parts.reshape(300, 6), whole, atol=1e-9)
    any_phase = readings(finger, same, rng, samples=100, scene=QUIET)
    assert np.abs(any_phase.reshape(300, 6) - whole).max() > 0.1
    held = [frame.values for frame in islice(nail_frames(finger, [None], hold_s=0.05, scene=replace(QUIET, drive_hz=169.0)), 210)]
    alone = readings(finger, [touch(None, rng, QUIET)], rng, samples=210, scene=QUIET, begun=np.zeros(1))[0]
    np.testing.assert_allclose(held, alone, atol=1e-9)


def test_live_frames_are_at_the_sensors_rate_and_go_through_the_patterns(finger: Finger) -> None:
    frames = list(islice(nail_frames(finger, [None, EDGES4[0]], hold_s=0.1, seed=3), 420))
    assert [frame.sequence for frame in frames] == list(range(420))
    assert frames[-1].device_time == pytest.approx(419 / RATE_HZ)
    again = list(islice(nail_frames(finger, [None, EDGES4[0]], hold_s=0.1, seed=3), 420))
    np.testing.assert_array_equal([f.values for f in frames], [f.values for f in again])
    loud = np.array([f.values[4] for f in frames]).reshape(3, 140).std(axis=1)
    assert loud[1] < 0.9 * loud[0] and loud[2] == pytest.approx(loud[0], rel=0.1)  # air, edge, air


def test_no_reading_at_all_is_refused(finger: Finger) -> None:
    with pytest.raises(InputError, match="0 readings"):
        readings(finger, [touch(None, np.random.default_rng(0))], np.random.default_rng(0), samples=0)
