"""One frame of an array after another: where it is touched, how hard, along which line, and what happens."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.array.beside import line_beside
from skinfab.fingertip.array.certainty import of_line, of_points, of_spot
from skinfab.fingertip.array.line_fit import Line, LineFinder
from skinfab.fingertip.array.logs import PULLED_PART
from skinfab.fingertip.array.matched import ArrayModel, Contact, Matcher
from skinfab.fingertip.array.peak import Peak, PeakFinder, highest
from skinfab.fingertip.array.spot_fit import Spot, SpotFinder
from skinfab.fingertip.array.tracking import LIFT_PART, TOUCH_N, Event, Place, Tracker
from skinfab.tolerances import LINE_RIVAL, MATCH_UNEXPLAINED

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: A frame is touched where a tactel reads more than so many standard deviations: one false one in half a million readings.
SIGMAS = 5.0
#: And is touched still where a force tells so many of it: its place is fitted with it, and noise alone has 64 places to try.
FAINT_SIGMAS = 6.0
#: What reads less than this part of the highest is not touched, and so is what lies so far from all that reads more, mm.
FAINT_PART, FAR_MM = 0.1, 7.0
#: Frames that no contact explains read less than this force does where they may be a wrong rest.
NOTHING_N = 0.3
#: States whose places are not to be trusted: nothing slips or rolls in them, and pulled ones do not even touch.
UNSURE = ("past", "wide", "pulled")


@dataclass(frozen=True, eq=False)
class Reading:
    """What a frame says.

    Parameters
    ----------
    time : float, s
    state : str
        ``none``, ``point``, ``line``, ``patch`` (round, and no point), ``several`` points, or a line and a point, ``edge`` (beyond the
        first or last ring's middle), ``past`` (farther out than can be told) or ``wide`` (none of these explains it), ``pulled`` (less
        is read than at rest: the array was touched then, or its polarity is turned).
    place : Place
        Of several points that of the strongest, with the force of all; NaN where nothing is touched.
    line : Line or None
        None of points and where nothing touches; of ``several`` it is one of them.
    spot : Spot or None
        Of a point or a patch: its radius, and how it pulls along the skin.
    contacts : tuple of Contact
        All that touches, the strongest first; none where it is not to be trusted (`past`, `wide`, `pulled`).
    peak : Peak
        As published: of the windowed sinc.
    Z : (rings, stripes) float
        Its deflections.
    saturated : int
        Tactels at the end of their range, which were left out.
    events : tuple of Event
        That are over with this frame.
    """

    time: float
    state: str
    place: Place
    line: Line | None
    spot: Spot | None
    contacts: tuple[Contact, ...]
    peak: Peak
    Z: FloatArray
    saturated: int = 0
    events: tuple[Event, ...] = ()


class Analyser:
    """Reads frames of deflections.

    Parameters
    ----------
    model : ArrayModel
    noise : float
        Standard deviation of a reading, as a part of the gap.

    Examples
    --------
    >>> from skinfab.fingertip.array.geometry import Geometry
    >>> from skinfab.fingertip.array.simulator import Skin
    >>> seed = Geometry()
    >>> read = Analyser(ArrayModel.nominal(seed), noise=2e-4)
    >>> read.frame(0.0, Skin(seed).pressed(0.5, axial_mm=13.0, angle_rad=0.3)).state
    'point'
    >>> read.frame(0.1, Skin(seed).lined(2.0, axial_mm=13.0, angle_rad=0.3, line_rad=1.0)).state
    'line'
    """

    def __init__(self, model: ArrayModel, *, noise: float) -> None:
        # What would end a contact is none; drift that is being followed stays below.
        floor = max(SIGMAS * noise, Matcher(model).reading_of(LIFT_PART * TOUCH_N))
        self._matcher = Matcher(model, floor=floor, noise=noise)
        self._lines = LineFinder(model, floor=floor, noise=noise)
        self._spots = SpotFinder(model)
        self._peaks = PeakFinder(model.geometry, floor=floor)
        self._tracker = Tracker(model.geometry.finger_radius)
        self._floor, self._noise = floor, noise
        #: What is read of a contact that begins.
        self.touch = self._matcher.reading_of(TOUCH_N)
        #: Whether nothing touched it in the last frame, and what the contacts found there are expected to read.
        self.idle, self.predicted = True, np.zeros(model.geometry.shape)

    def frame(self, time: float, Z: FloatArray, *, saturated: int = 0) -> Reading:
        """Take the next frame's deflections, (rings, stripes)."""
        found = _Found("pulled") if self._pulled(Z) else self._found(Z)
        sure = found.state not in UNSURE
        sd = self._sd(Z, found) if sure else [(0.0, 0.0)] * len(found.contacts)
        places = [Place(time, each.axial_mm, each.angle_rad, each.force_n, *one) for each, one in zip(found.contacts, sd, strict=True)]
        place = Place(time, math.nan, math.nan, 0.0)
        if places:
            place = replace(places[0], force_n=sum(each.force_n for each in places))
        events = self._tracker.step(time, places, sure=sure)
        self.idle, self.predicted = self._idle(Z), self._predicted(found)
        contacts = found.contacts if sure else ()
        return Reading(time, found.state, place, found.line, found.spot, contacts, self._peaks(Z), Z, saturated, tuple(events))

    def finish(self) -> tuple[Event, ...]:
        """What went on to the end."""
        return self._tracker.finish()

    def _predicted(self, found: _Found) -> FloatArray:
        if found.line is not None:
            return self._lines.predicted(found.line) + self._matcher.predicted(found.beside)
        if found.spot is not None and found.contacts == (_contact(found.spot),):
            return self._spots.predicted(found.spot)
        return self._matcher.predicted(found.contacts)

    def _sd(self, Z: FloatArray, found: _Found) -> list[tuple[float, float]]:
        """How surely the place of each contact is told."""
        geometry = self._matcher.model.geometry
        if found.line is not None:
            of_others, rest = self._matcher.predicted(found.beside), Z - self._lines.predicted(found.line)
            each = [of_line(Z - of_others, found.line, self._lines.predicted, geometry, noise=self._noise)]
            each += of_points(rest, found.beside, self._matcher.predicted, geometry, noise=self._noise)
            return [each[found.beside.index(one) + 1 if one in found.beside else 0] for one in found.contacts]
        if found.spot is not None and found.contacts == (_contact(found.spot),):
            return [of_spot(Z, found.spot, self._spots.predicted, geometry, noise=self._noise)]
        return of_points(Z, found.contacts, self._matcher.predicted, geometry, noise=self._noise)

    def _pulled(self, Z: FloatArray) -> bool:
        low = -highest(-Z)
        return -low > max(2 * self._floor, self.touch, PULLED_PART * max(highest(Z), 0.0))

    def _found(self, Z: FloatArray) -> _Found:
        """The simplest that explains all of the frame."""
        if not highest(Z) > self._floor:
            return self._lightly(Z) if self._tracker.touched else _Found("none")
        x, s, force, *_ = self._matcher.one(Z)
        one = Contact(float(x), math.remainder(s / self._matcher.model.geometry.core_radius, math.tau), float(force))
        if (end := self._matcher.end(x)) == "past":
            return _Found("past", (one,))
        known = Z[np.isfinite(Z)]
        total = max(float((known**2).sum()), 1e-300)
        # What noise alone leaves of a weak frame is held against nothing.
        allowed = (MATCH_UNEXPLAINED + 2 * known.size * self._noise**2 / total) * total
        push, patch = self._lines.rivals(Z)
        if (left := _left(Z, self._matcher.predicted((one,)))) <= allowed:
            # It may be told better with its pull along the skin: two more numbers, at what another direction of a line costs.
            better = left - _left(Z, self._spots.predicted(push)) > 2 * LINE_RIVAL * max(left / max(known.size - 3, 1), self._noise**2)
            return _Found(end, (_contact(push) if better else one,), spot=push)
        return self._beside_a_point(Z, allowed, push, patch) or _Found("wide", (one,))

    def _lightly(self, Z: FloatArray) -> _Found:
        """What touched before may do so still, between tactels of which each alone reads next to nothing."""
        if not highest(Z) > 0:
            return _Found("none")
        x, s, force, *_ = self._matcher.one(Z)
        one = Contact(float(x), math.remainder(s / self._matcher.model.geometry.core_radius, math.tau), float(force))
        told = float(np.nansum(Z**2)) - _left(Z, self._matcher.predicted((one,)))
        end = self._matcher.end(x)
        if force < LIFT_PART * TOUCH_N or end == "past" or told < FAINT_SIGMAS**2 * self._noise**2:
            return _Found("none")
        return _Found(end, (one,))

    def _beside_a_point(self, Z: FloatArray, allowed: float, push: Spot, patch: Spot) -> _Found | None:
        """A point that pulls along the skin, a patch, a line, several points, or a patch that pulls: the first that explains the frame."""
        made = {spot: self._spots.predicted(spot) for spot in (push, patch)}
        spot = min(made, key=lambda one: _left(Z, made[one]))
        explains = _left(Z, made[spot]) <= allowed
        line = self._lines(Z, (push, patch))
        if line is not None and (not explains or self._lines.better(Z, line, spot)) and _left(Z, self._lines.predicted(line)) <= allowed:
            return _Found("line", (Contact(line.axial_mm, line.angle_rad, line.force_n),), line=line)
        if not explains:
            several = self._matcher.several(Z, enough=allowed)
            explains = len(several) > 1 and _left(Z, self._matcher.predicted(several)) <= allowed
            if explains and len(several) == 2:
                return _Found("several", several)
            # A line and a point are fewer numbers than three points.
            if (two := line_beside(Z, several, self._matcher, self._lines, explained=explains, allowed=allowed)) is not None:
                line, point = two
                both = (Contact(line.axial_mm, line.angle_rad, line.force_n), point)
                return _Found("several", tuple(sorted(both, key=lambda one: -one.force_n)), line=line, beside=(point,))
            if explains:
                return _Found("several", several)
            spot = self._spots.patch(Z, (patch.axial_mm, patch.angle_rad, patch.force_n), pulled=True)
            made[spot] = self._spots.predicted(spot)
            explains = _left(Z, made[spot]) <= allowed
        if not explains or not spot.force_n > 0:
            return None
        end = self._matcher.end(spot.axial_mm)
        state = end if end != "point" else "patch" if spot.radius_mm > 0 else "point"
        return _Found(state, (_contact(spot),), spot=spot)

    def untouched(self, Z: FloatArray) -> BoolArray:
        """Tactels of a frame that lie far from all that differ from the others."""
        from scipy.ndimage import maximum_filter

        known = np.isfinite(Z)
        # What touches makes tactels read more: the lowest quarter tells what the others read.
        off = np.where(known, Z - np.quantile(Z[known], 0.25), 0.0) if known.any() else np.zeros(Z.shape)
        busy = np.abs(off) > max(self._floor, FAINT_PART * highest(off))
        g = self._matcher.model.geometry
        reach = tuple(2 * math.ceil(FAR_MM / pitch - 0.25) + 1 for pitch in g.pitch)
        near: BoolArray = maximum_filter(busy, size=reach, mode=("constant", "wrap"))
        return known & ~near

    def no_contact(self, reading: Reading) -> bool:
        """Whether a frame reads something that no contact explains: less than at rest, or next to nothing here and there."""
        return reading.state == "pulled" or (reading.state == "wide" and highest(reading.Z) < NOTHING_N / TOUCH_N * self.touch)

    def let_go(self, time: float) -> tuple[Event, ...]:
        """Nothing touches any more."""
        return tuple(self._tracker.step(time, []))

    def _idle(self, Z: FloatArray) -> bool:
        """Whether nothing touches: not a tactel reads as much as what begins a contact."""
        return not self._tracker.touched and bool((~(np.abs(Z) >= max(self._floor, self.touch))).all())


@dataclass(frozen=True, eq=False)
class _Found:
    """What a frame holds: its state and contacts."""

    state: str
    contacts: tuple[Contact, ...] = ()
    line: Line | None = None
    spot: Spot | None = None
    #: The points beside a line.
    beside: tuple[Contact, ...] = ()


def _contact(spot: Spot) -> Contact:
    return Contact(spot.axial_mm, spot.angle_rad, spot.force_n)


def _left(Z: FloatArray, predicted: FloatArray) -> float:
    """Sum of squares of what is left of a frame."""
    return float(np.nansum((Z - predicted) ** 2))
