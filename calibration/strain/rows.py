"""Which rows of a log can be used: in the order of time, whole, and of sizes that a sensor and a joint can have."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: Where times go back in more than this part of the steps, the rows are not in order; a board restarts a few times at most.
SHUFFLED = 0.02
#: Times that have not come up to where they were after so many rows began anew.
_ANEW = 10
#: What lies between the last row before a restart and the first one after it is not known; this, s, is more than is ever bridged.
RESTART_S = 1.0
#: A wire that opens for a moment reads something absurd for up to this, s; what lasts longer is not passed over in silence.
BURST_S = 0.5
#: It comes and goes at once: its first and last rows are this far, as a part, towards its farthest, which no joint is.
_AT_ONCE = 0.25
#: A spike is out of what is usual around it by more than that moves in the whole log. What is usual is a median over this, s, so
#: that spikes of up to half of it are seen; and over so many rows at least.
_AROUND_S, _NEIGHBOURS = 0.1, 9


def in_order(time: FloatArray, file: str) -> tuple[FloatArray, list[str]]:
    """Times that go on after a restart of the device, and what is to be said of it.

    Single rows that go back or stand still stay as they are: `prepare` leaves them out.

    Raises
    ------
    InputError
        The rows are not in the order of time.

    Examples
    --------
    >>> anew, said = in_order(np.concatenate([np.arange(50) / 10, np.arange(50) / 10]), "log.csv")
    >>> float(anew[50].round(1)), said
    (5.9, ['log.csv, row 51: times begin anew (4.9 to 0 s), as when the device restarts; what follows is taken as after a hole'])
    """
    back = np.flatnonzero(np.diff(time) < 0)
    if len(back) > max(SHUFFLED * len(time), 3):
        k = int(back[0])
        raise InputError(
            f"{file}: rows are not in the order of time: row {k + 2} is of {time[k + 1]:g} s and comes after {time[k]:g} s, and times "
            f"go back at {len(back)} of {len(time)} rows; sort the rows by time, or export the log again"
        )
    said, time, notes = time, time.copy(), []
    for k in back.tolist():
        after = time[k + 1 : k + 1 + _ANEW]
        if len(after) == _ANEW and after.max() < time[k]:
            # In the log's own words: what was added for a restart before this one is not in it.
            notes.append(
                f"{file}, row {k + 2}: times begin anew ({said[k]:g} to {said[k + 1]:g} s), as when the device restarts; "
                "what follows is taken as after a hole"
            )
            time[k + 1 :] += time[k] + RESTART_S - time[k + 1]
    return time, notes


def spikes(time: FloatArray, values: FloatArray) -> BoolArray:
    """Which ones of a column no sensor and no joint went to: bursts beyond all others, and what is out of its neighbours.

    Parameters
    ----------
    time : (n,) float, s
    values : (n,) float
        NaN where there is none.

    Examples
    --------
    >>> ramp = np.arange(20.0)
    >>> np.flatnonzero(spikes(np.arange(46) / 100, np.concatenate([ramp, [4e30] * 6, ramp[::-1]]))).tolist()
    [20, 21, 22, 23, 24, 25]
    """
    from scipy.ndimage import median_filter

    found = np.zeros(len(values), dtype=bool)
    there = np.flatnonzero(np.isfinite(values) & np.isfinite(time))
    if len(there) <= _NEIGHBOURS:
        return found
    burst = _bursts(time[there], values[there])
    found[there[burst]] = True
    there = there[~burst]
    step = float(np.median(np.diff(time[there])))
    size = max(_NEIGHBOURS, 2 * round(_AROUND_S / step / 2) + 1) if step > 0 else _NEIGHBOURS
    usual = median_filter(values[there], size=size, mode="nearest")
    with np.errstate(over="ignore"):
        found[there] = (np.abs(values[there] - usual) > np.ptp(usual)) & (np.ptp(usual) > 0)
    return found


def _bursts(time: FloatArray, values: FloatArray) -> BoolArray:
    """Stretches beyond all other values by more than those move, that come and go at once and are soon over."""
    ordered = np.sort(values)
    low, high = float(ordered[len(ordered) // 4]), float(ordered[(3 * len(ordered)) // 4])
    out = np.zeros(len(values), dtype=bool)
    while low < high:
        low, high = _grown(ordered, low, high)
        out = (values < low) | (values > high)
        edges = np.flatnonzero(np.diff(np.concatenate([[False], out, [False]]).astype(int)))
        moved = [slice(a, b) for a, b in edges.reshape(-1, 2).tolist() if not _is_burst(time[a:b], values[a:b], low, high)]
        if not moved:
            return out
        # The joint went there: what it did counts as usual, and the rest is judged anew.
        low = min(low, *(float(values[each].min()) for each in moved))
        high = max(high, *(float(values[each].max()) for each in moved))
    return out


def _grown(ordered: FloatArray, low: float, high: float) -> tuple[float, float]:
    """The values around `low` to `high` up to where, on either side, there are none for more than these span."""
    with np.errstate(over="ignore"):
        gaps = np.diff(ordered)
        while True:
            above = int(np.searchsorted(ordered, high, "right")) - 1
            below = int(np.searchsorted(ordered, low, "left"))
            up, down = np.flatnonzero(gaps[above:] > high - low), np.flatnonzero(gaps[:below][::-1] > high - low)
            wider = (
                float(ordered[below - int(down[0])] if len(down) else ordered[0]),
                float(ordered[above + int(up[0])] if len(up) else ordered[-1]),
            )
            if wider == (low, high):
                return wider
            low, high = wider


def _is_burst(time: FloatArray, values: FloatArray, low: float, high: float) -> bool:
    with np.errstate(over="ignore"):
        beyond = np.maximum(low - values, values - high)
        return bool(time[-1] - time[0] <= BURST_S and min(beyond[0], beyond[-1]) >= _AT_ONCE * beyond.max())
