"""What is wrong with a recording, in sentences, on opening it: before somebody fits, or believes, what it holds."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from skinfab.readout.frame import Recording

FloatArray = NDArray[np.float64]

#: A stream is off its rate where the median step differs by more than this part: crystals are off by 1e-4.
RATE_PART = 0.02
#: A log without a count of frames has a hole where its time goes on by more than this, s, and by so many steps.
HOLE_S, HOLE_STEPS = 0.5, 10
#: A channel clips where it stays at its own least or most for at least this long in a row, s, more than once.
CLIP_S = 0.05
CLIPS = 2
#: Clipping is told from a rest by where it is: at most this part of the frames of a clipped channel lies at an end ...
CLIP_PART = 0.5
#: ... and the channel gets there in a slope: the step into it is at least this part of the span, and more than one step of
#: the converter, which is what a crest's last one is.
CLIP_SLOPE, CLIP_STEPS = 0.002, 1.5
#: |cos(F, M)| of a touch at one point is 0 about that point, and small about one near it. A real sensor with faulty
#: calibration showed 0.99.
PARALLEL = 0.9
#: Forces below this part of the largest say nothing of a direction.
FORCE_PART = 0.1
#: Names and sentences are cut after so many channels.
NAMED = 6


def check(recording: Recording) -> list[str]:
    """Sentences on what is wrong; none where nothing is.

    Examples
    --------
    >>> from skinfab.readout.frame import Channel, Stream
    >>> stream = Stream("one", (Channel("U", "V"),), 100.0)
    >>> check(Recording.of_values(stream, np.ones((50, 1)), device_time=np.arange(50) / 100))
    ['U never changes; check its wiring']
    """
    if not len(recording):
        return ["there is no frame in it; record something"]
    return [*check_times(recording), *_channels(recording), *_forces(recording)]


def check_times(recording: Recording, *, coarse: bool = False) -> list[str]:
    """What is wrong with its times alone: for who looks at the channels by himself.

    Parameters
    ----------
    recording : Recording
    coarse : bool
        The device's clock is known to be coarser than its frames: that times repeat, and what its single steps come to, is not told of.
    """
    return [*_times(recording, coarse), *_missing(recording)] if len(recording) else []


def _times(recording: Recording, coarse: bool = False) -> list[str]:
    found = []
    for name, time, strict in (("device time", recording.device_time, not coarse), ("host time", recording.host_time, False)):
        if bad := int(np.count_nonzero(~np.isfinite(time))):
            found.append(f"{bad:,} of {len(time):,} frames have no {name}")
        steps = np.diff(time)
        with np.errstate(invalid="ignore"):
            back = steps <= 0 if strict else steps < 0
        if bad := int(np.count_nonzero(back)):
            at = int(np.argmax(back)) + 2
            how = "stands still or runs back" if strict else "runs back"
            found.append(f"the {name} {how} {_counted(bad, 'time')}, at frame {at:,} first; frames are doubled or the clock was set")
    nominal, steps = recording.stream.rate_hz, np.diff(recording.device_time)
    # Of frames that follow one another: lost ones are told elsewhere.
    steps = steps[(np.diff(recording.sequence) == 1) & (steps > 0)]
    if nominal and len(steps) and not coarse:
        rate = 1 / float(np.median(steps))
        if abs(rate - nominal) > RATE_PART * nominal:
            found.append(f"frames come at {rate:.4g} Hz, and the stream says {nominal:g}; check the device's clock")
    if len(steps) and (holes := steps[steps > max(HOLE_S, HOLE_STEPS * float(np.median(steps)))]).size:
        found.append(f"its time has {_counted(holes.size, 'hole')}, the longest of {holes.max():.3g} s; nothing is known of what was then")
    return found


def _missing(recording: Recording) -> list[str]:
    steps = np.diff(recording.sequence)
    found = []
    if lost := int((steps[steps > 1] - 1).sum()):
        part = 100 * lost / (lost + len(recording))
        found.append(f"{lost:,} frames are missing ({part:.2g} %), in {_counted(int(np.count_nonzero(steps > 1)), 'place')}")
    if doubled := int(np.count_nonzero(steps <= 0)):
        found.append(f"the frames' count does not go up at {_counted(doubled, 'place')}; frames are doubled or out of order")
    return found


def _counted(count: int, what: str) -> str:
    """A number of things.

    Examples
    --------
    >>> _counted(1, "place"), _counted(2000, "place")
    ('1 place', '2,000 places')
    """
    return f"{count:,} {what}{'s' * (count != 1)}"


def _channels(recording: Recording) -> list[str]:
    names = recording.stream.names
    dead, constant, clipped, flagged, holes = [], [], [], [], []
    rate = recording.stream.rate_hz or _rate(recording.device_time)
    for k, name in enumerate(names):
        values = recording.values[recording.valid[:, k], k]
        if not len(values):
            dead.append(name)
            continue
        if len(values) > 1 and np.ptp(values) == 0:
            constant.append(name)
        if recording.saturated[:, k].any():
            flagged.append(f"{name} ({100 * recording.saturated[:, k].mean():.2g} %)")
        elif _clips(values, rate):
            clipped.append(name)
        if part := float(np.mean(~recording.valid[:, k])):
            holes.append(f"{name} ({100 * part:.2g} %)")
    return [
        *_say(dead, "never has a valid reading", "never have a valid reading", "check its wiring", "check their wiring"),
        *_say(constant, "never changes", "never change", "check its wiring", "check their wiring"),
        *_say(flagged, "is saturated at times", "are saturated at times", "change its bridge or gain", "change their bridges or gains"),
        *_say(clipped, "seems clipped", "seem clipped", "it stays at one end of what it reads", "they stay at one end of what they read"),
        *_say(holes, "is not valid at times", "are not valid at times", "check its contact", "check their contacts"),
    ]


def _say(names: Sequence[str], one: str, many: str, do_one: str, do_many: str) -> list[str]:
    if not names:
        return []
    if len(names) == 1:
        return [f"{names[0]} {one}; {do_one}"]
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return [f"{', '.join(names[:NAMED])}{more} {many}; {do_many}"]


def _rate(time: FloatArray) -> float:
    steps = np.diff(time)
    steps = steps[steps > 0]
    return 1 / float(np.median(steps)) if len(steps) else 0.0


def _clips(values: FloatArray, rate: float) -> bool:
    """Does it stay exactly at its least or most, again and again, and run into it on a slope? At rest it comes in gently."""
    span = float(np.ptp(values)) if len(values) else 0.0
    shortest = max(round(CLIP_S * rate), 3)
    if not span:
        return False
    least = max(CLIP_SLOPE * span, CLIP_STEPS * float(np.diff(np.unique(values)).min()))
    for end in (values.min(), values.max()):
        at = values == end
        if at.mean() > CLIP_PART:
            continue
        edges = np.flatnonzero(np.diff(np.concatenate([[0], at.astype(np.int8), [0]])))
        starts, ends = edges[::2], edges[1::2]
        long = (ends - starts >= shortest) & (starts > 0)
        slope = np.abs(values[starts[long] - 1] - end) >= least
        if np.count_nonzero(slope) >= CLIPS:
            return True
    return False


def _forces(recording: Recording) -> list[str]:
    """Force and torque along each other: not what a touch at a point near the sensor's origin gives."""
    found = []
    for name, force, torque in _wrenches(recording):
        f, m = (np.where(recording.valid[:, each], recording.values[:, each], np.nan) for each in (force, torque))
        size, moment = np.linalg.norm(f, axis=1), np.linalg.norm(m, axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            felt = (size >= FORCE_PART * np.nanmax(size, initial=0)) & (size > 0) & (moment > 0)
            cosine = np.abs(np.einsum("ij,ij->i", f, m)) / (size * moment)
        if felt.any() and (middle := float(np.median(cosine[felt]))) > PARALLEL:
            found.append(
                f"{name}: force and torque are parallel (|cos| {middle:.2f}), which no touch at one point gives; "
                "check the sensor's calibration matrix"
            )
    return found


def _wrenches(recording: Recording) -> list[tuple[str, list[int], list[int]]]:
    """Sensors with three forces and three torques: channels of that kind, in their order, by threes."""
    kinds = [channel.kind for channel in recording.stream.channels]
    forces = [k for k, kind in enumerate(kinds) if kind == "force"]
    torques = [k for k, kind in enumerate(kinds) if kind == "torque"]
    if len(forces) != len(torques) or len(forces) % 3:
        return []
    names = recording.stream.names
    return [(f"{names[forces[k]]} to {names[torques[k + 2]]}", forces[k : k + 3], torques[k : k + 3]) for k in range(0, len(forces), 3)]
