"""The six channels among a stream's, and by what each is multiplied to be in G or degrees a second.

A model compares what it learned with what comes, so both must be in the same units: those that a log declares are converted.
"""

from __future__ import annotations

import math
import re

from skinfab.errors import InputError
from skinfab.readout.frame import Stream

#: The six channels, in the order of every array of a nail's readings: acceleration along, angular velocity about x, y and z.
CHANNELS = ("Ax", "Ay", "Az", "Gx", "Gy", "Gz")
_G = 9.80665
#: Declared units in ours, without blanks, points, stars and carets.
_ACCELERATION = {"G": 1.0, "g": 1.0, "mg": 1e-3, "mG": 1e-3, "m/s2": 1 / _G, "m/s\u00b2": 1 / _G, "ms-2": 1 / _G, "mm/s2": 1e-3 / _G}
_TURN = math.degrees(1.0)
_VELOCITY = {
    "deg/s": 1.0, "\u00b0/s": 1.0, "dps": 1.0, "mdps": 1e-3, "mdeg/s": 1e-3, "rad/s": _TURN, "rads-1": _TURN, "mrad/s": 1e-3 * _TURN,
}  # fmt: skip


def channel_columns(stream: Stream) -> tuple[tuple[int, float], ...]:
    """Which column each of `CHANNELS` is, -1 where there is none, and by what it is multiplied.

    A column is called ``Ax``, or ``Ax (m/s^2)``. One that does not say its unit is taken as it is.

    Raises
    ------
    InputError
        There is none of the channels, one is there twice, or its unit is not known.

    Examples
    --------
    >>> from skinfab.readout.frame import Channel
    >>> stream = Stream("nail", (Channel("Gx", "rad/s"), Channel("Ax")), 1400.0)
    >>> [(column, round(scale, 2)) for column, scale in channel_columns(stream)]
    [(1, 1.0), (-1, 1.0), (-1, 1.0), (0, 57.3), (-1, 1.0), (-1, 1.0)]
    """
    plain = [re.sub(r"\s*[\[(][^\])]*[\])]\s*$", "", name) for name in stream.names]
    if not any(name in plain for name in CHANNELS):
        raise InputError(
            f"stream {stream.name} has none of the channels {', '.join(CHANNELS)} (capital letters count); it has "
            f"{', '.join(stream.names)}; rename them so, accelerations in G, angular velocities in deg/s"
        )
    out = []
    for name in CHANNELS:
        if (count := plain.count(name)) > 1:
            raise InputError(f"stream {stream.name} has {count} columns {name}; leave one of them in the log")
        k = plain.index(name) if count else -1
        out.append((k, 1.0 if k < 0 else _scale(name, stream.channels[k].unit, stream.name)))
    return tuple(out)


def absent(stream: Stream) -> list[str]:
    """What is to be said of channels that a stream does not have: a sentence, or nothing."""
    names = [name for name, (k, _) in zip(CHANNELS, channel_columns(stream), strict=True) if k < 0]
    return [f"stream {stream.name} has no {', '.join(names)}, and is decided without"] if names else []


def units_said(stream: Stream) -> bool:
    """Does each of the six channels that is there declare its unit?"""
    return all(stream.channels[k].unit for k, _ in channel_columns(stream) if k >= 0)


def units_note(learned: bool | None, stream: Stream, what: str) -> list[str]:
    """What is to be said where either the model's logs or this stream do not declare their units: a sentence, or nothing.

    Parameters
    ----------
    learned : bool, optional
        Did the model's logs declare them? None where the model does not say.
    stream : Stream
    what : str
        ``log`` or ``stream``.
    """
    if learned is None or learned == units_said(stream):
        return []
    one, other = ("model's logs declare", f"this {what} does not") if learned else (f"{what} declares", "the model's logs did not")
    return [f"the {one} the units, and {other}: what says nothing is taken for G and deg/s, and wrong in other units"]


def _scale(name: str, unit: str, stream: str) -> float:
    if not unit:
        return 1.0
    known = _ACCELERATION if name[0] == "A" else _VELOCITY
    short = re.sub(r"[\s.*^\u00b7\u22c5]", "", unit)
    if short not in known:
        raise InputError(f"stream {stream}: {name} is in {unit}, which is not known; give {', '.join(known)}")
    return known[short]
