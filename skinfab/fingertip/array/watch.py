"""An array read frame after frame: where it is touched, how hard, along which line, and what happens."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.array.certainty import of_line, of_points, of_spot
from skinfab.fingertip.array.geometry import Geometry, tactel_columns
from skinfab.fingertip.array.line_fit import Line, LineFinder
from skinfab.fingertip.array.logs import PULLED_PART, REST_S, of_recording, require_rested, tactels
from skinfab.fingertip.array.matched import ArrayModel, Contact, Matcher
from skinfab.fingertip.array.peak import Peak, PeakFinder, highest
from skinfab.fingertip.array.rest import Rest
from skinfab.fingertip.array.simulator import Skin, deflection
from skinfab.fingertip.array.spot_fit import Spot, SpotFinder
from skinfab.fingertip.array.tracking import LIFT_PART, TOUCH_N, Event, Place, Tracker
from skinfab.readout.frame import Frame, Recording, Stream
from skinfab.tolerances import LINE_RIVAL, MATCH_UNEXPLAINED

FloatArray = NDArray[np.float64]

#: A frame is touched where a tactel reads more than so many standard deviations: one false one in half a million readings.
SIGMAS = 5.0
#: And is touched still where a force tells so many of it: its place is fitted with it, and noise alone has 64 places to try.
FAINT_SIGMAS = 6.0
#: States whose places are not to be trusted, and make no events.
UNSURE = ("past", "wide", "pulled")


@dataclass(frozen=True, eq=False)
class Reading:
    """What a frame says.

    Parameters
    ----------
    time : float, s
    state : str
        ``none``, ``point``, ``line``, ``patch`` (round, and no point), ``several`` points, ``edge`` (beyond the first or last ring's
        middle), ``past`` (farther out than can be told) or ``wide`` (none of these explains it), ``pulled`` (less is read than at
        rest: the array was touched then, or its polarity is turned).
    place : Place
        Of several points that of the strongest, with the force of all; NaN where nothing is touched.
    line : Line or None
        None of points and where nothing touches.
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
        self._touch = self._matcher.reading_of(TOUCH_N)
        #: Whether nothing touched it in the last frame.
        self.idle = True

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
        self.idle = self._idle(Z)
        contacts = found.contacts if sure else ()
        return Reading(time, found.state, place, found.line, found.spot, contacts, self._peaks(Z), Z, saturated, tuple(events))

    def finish(self) -> tuple[Event, ...]:
        """What went on to the end."""
        return self._tracker.finish()

    def _sd(self, Z: FloatArray, found: _Found) -> list[tuple[float, float]]:
        """How surely the place of each contact is told."""
        geometry = self._matcher.model.geometry
        if found.line is not None:
            return [of_line(Z, found.line, self._lines.predicted, geometry, noise=self._noise)]
        if found.spot is not None and found.contacts == (_contact(found.spot),):
            return [of_spot(Z, found.spot, self._spots.predicted, geometry, noise=self._noise)]
        return of_points(Z, found.contacts, self._matcher.predicted, geometry, noise=self._noise)

    def _pulled(self, Z: FloatArray) -> bool:
        low = -highest(-Z)
        return -low > max(2 * self._floor, self._touch, PULLED_PART * max(highest(Z), 0.0))

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
            several = self._matcher.several(Z)
            if len(several) > 1 and _left(Z, self._matcher.predicted(several)) <= allowed:
                return _Found("several", several)
            spot = self._spots.patch(Z, (patch.axial_mm, patch.angle_rad, patch.force_n), pulled=True)
            made[spot] = self._spots.predicted(spot)
            explains = _left(Z, made[spot]) <= allowed
        if not explains or not spot.force_n > 0:
            return None
        end = self._matcher.end(spot.axial_mm)
        state = end if end != "point" else "patch" if spot.radius_mm > 0 else "point"
        return _Found(state, (_contact(spot),), spot=spot)

    def _idle(self, Z: FloatArray) -> bool:
        """Whether nothing touches: not a tactel reads as much as what begins a contact."""
        return not self._tracker.touched and bool((~(np.abs(Z) >= max(self._floor, self._touch))).all())


@dataclass(frozen=True, eq=False)
class _Found:
    """What a frame holds: its state and contacts."""

    state: str
    contacts: tuple[Contact, ...] = ()
    line: Line | None = None
    spot: Spot | None = None


def _contact(spot: Spot) -> Contact:
    return Contact(spot.axial_mm, spot.angle_rad, spot.force_n)


def _left(Z: FloatArray, predicted: FloatArray) -> float:
    """Sum of squares of what is left of a frame."""
    return float(np.nansum((Z - predicted) ** 2))


class ArrayWatch:
    """Reads a stream's frames: the first second is rest, from there on each frame is a reading.

    Parameters
    ----------
    stream : Stream
    model : ArrayModel

    Raises
    ------
    InputError
        The stream has no array, or one of another shape than the model's.
    """

    def __init__(self, stream: Stream, model: ArrayModel) -> None:
        shape, columns = tactel_columns(stream)
        if shape != model.geometry.shape:
            raise InputError(
                f"the readings are of {shape[0]} x {shape[1]} tactels, and the model {model.geometry.rings} x {model.geometry.stripes}; "
                "give that of this array"
            )
        self.stream, self.model = stream, model
        self._columns = columns
        self._resting: list[Frame] = []
        self._analyser: Analyser | None = None
        self._rest: Rest | None = None
        self._said: tuple[str, ...] = ()
        self.noise = math.nan

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be known of the array, so far."""
        if self._rest is None or not self._rest.ever_stuck.any():
            return self._said
        return (
            *self._said,
            f"{self.stream.name}: {tactels(self._rest.ever_stuck)} stood still while the others changed, and were left out",
        )

    def step(self, frame: Frame) -> Reading | None:
        """Take a frame; None while the array's rest is measured.

        Raises
        ------
        InputError
            The array is touched in the first second.
        """
        if self._analyser is None or self._rest is None:
            if not self._resting or frame.device_time - self._resting[0].device_time < REST_S - 1e-9:
                self._resting.append(frame)
                return None
            self._rest, self._analyser = self._begin()
        valid, saturated = frame.valid[self._columns], frame.saturated[self._columns]
        time = frame.device_time - self._resting[0].device_time
        volts = self._rest.alive(time, np.where(valid & ~saturated, frame.values[self._columns], np.nan))
        reading = self._analyser.frame(time, deflection(volts, self._rest.volts), saturated=int((valid & saturated).sum()))
        self._rest.follow(time, volts, idle=self._analyser.idle)
        return reading

    def _begin(self) -> tuple[Rest, Analyser]:
        rest = of_recording(Recording.of_frames(self.stream, self._resting), name=self.stream.name)
        self.noise, self._said = rest.noise, rest.notes
        return Rest(rest.rest_v), Analyser(self.model, noise=rest.noise)

    def finish(self) -> tuple[Event, ...]:
        """What went on to the end; the next frame begins a new rest."""
        events = self._analyser.finish() if self._analyser is not None else ()
        self._analyser, self._resting = None, []
        return events


def warm_up() -> None:
    """Load all compiled code, so that the first touch does not wait for it."""
    seed = Geometry()
    read, skin = Analyser(ArrayModel.nominal(seed), noise=2e-4), Skin(seed)
    both = skin.points([(1.0, 0.0, 0.0)] * 2, [(5.0, 0.0), (18.0, 1.2)])
    for Z in (
        both,
        skin.plated(4.0, axial_mm=13.0, angle_rad=0.0, size_mm=18.0),
        skin.lined(2.0, axial_mm=13.0, angle_rad=0.0, line_rad=1.0),
    ):
        read.frame(0.0, Z)


def read_all(recording: Recording, model: ArrayModel) -> tuple[tuple[Reading, ...], ArrayWatch]:
    """All readings of a recording, and the watch that made them, with its noise and notes.

    Raises
    ------
    InputError
        As `ArrayWatch`; the recording ends before its rest does; or it reads less than its rest, which was none.
    """
    watch = ArrayWatch(recording.stream, model)
    readings = [made for frame in recording if (made := watch.step(frame)) is not None]
    require_rested([reading.Z for reading in readings if reading.state == "pulled"], recording.stream.name)
    if not readings:
        raise InputError(
            f"{recording.stream.name} ends within its first {REST_S:g} s, in which the array's rest is measured; record longer"
        )
    if last := watch.finish():
        readings[-1] = replace(readings[-1], events=(*readings[-1].events, *last))
    return tuple(readings), watch
