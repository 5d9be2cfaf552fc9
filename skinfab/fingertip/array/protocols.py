"""What is done to a simulated array: presses at known places, rods in known directions, and the seed's twirling of a bar."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.array.geometry import RATE_HZ, wrapped
from skinfab.fingertip.array.simulator import Device
from skinfab.fingertip.array.tracking import Event
from skinfab.readout.frame import Channel, Recording, Stream

FloatArray = NDArray[np.float64]

#: The seed's loads: 50 g on a 3 mm tip, 2 N on a rod.
PRESS_N, ROD_N = 0.4903, 2.0
#: The largest pull along the skin, as a part of the force: 27 degrees.
STEEPEST = 0.5
#: What is known of each frame; NaN where it is not touched, or is no rod.
TRUTHS = (("axial_mm", "mm"), ("angle_deg", "deg"), ("force_n", "N"), ("line_deg", "deg"))
#: A log begins untouched for so long, s, and every contact lasts so many frames.
REST_S, FRAMES = 1.0, 3
#: The seed's log of twirling: frames a second, and frames.
TWIRL_HZ, TWIRL_FRAMES = 6.0, 100


@dataclass(frozen=True, eq=False)
class Touches:
    """What touches the array in each frame.

    Parameters
    ----------
    axial_mm, angle_rad, force_n, line_rad : (n,) float
        NaN but for the force where it is not touched; `line_rad` NaN where it is no rod.
    """

    axial_mm: FloatArray
    angle_rad: FloatArray
    force_n: FloatArray
    line_rad: FloatArray


def deflections(device: Device, touches: Touches) -> FloatArray:
    """What they deflect, without noise, (n, rings, stripes); a contact that stays is computed once."""
    out = np.zeros((len(touches.force_n), *device.geometry.shape))
    before: tuple[float, ...] = ()
    each = zip(touches.force_n, touches.axial_mm, touches.angle_rad, touches.line_rad, strict=True)
    for k, (force, axial, angle, line) in enumerate(each):
        now = (force, axial, angle, line)
        if now == before:
            out[k] = out[k - 1]
        elif force > 0 and math.isnan(line):
            out[k] = device.skin.pressed(force, axial_mm=axial, angle_rad=angle)
        elif force > 0:
            out[k] = device.skin.lined(force, axial_mm=axial, angle_rad=angle, line_rad=line)
        before = now
    return out


def truth_stream(device: Device, rate_hz: float) -> Stream:
    """The array's channels, and behind them what is true."""
    stream = device.geometry.stream(rate_hz=rate_hz, simulated=True)
    return replace(stream, channels=(*stream.channels, *(Channel(name, unit, "truth") for name, unit in TRUTHS)))


def recorded(device: Device, touches: Touches, rng: np.random.Generator, *, rate_hz: float = RATE_HZ) -> Recording:
    """The log of an array that is touched so: voltages, and what is true."""
    n = len(touches.force_n)
    volts = device.volts(deflections(device, touches), rng).reshape(n, -1)
    truth = np.column_stack([touches.axial_mm, np.degrees(touches.angle_rad), touches.force_n, np.degrees(touches.line_rad)])
    return Recording.of_values(truth_stream(device, rate_hz), np.hstack([volts, truth]), device_time=np.arange(n) / rate_hz)


def _one_by_one(axial: FloatArray, angle: FloatArray, force: FloatArray, line: FloatArray) -> Touches:
    """Rest, and then each for some frames, with one untouched frame between."""
    n, rest = len(force), round(REST_S * RATE_HZ)
    where = rest + np.arange(n)[:, None] * (FRAMES + 1) + np.arange(FRAMES)

    def column(values: FloatArray, empty: float) -> FloatArray:
        out = np.full(rest + n * (FRAMES + 1), empty)
        out[where] = values[:, None]
        return out

    return Touches(column(axial, math.nan), column(angle, math.nan), column(force, 0.0), column(line, math.nan))


def presses(device: Device, count: int, *, seed: int = 0) -> Recording:
    """A log of presses with a small tip, anywhere on the array, at a half to twice of the seed's load.

    Examples
    --------
    >>> log = presses(Device(), 5)
    >>> len(log), log.stream.simulated, log.stream.names[-4:]
    (35, True, ('axial_mm', 'angle_deg', 'force_n', 'line_deg'))
    """
    rng = np.random.default_rng((seed, 11))
    length = (device.geometry.rings - 1) * device.geometry.ring_pitch
    touches = _one_by_one(
        rng.uniform(0, length, count),
        rng.uniform(-math.pi, math.pi, count),
        PRESS_N * rng.uniform(0.5, 2.0, count),
        np.full(count, math.nan),
    )
    return recorded(device, touches, rng)


def pushes(device: Device, count: int, *, seed: int = 0) -> Recording:
    """A log of presses that also pull along the skin, by up to half of the force; ``along_n`` and ``around_n`` say how much.

    Examples
    --------
    >>> pushes(Device(), 5).stream.names[-2:]
    ('along_n', 'around_n')
    """
    rng = np.random.default_rng((seed, 14))
    length = (device.geometry.rings - 1) * device.geometry.ring_pitch
    axial, angle = rng.uniform(0.15, 0.85, count) * length, rng.uniform(-math.pi, math.pi, count)
    force, part, way = rng.uniform(0.7, 2.0, count), rng.uniform(0, STEEPEST, count), rng.uniform(-math.pi, math.pi, count)
    touches = _one_by_one(axial, angle, force, np.full(count, math.nan))
    pulls = _one_by_one(force * part * np.cos(way), force * part * np.sin(way), force, np.full(count, math.nan))
    Z = np.zeros((len(touches.force_n), *device.geometry.shape))
    for k in np.flatnonzero(touches.force_n > 0):
        shear = float(pulls.axial_mm[k]), float(pulls.angle_rad[k])
        place = {"axial_mm": float(touches.axial_mm[k]), "angle_rad": float(touches.angle_rad[k])}
        Z[k] = device.skin.pressed(float(touches.force_n[k]), **place, shear_n=shear)
    stream = truth_stream(device, RATE_HZ)
    stream = replace(stream, channels=(*stream.channels, *(Channel(name, "N", "truth") for name in ("along_n", "around_n"))))
    truth = [touches.axial_mm, np.degrees(touches.angle_rad), touches.force_n, touches.line_rad, pulls.axial_mm, pulls.angle_rad]
    volts = device.volts(Z, rng).reshape(len(Z), -1)
    return Recording.of_values(stream, np.column_stack([volts, *truth]), device_time=np.arange(len(Z)) / RATE_HZ)


def rods(device: Device, count: int, *, seed: int = 0) -> Recording:
    """A log of rods in all directions, over the middle of the array."""
    rng = np.random.default_rng((seed, 12))
    length = (device.geometry.rings - 1) * device.geometry.ring_pitch
    touches = _one_by_one(
        rng.uniform(0.35, 0.65, count) * length,
        rng.uniform(-math.pi, math.pi, count),
        ROD_N * rng.uniform(0.7, 1.4, count),
        rng.uniform(-math.pi / 2, math.pi / 2, count),
    )
    return recorded(device, touches, rng)


def twirl(device: Device, *, seed: int = 0) -> tuple[Recording, tuple[Event, ...]]:
    """The seed's log of a bar that is twirled (its figures 6 and 7), as far as its text tells it, and what happens in it.

    Held by three fingers the bar rolls on this one (frames 1 to 16), which is then taken away (17), comes back 90 degrees on (50), rolls,
    slips along the finger and skews (55), is held less (68), rolls again, and is pressed hardest at 90. Sizes and moments vary with
    the seed.
    """
    rng = np.random.default_rng((seed, 13))
    n, rest = TWIRL_FRAMES, round(REST_S * TWIRL_HZ)
    lift, touch = 17 + int(rng.integers(-2, 3)), 50 + int(rng.integers(-3, 4))
    slip = touch + 5 + int(rng.integers(0, 2))
    third = 72 + int(rng.integers(0, 5))
    steps = np.zeros((n, 2))  # mm along, and around on the outside
    first_to = lift - 3
    steps[2:first_to, 1] = rng.uniform(0.8, 1.3)
    steps[2:first_to, 0] = rng.uniform(-0.1, 0.1)
    steps[touch + 1 : slip, 1] = rng.uniform(1.0, 1.5)
    steps[slip] = rng.choice([-1, 1]) * rng.uniform(5.5, 7.5), rng.uniform(-1.5, 1.5)
    steps[third : third + 8, 1] = -rng.uniform(0.8, 1.3)
    path = np.cumsum(steps, axis=0)
    r = device.geometry.finger_radius
    axial = 13.0 + path[:, 0] - (steps[slip, 0] / 2)
    angle = rng.uniform(-math.pi, math.pi) + path[:, 1] / r
    angle[touch:] += math.radians(90)
    force = np.interp(
        np.arange(n), [0, lift - 4, lift, touch - 1, touch + 3, 67, 70, 86, 90, n - 1], [1.6, 1.6, 0, 0, 1.6, 1.6, 1.0, 1.0, 2.6, 2.2]
    )
    line = np.where(np.arange(n) < slip, math.radians(rng.uniform(60, 85)), math.radians(rng.uniform(20, 50)))
    away = force <= 0

    def column(values: FloatArray, empty: float) -> FloatArray:
        return np.concatenate([np.full(rest, empty), np.where(away, empty, values)])

    touches = Touches(
        column(axial, math.nan), column(np.array([wrapped(a) for a in angle]), math.nan), column(force, 0.0), column(line, math.nan)
    )

    def at(k: int) -> float:
        return (k + rest) / TWIRL_HZ

    def moved(a: int, b: int) -> tuple[float, float]:
        return float(path[b, 0] - path[a, 0]), float(path[b, 1] - path[a, 1])

    events = (
        Event("touch", at(0), at(0)),
        Event("roll", at(1), at(first_to - 1), *moved(1, first_to - 1)),
        Event("lift", at(lift), at(lift)),
        Event("touch", at(touch), at(touch)),
        Event("roll", at(touch), at(slip - 1), *moved(touch, slip - 1)),
        Event("slip", at(slip - 1), at(slip), *moved(slip - 1, slip)),
        Event("roll", at(third - 1), at(third + 7), *moved(third - 1, third + 7)),
    )
    return recorded(device, touches, rng, rate_hz=TWIRL_HZ), events
