"""An array whose rest wanders under a contact, is measured under one, or is pressed so slowly that it seems to wander."""

import math
from collections.abc import Sequence

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.array.analyser import Reading
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.layer import LayerDevice
from skinfab.fingertip.array.matched import ArrayModel
from skinfab.fingertip.array.simulator import Skin
from skinfab.fingertip.array.watch import ArrayWatch, read_all
from skinfab.readout.frame import Recording

SEED = Geometry()
MODEL = ArrayModel.nominal(SEED)
A, B = (Skin(SEED).pressed(1.0, axial_mm=axial, angle_rad=angle) for axial, angle in ((12.0, 0.3), (16.0, -2.5)))
NONE = np.zeros(SEED.shape)
HZ = 15


def logged(frames: Sequence[np.ndarray]) -> Recording:
    """What a tactel of 1 V and noise of 2e-4 reads."""
    Z = np.array(frames)
    volts = 1 / (1 - Z - 2e-4 * np.random.default_rng(0).standard_normal(Z.shape))
    return Recording.of_values(SEED.stream(simulated=True), volts.reshape(len(Z), -1), device_time=np.arange(len(Z)) / HZ)


def watched(recording: Recording) -> tuple[list[Reading], list[tuple[str, int]], ArrayWatch]:
    """As from a port, with the second of each event."""
    watch = ArrayWatch(recording.stream, MODEL)
    made = [reading for frame in recording if (reading := watch.step(frame)) is not None]
    return made, [(event.kind, round(event.start)) for reading in made for event in reading.events], watch


@pytest.mark.parametrize("how", ["warms up", "rises while held", "drops at once"])
def test_rest_that_wanders_otherwise_under_a_contact(how: str) -> None:
    """By 0.6 to 2 % of the gap, more than what 0.3 N read: moved on at the speed of before, the rest would be off for good."""
    by = {
        "warms up": lambda t: 0.02 * (1 - math.exp(-t / 15)),
        "rises while held": lambda t: 0.006 * min(max(t - 10, 0) / 15, 1),
        "drops at once": lambda t: -0.006 * (t > 15),
    }[how]
    held = [10 <= k / HZ < 25 or 35 <= k / HZ < 38 for k in range(40 * HZ)]
    made, events, _ = watched(logged([by(k / HZ) + (A if one else NONE) for k, one in enumerate(held)]))
    assert events == [("touch", 10), ("lift", 25), ("touch", 35), ("lift", 38)]
    touched = [reading for reading in made if 10 <= reading.time < 24.9]
    assert sum(reading.state == "point" for reading in touched) > 0.9 * len(touched)
    assert all(abs(reading.place.force_n - 1) < 0.06 for reading in touched if reading.state == "point")


def test_tactels_that_wander_differently() -> None:
    speeds = 0.02 / 60 * np.random.default_rng(2).uniform(0.5, 1.5, SEED.shape)
    made, events, _ = watched(logged([speeds * k / HZ + (A if 20 <= k / HZ < 26 else NONE) for k in range(28 * HZ)]))
    assert events == [("touch", 20), ("lift", 26)] and not any(reading.state == "wide" for reading in made)


def test_a_press_that_grows_slowly_is_told() -> None:
    """3 N in 60 s: a rest that follows each tactel at once takes it for wandering, and then reads less than nothing."""
    grows = [A * 3 * k / (60 * HZ) for k in range(20 * HZ)]
    made, events, _ = watched(logged([NONE] * 2 * HZ + grows + [A] * 2 * HZ + [NONE] * 2 * HZ))
    assert [kind for kind, _ in events] == ["touch", "lift"] and events[0][1] <= 7 and events[1][1] == 24
    assert made[24 * HZ - 16].place.force_n == pytest.approx(1.0, abs=0.1)
    assert all(reading.state != "pulled" for reading in made)


def test_a_rest_that_was_none_is_taken_anew() -> None:
    """Touched in the first second: pulled once it is let go; after three seconds of that it is read as if it had not been."""
    recording = logged([A] * 2 * HZ + [NONE] * 5 * HZ + [B] * 2 * HZ + [NONE] * HZ)
    made, events, watch = watched(recording)
    assert sum(reading.state == "pulled" for reading in made) == pytest.approx(3 * HZ, abs=2)
    assert events == [("touch", 7), ("lift", 9)] and "taken for rest" in watch.notes[0]
    with pytest.raises(InputError, match="touched in the first second"):
        read_all(recording, MODEL)


def test_a_log_that_was_read_before_is_not_refused() -> None:
    """What was let go late had been touched before it all began: that is noted."""
    recording = logged([B] * 2 * HZ + [A + B] * 2 * HZ + [B] * HZ + [NONE] * 5 * HZ + [A] * HZ)
    readings, watch = read_all(recording, MODEL)
    assert [event.kind for reading in readings for event in reading.events] == ["touch", "lift", "touch"]
    assert "taken for rest" in watch.notes[0]


def test_a_field_that_is_not_known_touches_still() -> None:
    """Most frames of presses on another skin are wide, which told nothing at all: their places are not known, that they touch is."""
    skin = LayerDevice(seed=3).skin
    frames = [NONE] * 17
    for axial, angle in ((6.0, 0.5), (13.0, -2.0), (19.0, 2.5)):
        Z = skin.pressed(1.0, axial_mm=axial, angle_rad=angle)
        frames += [part * Z for part in (0.2, 0.4, 0.6, 0.8, *[1.0] * 6, 0.6, 0.2)] + [NONE] * 5
    made, events, _ = watched(logged(frames))
    assert sum(reading.state == "wide" for reading in made) > 15
    assert [kind for kind, _ in events] == ["touch", "lift"] * 3
