"""One more sensor, under the next free name and on the next free channel."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from skinfab.patterns.base import Pattern
from skinfab.placement.sensor import Sensor


def free_id(sensors: Sequence[Sensor], pattern: Pattern) -> str:
    """The next id of the pattern's kind that no sensor has: C1, C2, ... for contact, S1, ... for strain."""
    letter, taken = pattern.senses[0].upper(), {s.id for s in sensors}
    return next(f"{letter}{k}" for k in range(1, len(taken) + 2) if f"{letter}{k}" not in taken)


def free_channel(sensors: Sequence[Sensor]) -> int:
    """The lowest channel that no sensor is read on."""
    taken = {s.channel for s in sensors}
    return next(k for k in range(len(taken) + 1) if k not in taken)


def add_at(
    sensors: Sequence[Sensor],
    pattern: Pattern,
    piece: str,
    middle: ArrayLike,
    *,
    angle: float = 0.0,
    reserved: Sequence[Sensor] = (),
) -> tuple[tuple[Sensor, ...], Sensor]:
    """Put a pattern on a piece with its middle at a point; whether it fits is for `check` to say.

    Parameters
    ----------
    sensors : sequence of Sensor
        Those that are there.
    pattern : Pattern
    piece : str
        Id.
    middle : (2,) float, mm
        In the piece frame.
    angle : float, rad
    reserved : sequence of Sensor
        Others that lie nowhere for now, whose ids and channels stay theirs.

    Returns
    -------
    sensors : tuple of Sensor
        With the new one, in the order of channels.
    new : Sensor

    Examples
    --------
    >>> from skinfab.patterns.registry import make_pattern
    >>> (only,), new = add_at([], make_pattern("contact-spiral", {"s": 20}), "P1", [30.0, 40.0])
    >>> only is new, new.id, new.channel
    (True, 'C1', 0)
    """
    c, s = np.cos(angle), np.sin(angle)
    x, y = np.asarray(middle, dtype=np.float64) - np.array([[c, -s], [s, c]]) @ pattern.middle
    taken = [*sensors, *reserved]
    new = Sensor(free_id(taken, pattern), piece, pattern, float(x), float(y), float(angle), free_channel(taken))
    return tuple(sorted([*sensors, new], key=lambda s: s.channel)), new
