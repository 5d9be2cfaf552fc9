"""When a capture began by a log's time, found from the movement that both have recorded."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from calibration.mocap.angle import MAX_GAP_S
from calibration.strain.correlation import STEP_S, Pair
from calibration.strain.lag import Lag, find_lag
from calibration.strain.prepare import CUTOFF_HZ
from skinfab.errors import InputError
from skinfab.readout.filters import Lowpass

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: The two must have this part of the shorter one in common, or the shift is not judged.
OVERLAP = 0.5
#: A shift known no better than this, s, is refused: at 200 deg/s it is 20 degrees.
WIDEST_S = 0.1


def find_shift(time: FloatArray, reading: FloatArray, capture_time: FloatArray, angle: FloatArray) -> Lag:
    """By how much a capture began after a log: the shift at which a curve of the angle, behind slack, explains the reading best.

    A lag of the sensor's own, beyond slack, counts as one of the clock; a soft sensor's is within 0.1 s.

    Parameters
    ----------
    time : (n,) float, s
        Of the readings, rising.
    reading : (n,) float
        NaN where there is none.
    capture_time : (m,) float, s
        Of the angles, by the camera's clock.
    angle : (m,) float, deg
        NaN where there is none.

    Raises
    ------
    InputError
        There is too little movement to tell, several shifts fit alike, or none does.

    Examples
    --------
    >>> seconds = np.arange(3000) / 100
    >>> bent = lambda t: 45 + 25 * np.cos(1.3 * t + np.sin(t / 4)) + 15 * np.cos(0.7 * t)
    >>> round(find_shift(seconds, 2 + 0.01 * bent(seconds - 1.5), seconds, bent(seconds)).lag_s, 2)
    1.5
    """
    when, bent, known = _even(capture_time, angle, "angle")
    since, read, counts = _even(time, reading, "reading")
    length = OVERLAP * min(bent.size, read.size) * STEP_S
    lags = (since + length - when - bent.size * STEP_S, since + read.size * STEP_S - length - when)
    found = find_lag([Pair(when, bent, known, since, read, counts)], lags, least_overlap_s=length)
    if found.others_s:
        # Those nearest to 0 first: two recordings are mostly begun within a few seconds.
        *some, last = (f"{each:.2f}" for each in sorted((found.lag_s, *found.others_s), key=abs)[:5])
        raise InputError(
            f"the movement repeats, so that shifts of {', '.join(some)} and {last} s fit alike; give --shift with the one you know to be "
            "near, or record again and bend the joint a few times quickly and irregularly at the start"
        )
    if found.high_s - found.low_s > 2 * WIDEST_S:
        raise InputError(
            f"the shift is known no better than {found.low_s:.2f} to {found.high_s:.2f} s; record more movement, some of it quick, "
            "or give --shift"
        )
    return found


def _even(time: FloatArray, values: FloatArray, what: str) -> tuple[float, FloatArray, BoolArray]:
    """When it begins; the values at even times, filtered; and which of these have a sample near."""
    there = np.isfinite(time) & np.isfinite(values)
    t, v = time[there], values[there]
    forward = np.concatenate([[True], t[1:] > np.maximum.accumulate(t)[:-1]]) if t.size else np.zeros(0, dtype=bool)
    t, v = t[forward], v[forward]
    low = Lowpass(CUTOFF_HZ, 1 / STEP_S)
    # Both on one grid: times that are whole numbers of steps.
    first = np.ceil(t[0] / STEP_S) if t.size else 0.0
    steps = np.arange(first, np.floor(t[-1] / STEP_S) + 1 if t.size else 0.0)
    even = steps * STEP_S
    if even.size < low.shortest:
        raise InputError(f"there are {t.size} times with {what}s, too few to find a shift from; give --shift")
    after = np.clip(np.searchsorted(t, even), 1, t.size - 1)
    near = t[after] - t[after - 1] <= max(MAX_GAP_S, 1.5 * float(np.median(np.diff(t))))
    return float(even[0]), low.zero_phase(np.interp(even, t, v)), np.asarray(near, dtype=bool)
