"""What moves on the finger: touch, lift-off, rolling and slipping, from where it is touched in frame after frame.

As in the seed's log of a bar that is twirled: a contact that moves far in very short time has slipped, one that moves on slowly rolls.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.array.geometry import Geometry

FloatArray = NDArray[np.float64]

KINDS = ("touch", "lift", "slip", "roll")
#: A force that begins a contact, N, and the part of it that ends it.
TOUCH_N, LIFT_PART = 0.1, 0.5
#: A contact slips where it moves by so much, mm, in so short a time, s: 20 mm/s, where a bar that rolls through 90 degrees in ten of the
#: seed's frames goes at 12.
SLIP_MM, SLIP_S = 4.0, 0.2
#: It rolls where it moves on by so much, mm; and stands where it does not for so long, s.
ROLL_MM, STAND_S = 2.0, 0.7
#: A slip is over where it is slower than this part of what began it; times of frames are rounded by no more than this, s.
_SLOW, _ROUNDING_S = 0.5, 1e-6


@dataclass(frozen=True)
class Place:
    """Where the finger is touched in a frame.

    Parameters
    ----------
    time : float, s
    axial_mm, angle_rad : float
        NaN where it is not known.
    force_n : float
        0 where it is not touched.
    """

    time: float
    axial_mm: float
    angle_rad: float
    force_n: float


@dataclass(frozen=True)
class Event:
    """What happened.

    Parameters
    ----------
    kind : str
        Of `KINDS`.
    start, end : float, s
        The same for a touch and a lift; of a slip the frames before and after.
    along_mm, around_mm : float
        By how much it moved on the skin's outside; 0 for a touch and a lift.
    """

    kind: str
    start: float
    end: float
    along_mm: float = 0.0
    around_mm: float = 0.0


class _Roll(NamedTuple):
    """A roll so far: since when, how far on the outside, mm, and where it has come to."""

    start: float
    along_mm: float
    around_mm: float
    at: Place


def centre_of_pressure(Z: FloatArray, geometry: Geometry) -> tuple[float, float]:
    """Middle of the deflections above zero within two tactels of the highest: mm and rad; NaN where nothing is deflected.

    Examples
    --------
    >>> Z = np.zeros((8, 8)); Z[3, 7] = Z[3, 0] = 1.0
    >>> centre_of_pressure(Z, Geometry()) == (3 * 3.7, -math.pi / 8)
    True
    """
    Z = np.where(np.isfinite(Z), np.maximum(Z, 0.0), 0.0)
    i, j = divmod(int(Z.argmax()), Z.shape[1])
    if not Z[i, j] > 0:
        return math.nan, math.nan
    ring = np.arange(len(Z)) - i
    stripe = (np.arange(Z.shape[1]) - j + Z.shape[1] // 2) % Z.shape[1] - Z.shape[1] // 2
    W = np.where((np.abs(ring)[:, None] <= 2) & (np.abs(stripe)[None, :] <= 2), Z, 0.0)
    x, y = float((W.sum(axis=1) * ring).sum() / W.sum()), float((W.sum(axis=0) * stripe).sum() / W.sum())
    return geometry.from_tactels(i + x, j + y)


class Tracker:
    """Follows the place of contact and says what happens.

    Parameters
    ----------
    radius_mm : float
        Of the skin's outside.

    Examples
    --------
    >>> tracker = Tracker(12.7)
    >>> places = [Place(k / 6, 10.0 if k < 5 else 17.0, 0.0, 1.0 if k < 9 else 0.0) for k in range(10)]
    >>> [event.kind for event in tracker.follow(places)]
    ['touch', 'slip', 'lift']
    """

    def __init__(self, radius_mm: float) -> None:
        self._radius = radius_mm
        self._begin()

    def _begin(self) -> None:
        self._touched = False
        self._recent: list[Place] = []
        #: Where a slip began; where the contact stood, the last frame in which it still did, and where it has come to in rolling.
        self._slip: Place | None = None
        self._stood: Place | None = None
        self._still: Place | None = None
        self._roll: _Roll | None = None

    def follow(self, places: Iterable[Place]) -> tuple[Event, ...]:
        """All events of a sequence of frames, from the start."""
        self._begin()
        events = [event for place in places for event in self.step(place)]
        return (*events, *self.finish())

    def finish(self) -> tuple[Event, ...]:
        """What goes on still, ended."""
        events = self._end()
        self._begin()
        return tuple(events)

    def step(self, place: Place) -> list[Event]:
        """Take the next frame; events that are over with it."""
        known = math.isfinite(place.axial_mm) and math.isfinite(place.angle_rad)
        if not self._touched:
            if not (place.force_n >= TOUCH_N and known):
                return []
            self._touched = True
            self._stand(place)
            return [Event("touch", place.time, place.time)]
        if place.force_n < LIFT_PART * TOUCH_N:
            events = [*self._end(), Event("lift", place.time, place.time)]
            self._begin()
            return events
        return self._move(place) if known else []

    def _stand(self, place: Place) -> None:
        """From here on it has neither slipped nor rolled."""
        self._recent, self._stood, self._still, self._roll, self._slip = [place], place, place, None, None

    def _move(self, place: Place) -> list[Event]:
        last = self._recent[-1]
        before = [each for each in self._recent if place.time - each.time <= SLIP_S + _ROUNDING_S] or [last]
        self._recent = [*before, place]
        if self._slip is not None:
            if self._far(last, place) > _SLOW * SLIP_MM / SLIP_S * (place.time - last.time):
                return []
            events = self._end(last)
            self._stand(last)
            self._recent = [last, place]
            return events
        far = max(before, key=lambda each: self._far(each, place))
        if self._far(far, place) >= SLIP_MM:
            # What stood there until a moment ago slips from that moment on, and did not roll before.
            self._slip = next(each for each in reversed(before) if self._far(far, each) < SLIP_MM / 4)
            if self._roll is not None and self._roll.start >= self._slip.time - SLIP_S:
                self._roll = None
            return self._end_roll()
        return self._turn(place)

    def _turn(self, place: Place) -> list[Event]:
        """Rolling: on from where it stood, by a step of `ROLL_MM` after the other."""
        assert self._stood is not None and self._still is not None
        at = self._stood if self._roll is None else self._roll.at
        if self._far(at, place) >= ROLL_MM:
            start, along, around = (self._still.time, 0.0, 0.0) if self._roll is None else self._roll[:3]
            moved = self._between(at, place)
            self._roll = _Roll(start, along + moved[0], around + moved[1], place)
        elif self._roll is None:
            if self._far(at, place) < ROLL_MM / 2:
                self._still = place
        elif place.time - self._roll.at.time > STAND_S:
            events = self._end_roll()
            self._stood = self._still = place
            return events
        return []

    def _end(self, last: Place | None = None) -> list[Event]:
        """A slip or a roll that is over, the slip with the last frame of its motion."""
        if self._slip is not None:
            end = last or self._recent[-1]
            event = Event("slip", self._slip.time, end.time, *self._between(self._slip, end))
            self._slip = None
            return [event]
        return self._end_roll()

    def _end_roll(self) -> list[Event]:
        if self._roll is None:
            return []
        start, along, around, at = self._roll
        self._roll = None
        return [Event("roll", start, at.time, along, around)]

    def _between(self, a: Place, b: Place) -> tuple[float, float]:
        return b.axial_mm - a.axial_mm, self._radius * math.remainder(b.angle_rad - a.angle_rad, math.tau)

    def _far(self, a: Place, b: Place) -> float:
        return math.hypot(*self._between(a, b))


def matched_events(truth: Sequence[Event], found: Sequence[Event], *, slack: float) -> list[tuple[int, int]]:
    """Which found event is which true one: of its kind, overlapping within `slack` seconds; each once, the earliest first.

    Examples
    --------
    >>> matched_events([Event("slip", 1.0, 1.2)], [Event("slip", 5.0, 5.2), Event("slip", 1.1, 1.3)], slack=0.2)
    [(0, 1)]
    """
    pairs, free = [], set(range(len(found)))
    for k, true in enumerate(truth):
        for m in sorted(free):
            if found[m].kind == true.kind and found[m].start <= true.end + slack and found[m].end >= true.start - slack:
                pairs.append((k, m))
                free.discard(m)
                break
    return pairs
