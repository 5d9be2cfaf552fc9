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
#: A spike is out of its neighbours by more than the whole log moves, and lasts for less than half of so many rows.
_NEIGHBOURS = 9


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
    time, notes = time.copy(), []
    for k in back.tolist():
        after = time[k + 1 : k + 1 + _ANEW]
        if len(after) == _ANEW and after.max() < time[k]:
            notes.append(
                f"{file}, row {k + 2}: times begin anew ({time[k]:g} to {time[k + 1]:g} s), as when the device restarts; "
                "what follows is taken as after a hole"
            )
            time[k + 1 :] += time[k] + RESTART_S - time[k + 1]
    return time, notes


def spikes(values: FloatArray) -> BoolArray:
    """Which ones of a column are out of their neighbours by more than all the others move.

    Examples
    --------
    >>> np.flatnonzero(spikes(np.concatenate([np.arange(20.0), [4e30], np.arange(20.0)]))).tolist()
    [20]
    """
    from scipy.ndimage import median_filter

    there = np.flatnonzero(np.isfinite(values))
    found = np.zeros(len(values), dtype=bool)
    if len(there) > _NEIGHBOURS:
        usual = median_filter(values[there], size=_NEIGHBOURS, mode="nearest")
        with np.errstate(over="ignore"):
            found[there] = (np.abs(values[there] - usual) > np.ptp(usual)) & (np.ptp(usual) > 0)
    return found
