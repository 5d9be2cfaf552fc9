"""Does a log's reading come with its angle? Where a camera and a board each have a clock of their own, often it does not."""

from __future__ import annotations

from typing import Any

import numpy as np

from calibration.strain.correlation import STEP_S, Pair
from calibration.strain.lag import Lag, find_lag
from calibration.strain.prepare import Prepared
from skinfab.errors import InputError

#: Lags are searched up to this, s, to either side, or up to this part of the longest stretch without a gap.
SEARCH_S, SEARCH_PART = 2.5, 0.25
#: What is normal, s: a real soft sensor over four real knees came 0.06 to 0.01 s before the markers, which lie on moving skin,
#: and the material of a sensor is late by up to 0.1 s.
NORMAL_S = (-0.1, 0.1)


def log_lag(log: Prepared) -> Lag:
    """By how much the readings of a log come after its angles, slack apart.

    Raises
    ------
    InputError
        As `find_lag`; or no stretch of the log is long enough.

    Examples
    --------
    >>> from calibration.strain.prepare import prepare
    >>> from skinfab.readout.table import Table
    >>> time = np.arange(4000) / 100
    >>> angle = 45 - 40 * np.cos(time + 0.3 * np.sin(time / 3))
    >>> late = np.interp(time - 0.3, time, angle)
    >>> table = Table("finger.csv", "", time, {"U": 1 + 2e-3 * late, "PIP": angle}, {})
    >>> round(log_lag(prepare(table, signal="U", angle="PIP", limits=(10, 80))).lag_s, 1)
    0.3
    """
    longest = max(float(run.time[-1] - run.time[0]) for run in log.runs)
    reach = min(SEARCH_S, SEARCH_PART * longest)
    pairs = []
    for run in log.runs:
        t = np.arange(run.time[0], run.time[-1], STEP_S)
        angle = np.interp(t, run.time, run.angle)
        # All lags are judged by the same readings: those that have an angle at each of them.
        counts = (t >= t[0] + reach) & (t <= t[-1] - reach)
        if counts.any():
            inside = (angle >= log.low) & (angle <= log.high)
            pairs.append(Pair(t[0], angle, inside, t[0], np.interp(t, run.time, run.signal), counts))
    return find_lag(pairs, (-reach, reach), near_zero=True)


def clock_facts(log: Prepared) -> tuple[dict[str, Any] | None, list[str]]:
    """The lag, ready for JSON, and what is to be said of it; None where it cannot be told."""
    try:
        lag = log_lag(log)
    except InputError as fault:
        return None, [f"whether readings and angles were taken at the same time could not be judged: {fault}"]
    facts = {
        "lag_s": lag.lag_s,
        "interval_s": [lag.low_s, lag.high_s],
        "slack_deg": lag.slack_deg,
        "r2": lag.explained,
        "others_s": list(lag.others_s),
    }
    notes = []
    if lag.low_s > NORMAL_S[1] or lag.high_s < NORMAL_S[0]:
        way = "after" if lag.lag_s > 0 else "before"
        notes.append(
            f"the readings come {abs(lag.lag_s):.2f} s {way} the angles ({lag.low_s:.2f} to {lag.high_s:.2f} s), slack apart; a sensor's "
            f"own lag is within {NORMAL_S[1]:g} s, so the clocks of camera and board do not agree, and the errors are those of this log "
            f"alone: add {lag.lag_s:.2f} s to --shift of skinfab angle, or let it find the shift with --shift auto"
        )
    if lag.others_s:
        others = " or ".join(f"{each:.2f}" for each in lag.others_s[:3])
        notes.append(
            f"the movement repeats: readings that come {others} s after the angles fit as well as {lag.lag_s:.2f} s, so that a shift "
            "of the clocks by that much would not be seen; bend the joint irregularly at the start of a recording"
        )
    return facts, notes


def clock_line(facts: dict[str, Any]) -> str:
    """The lag in a line.

    Examples
    --------
    >>> clock_line({"lag_s": -0.03, "interval_s": [-0.04, -0.02], "slack_deg": 1.5})
    'readings come -0.03 s after the angles (-0.04 to -0.02 s), with 1.5 degrees of slack'
    """
    low, high = facts["interval_s"]
    lag, slack = round(facts["lag_s"], 2) + 0.0, facts["slack_deg"]
    return f"readings come {lag:.2f} s after the angles ({low:.2f} to {high:.2f} s), with {slack:.1f} degrees of slack"
