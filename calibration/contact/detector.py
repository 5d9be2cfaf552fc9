"""Contacts in the readings of a skin: when each channel is touched, how strongly, and which way its reading goes.

Each channel is judged by its signed change against its own noise: a touch makes most sensors rise by 5 to 110 % and some
fall. Once touched, a channel's baseline is held, so that a contact may last; it ends where most of the change is gone.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from calibration.contact import state as inner
from calibration.contact.alarm import Alarm, alarm_for
from calibration.contact.clock import Clock, SetBack, longest_hole, rate_of
from calibration.contact.health import Freeze, Health
from calibration.contact.rest import AGAIN, STILL_FRAMES, STILL_S, at_rest, patience
from skinfab.errors import InputError
from skinfab.readout.frame import Frame, Recording, Stream

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: False alarms a minute, all channels together, where nobody says otherwise: one in ten minutes.
FALSE_ALARMS = 0.1
#: A channel that could be frozen for longer than this, s, before its noise tells, does not tell.
TELLS_S = 60.0


@dataclass(frozen=True)
class Contact:
    """A touch of one channel.

    Parameters
    ----------
    channel : str
    start, end : float, s
        By the device's clock, carried on where it was set back; the end is NaN while it lasts.
    sign : int
        1 where the reading rises, -1 where it falls.
    strength : float
        Largest change, smoothed over 0.05 s, as a part of the reading at rest.
    saturated : bool
        The reading was at the end of its range meanwhile: the strength is at least this.
    dropped : bool
        The channel fell silent or froze, or the time has a hole: the end is the last that was read.
    """

    channel: str
    start: float
    end: float
    sign: int
    strength: float
    saturated: bool = False
    dropped: bool = False

    @property
    def lasting(self) -> bool:
        """Has it not ended yet?"""
        return math.isnan(self.end)


@dataclass(frozen=True, eq=False)
class Detection:
    """Contacts of a recording.

    Parameters
    ----------
    contacts : tuple of Contact
        In the order of their starts.
    channels : tuple of Health
    alarm : Alarm
    false_alarms : float
        Expected a minute, all channels together.
    set_back : tuple of SetBack
        Where the clock was set back.
    """

    contacts: tuple[Contact, ...]
    channels: tuple[Health, ...]
    alarm: Alarm
    false_alarms: float
    set_back: tuple[SetBack, ...] = ()

    def of(self, channel: str) -> tuple[Contact, ...]:
        """Those of one channel."""
        return tuple(each for each in self.contacts if each.channel == channel)

    @property
    def faults(self) -> tuple[str, ...]:
        """What is wrong with the clock and the channels, and what it did to the contacts, a sentence each."""
        found = [str(each) for each in self.set_back] + [fault for health in self.channels for fault in health.faults]
        if cut := sum(each.dropped for each in self.contacts):
            found.append(
                f"{cut} contact{'s were' if cut > 1 else ' was'} cut short, where the time has a hole or the channel fell silent or froze; "
                "the end is the last that was read"
            )
        return tuple(found)


class ContactDetector:
    """Contacts from frames as they come.

    Parameters
    ----------
    stream : Stream
        It must say how many frames come a second.
    false_alarms : float
        To be expected a minute, all channels together.
    channels : sequence of str, optional
        To be watched; without it those of the kind ``contact``, or all where there are none.

    Raises
    ------
    InputError
        There is no such channel, the stream's rate is not known, or no threshold gives that many false alarms.

    Examples
    --------
    >>> from skinfab.readout.frame import Channel
    >>> time, noise = np.arange(1000) / 100, np.random.default_rng(0).standard_normal((1000, 1))
    >>> touched = np.where((time > 5) & (time < 7), 140.0, 100.0)[:, None]
    >>> stream = Stream("skin", (Channel("S1", "kohm", "contact"),), 100.0)
    >>> watch = ContactDetector(stream)
    >>> for frame in Recording.of_values(stream, touched + 0.4 * noise, device_time=time):
    ...     for contact in watch.step(frame):
    ...         print(f"{frame.device_time:.2f} {contact.channel} {contact.start:.2f} {contact.end:.2f} {contact.strength:.1f}")
    5.03 S1 5.01 nan 0.4
    7.06 S1 5.01 7.06 0.4
    """

    def __init__(self, stream: Stream, *, false_alarms: float = FALSE_ALARMS, channels: Sequence[str] | None = None) -> None:
        if not stream.rate_hz > 0:
            raise InputError(f"stream {stream.name} does not say how many frames come a second; give its rate")
        names = channels or [each.name for each in stream.channels if each.kind == "contact"] or stream.names
        self.stream, self.false_alarms = stream, false_alarms
        self._columns = np.array([stream.index(name) for name in names], dtype=np.int64)
        still = max(round(STILL_S * stream.rate_hz), STILL_FRAMES)
        self.alarm = alarm_for(false_alarms, channels=len(names), rate_hz=stream.rate_hz, still_frames=still)
        c = len(names)
        self._state, self._windows, self._effect = inner.fresh(c), np.zeros((c, still)), np.zeros(c, dtype=np.int64)
        self._clock, self._hole = Clock(stream.rate_hz), longest_hole(stream.rate_hz)
        self._began, self._time, self._ended = math.nan, -math.inf, list[Contact]()
        self._ready, self._frames = [math.nan] * c, 0
        self._freezes: list[list[Freeze]] = [[] for _ in range(c)]
        self._masked, self._saturated = np.zeros(c, dtype=np.int64), np.zeros(c, dtype=np.int64)
        self._least, self._most = np.full(c, math.inf), np.full(c, -math.inf)

    @property
    def touched(self) -> tuple[str, ...]:
        """Channels that are being touched."""
        return self._in(inner.CONTACT)

    @property
    def waiting(self) -> tuple[str, ...]:
        """Channels that have not been at rest yet, and so are not watched."""
        return self._in(inner.LEARNING)

    @property
    def frozen(self) -> tuple[str, ...]:
        """Channels that have frozen."""
        return self._in(inner.FROZEN)

    @property
    def now(self) -> float:
        """The time of the last frame, s, carried on where the clock was set back."""
        return self._time

    def step(self, frame: Frame) -> tuple[Contact, ...]:
        """The contacts that this frame shows to have begun (their end is NaN) or to have ended.

        One that ends where it began is taken back: what made it was a channel that froze.
        """
        return self._feed(np.array([frame.device_time]), frame.values[None], frame.valid[None], frame.saturated[None])

    def run(self, recording: Recording) -> Detection:
        """All frames of a recording at once, the same as one by one; contacts that have not ended are among the result."""
        self._feed(recording.device_time, recording.values, recording.valid, recording.saturated)
        return self.found()

    def found(self) -> Detection:
        """All contacts so far, those that have not ended too."""
        contacts = sorted([*self._ended, *self.lasting()], key=lambda each: (each.start, each.channel))
        return Detection(tuple(contacts), self.health(), self.alarm, self.false_alarms, tuple(self._clock.set_back))

    def lasting(self) -> list[Contact]:
        """The contacts that have not ended."""
        return [self._contact(j, ended=False) for j in np.flatnonzero(self._state["phase"] == inner.CONTACT).tolist()]

    def health(self) -> tuple[Health, ...]:
        """What each channel was good for so far."""
        frames = max(self._frames, 1)
        soonest = self._began + (self._windows.shape[1] - 1) / self.stream.rate_hz
        found = []
        for j, ready in enumerate(self._ready):
            state, rested = self._state[j], not math.isnan(ready)
            found.append(
                Health(
                    self._name(j),
                    r0=float(state["r0"]) if rested else math.nan,
                    noise=float(state["noise"]) if rested else math.nan,
                    ready=ready,
                    late=ready - soonest if rested else math.nan,
                    watched=float(state["watched"]) / frames,
                    masked=float(self._masked[j]) / frames,
                    saturated=float(self._saturated[j]) / frames,
                    constant=bool(self._least[j] == self._most[j]),
                    tells=bool(state["patience"] <= TELLS_S * self.stream.rate_hz),
                    least=float(self._least[j]),
                    most=float(self._most[j]),
                    freezes=tuple(self._freezes[j]),
                )
            )
        return tuple(found)

    def _feed(self, time: FloatArray, values: FloatArray, valid: BoolArray, saturated: BoolArray) -> tuple[Contact, ...]:
        columns = self._columns
        values, valid, saturated = values[:, columns], valid[:, columns] & np.isfinite(values[:, columns]), saturated[:, columns]
        self._frames += len(time)
        self._masked += np.count_nonzero(~valid, axis=0)
        saturated = saturated & valid
        self._saturated += np.count_nonzero(saturated, axis=0)
        self._least = np.minimum(self._least, np.min(np.where(valid, values, math.inf), axis=0, initial=math.inf))
        self._most = np.maximum(self._most, np.max(np.where(valid, values, -math.inf), axis=0, initial=-math.inf))
        time = self._clock.of(time)
        if math.isnan(self._began) and (known := time[np.isfinite(time)]).size:
            self._began = float(known[0])
        edges: list[Contact] = []
        k = 0
        while k < len(time):
            self._effect[:] = inner.NOTHING
            k, self._time = inner.run(
                self._state,
                self._windows,
                time,
                values,
                valid,
                saturated,
                k,
                self._time,
                self.alarm.threshold,
                self.alarm.cap,
                self._hole,
                self._effect,
            )
            for j in np.flatnonzero(self._effect).tolist():
                edges += self._done(j, int(self._effect[j]))
        self._ended += [each for each in edges if each.end > each.start]
        return tuple(edges)

    def _done(self, j: int, effect: int) -> list[Contact]:
        """What a frame brought about on a channel: the contact that it shows, if any."""
        if effect == inner.WINDOW_FULL:
            self._learn(j)
        elif effect == inner.FROZE:
            self._freezes[j].append(Freeze(float(self._state["one_since"][j]), math.nan, float(self._state["one"][j])))
            return [self._contact(j, ended=True)] if self._state["cut"][j] else []
        elif effect == inner.THAWED:
            self._freezes[j][-1] = replace(self._freezes[j][-1], end=self._time)
        else:
            return [self._contact(j, ended=effect == inner.ENDED)]
        return []

    def _learn(self, j: int) -> None:
        """A window of readings is full: was the channel at rest? If not, it is tried again a little later."""
        state, window = self._state[j], self._windows[j]
        if (found := at_rest(window)) is None:
            passed = len(window) // AGAIN
            window[:-passed] = window[passed:].copy()
            state["filled"] = len(window) - passed
            return
        state["phase"], state["r0"], state["noise"], state["baseline"] = inner.REST, found.level, found.noise, found.level
        state["before_that"], state["before"], state["seen"] = window[-2], window[-1], self._time
        wait = patience(window, found, rate_hz=self.stream.rate_hz)
        state["within"], state["patience"] = wait.within, wait.frames
        state["one"], state["one_since"], state["one_frames"], state["one_baseline"] = window[-1], self._time, 1, found.level
        self._ready[j] = self._time

    def _contact(self, j: int, *, ended: bool) -> Contact:
        state = self._state[j]
        return Contact(
            self._name(j),
            float(state["start"]),
            float(state["end"]) if ended else math.nan,
            int(state["sign"]),
            float(state["peak"] / abs(state["r0"])),
            bool(state["saturated"]),
            bool(state["dropped"]),
        )

    def _in(self, phase: int) -> tuple[str, ...]:
        return tuple(self._name(j) for j in np.flatnonzero(self._state["phase"] == phase).tolist())

    def _name(self, j: int) -> str:
        return self.stream.names[self._columns[j]]


def detect(recording: Recording, *, false_alarms: float = FALSE_ALARMS, channels: Sequence[str] | None = None) -> Detection:
    """Contacts of a whole recording.

    Parameters
    ----------
    recording : Recording
        It begins at rest, for `STILL_S` seconds. Where its stream does not say how many frames come a second, the
        median of their distances does.
    false_alarms : float
        To be expected a minute, all channels together.
    channels : sequence of str, optional
        To be watched; without it those of the kind ``contact``, or all where there are none.

    Raises
    ------
    InputError
        It is too short, there is no such channel, or no threshold gives that many false alarms.

    Examples
    --------
    >>> from skinfab.readout.frame import Channel
    >>> time, noise = np.arange(1000) / 100, np.random.default_rng(0).standard_normal((1000, 1))
    >>> falls = np.where((time > 5) & (time < 7), 84.1, 100.0)[:, None]
    >>> log = Recording.of_values(Stream("skin", (Channel("S2"),)), falls + 0.4 * noise, device_time=time)
    >>> [(c.channel, round(c.start, 1), round(c.end, 1), c.sign, round(c.strength, 2)) for c in detect(log).contacts]
    [('S2', 5.0, 7.1, -1, 0.16)]
    """
    stream = recording.stream
    if len(recording) < STILL_FRAMES:
        raise InputError(
            f"{len(recording)} frames are too few to know a channel at rest; record {STILL_S:g} s without a touch, then the contacts"
        )
    stream = replace(stream, rate_hz=rate_of(recording))
    return ContactDetector(stream, false_alarms=false_alarms, channels=channels).run(recording)
