"""Labelled images: a folder of them, and a table that says where the edge was in each."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from skinfab.errors import InputError
from skinfab.fingertip.optical.edge import Edge
from skinfab.fingertip.optical.picture import read_picture
from skinfab.fingertip.optical.pins import Image
from skinfab.spreadsheet import read_csv_lines

_MAX_BYTES = 100_000_000


@dataclass(frozen=True)
class Columns:
    """What the table's columns are called.

    Parameters
    ----------
    image, offset, angle : str
        File name; mm off the plate; degrees.
    depth, group : str
        mm; the trial that an image is of. They may be missing.
    """

    image: str = "image"
    offset: str = "offset_mm"
    angle: str = "angle_deg"
    depth: str = "depth_mm"
    group: str = "group"


@dataclass(frozen=True, eq=False)
class Targets:
    """Images with what is true.

    Parameters
    ----------
    names : tuple of str
    images : tuple of (h, w) uint8
    edges : tuple of Edge
    groups : tuple of str
    simulated : bool
        One of them says so, or the table does.
    notes : tuple of str
    """

    names: tuple[str, ...]
    images: tuple[Image, ...]
    edges: tuple[Edge, ...]
    groups: tuple[str, ...]
    simulated: bool
    notes: tuple[str, ...]


def read_targets(table: str | Path, folder: str | Path | None = None, *, columns: Columns | None = None) -> Targets:
    """Read a table of labels and its images.

    Parameters
    ----------
    table : path
        CSV with headings.
    folder : path, optional
        Where the images lie; beside the table where it is left out.
    columns : Columns, optional

    Raises
    ------
    InputError
        The table, a column, a number or an image is missing or cannot be read; an image stands there twice.
    """
    table, columns = Path(table), columns or Columns()
    lines, comma = read_csv_lines(table, max_bytes=_MAX_BYTES, wanted="a table of images and targets as CSV")
    rows = list(csv.DictReader((line for line in lines if line.strip() and not line.startswith("#")), delimiter=comma))
    if not rows:
        raise InputError(f"{table} has no rows; give a line of headings and one line an image")
    for name in (columns.image, columns.offset, columns.angle):
        if name not in rows[0]:
            raise InputError(f"{table} has no column {name!r}; it has {', '.join(map(repr, rows[0]))}: name the right ones by options")
    names = [row[columns.image] or "" for row in rows]
    if twice := next((name for name, count in _counts(names).items() if count > 1), None):
        raise InputError(f"{table} names image {twice!r} twice; it could be learned from and judged on: give one line an image")
    deep, grouped = columns.depth in rows[0], columns.group in rows[0]
    edges = tuple(
        Edge(
            _number(row, columns.offset, table, k),
            math.radians(_number(row, columns.angle, table, k)),
            _number(row, columns.depth, table, k) if deep else math.nan,
        )
        for k, row in enumerate(rows)
    )
    read = [read_picture(_place(name, Path(folder) if folder else table.parent)) for name in names]
    notes = [] if deep else [f"{table.name} has no column {columns.depth!r}: depth is not learned"]
    if not grouped:
        notes.append(f"{table.name} has no column {columns.group!r}: every image counts as a trial of its own")
    groups = tuple((row[columns.group] or name) if grouped else name for row, name in zip(rows, names, strict=True))
    simulated = any(made for _, made in read) or rows[0].get("simulated") == "1"
    return Targets(tuple(names), tuple(image for image, _ in read), edges, groups, simulated, tuple(notes))


def _counts(names: Sequence[str]) -> dict[str, int]:
    out: dict[str, int] = {}
    for name in names:
        out[name] = out.get(name, 0) + 1
    return out


def _number(row: dict[str, str], name: str, table: Path, k: int) -> float:
    try:
        value = float(row[name])
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{table}, row {k + 1}, column {name!r}: {row[name]!r} is not a number; correct it or leave the row out")
    return value


def _place(name: str, folder: Path) -> Path:
    """A table may name images by their way from itself, although their own folder was given."""
    return folder / name if (folder / name).exists() else folder / Path(name).name
