"""Vicon's CSV export: sections with five lines of headings each, of which the one of the trajectories holds the markers.

::

    Trajectories                       what the section holds; Devices and Model Outputs are others
    100                                frames a second
    ,,Anna:MCP,,,Anna:PIP,,,           labels, each over its first column
    Frame,Sub Frame,X,Y,Z,X,Y,Z        columns; residuals and others are passed over
    ,,mm,mm,mm,mm,mm,mm                units
    1,0,-391.9,-6180.0,1734.4,...      a line a frame, empty where a marker was not seen
"""

from __future__ import annotations

import csv
import hashlib
import itertools
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calibration.mocap.markers import Markers, in_mm, masked
from skinfab.errors import InputError

FloatArray = NDArray[np.float64]

_AXES = ("X", "Y", "Z")


def read_vicon(path: Path) -> Markers:
    """Read the markers of an export; commas, semicolons (with decimal commas or points) or tabs part its cells.

    Raises
    ------
    InputError
        It is no such export, has no trajectories, or a part of it is damaged; which one is said.
    """
    data = path.read_bytes()
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")  # names with umlauts, as Windows writes them
    delimiter = max(",;\t", key=text[:20_000].count)
    try:
        rows = [[cell.strip() for cell in row] for row in csv.reader(text.replace("\0", "").splitlines(), delimiter=delimiter)]
    except csv.Error as fault:
        raise InputError(f"{path} is not a CSV file: {fault}; export it from Vicon again") from fault
    start = next((k for k, row in enumerate(rows) if row and row[0].lower() == "trajectories"), None)
    if start is None:
        raise InputError(f"{path} has no section 'Trajectories', so it is no export of Vicon's markers; give a C3D file or such an export")
    if len(rows) < start + 6:
        raise InputError(f"{path} ends within the headings of its trajectories; export it again")
    comma = delimiter == ";"
    rate = _rate(rows[start + 1], f"{path}, line {start + 2}", comma=comma)
    places = _places(rows[start + 2], rows[start + 3], path, start + 3)
    units = rows[start + 4]
    body = _body(rows, start + 5)
    if not body:
        raise InputError(f"{path} has no frame in its trajectories; export it again")
    notes = []
    if len(body[-1]) < max(max(each) for each in places.values()) + 1 and len(body) > 1:
        body.pop()
        notes.append(f"{path.name} was cut off within its last line; the {len(body):,} frames before it are whole")
    frame = np.array([float(row[0]) for row in body])
    if not np.all(np.diff(frame) > 0):
        raise InputError(f"{path}: the frames' numbers do not go up from line to line; export it again")
    positions = {}
    for label, columns in places.items():
        scale = in_mm(units[columns[0]] if columns[0] < len(units) else "", f"{path}, marker {label!r}")
        cells = np.empty((len(body), 3))
        for i, row in enumerate(body):
            try:
                cells[i] = [_number(row[k : k + 1], comma=comma) for k in columns]
            except ValueError as fault:
                raise InputError(f"{path}, frame {row[0]}, marker {label!r}: {fault}; mend the line, or leave its cells empty") from fault
        positions[label] = masked(cells) * scale
    with np.errstate(over="ignore", invalid="ignore"):
        time = (frame - frame[0]) / rate
    if not np.isfinite(time).all():
        raise InputError(f"{path}: frames {body[0][0]} to {body[-1][0]} at {rate:g} a second make no times; export it again")
    # By the frames' numbers: a line that was left out is a gap, and not a jump in time.
    return Markers(path.name, hashlib.sha256(data).hexdigest(), rate, time, positions, tuple(notes))


def _rate(row: Sequence[str], where: str, *, comma: bool) -> float:
    try:
        rate = _number(row[:1], comma=comma)
    except ValueError:
        rate = float("nan")
    if not (np.isfinite(rate) and rate > 0):
        raise InputError(f"{where}: {''.join(row[:1])!r} is no rate; it must be frames a second")
    return rate


def _body(rows: Sequence[Sequence[str]], start: int) -> list[Sequence[str]]:
    """The section's lines, up to an empty one or whatever does not begin with a number."""
    body: list[Sequence[str]] = []
    for row in rows[start:]:
        if not row or not row[0].isdecimal():
            break
        body.append(row)
    return body


def _places(names: Sequence[str], columns: Sequence[str], path: Path, line: int) -> dict[str, tuple[int, int, int]]:
    """The columns of each marker: its label stands over the first of them."""
    starts = [k for k, name in enumerate(names) if name]
    places: dict[str, tuple[int, int, int]] = {}
    for k, end in itertools.pairwise([*starts, len(columns)]):
        under = [name.upper() for name in columns[k:end]]
        if not set(_AXES) <= set(under):
            continue  # a rotation, a residual of its own: no marker
        if names[k] in places:
            raise InputError(f"{path}, line {line}: two markers are called {names[k]!r}; give each one a label of its own")
        x, y, z = (k + under.index(axis) for axis in _AXES)
        places[names[k]] = (x, y, z)
    if not places:
        raise InputError(f"{path}, lines {line} and {line + 1}: no label stands over columns X, Y and Z; export the trajectories again")
    return places


def _number(cells: Sequence[str], *, comma: bool = False) -> float:
    """A cell's number; NaN where it is empty or missing.

    Raises
    ------
    ValueError
        It is something else.
    """
    if not cells or not cells[0]:
        return float("nan")
    return float(cells[0].replace(",", ".") if comma else cells[0])
