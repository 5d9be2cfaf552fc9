"""A simulated hand on a sensing skin: five objects, touched as the paper's were, and what is true of each touch.

R = R0 (1 + change of the touches + drift + noise), with drop-outs. A touch presses, holds and lets go; silicone creeps, so that
a part of its change comes and goes slowly; its size scatters as Table II says. Each term can be left out: `without`.

What it leaves out: neighbouring sensors do not feel each other's touch; noise is white and normal, without hum or spikes; drift
is straight, without warm-up or humidity; a hand does not slide or rub; nothing wears, and wires break for a moment only;
the object's weight on its lowest sensor is part of the rest. Sizes of drift, noise, creep and drop-outs are assumed:
the paper gives none. What is measured here says how the detector answers these disturbances, not how large a skin's are.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import signal

from calibration.contact.detector import Contact
from calibration.contact.objects import Pad, pads
from skinfab.readout.frame import Channel, Recording, Stream

FloatArray = NDArray[np.float64]

RATE_HZ = 100.0
#: A bridge reads up to this many times the resistance at rest; an open wire reads the end.
RANGE = 5.0


@dataclass(frozen=True)
class Scene:
    """How much of each disturbance there is.

    Parameters
    ----------
    noise : float
        Standard deviation, as a part of R0.
    drift_per_minute : float
        Standard deviation of each channel's rate, as a part of R0.
    ramp_s : float
        A press, and a release, takes so long.
    creep : float
        Part of a change that comes, and goes, slowly ...
    creep_s : float
        ... with this time constant.
    scatter : float
        Touch by touch, times that of Table II over trials.
    signed : bool
        Does a channel that falls fall, or rise by as much?
    second : float
        How often a second finger comes onto a touched pad and stays longer.
    drop_outs_per_minute : float
        Of each channel, up to 3 s long; half of them silent, half with an open wire.
    """

    noise: float = 0.004
    drift_per_minute: float = 0.02
    ramp_s: float = 0.15
    creep: float = 0.1
    creep_s: float = 2.0
    scatter: float = 1.0
    signed: bool = True
    second: float = 0.3
    drop_outs_per_minute: float = 0.5


#: What to leave out, and what is left then.
ABLATIONS: dict[str, dict[str, float | bool]] = {
    "noise": {"noise": 1e-4},
    "drift": {"drift_per_minute": 0.0},
    "ramp": {"ramp_s": 0.01},
    "creep": {"creep": 0.0},
    "scatter": {"scatter": 0.0},
    "signs": {"signed": False},
    "second finger": {"second": 0.0},
    "drop-outs": {"drop_outs_per_minute": 0.0},
}


@dataclass(frozen=True, eq=False)
class Trial:
    """A simulated recording, and the touches in it: from the first press to the last finger off."""

    recording: Recording
    truth: tuple[Contact, ...]


def without(term: str, scene: Scene | None = None) -> Scene:
    """A scene that lacks a term of `ABLATIONS`; of noise a trace is left, as a converter's rounding would leave."""
    return replace(scene or Scene(), **ABLATIONS[term])  # type: ignore[arg-type]


def simulate(name: str, *, seed: int = 0, scene: Scene | None = None) -> Trial:
    """One trial: 4 s at rest, every pad once, 30 s in hand, a grip of 20 s on the first two pads, rest.

    Parameters
    ----------
    name : str
        Of one of `calibration.contact.objects.OBJECTS`.
    seed : int
        The same seed, the same trial.
    scene : Scene, optional

    Raises
    ------
    InputError
        There is no such object.

    Examples
    --------
    >>> trial = simulate("cube", seed=1)
    >>> trial.recording.stream.simulated, len(trial.recording.stream.channels), len(trial.truth) > 12
    (True, 6, True)
    """
    scene = scene or Scene()
    sensors = pads(name)
    # One source of chance for each term, so that leaving one out changes nothing else.
    hand, touch, finger, slow, white, wire = (np.random.default_rng([k, seed, *name.encode()]) for k in range(6))
    spans, length = _hand(len(sensors), hand)
    time = np.arange(round(length * RATE_HZ)) / RATE_HZ
    channels = tuple(
        Channel(f"S{j + 1}", "kohm", "contact", low=0.0, high=round(RANGE * pad.r0, 4), sensor=f"{name}-S{j + 1}")
        for j, pad in enumerate(sensors)
    )
    stream = Stream(name, channels, RATE_HZ, simulated=True)
    columns, truth = [], []
    for j, pad in enumerate(sensors):
        change, touches = _touches(channels[j].name, pad, spans[j], time, scene, (touch, finger))
        drift = scene.drift_per_minute / 60 * slow.standard_normal() * time
        reading = pad.r0 * (1 + change + drift + scene.noise * white.standard_normal(len(time)))
        _drop_out(reading, channels[j].high, scene, wire)
        columns.append(np.minimum(reading, channels[j].high))
        truth += touches
    made = Recording.of_values(stream, np.column_stack(columns), device_time=time)
    return Trial(made, tuple(sorted(truth, key=lambda each: (each.start, each.channel))))


def _hand(count: int, rng: np.random.Generator) -> tuple[list[list[tuple[float, float]]], float]:
    """From when to when each pad is touched, and how long the trial is, s."""
    spans: list[list[tuple[float, float]]] = [[] for _ in range(count)]
    now = 4.0
    for j in range(count):  # each one once
        hold = rng.uniform(0.6, 1.5)
        spans[j].append((now, now + hold))
        now += hold + rng.uniform(0.4, 1.0)
    for j in range(count):  # in hand: several at a time
        at = now + 1 + rng.exponential(3.0)
        while at < now + 30:
            hold = rng.uniform(0.4, 3.0)
            spans[j].append((at, at + hold))
            at += hold + 1.5 + rng.exponential(3.0)
    now += 36
    for j in range(min(2, count)):
        spans[j].append((now, now + 20))
    return spans, now + 24


def _touches(
    channel: str,
    pad: Pad,
    spans: list[tuple[float, float]],
    time: FloatArray,
    scene: Scene,
    chance: tuple[np.random.Generator, np.random.Generator],
) -> tuple[FloatArray, list[Contact]]:
    """The change that touches make, and what is true of them."""
    assert pad.touched is not None and pad.scatter is not None
    strength, second_finger = chance
    total, truth = np.zeros_like(time), []
    for start, end in spans:
        fingers = [(start, end)]
        comes, on, off = second_finger.uniform(size=3)
        if comes < scene.second:
            fingers.append((start + (0.3 + 0.4 * on) * (end - start), end + 0.1 + 0.4 * off))
        alone = np.zeros_like(time)
        sizes = pad.touched / pad.r0 - 1 + scene.scatter * pad.scatter / pad.r0 * strength.standard_normal(2)
        for (down, up), size in zip(fingers, sizes, strict=False):
            alone += (size if scene.signed else abs(size)) * _press(time, down, up, scene.ramp_s)
        total += alone
        largest = float(alone[np.argmax(np.abs(alone))])
        truth.append(Contact(channel, start, float(fingers[-1][1]) + scene.ramp_s, 1 if largest > 0 else -1, abs(largest)))
    gain = 1 - np.exp(-1 / (RATE_HZ * scene.creep_s))
    slow = signal.lfilter([gain], [1, gain - 1], total)
    return (1 - scene.creep) * total + scene.creep * slow, truth


def _press(time: FloatArray, down: float, up: float, ramp: float) -> FloatArray:
    """0 to 1 from `down` on, and back to 0 from `up` on, each along half a cosine."""
    rise, fall = (np.clip((time - at) / ramp, 0, 1) for at in (down, up))
    return (np.cos(np.pi * fall) - np.cos(np.pi * rise)) / 2


def _drop_out(reading: FloatArray, end_of_range: float, scene: Scene, rng: np.random.Generator) -> None:
    for at in rng.uniform(0, len(reading), rng.poisson(scene.drop_outs_per_minute * len(reading) / RATE_HZ / 60)).astype(int):
        length = int(rng.uniform(0.05, 3.0) * RATE_HZ)
        reading[at : at + length] = np.nan if rng.random() < 0.5 else end_of_range
