"""The table of measured strips, as spreadsheets save it: commas, semicolons or tabs, decimal points or commas."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.spreadsheet import read_csv_lines

#: A table larger than this is none of ours.
TABLE_MAX_BYTES = 1_000_000

_COLUMNS = ("length_mm", "r_kohm")


@dataclass(frozen=True)
class Strips:
    """Measured strips.

    Parameters
    ----------
    length_mm, r_kohm : (n,) float
    unmeasured : tuple of str
        Lines of the table without a resistance: strips that broke or were not measured.
    names : tuple of str
        What a message calls each measured strip; "strip 1" and so on where there are none.
    """

    length_mm: NDArray[np.float64]
    r_kohm: NDArray[np.float64]
    unmeasured: tuple[str, ...] = ()
    names: tuple[str, ...] = ()

    def name(self, k: int) -> str:
        return self.names[k] if self.names else f"strip {k + 1}"


def read_strips(path: str | Path) -> Strips:
    """Read a CSV file with the columns length_mm and r_kohm; an empty r_kohm is a strip that was not measured.

    The headings tell whether commas, semicolons or tabs part the columns. A comma in a number is a decimal comma.

    Raises
    ------
    InputError
        The file cannot be read, a column is missing, a value is not a positive number, or nothing was measured yet.
    """
    path = Path(path)
    lines, delimiter = read_csv_lines(path, max_bytes=TABLE_MAX_BYTES, wanted="the strips.csv that skinfab strips made, filled in")
    try:
        reader = csv.reader(lines, delimiter=delimiter, strict=True)
        rows = [(reader.line_num, [cell.strip() for cell in row]) for row in reader]
    except csv.Error as fault:
        raise InputError(f"{path} is not a CSV file: {fault}; save the table as CSV, UTF-8") from fault
    rows = [(number, row) for number, row in rows if any(row)]
    head = [name.lower() for name in rows[0][1]] if rows else []
    for name in _COLUMNS:
        if head.count(name) != 1:
            has = "no column" if name not in head else "more than one column"
            raise InputError(f"{path}: there is {has} {name!r}; the first line names the columns, length_mm and r_kohm among them")
    _require_plain_thousands(rows[1:], head, delimiter, path)
    measured: list[tuple[float, float]] = []
    names, unmeasured = [], []
    for number, row in rows[1:]:
        cells = _cells(head, row, f"{path}, line {number}")
        if not cells["r_kohm"]:
            unmeasured.append(f"line {number}")
            continue
        measured.append((_positive(cells, "length_mm", f"{path}, line {number}"), _positive(cells, "r_kohm", f"{path}, line {number}")))
        names.append(f"{cells.get('sensor') or 'the strip'} (line {number})")
    if not measured:
        if not unmeasured:
            raise InputError(f"{path} has headings but no strips; give the strips.csv that skinfab strips made, filled in")
        raise InputError(
            f"{path} is not filled in: the column r_kohm is empty for all {len(unmeasured)} strips; measure each from pad to pad, "
            "write its kilo-ohm there and save the table"
        )
    length, r = np.array(measured, dtype=float).T
    return Strips(length, r, tuple(unmeasured), tuple(names))


def _require_plain_thousands(rows: Sequence[tuple[int, list[str]]], head: Sequence[str], delimiter: str, path: Path) -> None:
    """Where commas are decimal, 1.382 means 1382: refused, as one cannot know."""
    if delimiter == ",":
        return
    numbers = [(number, cell) for number, row in rows for name, cell in zip(head, row, strict=False) if name in _COLUMNS]
    pointed = [(number, cell) for number, cell in numbers if "." in cell]
    thousands = [(number, cell) for number, cell in pointed if re.fullmatch(r"[1-9]\d{0,2}\.\d{3}", cell)]
    if thousands and (len(thousands) == len(pointed) or any("," in cell for _, cell in numbers)):
        number, cell = thousands[0]
        whole = cell.split(".")[0]
        raise InputError(
            f"{path}, line {number}: is {cell!r} {cell.replace('.', '')} with a mark between thousands, or a little over {whole}? "
            "Write numbers without marks between thousands"
        )


def _cells(head: Sequence[str], row: Sequence[str], where: str) -> dict[str, str]:
    """The row by heading; cells that are left out at its end are empty."""
    if any(row[len(head) :]):
        raise InputError(
            f"{where}: {len(row)} values under {len(head)} headings; if that is a decimal comma, save the table with semicolons "
            "between the columns, or write a decimal point"
        )
    return dict.fromkeys(head, "") | dict(zip(head, row, strict=False))


def _positive(cells: dict[str, str], name: str, where: str) -> float:
    text = cells[name]
    try:
        # With both, or two of one, nobody knows which parts the thousands.
        value = float(text.replace(",", ".")) if "_" not in text else math.nan
    except ValueError:
        value = math.nan
    if not 0 < value < math.inf:
        raise InputError(
            f"{where}, column {name}: {name} is {text!r}; it must be a positive number without a unit and without marks between "
            "thousands, or an empty r_kohm where a strip is broken"
        )
    return value
