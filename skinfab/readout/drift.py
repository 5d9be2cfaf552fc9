"""A slow baseline under a fast signal: what drift moves goes with it, what a contact moves does not.

A plain high-pass forgets a contact that lasts; here whoever knows of one holds the baseline meanwhile. At rest a reading
far off counts as one just off, so that a spike does not drag the baseline along.
"""

from __future__ import annotations

import math

from numba import njit


@njit(cache=True)
def follow(baseline: float, reading: float, dt: float, time_constant: float, reach: float) -> float:
    """One step of a baseline towards a reading: a first-order lag of `time_constant`, which sees no farther than `reach`."""
    off = min(max(reading - baseline, -reach), reach)
    return float(baseline + off * (1.0 - math.exp(-dt / time_constant)))
