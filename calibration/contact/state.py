"""The inner loop of the contact detector: what one frame does to the state of each channel. Compiled; batch and stream run the same."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numba import njit
from numpy.typing import NDArray

from calibration.contact.alarm import ALLOWANCE
from skinfab.readout.drift import follow

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

#: Phases of a channel.
LEARNING, REST, CONTACT, SETTLING, FROZEN = 0, 1, 2, 3, 4
#: What a frame can bring about on a channel.
NOTHING, WINDOW_FULL, STARTED, ENDED, FROZE, THAWED = 0, 1, 2, 3, 4, 5

#: A contact ends where less than this part of its largest change is left: far from the noise, and from what drifted meanwhile.
END_PART = 0.3
#: ... and goes on as another one where the change comes back to this part before the reading has settled, and to the
#: shift that the detector is made for, in standard deviations.
AGAIN_PART = 0.5
SHIFT = 2 * ALLOWANCE
#: After a contact the baseline is set anew, once the reading had this long to settle, s.
SETTLE_S = 0.3
#: Changes under contact are smoothed by this, s.
SMOOTH_S = 0.05
#: A frozen channel reads again once so many frames in a row are unlike what it had frozen at, and it had time to settle.
THAW_FRAMES = 3
#: Time constant of the baseline at rest, s.
BASELINE_S = 0.5
#: After a contact so much of its largest change, and whatever is left of it, may go back by itself ...
RECOVERY_PART = 0.2
#: ... in about so long, s: silicone creeps back. Less than that, the other way, is no contact meanwhile.
RECOVERY_S = 10.0


class ChannelState(Protocol):
    """What is known of one channel: a record, whose fields compiled code reads as attributes."""

    phase: int
    r0: float  # level at rest, when it was learnt
    noise: float
    baseline: float
    rise: float  # how far the reading may yet go by itself after a contact, up ...
    fall: float  # ... and down
    up: float  # cumulative sums, and since when they are above zero
    down: float
    up_since: float
    down_since: float
    before: float  # the last two readings
    before_that: float
    seen: float  # when it last read anything
    sign: float
    start: float
    alarmed: float  # when the start was seen
    end: float
    change: float  # from the baseline, smoothed
    peak: float  # largest change in the direction of the sign
    saturated: bool
    dropped: bool
    cut: bool  # the channel froze under a contact
    filled: int  # of the window at rest
    within: float  # readings that differ by less are one ...
    patience: float  # ... and after so many of them it has frozen
    one: float  # the reading that it stays at, since when, and for how many frames
    one_since: float
    one_frames: float
    one_baseline: float  # what was known when it came there
    one_rise: float
    one_fall: float
    unlike: int  # frames in a row that differ from where it had frozen, and since when
    unlike_since: float
    watched: float  # frames in which a contact could be seen


_KINDS = {"int": np.int64, "float": np.float64, "bool": np.bool_}
STATE = np.dtype([(name, _KINDS[kind]) for name, kind in ChannelState.__annotations__.items()], align=True)


@njit(cache=True)
def run(
    state: NDArray[np.void],
    windows: FloatArray,
    time: FloatArray,
    values: FloatArray,
    valid: BoolArray,
    saturated: BoolArray,
    first: int,
    last_time: float,
    threshold: float,
    cap: float,
    hole: float,
    effect: IntArray,
) -> tuple[int, float]:
    """Frames from `first` on until one brings about anything; (the frame after it, its time), what it did is in `effect`.

    Parameters
    ----------
    state : (c,) STATE
    windows : (c, n) float
        Readings at rest, being gathered.
    time : (k,) float, s
        Growing; a frame without a time (NaN) says nothing.
    values, valid, saturated : (k, c)
    first : int
    last_time : float
        Of the frame before.
    threshold, cap : float
        Of the alarm, in standard deviations.
    hole : float, s
        How long a channel may read nothing before a contact has ended.
    effect : (c,) int
    """
    for k in range(first, len(time)):
        now = time[k]
        dt = now - last_time
        if not dt > 0:
            continue
        last_time = now
        any_effect = False
        for j in range(len(state)):
            effect[j] = _step(state[j], windows[j], now, dt, values[k, j], valid[k, j], saturated[k, j], threshold, cap, hole)
            any_effect |= effect[j] != 0
        if any_effect:
            return k + 1, last_time
    return len(time), last_time


@njit(cache=True)
def _step(
    s: ChannelState,
    window: FloatArray,
    now: float,
    dt: float,
    x: float,
    valid: bool,
    saturated: bool,
    threshold: float,
    cap: float,
    hole: float,
) -> int:
    if s.phase == CONTACT and now - s.seen > hole:  # nothing was read, or there was no frame at all
        s.end, s.dropped = s.seen, True
        _rest(s)
        return ENDED
    if not valid:
        return NOTHING
    if s.phase == LEARNING:
        return _learn(s, window, now, x, saturated, hole)
    if saturated and s.phase != CONTACT:
        return NOTHING  # an open wire reads the same: it starts nothing
    if now - s.seen > hole:  # what had begun to sum up says nothing of now
        s.up = s.down = 0.0
    s.seen = now
    if saturated:  # how far it goes is not known, nor whether the wire is open: what there is goes on
        s.saturated = True
        return NOTHING
    if abs(x - s.one) > s.within:
        s.one, s.one_since, s.one_frames = x, now, 0.0
        s.one_baseline, s.one_rise, s.one_fall = s.baseline, s.rise, s.fall
    s.one_frames += 1.0
    if s.phase == FROZEN:
        return _thaw(s, now, x)
    s.watched += 1.0
    if s.one_frames > s.patience:
        return _freeze(s)
    middle = max(min(x, s.before), min(max(x, s.before), s.before_that))  # of three: a spike is none of it
    s.before_that, s.before = s.before, x
    if s.phase == REST:
        return _watch(s, now, dt, x, threshold, cap)
    s.change += (middle - s.baseline - s.change) * (1.0 - np.exp(-dt / SMOOTH_S))
    if s.phase == CONTACT:
        s.peak = max(s.peak, s.sign * s.change)
        if s.sign * s.change < END_PART * s.peak:
            s.end, s.phase = now, SETTLING
            return ENDED
        return NOTHING
    sign = 1.0 if s.change > 0 else -1.0
    if abs(s.change) >= max(AGAIN_PART * s.peak, SHIFT * s.noise, s.rise if sign > 0 else s.fall):
        _start(s, now, now, sign)
        return STARTED
    if now - s.end >= SETTLE_S:
        _anchor(s)
        _rest(s)
    return NOTHING


@njit(cache=True)
def _learn(s: ChannelState, window: FloatArray, now: float, x: float, saturated: bool, hole: float) -> int:
    """Gather a window of readings, which must not have a hole."""
    if saturated:
        return NOTHING
    if now - s.seen > hole:
        s.filled = 0
    s.seen = now
    window[s.filled] = x
    s.filled += 1
    return WINDOW_FULL if s.filled == len(window) else NOTHING


@njit(cache=True)
def _freeze(s: ChannelState) -> int:
    """It read one value for too long: since then it said nothing, and what it said of a touch since then is taken back."""
    s.cut = s.phase == CONTACT
    if s.cut:
        s.end, s.dropped = s.start if s.alarmed > s.one_since else s.one_since, True
    s.watched -= s.one_frames
    s.baseline, s.rise, s.fall = s.one_baseline, s.one_rise, s.one_fall
    s.unlike = 0
    _rest(s)
    s.phase = FROZEN
    return FROZE


@njit(cache=True)
def _thaw(s: ChannelState, now: float, x: float) -> int:
    s.unlike = s.unlike + 1 if abs(x - s.before) > s.within else 0
    if s.unlike <= 1:
        s.unlike_since = now
    if s.unlike < THAW_FRAMES or now - s.unlike_since < SETTLE_S:
        return NOTHING
    s.before_that = s.before = x
    _rest(s)
    return THAWED


@njit(cache=True)
def _anchor(s: ChannelState) -> None:
    """Set the baseline where the reading came to rest, and say how far it may go from there by itself."""
    creep = RECOVERY_PART * s.peak
    s.baseline += s.change
    s.rise, s.fall = max(-s.change, 0.0), max(s.change, 0.0)
    if s.sign > 0:
        s.fall = max(s.fall, creep)
    else:
        s.rise = max(s.rise, creep)


@njit(cache=True)
def _watch(s: ChannelState, now: float, dt: float, x: float, threshold: float, cap: float) -> int:
    """A reading while nothing touches the channel."""
    z = (x - s.baseline) / s.noise
    if s.up == 0.0:
        s.up_since = now
    if s.down == 0.0:
        s.down_since = now
    s.up = max(0.0, s.up + min(z, cap) - ALLOWANCE)
    s.down = max(0.0, s.down + min(-z, cap) - ALLOWANCE)
    alarm = 1.0 if s.up >= threshold else -1.0 if s.down >= threshold else 0.0
    left = s.rise if alarm > 0 else s.fall
    step = min(left, ALLOWANCE * s.noise)
    if alarm != 0.0 and left > s.noise:  # silicone recovers, nothing touches it
        s.baseline, s.up, s.down = s.baseline + alarm * step, 0.0, 0.0
        if alarm > 0:
            s.rise -= step
        else:
            s.fall -= step
        return NOTHING
    if alarm != 0.0:
        s.change = x - s.baseline
        _start(s, now, s.up_since if alarm > 0 else s.down_since, alarm)
        return STARTED
    # After a hole the reading is no more known than after one frame: what came meanwhile must not be taken for drift.
    s.baseline = follow(s.baseline, x, min(dt, SMOOTH_S), BASELINE_S, cap * s.noise)
    fading = np.exp(-dt / RECOVERY_S)
    s.rise, s.fall = s.rise * fading, s.fall * fading
    return NOTHING


@njit(cache=True)
def _start(s: ChannelState, now: float, start: float, sign: float) -> None:
    s.phase, s.start, s.alarmed, s.sign, s.end = CONTACT, start, now, sign, np.nan
    s.peak = max(sign * s.change, ALLOWANCE * s.noise)
    s.saturated, s.dropped = False, False


@njit(cache=True)
def _rest(s: ChannelState) -> None:
    s.phase, s.up, s.down = REST, 0.0, 0.0


def fresh(channels: int) -> NDArray[np.void]:
    """Channels of which nothing is known yet."""
    return np.zeros(channels, dtype=STATE)
