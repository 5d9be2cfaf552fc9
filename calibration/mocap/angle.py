"""The angle of a joint from three markers, and markers over short gaps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: Markers that are away for no longer than this, s, are put in between; a finger's fastest cycle takes a second.
MAX_GAP_S = 0.1


def joint_angle(mcp: FloatArray, pip: FloatArray, dip: FloatArray) -> FloatArray:
    """Angle (deg) between the bones MCP->PIP and PIP->DIP: 0 straight, 90 bent at a right angle, up to 180.

    The paper's eq. 2 takes the arcsine of |V1 x V2| / (|V1| |V2|), which cannot tell 95 from 85 degrees; this is
    ``atan2(|V1 x V2|, V1 . V2)``, exact everywhere, and not sensitive near 0 and 90 as arcsine and arccosine are.

    Parameters
    ----------
    mcp, pip, dip : (n, 3) float, mm
        The markers; NaN where one is missing.

    Returns
    -------
    (n,) float, deg
        NaN where a marker is missing, or two lie in one place.

    Examples
    --------
    >>> a = np.radians(95.0)
    >>> mcp, pip, dip = np.array([[-40.0, 0, 0]]), np.zeros((1, 3)), 25 * np.array([[np.cos(a), np.sin(a), 0]])
    >>> float(joint_angle(mcp, pip, dip)[0].round(9))
    95.0
    """
    first, second = pip - mcp, dip - pip
    across = np.linalg.norm(np.cross(first, second), axis=1)
    along = np.einsum("ij,ij->i", first, second)
    out = np.degrees(np.arctan2(across, along))
    out[(across == 0) & (along == 0)] = np.nan
    return out


def bridge_gaps(time: FloatArray, positions: FloatArray, *, max_gap_s: float = MAX_GAP_S) -> tuple[FloatArray, BoolArray]:
    """A marker with its short gaps put in by straight lines.

    Parameters
    ----------
    time : (n,) float, s
    positions : (n, 3) float
        NaN where it is missing.
    max_gap_s : float, s
        From the last frame that shows it to the next one. 0: nothing is put in.

    Returns
    -------
    positions : (n, 3) float
        Longer gaps, and those at either end, stay NaN.
    bridged : (n,) bool
        Which ones were put in.

    Raises
    ------
    InputError
        The time is no time.

    Examples
    --------
    >>> time, gaps = np.arange(6) / 100, np.array([0, np.nan, 2, np.nan, np.nan, 5])[:, None] * np.ones(3)
    >>> filled, bridged = bridge_gaps(time, gaps, max_gap_s=0.02)
    >>> filled[:, 0].tolist(), bridged.tolist()
    ([0.0, 1.0, 2.0, nan, nan, 5.0], [False, True, False, False, False, False])
    """
    if not max_gap_s >= 0:
        raise InputError(f"a gap of {max_gap_s:g} s is none; give 0 to put nothing in, or a time")
    seen: BoolArray = np.asarray(np.isfinite(positions).all(axis=1), dtype=bool)
    out = np.where(seen[:, None], positions, np.nan)
    at = np.flatnonzero(seen)
    if len(at) < 2:
        return out, np.zeros(len(time), dtype=bool)
    after = np.clip(np.searchsorted(at, np.arange(len(time))), 1, len(at) - 1)
    gap = time[at[after]] - time[at[after - 1]]
    inside = (np.arange(len(time)) > at[0]) & (np.arange(len(time)) < at[-1])
    # Times are multiples of a frame: a gap of just the allowed length must not fall to rounding.
    bridged: BoolArray = np.asarray(~seen & inside & (gap <= max_gap_s * (1 + 1e-9)), dtype=bool)
    for k in range(positions.shape[1]):
        out[bridged, k] = np.interp(time[bridged], time[at], positions[at, k])
    return out, bridged
