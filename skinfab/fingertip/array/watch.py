"""An array read frame after frame: where it is touched, how hard, along which line, and what happens."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.array.geometry import tactel_columns
from skinfab.fingertip.array.line_fit import Line, LineFinder
from skinfab.fingertip.array.logs import REST_S, of_recording
from skinfab.fingertip.array.matched import ArrayModel, Contact, Match, Matcher
from skinfab.fingertip.array.peak import Peak, PeakFinder
from skinfab.fingertip.array.simulator import deflection
from skinfab.fingertip.array.tracking import Event, Place, Tracker
from skinfab.readout.frame import Frame, Recording, Stream
from skinfab.tolerances import MATCH_UNEXPLAINED

FloatArray = NDArray[np.float64]

#: A frame is touched where a tactel reads more than so many standard deviations: one false one in half a million readings.
SIGMAS = 5.0


@dataclass(frozen=True, eq=False)
class Reading:
    """What a frame says.

    Parameters
    ----------
    time : float, s
    state : str
        ``none``, ``point``, ``line``, ``several`` points, ``edge`` (beyond the first or last ring's middle), ``past`` (farther out
        than can be told) or ``wide`` (none of these explains it).
    place : Place
        Of several points their middle, as far as one line tells it.
    line : Line or None
        None where nothing touches.
    contacts : tuple of Contact
        Points, the strongest first; none of a line.
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
        floor = SIGMAS * noise
        self._matcher = Matcher(model, floor=floor, noise=noise)
        self._lines = LineFinder(model, floor=floor, noise=noise)
        self._peaks = PeakFinder(model.geometry, floor=floor)
        self._tracker = Tracker(model.geometry.finger_radius)
        self._noise = noise

    def frame(self, time: float, Z: FloatArray, *, saturated: int = 0) -> Reading:
        """Take the next frame's deflections, (rings, stripes)."""
        match, peak = self._matcher(Z), self._peaks(Z)
        line = self._lines(Z) if match.contacts else None
        state, contacts = self._state(Z, match, line)
        place = _place(time, state, contacts, line)
        return Reading(time, state, place, line, contacts, peak, Z, saturated, tuple(self._tracker.step(place)))

    def _state(self, Z: FloatArray, match: Match, line: Line | None) -> tuple[str, tuple[Contact, ...]]:
        """The simplest that explains all of the frame, and its contacts."""
        if line is None or match.state == "past":
            return match.state, match.contacts
        known = Z[np.isfinite(Z)]
        total = max(float((known**2).sum()), 1e-300)
        # What noise alone leaves of a weak frame is held against nothing.
        allowed = MATCH_UNEXPLAINED + 2 * known.size * self._noise**2 / total
        one = match.contacts[:1] if match.state in ("one", "edge") else ()
        if one and _left(Z, self._matcher.predicted(one)) <= allowed * total:
            return ("edge" if match.state == "edge" else "point"), one
        if _left(Z, self._lines.predicted(line)) <= allowed * total:
            return "line", ()
        several = self._matcher.several(Z)
        if len(several) > 1 and _left(Z, self._matcher.predicted(several)) <= allowed * total:
            return "several", several
        return "wide", match.contacts[:1]

    def finish(self) -> tuple[Event, ...]:
        """What went on to the end."""
        return self._tracker.finish()


def _left(Z: FloatArray, predicted: FloatArray) -> float:
    """Sum of squares of what is left of a frame."""
    return float(np.nansum((Z - predicted) ** 2))


def _place(time: float, state: str, contacts: tuple[Contact, ...], line: Line | None) -> Place:
    if line is None:
        return Place(time, math.nan, math.nan, 0.0)
    if state in ("point", "edge", "past"):
        contact = contacts[0]
        return Place(time, contact.axial_mm, contact.angle_rad, contact.force_n)
    return Place(time, line.axial_mm, line.angle_rad, line.force_n)


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
                f"{stream.name} has {shape[0]} x {shape[1]} tactels, and the model {model.geometry.rings} x {model.geometry.stripes}; "
                "give that of this array"
            )
        self.stream, self.model = stream, model
        self._columns = columns
        self._resting: list[Frame] = []
        self._analyser: Analyser | None = None
        self.notes: tuple[str, ...] = ()
        self.noise = math.nan

    def step(self, frame: Frame) -> Reading | None:
        """Take a frame; None while the array's rest is measured.

        Raises
        ------
        InputError
            The array is touched in the first second.
        """
        if self._analyser is None:
            if not self._resting or frame.device_time - self._resting[0].device_time < REST_S - 1e-9:
                self._resting.append(frame)
                return None
            self._begin()
        assert self._analyser is not None
        valid, saturated = frame.valid[self._columns], frame.saturated[self._columns]
        volts = np.where(valid & ~saturated, frame.values[self._columns], np.nan)
        Z = np.where(self._dead, np.nan, deflection(volts, self._rest_v))
        time = frame.device_time - self._resting[0].device_time
        return self._analyser.frame(time, Z, saturated=int((valid & saturated).sum()))

    def _begin(self) -> None:
        rest = of_recording(Recording.of_frames(self.stream, self._resting), name=self.stream.name)
        self._dead = ~np.isfinite(rest.rest_v)
        self._rest_v = np.where(self._dead, 1.0, rest.rest_v)
        self.noise, self.notes = rest.noise, rest.notes
        self._analyser = Analyser(self.model, noise=rest.noise)

    def finish(self) -> tuple[Event, ...]:
        """What went on to the end; the next frame begins a new rest."""
        events = self._analyser.finish() if self._analyser is not None else ()
        self._analyser, self._resting = None, []
        return events


def read_all(recording: Recording, model: ArrayModel) -> tuple[tuple[Reading, ...], ArrayWatch]:
    """All readings of a recording, and the watch that made them, with its noise and notes.

    Raises
    ------
    InputError
        As `ArrayWatch`, or the recording ends before its rest does.
    """
    watch = ArrayWatch(recording.stream, model)
    readings = [made for frame in recording if (made := watch.step(frame)) is not None]
    if not readings:
        raise InputError(
            f"{recording.stream.name} ends within its first {REST_S:g} s, in which the array's rest is measured; record longer"
        )
    if last := watch.finish():
        readings[-1] = replace(readings[-1], events=(*readings[-1].events, *last))
    return tuple(readings), watch
