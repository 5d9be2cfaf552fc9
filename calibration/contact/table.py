"""What each contact sensor reads at rest and touched, over trials: the paper's Table II from one's own data, and its fig. 6's scale."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from calibration.contact.clock import longest_hole, on_one_clock, rate_of
from calibration.contact.detector import Contact, Detection
from skinfab.errors import InputError
from skinfab.readout.frame import Recording

FloatArray = NDArray[np.float64]

#: A contact is stable in the middle of it: so much is left out at each end.
EDGES = 0.25


@dataclass(frozen=True)
class Row:
    """A channel over all trials.

    Parameters
    ----------
    channel, unit : str
    r0 : float
        Reading at rest, the median over trials.
    touched, scatter : float
        Mean over trials at stable contact, and the standard deviation over trials; NaN where there is too little.
    change, change_scatter : float
        The mean over trials of the change as a part of that trial's own reading at rest, and its standard deviation.
    contacts, trials : int
        How many contacts in how many trials that is.
    watched : float
        Part of the frames, of all trials, in which a contact could be seen.
    state : str
        ``silent``, ``constant``, ``never at rest`` or ``frozen``, and in how many trials if not in all; empty where it was well.
    """

    channel: str
    unit: str
    r0: float
    touched: float
    scatter: float
    change: float
    change_scatter: float
    contacts: int
    trials: int
    watched: float
    state: str


def stable_level(recording: Recording, contact: Contact) -> float:
    """Median reading in the middle of a contact; NaN where nothing was read there.

    Parameters
    ----------
    recording : Recording
    contact : Contact
        One that lasts ends with the recording.
    """
    (time, _), j = on_one_clock(recording), recording.stream.index(contact.channel)
    end = float(np.nanmax(time)) if contact.lasting else contact.end
    edge = EDGES * (end - contact.start)
    good = (time >= contact.start + edge) & (time <= end - edge) & recording.valid[:, j] & ~recording.saturated[:, j]
    return float(np.median(recording.values[good, j])) if good.any() else math.nan


def contact_table(trials: Sequence[tuple[Recording, Detection]]) -> tuple[Row, ...]:
    """A row for each channel.

    Parameters
    ----------
    trials : sequence of (Recording, Detection)
        Of one object: all have the same channels.

    Raises
    ------
    InputError
        They do not.

    Examples
    --------
    >>> from calibration.contact.detector import detect
    >>> from calibration.contact.simulator import simulate
    >>> made = [simulate("grip", seed=k).recording for k in range(3)]
    >>> row = contact_table([(each, detect(each)) for each in made])[0]
    >>> row.channel, round(row.r0), round(row.touched), row.trials  # Table II: 20.2, and 28.6 +- 2.9 kohm
    ('S1', 20, 28, 3)
    """
    names = [health.channel for health in trials[0][1].channels]
    for recording, found in trials:
        if (others := [health.channel for health in found.channels]) != names:
            raise InputError(
                f"trials of one object have the same channels; {trials[0][0].stream.name} has {', '.join(names)} and "
                f"{recording.stream.name} has {', '.join(others)}"
            )
    return tuple(_row(name, j, trials) for j, name in enumerate(names))


def _row(name: str, j: int, trials: Sequence[tuple[Recording, Detection]]) -> Row:
    rest, levels, changes, contacts = [], [], [], 0
    for recording, found in trials:
        r0 = found.channels[j].r0
        if math.isnan(r0):
            continue
        rest.append(r0)
        seen = [level for each in found.of(name) if not math.isnan(level := stable_level(recording, each))]
        contacts += len(seen)
        if seen:
            levels.append(float(np.mean(seen)))
            changes.append(float(np.mean(seen)) / r0 - 1)
    channel = trials[0][0].stream.channels[trials[0][0].stream.index(name)]
    return Row(
        name,
        channel.unit,
        float(np.median(rest)) if rest else math.nan,
        float(np.mean(levels)) if levels else math.nan,
        float(np.std(levels, ddof=1)) if len(levels) > 1 else math.nan,
        float(np.mean(changes)) if changes else math.nan,
        float(np.std(changes, ddof=1)) if len(changes) > 1 else math.nan,
        contacts,
        len(levels),
        sum(found.channels[j].watched * len(recording) for recording, found in trials) / sum(len(recording) for recording, _ in trials),
        _state([found.channels[j].state for _, found in trials]),
    )


def _state(states: Sequence[str]) -> str:
    """
    Examples
    --------
    >>> _state(["frozen", "", "frozen"]), _state(["silent"]), _state(["", ""])
    ('frozen in 2 of 3', 'silent', '')
    """
    of = len(states)
    counts = {state: states.count(state) for state in states if state}
    return ", ".join(state if count == of else f"{state} in {count} of {of}" for state, count in counts.items())


def normalised(recording: Recording, found: Detection) -> FloatArray:
    """Change of each watched channel as a part of its largest one under contact, (n, c), 0 to 1; NaN where nothing was read.

    A channel that falls when it is touched goes up here as all others do; one that was never touched stays at 0.
    """
    time, _ = on_one_clock(recording)
    out = np.zeros((len(recording), len(found.channels)))
    for k, health in enumerate(found.channels):
        j = recording.stream.index(health.channel)
        good = recording.valid[:, j] & ~recording.saturated[:, j] & np.isfinite(time)
        for freeze in health.freezes:
            good &= (time < freeze.start) | (time >= freeze.end)
        change = np.where(good, recording.values[:, j] - health.r0, np.nan)
        touched = np.zeros(len(recording), dtype=bool)
        for each in found.of(health.channel):
            touched |= (time >= each.start) & ~(time > each.end)
        if (good & touched).any() and not math.isnan(health.r0):
            under = change[good & touched]
            largest = under[np.argmax(np.abs(under))]
            out[:, k] = np.clip(change / largest, 0.0, 1.0) if largest else 0.0
        out[~good, k] = np.nan
    return out


def unwatched(recording: Recording, found: Detection, channel: str) -> list[tuple[float, float]]:
    """From when to when, s, no contact of a channel could be seen: before it rested, while it was frozen, and in holes of the time.

    Examples
    --------
    >>> from calibration.contact.detector import detect
    >>> from calibration.contact.simulator import simulate
    >>> log = simulate("grip", seed=1).recording
    >>> [(start, round(end)) for start, end in unwatched(log, detect(log), "S1")]
    [(0.0, 3)]
    """
    time = on_one_clock(recording)[0]
    time = time[np.isfinite(time)]
    (health,) = (each for each in found.channels if each.channel == channel)
    end = float(time[-1])
    if health.state in ("silent", "constant", "never at rest"):
        return [(float(time[0]), end)]
    hole = longest_hole(rate_of(recording))
    holes = np.flatnonzero(np.diff(time) > hole)
    return [
        (float(time[0]), health.ready),
        *((each.start, end if math.isnan(each.end) else each.end) for each in health.freezes),
        *((float(time[k]), float(time[k + 1])) for k in holes if time[k] > health.ready),
    ]
