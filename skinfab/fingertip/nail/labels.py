"""Logs with labels: a table that says from when to when, in which log, what was touched.

A row a trial; the columns ``log``, ``start_s``, ``end_s`` and ``label`` must be there (without an end a trial lasts as long as its log),
the others may be: ``participant``, ``trial``,
``part`` (``train`` or ``test``), ``x_mm``, ``y_mm``, ``angle_deg``, ``force_n`` and, of a simulator, which knows it, where the pattern
really lay: ``true_x_mm``, ``true_y_mm``, ``true_angle_deg``. Times count from the log's first frame. The label of no
contact is ``none``. Lines that begin with ``#`` are remarks; a simulator says ``# simulated: true``.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.files import atomic_write
from skinfab.fingertip.nail.doubles import without_copies, without_doubles
from skinfab.fingertip.nail.pace import Pace, pace_of_log
from skinfab.fingertip.nail.places import places_of, times_of
from skinfab.fingertip.nail.units import channel_columns, units_said
from skinfab.readout.frame import Recording
from skinfab.readout.logs.log import read_log
from skinfab.spreadsheet import read_csv_lines

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: The label of a finger that touches nothing.
NOTHING = "none"
#: A larger table is none of trials.
MAX_BYTES = 50_000_000
#: A log of which so many times more is lost than there is has no use for rows in between.
_MOST_PLACES = 20

_NEEDED = ("log", "start_s", "end_s", "label")
_FILLED = ("log", "start_s", "label")
_PARTS = ("", "train", "test")
_WORDS = ("log", "label", "participant", "trial", "part")
_TRUE = ("true_x_mm", "true_y_mm", "true_angle_deg")
_COLUMNS = ("log", "start_s", "end_s", "label", "participant", "trial", "part", "x_mm", "y_mm", "angle_deg", "force_n", *_TRUE)


@dataclass(frozen=True)
class Label:
    """What was touched in one trial.

    Parameters
    ----------
    log : str
        Name of the log's file, beside the table.
    start_s, end_s : float
        From the log's first frame on; the end is infinite where the table leaves it to the log.
    label : str
        The class; `NOTHING` for no contact.
    participant, trial, part : str
        Empty where nobody said.
    x_mm, y_mm : float
        The middle of what was aimed at, on the pad; NaN where there is none.
    angle_deg : float
        Direction of an edge; NaN where there is none.
    force_n : float
        NaN where nobody measured it.
    true_x_mm, true_y_mm, true_angle_deg : float
        Where the pattern really lay; NaN where nobody knows.
    """

    log: str
    start_s: float
    end_s: float
    label: str
    participant: str = ""
    trial: str = ""
    part: str = ""
    x_mm: float = math.nan
    y_mm: float = math.nan
    angle_deg: float = math.nan
    force_n: float = math.nan
    true_x_mm: float = math.nan
    true_y_mm: float = math.nan
    true_angle_deg: float = math.nan


@dataclass(frozen=True, eq=False)
class Trial:
    """A label and its readings.

    Parameters
    ----------
    label : Label
    values : (n, 6) float
        In the order of `CHANNELS`; NaN where a reading is missing or not valid.
    saturated : (n, 6) bool
        At the end of the channel's range: the value is no measurement.
    rate_hz : float
    sha256 : str
        Of the log; empty where there is no file.
    units_said : bool
        Does the log declare the units? They are G and deg/s then; else nobody knows.
    """

    label: Label
    values: FloatArray
    saturated: NDArray[np.bool_]
    rate_hz: float
    sha256: str = ""
    units_said: bool = False


def write_labels(path: str | Path, labels: Sequence[Label], *, simulated: bool) -> None:
    """Write the table."""
    text = io.StringIO()
    text.write("# simulated: true\n" if simulated else "")
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(_COLUMNS)
    for each in labels:
        cells = (getattr(each, name) for name in _COLUMNS)
        rows.writerow([cell if isinstance(cell, str) else f"{cell:.9g}" if math.isfinite(cell) else "" for cell in cells])
    atomic_write(path, text.getvalue())


def read_labels(path: str | Path) -> tuple[list[Label], bool]:
    """The rows of a table, and whether it says that a simulator made it.

    Raises
    ------
    InputError
        It cannot be read, a column is missing, or a cell is no number; which one is said.
    """
    path = Path(path)
    lines, delimiter = read_csv_lines(path, max_bytes=MAX_BYTES, wanted="a table of labels as a CSV file")
    simulated = any(line.lower().replace(" ", "") == "#simulated:true" for line in lines)
    body = [(k, line) for k, line in enumerate(lines, start=1) if line.strip() and not line.startswith("#")]
    try:
        rows = list(csv.reader([line for _, line in body], delimiter=delimiter, strict=True))
    except csv.Error as fault:
        raise InputError(f"{path} is not a CSV file: {fault}; give a table of labels") from fault
    head = [name.strip() for name in rows[0]] if rows else []
    if missing := [name for name in _NEEDED if name not in head]:
        raise InputError(f"{path} has no column {missing[0]!r}; a table of labels needs {', '.join(_NEEDED)}")
    if delimiter != ",":  # as spreadsheets write it that have a decimal comma
        rows[1:] = [
            [cell.replace(",", ".") if name not in _WORDS else cell for name, cell in zip(head, row, strict=False)] for row in rows[1:]
        ]
    labels = [_label(dict(zip(head, row, strict=False)), f"{path}, line {k}") for (k, _), row in zip(body[1:], rows[1:], strict=False)]
    if not labels:
        raise InputError(f"{path} has headings and no rows; a row says which log holds what, from when to when")
    return labels, simulated


def _label(cells: dict[str, str], where: str) -> Label:
    if any(not cells.get(name, "").strip() for name in _FILLED):
        raise InputError(f"{where}: {', '.join(_FILLED)} must all be there")
    words = {name: cells.get(name, "").strip() for name in _WORDS}
    # Spreadsheets make capitals of their own: "Test" taken for training would flatter the model.
    words["part"] = words["part"].lower()
    words["label"] = NOTHING if words["label"].lower() == NOTHING else words["label"]
    if words["part"] not in _PARTS:
        raise InputError(f"{where}: part {words['part']!r} is neither train nor test; write one of them, or leave it empty")
    numbers = {name: _number(cells.get(name, ""), f"{where}, {name}") for name in _COLUMNS if name not in _WORDS}
    if math.isnan(numbers["end_s"]):
        numbers["end_s"] = math.inf
    if not 0 <= numbers["start_s"] < numbers["end_s"]:
        raise InputError(f"{where}: {numbers['start_s']:g} to {numbers['end_s']:g} s is no time of a log; the start must be before the end")
    return Label(**words, **numbers)  # type: ignore[arg-type]  # words and numbers have their fields' types


def _number(cell: str, where: str) -> float:
    text = cell.strip()
    if not text or text.lower() == "nan":
        return math.nan
    try:
        value = float(text)
    except ValueError:
        value = math.inf
    if not math.isfinite(value):
        raise InputError(f"{where}: {cell!r} is no number; mend it or leave it empty")
    return value


def read_trials(path: str | Path, *, rate_hz: float | None = None) -> tuple[list[Trial], bool, list[str]]:
    """The trials of a table, whether they are simulated, and what is to be said of them.

    A frame that was lost is a row of NaN in its place: closing up would make the motor's phase jump.

    Parameters
    ----------
    path : path
    rate_hz : float, optional
        Readings a second, where the logs do not say.

    Raises
    ------
    InputError
        As `read_labels`, `pace_of_log`, `without_doubles` and `without_copies`; a log cannot be read, has none of the channels, ends before
        a trial does, or lacks most of one.
    """
    path = Path(path)
    labels, simulated = read_labels(path)
    logs: dict[str, tuple[FloatArray, FloatArray, NDArray[np.bool_], Pace, str, bool]] = {}
    trials, notes = [], []
    for each in labels:
        if each.log not in logs:
            log = read_log(path.parent / each.log)
            notes += [f"{log.file}: {note}" if log.file not in note else note for note in log.notes]
            simulated |= log.recording.stream.simulated
            pace = pace_of_log(log, rate_hz=rate_hz)
            logs[each.log] = (*evenly(log.recording, pace), pace, log.sha256, units_said(log.recording.stream))
            notes += [f"{log.file}: {wrong}" for wrong in pace.notes]
        time, values, bad, pace, sha256, said = logs[each.log]
        whole = to_the_end(each, time, pace.rate_hz)
        rows = rows_of(whole, time, pace)
        if rows is None:
            raise InputError(
                f"{path}: {each.log} ends at {time[-1]:.3f} s and a trial of it lasts from {whole.start_s:g} to {whole.end_s:g} s; "
                "give the whole log, or mend the table"
            )
        there: NDArray[np.bool_] = np.asarray(np.isfinite(values[rows]).any(axis=1))
        if there.mean() < 0.5:
            raise InputError(
                f"{path}: {each.log} has {there.sum()} of the {len(there)} readings of its trial from {whole.start_s:g} to "
                f"{whole.end_s:g} s; leave that row out, or record the trial again"
            )
        trials.append(Trial(whole, values[rows], bad[rows], pace.rate_hz, sha256, said))
    kept, doubled = without_doubles([each.label for each in trials], [each.sha256 for each in trials], path)
    trials = [trials[k] for k in kept]
    kept, copied = without_copies([each.label for each in trials], [each.values for each in trials], path)
    return [trials[k] for k in kept], simulated, notes + doubled + copied


def to_the_end(label: Label, time: FloatArray, rate_hz: float) -> Label:
    """The label with the end of its log, where the table leaves it to that; of readings at these times."""
    return label if math.isfinite(label.end_s) else replace(label, end_s=float(time[-1]) + 1 / rate_hz)


def rows_of(label: Label, time: FloatArray, pace: Pace) -> slice | None:
    """Which of the readings at these times are the trial's; None where it begins or ends after the log's end, as far as its times tell."""
    first, last = np.searchsorted(time, [label.start_s - 0.5 / pace.rate_hz, label.end_s - 0.5 / pace.rate_hz])
    ends = label.end_s - 1.5 / pace.rate_hz - pace.loose_s
    return None if last - first < 2 or time[-1] < ends else slice(int(first), int(last))


def six_channels(recording: Recording) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Readings in the order of `CHANNELS`, (n, 6), NaN where there is none, and which of them are saturated.

    Raises
    ------
    InputError
        As `channel_columns`.
    """
    values = np.full((len(recording), 6), np.nan)
    saturated = np.zeros((len(recording), 6), dtype=bool)
    for k, (column, scale) in enumerate(channel_columns(recording.stream)):
        if column >= 0:
            values[:, k] = scale * recording.column(recording.stream.names[column])
            saturated[:, k] = recording.saturated[:, column]
    return values, saturated


def evenly(recording: Recording, pace: Pace) -> tuple[FloatArray, FloatArray, NDArray[np.bool_]]:
    """Times from the first frame on, readings and which are saturated, with a row for each frame that was lost."""
    values, bad = six_channels(recording)
    timed = np.isfinite(recording.device_time)
    every = places_of(recording, pace)
    time, values, bad, places = times_of(recording, every, pace)[timed], values[timed], bad[timed], every[timed]
    if (np.diff(places) < 1).any() or places[-1] - places[0] > _MOST_PLACES * len(places):
        return time, values, bad
    at = places - places[0]
    rows = np.full((int(at[-1]) + 1, 6), np.nan)
    rows[at] = values
    saturated = np.zeros(rows.shape, dtype=bool)
    saturated[at] = bad
    return np.interp(np.arange(len(rows)), at, time), rows, saturated
