"""Logs of a six-axis sensor: a column a component of force (N) and moment (N mm), a label where there is one, and what else there is.

Any log that `skinfab.readout.logs.log` reads; a CSV file may say of itself what it was taken of, in remarks before its headings:
``# label: towel``, ``# group: 3`` (what must not be parted between training and test: a trial, an object, a participant).
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.files import atomic_write
from skinfab.fingertip.force.wrench import WRENCH, wrench_columns
from skinfab.readout.logs.log import read_log_table

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class WrenchLog:
    """What a six-axis sensor read.

    Parameters
    ----------
    name : str
    time : (n,) float, s
    force : (n, 3) float, N
    moment : (n, 3) float, N mm
        About the sensor's origin.
    label, group : str
        What it was taken of, and what it must stay together with; empty where nobody said.
    others : dict of (n,) float
        Columns beside the six.
    simulated : bool
    sha256 : str
        Of the file; empty where there is none.
    notes : tuple of str
    units_said : bool
        Does the log name the units of its moments? Where it does not, they are taken for N mm.
    """

    name: str
    time: FloatArray
    force: FloatArray
    moment: FloatArray
    label: str = ""
    group: str = ""
    others: Mapping[str, FloatArray] = field(default_factory=dict)
    simulated: bool = False
    sha256: str = ""
    notes: tuple[str, ...] = ()
    units_said: bool = False

    def __len__(self) -> int:
        return len(self.time)

    @property
    def rate_hz(self) -> float:
        """Samples a second, by the median of their distances; NaN of fewer than two."""
        return 1 / float(np.median(np.diff(self.time))) if len(self) > 1 else math.nan


def read_wrench(path: str | Path) -> WrenchLog:
    """Read a log, in the units that it declares; rows in which a component is missing or saturated are left out, and counted in a note.

    Raises
    ------
    InputError
        As `skinfab.readout.logs.log.read_log` and `wrench_columns`; or no row has all of the components.
    """
    path = Path(path)
    table, said = read_log_table(path)
    used = wrench_columns(table.columns, table.units, where=str(path))
    wrench = np.column_stack([scale * table.columns[name] for name, scale in used])
    whole = np.asarray(np.isfinite(wrench).all(axis=1))
    if not whole.any():
        raise InputError(f"{path} has no row in which all of {', '.join(WRENCH)} are numbers; look at the sensor")
    notes = [*said, *table.notes]
    if left_out := int((~whole).sum()):
        notes.append(f"{path.name}: {left_out:,} of {len(whole):,} rows lack a component and were left out")
    names = [name for name, _ in used]
    others = {name: column[whole] for name, column in table.columns.items() if name not in names}
    return WrenchLog(
        path.name,
        table.time[whole],
        np.ascontiguousarray(wrench[whole, :3]),
        np.ascontiguousarray(wrench[whole, 3:]),
        table.remarks.get("label", ""),
        table.remarks.get("group", ""),
        others,
        table.simulated,
        table.sha256,
        tuple(notes),
        all(name in table.units for name in names[3:]),
    )


def once(logs: Sequence[WrenchLog]) -> tuple[list[WrenchLog], tuple[str, ...]]:
    """Each file once, and what to know: a copy is no second measurement, and would show no scatter.

    Examples
    --------
    >>> rest = np.arange(2.0), np.zeros((2, 3)), np.zeros((2, 3))
    >>> kept, notes = once([WrenchLog("a.csv", *rest, sha256="1"), WrenchLog("b.csv", *rest, sha256="1")])
    >>> [log.name for log in kept], notes
    (['a.csv'], ('b.csv is the same file as a.csv, and counts once',))
    """
    first: dict[str, WrenchLog] = {}
    notes = []
    for k, log in enumerate(logs):
        known = first.setdefault(log.sha256 or f"{k}", log)
        if known is not log:
            notes.append(f"{log.name} is the same file as {known.name}, and counts once")
    return list(first.values()), tuple(notes)


def write_wrench(log: WrenchLog, path: str | Path) -> None:
    """Write a log as CSV, whole or not at all; times to the microsecond, readings with seven digits.

    Raises
    ------
    InputError
        The file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "a.csv"
    >>> write_wrench(WrenchLog("a", np.arange(2) / 200, np.ones((2, 3)), np.zeros((2, 3)), "towel", "3", simulated=True), path)
    >>> read = read_wrench(path)
    >>> read.label, read.group, read.simulated, read.rate_hz
    ('towel', '3', True, 200.0)
    """
    text = io.StringIO()
    for name, value in (("simulated", "true" if log.simulated else ""), ("label", log.label), ("group", log.group)):
        if value:
            text.write(f"# {name}: {' '.join(value.split())}\n")
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["time", *WRENCH, *log.others])
    numbers = np.column_stack([log.force, log.moment, *log.others.values()])
    rows.writerows([f"{t:.6f}", *(f"{value:.7g}" for value in row)] for t, row in zip(log.time.tolist(), numbers.tolist(), strict=True))
    atomic_write(path, text.getvalue())
