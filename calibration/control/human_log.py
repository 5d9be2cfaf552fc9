"""A log of a human's sensor, as a motion that a robot can follow."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from calibration.control.protocols import Motion
from calibration.finger.simulated import RATE_HZ
from calibration.strain.document import SensorCalibration
from calibration.strain.rows import in_order
from skinfab.errors import InputError
from skinfab.readout.frame import Frame
from skinfab.readout.table import Table

FloatArray = NDArray[np.float64]


def human_motion(table: Table, human: SensorCalibration) -> tuple[Motion, list[Frame], bool, list[str]]:
    """The motion that a log shows, at the controller's rate.

    Parameters
    ----------
    table : Table
        With a column of the calibration's signal, and perhaps one of its angle.
    human : SensorCalibration

    Returns
    -------
    motion : Motion
    readings : list of Frame
        Those that have come by each moment: a hole in the log gives the same frame again, which grows old.
    measured : bool
        Is the motion's angle the log's own? Else it is what the calibration makes of the readings.
    notes : list of str
        What was left out, a sentence each.

    Raises
    ------
    InputError
        There is no such column, too short a log, or its rows are not in the order of time.
    """
    volts = table.column(human.signal)
    clock, anew = in_order(table.time, table.file)
    notes = [*table.notes, *anew]
    # As `calibration.strain.prepare` does it: stamps in whole milliseconds are often doubled, and no fault of the readings.
    forward = np.concatenate([[True], clock[1:] > np.maximum.accumulate(clock)[:-1]])
    if count := int(np.count_nonzero(~forward)):
        first = int(np.argmin(forward)) + 1
        notes.append(f"{table.file}: {count} of {len(volts)} rows stand still or go back in time (row {first} first); they were left out")
    good = forward & np.isfinite(volts)
    since = clock[good]
    if len(since) < 2 or since[-1] - since[0] < 1.0:
        raise InputError(f"{table.file}: fewer than 1 s of readings of {human.signal!r}; there is nothing to follow")
    measured = human.angle in table.columns and bool(np.isfinite(table.columns[human.angle][good]).all())
    angle = table.columns[human.angle][good] if measured else human.angles(since, volts[good])[0]
    time = np.arange(int((since[-1] - since[0]) * RATE_HZ + 1e-6) + 1) / RATE_HZ
    since = since - since[0]
    last = np.searchsorted(since, time + 1e-9, side="right") - 1
    seen = [
        Frame(t, t, k, np.array([u]), np.array([True]), np.array([False]))
        for k, (t, u) in enumerate(zip(since.tolist(), volts[good].tolist(), strict=True))
    ]
    return Motion(table.file, time, np.interp(time, since, angle)), [seen[k] for k in last.tolist()], measured, notes
