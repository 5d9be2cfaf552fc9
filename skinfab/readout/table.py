"""Logs as tables: a CSV file with a line of headings, a column of times, and columns of numbers.

Any spreadsheet's or logger's file of that shape is read, not the project's own alone. Lines that begin with ``#`` before
the headings are remarks of the form ``# name: value``; a log made by a simulator says ``# simulated: true`` there.
"""

from __future__ import annotations

import csv
import hashlib
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.spreadsheet import read_csv_lines

FloatArray = NDArray[np.float64]

#: A larger file is read as a recording, piece by piece, not as one table.
TABLE_MAX_BYTES = 1_000_000_000

#: What a column of times is called, and how long its unit is in s; a unit may follow in brackets or after an underscore.
_TIME_NAMES = ("time", "t", "timestamp", "device_time", "host_time", "seconds", "zeit")
_TIME_UNITS = {"": 1.0, "s": 1.0, "sec": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}

#: 1,5 for 1.5; but 1,234 may be one thousand and more.
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")
#: What stands for nothing in a cell.
_EMPTY = {"", "nan", "na", "n/a", "null", "none", "-"}


@dataclass(frozen=True, eq=False)
class Table:
    """The columns of a log.

    Parameters
    ----------
    file : str
        Its name.
    sha256 : str
        Of its bytes.
    time : (n,) float, s
        From the first row on.
    columns : dict of (n,) float
        By heading, NaN where a cell is empty; the column of times is not among them.
    remarks : dict of str
        From the lines before the headings.
    notes : tuple of str
        What was left out, a sentence each.
    units : dict of str
        Of the columns that say theirs, as `skinfab.readout.logs.log.read_log_table` fills it.
    """

    file: str
    sha256: str
    time: FloatArray
    columns: dict[str, FloatArray]
    remarks: dict[str, str]
    notes: tuple[str, ...] = ()
    units: Mapping[str, str] = field(default_factory=dict)

    @property
    def simulated(self) -> bool:
        """Does the file say that a simulator made it?"""
        return self.remarks.get("simulated", "").lower() in ("true", "yes", "1")

    def column(self, name: str) -> FloatArray:
        """One of the columns.

        Raises
        ------
        InputError
            There is none of that name, or it holds no number.
        """
        if name not in self.columns:
            raise InputError(f"{self.file} has no column {name!r}; it has {', '.join(repr(each) for each in self.columns) or 'none'}")
        found = self.columns[name]
        if not np.isfinite(found).any():
            raise InputError(f"{self.file}: column {name!r} holds no number at all; choose another one")
        return found


def read_table(path: str | Path) -> Table:
    """Read a log.

    Cells are parted by commas, or by semicolons or tabs (then a decimal comma is understood). Times are numbers in the unit
    that the heading names (``time_ms``, ``Time (s)``; seconds where it names none) or dates in ISO 8601.

    Raises
    ------
    InputError
        The file cannot be read, has no headings, no column of times, or a cell that is no number; which one is said.
    """
    path = Path(path)
    lines, delimiter = read_csv_lines(path, max_bytes=TABLE_MAX_BYTES, wanted="a log as a CSV file")
    remarks, head, rows, first, notes = _parts(lines, delimiter, path)
    at = _time_column(head, path)
    comma = delimiter != ","
    columns = {
        name: _numbers(rows, k, comma=comma, where=f"{path}, column {name!r}", first=first) for k, name in enumerate(head) if k != at
    }
    time = _times(rows, at, head[at], comma=comma, where=f"{path}, column {head[at]!r}", first=first)
    return Table(path.name, hashlib.sha256(path.read_bytes()).hexdigest(), time, columns, remarks, notes)


def _parts(lines: Sequence[str], delimiter: str, path: Path) -> tuple[dict[str, str], list[str], list[list[str]], int, tuple[str, ...]]:
    """Remarks, headings, rows, the number of the first row's line, and what was left out."""
    remarks: dict[str, str] = {}
    start = 0
    while start < len(lines) and (lines[start].startswith("#") or not lines[start].strip()):
        name, colon, value = lines[start].lstrip("# ").partition(":")
        if colon:
            remarks[name.strip().lower()] = value.strip()
        start += 1
    try:
        rows = list(csv.reader(lines[start:], delimiter=delimiter, strict=True))
    except csv.Error as fault:
        raise InputError(f"{path} is not a CSV file: {fault}; give a log with a line of headings and rows of numbers") from fault
    head = [name.strip() for name in rows[0]] if rows else []
    if len(head) < 2 or all(_is_number(name) for name in head):
        raise InputError(f"{path} does not begin with a line of headings; put one there: a time and the names of the signals")
    if twice := next((name for name in head if head.count(name) > 1), None):
        raise InputError(f"{path}: two columns are called {twice!r}; give each one a name of its own")
    body = [row for row in rows[1:] if any(cell.strip() for cell in row)]
    notes: tuple[str, ...] = ()
    for k, row in enumerate(rows[1:]):
        if any(cell.strip() for cell in row) and len(row) != len(head):
            number = start + 2 + k
            if k == len(rows) - 2:  # cut off while it was written: what is whole counts
                body.pop()
                notes = (f"{path.name}: the last line is cut off and was left out",)
                break
            what = "mend the line"
            if delimiter == "," and len(row) > len(head) and all(cell.strip().lstrip("+-").isdigit() for cell in row):
                what = "if these are decimal commas, save the log with points, or with semicolons between its columns"
            raise InputError(f"{path}, line {number}: {len(row)} cells under {len(head)} headings; {what}")
    if not body:
        raise InputError(f"{path} has headings and no rows; record something first")
    return remarks, head, body, start + 2, notes


def _time_column(head: Sequence[str], path: Path) -> int:
    for k, name in enumerate(head):
        base, unit = _named(name)
        if base in _TIME_NAMES and unit in _TIME_UNITS:
            return k
    raise InputError(f"{path} has no column of times among {', '.join(repr(name) for name in head)}; call it time or time_ms")


def _named(heading: str) -> tuple[str, str]:
    """A heading's name and unit.

    Examples
    --------
    >>> _named("Time (ms)"), _named("device_time_s"), _named("timestamp")
    (('time', 'ms'), ('device_time', 's'), ('timestamp', ''))
    """
    text = heading.strip().lower()
    if match := re.fullmatch(r"(.+?)\s*[\[(]([a-z]+)[\])]", text):
        return match[1].strip(), match[2]
    if (match := re.fullmatch(r"(.+)_([a-z]+)", text)) and match[1] in _TIME_NAMES:
        return match[1], match[2]
    return text, ""


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _numbers(rows: Sequence[Sequence[str]], k: int, *, comma: bool, where: str, first: int) -> FloatArray:
    cells = [row[k] for row in rows]
    try:
        return np.array(cells, dtype=float)  # at once where nothing is missing
    except ValueError:
        pass
    out = np.empty(len(cells))
    for i, cell in enumerate(cells):
        text = cell.strip()
        if text.lower() in _EMPTY:
            out[i] = math.nan
            continue
        try:
            out[i] = float(text.replace(",", ".") if comma else text)
        except ValueError:
            if not comma and _DECIMAL_COMMA.fullmatch(text):
                raise InputError(
                    f"{where}, row {i + 1} (line {first + i} or so): {text!r} has a decimal comma, and commas part the columns; "
                    "save the log with points in its numbers, or with semicolons between its columns"
                ) from None
            if i < 1 or not np.isfinite(out[:i]).any():
                return np.full(len(cells), np.nan)  # a column of words: nothing to reckon with
            raise InputError(f"{where}, row {i + 1} (line {first + i} or so): {cell!r} is no number; mend it or leave it empty") from None
    return out


def _times(rows: Sequence[Sequence[str]], k: int, name: str, *, comma: bool, where: str, first: int) -> FloatArray:
    if _is_number(rows[0][k].replace(",", ".")):
        time = _numbers(rows, k, comma=comma, where=where, first=first) * _TIME_UNITS[_named(name)[1]]
    else:
        moments = []
        for i, row in enumerate(rows):
            try:
                moments.append(datetime.fromisoformat(row[k].strip()))
            except ValueError:
                raise InputError(f"{where}, row {i + 1}: {row[k]!r} is no time; give seconds or 2026-01-31 12:00:00.000") from None
        try:
            time = np.array([(moment - moments[0]).total_seconds() for moment in moments])
        except TypeError as fault:
            raise InputError(f"{where}: some times name their time zone and some do not; let all or none do so") from fault
    if not np.isfinite(time).all():
        row_number = int(np.argmax(~np.isfinite(time))) + 1
        raise InputError(f"{where}, row {row_number}: the time is missing; fill it in or take the row out")
    return time - time[0]
