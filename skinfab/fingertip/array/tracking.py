"""What moves on the finger: touch, lift-off, rolling and slipping, from where it is touched in frame after frame.

As in the seed's log of a bar that is twirled: a contact that moves far in very short time has slipped, one that moves on slowly rolls
(`skinfab.fingertip.array.motion`). Each of several contacts is followed by itself.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.motion import SLIP_S, At, Motion, Moved, Smooth

FloatArray = NDArray[np.float64]

KINDS = ("touch", "lift", "slip", "roll")
#: A force that begins a contact, N, and the part of it that ends it.
TOUCH_N, LIFT_PART = 0.1, 0.5
#: Another number of contacts than before is told once it has lasted so long, s.
SURE_S = 0.2
#: Times of frames are rounded by no more than this, s.
_ROUNDING_S = 1e-6


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
    along_sd, around_sd : float, mm
        Standard deviations of the place on the skin's outside.
    """

    time: float
    axial_mm: float
    angle_rad: float
    force_n: float
    along_sd: float = 0.0
    around_sd: float = 0.0


@dataclass(frozen=True)
class Event:
    """What happened.

    Parameters
    ----------
    kind : str
        Of `KINDS`.
    start, end : float, s
        The same for a touch and a lift; else the last frame before it moved and the first after.
    along_mm, around_mm : float
        By how much it moved on the skin's outside; 0 for a touch and a lift.
    number : int
        Of the contact, counted from 1 as they touch.
    """

    kind: str
    start: float
    end: float
    along_mm: float = 0.0
    around_mm: float = 0.0
    number: int = 1


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


class _Followed:
    """One contact: its number, and where it is."""

    def __init__(self, number: int, place: Place, radius_mm: float, every_s: float) -> None:
        self.number, self.last, self._radius = number, place, radius_mm
        self._at = At(place.time, place.axial_mm, radius_mm * place.angle_rad, place.along_sd, place.around_sd)
        self._smooth = Smooth()
        self._motion: Motion | None = None
        self._move(every_s)

    def _turn(self, place: Place) -> float:
        return self._radius * math.remainder(place.angle_rad - self.last.angle_rad, math.tau)

    def far(self, place: Place) -> float:
        """How far from it a place is, mm."""
        return math.hypot(place.axial_mm - self.last.axial_mm, self._turn(place))

    def step(self, place: Place, every_s: float, *, anew: bool) -> list[Event]:
        """Take the next place, so long after the frame before; `anew`: how it came there was not seen."""
        self._at = At(place.time, place.axial_mm, self._at.around + self._turn(place), place.along_sd, place.around_sd)
        self.last = place
        events = []
        if anew:
            events = self.end()
            self._smooth, self._motion = Smooth(), None
        return [*events, *self._move(every_s)]

    def _move(self, every_s: float) -> list[Event]:
        at = self._smooth.step(self._at, every_s)
        if at is None:
            return []
        if self._motion is None:
            self._motion = Motion(at)
            return []
        return self._events(self._motion.step(at))

    def end(self) -> list[Event]:
        """What goes on still, ended."""
        return self._events(self._motion.end()) if self._motion is not None else []

    def _events(self, moved: Sequence[Moved]) -> list[Event]:
        return [Event(each.kind, each.start, each.end, each.along_mm, each.around_mm, self.number) for each in moved]


class Tracker:
    """Follows the places of all contacts and says what happens.

    From frame to frame a contact is the one that lies nearest. That there is one more, or one less but still another, is told once it has
    been so for `SURE_S`: a contact that is taken for two in a single frame is no event. While their number changes nothing slips or rolls.

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
        self._each: list[_Followed] = []
        self._number = 0
        #: The last frame that was sure, whether any was passed over since, and since when how many there are that are not followed yet.
        self._known, self._passed = -math.inf, False
        self._other: tuple[float, int] | None = None
        #: Since when it is touched where is not known.
        self._unsure = math.nan
        #: Of the last frame, and how long it took to come.
        self._time, self._every = math.nan, math.inf

    @property
    def touched(self) -> bool:
        """Whether anything is followed."""
        return bool(self._each)

    def follow(self, places: Iterable[Place]) -> tuple[Event, ...]:
        """All events of one contact's frames, from the start; frames of which the place is not known are passed over."""
        self._begin()
        events: list[Event] = []
        for place in places:
            known = math.isfinite(place.axial_mm) and math.isfinite(place.angle_rad) and math.isfinite(place.force_n)
            events += self.step(place.time, [place] if known else [], sure=known or place.force_n == 0)
        return (*events, *self.finish())

    def finish(self) -> tuple[Event, ...]:
        """What goes on still, ended."""
        events = tuple(event for each in self._each for event in each.end())
        self._begin()
        return events

    def step(self, time: float, places: Sequence[Place], *, sure: bool = True) -> list[Event]:
        """Take the next frame's contacts; events that are over with it.

        A frame that is not `sure` says at most that it is touched: after `SURE_S` of such frames, where nothing is followed, that is told.
        """
        if time > self._time:
            self._every = time - self._time
        self._time = time
        if not sure:
            self._passed = True
            return self._touched_somewhere(time, places)
        self._unsure = math.nan
        strong = [place for place in places if place.force_n >= TOUCH_N]
        weak = [place for place in places if LIFT_PART * TOUCH_N <= place.force_n < TOUCH_N]
        felt = strong + weak[: max(len(self._each) - len(strong), 0)]
        since = time
        if felt and self._each and len(felt) != len(self._each):
            if self._other is None or self._other[1] != len(felt):
                self._other = time, len(felt)
            since = self._other[0]
            if time - since < SURE_S - _ROUNDING_S:
                self._passed = True
                return []
        changed = len(felt) != len(self._each)
        anew = changed or (self._passed and time - self._known > SLIP_S + _ROUNDING_S)
        self._known, self._passed, self._other = time, False, None
        return self._take(felt, since, anew=anew)

    def _touched_somewhere(self, time: float, places: Sequence[Place]) -> list[Event]:
        """A touch of which the place is not known; it is where the first frame that is sure says."""
        if self._each or not any(place.force_n >= TOUCH_N for place in places):
            self._unsure = math.nan
            return []
        if math.isnan(self._unsure):
            self._unsure = time
        if time - self._unsure < SURE_S - _ROUNDING_S:
            return []
        since, self._unsure = self._unsure, math.nan
        # How it goes on from this place is not seen.
        self._known = -math.inf
        return self._take(places[:1], since, anew=True)

    def _take(self, felt: Sequence[Place], since: float, *, anew: bool) -> list[Event]:
        """Go on with the places that are nearest to what is followed; begin and end the others."""
        left, free, events = list(self._each), list(felt), []
        followed = []
        while left and free:
            each, place = min(((one, two) for one in left for two in free), key=lambda pair: pair[0].far(pair[1]))
            left.remove(each)
            free.remove(place)
            events += each.step(place, self._every, anew=anew)
            followed.append(each)
        for each in left:
            events += [*each.end(), Event("lift", since, since, number=each.number)]
        for place in free:
            self._number += 1
            followed.append(_Followed(self._number, place, self._radius, self._every))
            events.append(Event("touch", since, since, number=self._number))
        self._each = followed
        return events


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
