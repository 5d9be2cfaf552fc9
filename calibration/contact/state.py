"""The inner loop of the contact detector: what one frame does to the state of each channel. Compiled; batch and stream run the same."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from calibration.contact.alarm import ALLOWANCE
from skinfab.readout.drift import follow

#: Phases of a channel.
LEARNING, REST, CONTACT, SETTLING = 0, 1, 2, 3
#: What a frame can bring about on a channel.
NOTHING, WINDOW_FULL, STARTED, ENDED = 0, 1, 2, 3

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
#: A contact lasts through a hole in the readings of up to this, s.
MAX_HOLE_S = 1.0
#: Time constant of the baseline at rest, s.
BASELINE_S = 0.5
#: After a contact so much of its largest change, and whatever is left of it, may go back by itself ...
RECOVERY_PART = 0.2
#: ... in about so long, s: silicone creeps back. Less than that, the other way, is no contact meanwhile.
RECOVERY_S = 10.0

#: What is known of one channel.
STATE = np.dtype(
    [
        ("phase", np.int64),
        ("r0", np.float64),  # level at rest, when it was learnt
        ("noise", np.float64),
        ("baseline", np.float64),
        ("rise", np.float64),  # how far the reading may yet go by itself after a contact, up ...
        ("fall", np.float64),  # ... and down
        ("up", np.float64),  # cumulative sums, and since when they are above zero
        ("down", np.float64),
        ("up_since", np.float64),
        ("down_since", np.float64),
        ("before", np.float64),  # the last two readings
        ("before_that", np.float64),
        ("seen", np.float64),  # when it last read anything
        ("sign", np.float64),
        ("start", np.float64),
        ("end", np.float64),
        ("change", np.float64),  # from the baseline, smoothed
        ("peak", np.float64),  # largest change in the direction of the sign
        ("saturated", np.bool_),
        ("dropped", np.bool_),
        ("filled", np.int64),  # of the window at rest
    ],
    align=True,
)


@njit(cache=True)
def run(state, windows, time, values, valid, saturated, first, last_time, threshold, cap, effect):  # type: ignore[no-untyped-def]
    """Frames from `first` on until one brings about anything; (the frame after it, its time), what it did is in `effect`.

    Parameters
    ----------
    state : (c,) STATE
    windows : (c, n) float
        Readings at rest, being gathered.
    time : (k,) float, s
    values, valid, saturated : (k, c)
    first : int
    last_time : float
        Of the frame before.
    threshold, cap : float
        Of the alarm, in standard deviations.
    effect : (c,) int
    """
    for k in range(first, len(time)):
        now = time[k]
        dt = now - last_time
        if not dt > 0:  # a clock set back, or a frame a second time: it says nothing
            continue
        last_time = now
        any_effect = False
        for j in range(len(state)):
            effect[j] = _step(state[j], windows[j], now, dt, values[k, j], valid[k, j], saturated[k, j], threshold, cap)
            any_effect |= effect[j] != 0
        if any_effect:
            return k + 1, last_time
    return len(time), last_time


@njit(cache=True)
def _step(s, window, now, dt, x, valid, saturated, threshold, cap):  # type: ignore[no-untyped-def]
    if not valid:
        if s.phase == CONTACT and now - s.seen > MAX_HOLE_S:
            s.end, s.dropped = s.seen, True
            _rest(s)
            return ENDED
        return NOTHING
    if s.phase == LEARNING:
        if not saturated:
            window[s.filled] = x
            s.filled += 1
            if s.filled == len(window):
                return WINDOW_FULL
        return NOTHING
    if saturated and s.phase != CONTACT:
        return NOTHING  # an open wire reads the same: it starts nothing
    s.seen = now
    if saturated:  # how far it goes is not known, nor whether the wire is open: what there is goes on
        s.saturated = True
        return NOTHING
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
        _start(s, now, sign)
        return STARTED
    if now - s.end >= SETTLE_S:
        _anchor(s)
        _rest(s)
    return NOTHING


@njit(cache=True)
def _anchor(s):  # type: ignore[no-untyped-def]
    """Set the baseline where the reading came to rest, and say how far it may go from there by itself."""
    creep = RECOVERY_PART * s.peak
    s.baseline += s.change
    s.rise, s.fall = max(-s.change, 0.0), max(s.change, 0.0)
    if s.sign > 0:
        s.fall = max(s.fall, creep)
    else:
        s.rise = max(s.rise, creep)


@njit(cache=True)
def _watch(s, now, dt, x, threshold, cap):  # type: ignore[no-untyped-def]
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
        _start(s, s.up_since if alarm > 0 else s.down_since, alarm)
        return STARTED
    # After a hole the reading is no more known than after one frame: what came meanwhile must not be taken for drift.
    s.baseline = follow(s.baseline, x, min(dt, SMOOTH_S), BASELINE_S, cap * s.noise)
    fading = np.exp(-dt / RECOVERY_S)
    s.rise, s.fall = s.rise * fading, s.fall * fading
    return NOTHING


@njit(cache=True)
def _start(s, start, sign):  # type: ignore[no-untyped-def]
    s.phase, s.start, s.sign, s.end = CONTACT, start, sign, np.nan
    s.peak = max(sign * s.change, ALLOWANCE * s.noise)
    s.saturated, s.dropped = False, False


@njit(cache=True)
def _rest(s):  # type: ignore[no-untyped-def]
    s.phase, s.up, s.down = REST, 0.0, 0.0


def fresh(channels: int) -> NDArray[np.void]:
    """Channels of which nothing is known yet."""
    return np.zeros(channels, dtype=STATE)
