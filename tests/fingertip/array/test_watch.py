"""Logs read frame by frame: several contacts, drift, broken wires, and rests that were none."""

import math

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.array.analyser import Reading
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.logs import of_recording
from skinfab.fingertip.array.matched import ArrayModel
from skinfab.fingertip.array.simulator import Device
from skinfab.fingertip.array.tracking import Event
from skinfab.fingertip.array.watch import ArrayWatch, read_all
from skinfab.readout.frame import Recording

SEED = Geometry()
DEVICE = Device(seed=3)
MODEL = ArrayModel(SEED, DEVICE.rubber, DEVICE.skin.gains)
SKIN = DEVICE.skin
A, B = SKIN.pressed(1.0, axial_mm=6.0, angle_rad=0.0), SKIN.pressed(1.2, axial_mm=18.0, angle_rad=1.2)
NONE = np.zeros(SEED.shape)


def logged(frames: list[np.ndarray], *, rest: int = 18, wander: float = 0.0) -> Recording:
    """Frames after a rest, 15 a second; `wander` is by how much V0 grows a frame."""
    Z = np.array([NONE] * rest + frames)
    volts = DEVICE.volts(Z, np.random.default_rng(2)) * (1 + wander * np.maximum(np.arange(len(Z)) - rest, 0))[:, None, None]
    return Recording.of_values(SEED.stream(simulated=True), volts.reshape(len(Z), -1), device_time=np.arange(len(Z)) / 15)


def read(recording: Recording) -> tuple[tuple[Reading, ...], list[Event], ArrayWatch]:
    readings, watch = read_all(recording, MODEL)
    return readings, [event for reading in readings for event in reading.events], watch


def test_each_of_several_contacts_is_followed_by_itself() -> None:
    """One stays, another comes, the first goes: nothing moves."""
    readings, events, _ = read(logged([A] * 20 + [A + B] * 20 + [B] * 20))
    assert [(event.kind, event.number, round(event.start * 15) - 18) for event in events] == [
        ("touch", 1, 0),
        ("touch", 2, 20),
        ("lift", 1, 40),
    ]
    both = next(reading for reading in readings if reading.time > 34.5 / 15 + 0.5)
    assert both.state == "several" and both.place.force_n == pytest.approx(2.2, abs=0.03)
    assert sorted(each.axial_mm for each in both.contacts) == pytest.approx([6.0, 18.0], abs=0.1)
    assert both.place.axial_mm == both.contacts[0].axial_mm == pytest.approx(18.0, abs=0.1)  # of the strongest


def test_load_that_shifts_from_one_contact_to_another_is_no_slip() -> None:
    part = np.clip((np.arange(60) - 20) / 20, 0, 1)
    _, events, _ = read(logged([(1 - f) * A + f * B for f in part]))
    assert [(event.kind, event.number) for event in events] == [("touch", 1), ("touch", 2), ("lift", 1)]


def test_two_contacts_of_which_one_slips() -> None:
    moved = SKIN.pressed(1.0, axial_mm=12.0, angle_rad=0.0)
    _, events, _ = read(logged([A] * 10 + [A + B] * 20 + [moved + B] * 20 + [NONE] * 5))
    assert [(event.kind, event.number) for event in events[:3]] == [("touch", 1), ("touch", 2), ("slip", 1)]
    assert events[2].along_mm == pytest.approx(6.0, abs=0.2) and abs(events[2].around_mm) < 0.3
    assert sorted((event.kind, event.number) for event in events[3:]) == [("lift", 1), ("lift", 2)]


def test_what_is_not_understood_touches_but_does_not_move() -> None:
    """A plate as wide as the finger: it touches and lifts, and what stood before stands after it."""
    plate = SKIN.plated(4.0, axial_mm=18.0, angle_rad=0.0, size_mm=18)
    readings, events, _ = read(logged([plate] * 20 + [NONE] * 5 + [A] * 10 + [plate] * 10 + [A] * 10 + [NONE] * 3))
    assert sum(reading.state == "wide" for reading in readings) >= 28
    assert [(event.kind, round(event.start * 15) - 18) for event in events] == [("touch", 0), ("lift", 20), ("touch", 25), ("lift", 55)]
    assert all(r.contacts == () for r in readings if r.state == "wide")


def test_drift_is_followed() -> None:
    """V0 grows by 1.5 % in 20 s, as much as 0.35 N read; a touch amid it is found where and as hard as it is."""
    readings, events, _ = read(logged([NONE] * 150 + [A] * 100 + [NONE] * 50, wander=5e-5))
    assert [(event.kind, round(event.start * 15) - 18) for event in events] == [("touch", 150), ("lift", 250)]
    assert {reading.state for reading in readings if 150 <= reading.time * 15 - 18 < 250} == {"point"}
    held = [reading.place for reading in readings if reading.state == "point"]
    assert np.median([place.force_n for place in held]) == pytest.approx(1.0, abs=0.06)
    assert np.median([place.axial_mm for place in held]) == pytest.approx(6.0, abs=0.1)


@pytest.mark.parametrize("how", ["begun touched", "turned"])
def test_a_rest_that_was_none_is_refused(how: str) -> None:
    """Steady while it was measured, so that only what came after shows it."""
    log = logged([NONE] * 20 + [B] * 10)
    if how == "begun touched":
        recording = Recording.of_values(log.stream, logged([A] * 30 + [NONE] * 20 + [B] * 20).values[18:], device_time=np.arange(70) / 15)
    else:
        recording = logged([-A] * 10 + [NONE] * 5)
    for use in (read, lambda each: of_recording(each, name="a log")):
        with pytest.raises(InputError, match=r"read less than at rest, r[0-3]s0.*touched in the first second"):
            use(recording)
    watch = ArrayWatch(recording.stream, MODEL)
    made = [reading for frame in recording if (reading := watch.step(frame)) is not None]
    assert sum(reading.state == "pulled" for reading in made) >= 10
    assert all(math.isnan(reading.place.axial_mm) and not reading.events for reading in made if reading.state == "pulled")


@pytest.mark.parametrize("volts", [0.0, -1.0, 1.3])
def test_dead_wires_are_left_out(volts: float) -> None:
    recording = logged([A] * 20)
    recording.values[:, 8 * 2 + 0] = volts  # beside the contact
    readings, _, watch = read(recording)
    assert "r2s0" in watch.notes[0] and "look at their wires" in watch.notes[0]
    assert readings[-1].state == "point" and (readings[-1].place.axial_mm, readings[-1].place.force_n) == pytest.approx(
        (6.0, 1.0), abs=0.15
    )
    recording.values[:, :] = 0.0
    with pytest.raises(InputError, match="no tactel reads a voltage above zero"):
        of_recording(recording, name="a")


def test_a_tactel_that_breaks_amid_a_log() -> None:
    recording = logged([NONE] * 10 + [A] * 40)
    recording.values[38:, 60] = 1.3
    readings, events, watch = read(recording)
    assert "r7s4 stood still" in watch.notes[-1] and [event.kind for event in events] == ["touch"]
    assert readings[-1].state == "point" and readings[-1].place.axial_mm == pytest.approx(6.0, abs=0.1)


def test_a_point_says_how_it_pulls() -> None:
    readings, _, _ = read(logged([SKIN.pressed(1.0, axial_mm=12.0, angle_rad=0.5, shear_n=(0.3, -0.2))] * 3))
    spot = readings[-1].spot
    assert spot is not None and spot.tilt_rad == pytest.approx((math.atan(0.3), math.atan(-0.2)), abs=math.radians(2.5))
