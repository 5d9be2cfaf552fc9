"""An array's stream, or a recording of it, read from its rest on: what V0 does is followed, and a rest that was none is taken anew."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.array.analyser import Analyser, Reading
from skinfab.fingertip.array.geometry import Geometry, tactel_columns
from skinfab.fingertip.array.logs import REST_FRAMES, REST_S, RESTLESS, of_recording, require_rested, tactels
from skinfab.fingertip.array.matched import ArrayModel
from skinfab.fingertip.array.rest import Rest
from skinfab.fingertip.array.simulator import Skin, deflection
from skinfab.fingertip.array.tracking import Event
from skinfab.readout.frame import Frame, Recording, Stream

FloatArray = NDArray[np.float64]

#: Frames of which nothing makes sense are a wrong rest if they stay so for so long, s; or, `True`, if they are pulled.
WRONG_S = {False: 10.0, True: 3.0}


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
        # Frames of which nothing makes sense: their times and voltages.
        self._wrong: list[tuple[float, FloatArray]] = []
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
        self._rest.step_back(volts, least=self._analyser.touch)
        reading = self._analyser.frame(time, deflection(volts, self._rest.volts), saturated=int((valid & saturated).sum()))
        if self._analyser.idle:
            self._rest.follow(time, volts, idle=True)
        else:
            # Far from a contact rubber swells by what 0.2 % of its highest reading come to: that is not wandering.
            explained = volts * (1 - self._analyser.predicted)
            self._rest.follow(time, explained, idle=False, untouched=self._analyser.untouched(reading.Z))
        return self._renewed(reading, volts)

    def _renewed(self, reading: Reading, volts: FloatArray) -> Reading:
        """Where for long nothing explains what is read, it is the rest that is wrong: what is read now is taken for it."""
        wrong = self._analyser is not None and self._analyser.no_contact(reading)
        self._wrong = [*self._wrong, (reading.time, volts)] if wrong else []
        if self._analyser is None or self._rest is None or not wrong:
            return reading
        for_s = WRONG_S[reading.state == "pulled"]
        last = np.array([each for time, each in self._wrong if reading.time - time <= REST_S + 1e-9])
        if reading.time - self._wrong[0][0] < for_s or len(last) < REST_FRAMES:
            return reading
        off = last / self._rest.volts
        if not np.nanmax(np.nanstd(np.where(np.isfinite(off), off, 1.0), axis=0)) <= RESTLESS:
            return reading
        self._rest.renew(np.median(last, axis=0))
        self._wrong = []
        self._said = (
            *self._said,
            f"{self.stream.name}: what was read at {reading.time:.1f} s was taken for rest, as no contact explained it for {for_s:g} s; "
            "the array was touched when it was thought at rest, or warmed up unevenly",
        )
        return replace(reading, events=(*reading.events, *self._analyser.let_go(reading.time)))

    def _begin(self) -> tuple[Rest, Analyser]:
        rest = of_recording(Recording.of_frames(self.stream, self._resting), name=self.stream.name)
        self.noise, self._said = rest.noise, rest.notes
        return Rest(rest.rest_v), Analyser(self.model, noise=rest.noise)

    def finish(self) -> tuple[Event, ...]:
        """What went on to the end; the next frame begins a new rest."""
        events = self._analyser.finish() if self._analyser is not None else ()
        self._analyser, self._resting, self._wrong = None, [], []
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
    pulled = [k for k, reading in enumerate(readings) if reading.state == "pulled"]
    if not any(reading.contacts for reading in readings[: min(pulled, default=0)]):
        # From the first thing that happened on: it was no rest that was measured.
        require_rested([readings[k].Z for k in pulled], recording.stream.name)
    if not readings:
        raise InputError(
            f"{recording.stream.name} ends within its first {REST_S:g} s, in which the array's rest is measured; record longer"
        )
    if last := watch.finish():
        readings[-1] = replace(readings[-1], events=(*readings[-1].events, *last))
    return tuple(readings), watch
