"""Labelled images: a folder of them, and a table that says where the edge was in each."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from skinfab.errors import InputError
from skinfab.fingertip.optical.edge import Edge
from skinfab.fingertip.optical.picture import read_picture
from skinfab.fingertip.optical.pins import Image
from skinfab.spreadsheet import read_csv_rows

_MAX_BYTES = 100_000_000
#: Angles that all lie within this, degrees, may be radians; offsets that all do, mm, may be metres.
_RADIANS, _METRES = 2 * math.pi + 0.01, 0.05
#: A number is far from all others that is so many times farther from their middle than nine in ten are.
_OUTLIER = 10.0


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
        The table, a column, a number or an image is missing or cannot be read; an image stands there twice, or under
        two names in two groups.
    """
    table, columns = Path(table), columns or Columns()
    rows = read_csv_rows(table, max_bytes=_MAX_BYTES, wanted="a table of images and targets as CSV")
    if not rows:
        raise InputError(f"{table} has no rows; give a line of headings and one line an image")
    for name in (columns.image, columns.offset, columns.angle):
        if name not in rows[0]:
            raise InputError(f"{table} has no column {name!r}; it has {', '.join(map(repr, rows[0]))}: name the right ones by options")
    names = [row[columns.image] or "" for row in rows]
    places = [_place(name, Path(folder) if folder else table.parent, table) for name in names]
    first: dict[Path, str] = {}
    for name, place in zip(names, places, strict=True):
        if (other := first.setdefault(place.resolve(), name)) is not name:
            also = "" if other == name else f" (as {other!r} first)"
            raise InputError(f"{table} names image {name!r} twice{also}; it could be learned from and judged on: give one line an image")
    deep, grouped = columns.depth in rows[0], columns.group in rows[0]
    edges = tuple(
        Edge(
            _number(row, columns.offset, table, k),
            math.radians(_number(row, columns.angle, table, k)),
            _number(row, columns.depth, table, k) if deep else math.nan,
        )
        for k, row in enumerate(rows)
    )
    read = [read_picture(place) for place in places]
    notes = [] if deep else [f"{table.name} has no column {columns.depth!r}: depth is not learned"]
    if not grouped:
        notes.append(f"{table.name} has no column {columns.group!r}: every image counts as a trial of its own")
    groups = tuple((row[columns.group] or name) if grouped else name for row, name in zip(rows, names, strict=True))
    alike: dict[bytes, int] = {}
    for k, (image, _) in enumerate(read):
        if groups[j := alike.setdefault(image.tobytes(), k)] != groups[k]:
            raise InputError(
                f"{table}: images {names[j]!r} and {names[k]!r} are alike in every pixel and of other groups; one could be learned from "
                "and the other judged on: leave one out, or give them one group"
            )
    simulated = any(made for _, made in read) or rows[0].get("simulated") == "1"
    return Targets(tuple(names), tuple(image for image, _ in read), edges, groups, simulated, tuple(notes))


def fit_to_learn(targets: Targets, columns: Columns) -> Targets:
    """The same with notes on numbers that may be of another unit or column; depth is left out where it is always the same.

    Raises
    ------
    InputError
        Offset or angle is the same in all images: a model of it would be perfect and know nothing.
    """
    offset, angle, depth = np.array([(e.offset_mm, math.degrees(e.angle_rad), e.depth_mm) for e in targets.edges]).T
    for values, column, option in ((offset, columns.offset, "--offset-column"), (angle, columns.angle, "--angle-column")):
        if np.ptp(values) < 1e-9 * max(float(np.abs(values).max()), 1.0):
            raise InputError(f"column {column!r} is {values[0]:g} in all images, so nothing of it can be learned; name another by {option}")
    notes = list(targets.notes)
    if np.abs(angle).max() < _RADIANS:
        notes.append(f"all of column {columns.angle!r} lies from {angle.min():g} to {angle.max():g}: if these are radians, give degrees")
    if np.abs(offset).max() < _METRES:
        notes.append(f"all of column {columns.offset!r} lies from {offset.min():g} to {offset.max():g}: if these are metres, give mm")
    for values, column in ((offset, columns.offset), (angle, columns.angle), (depth, columns.depth)):
        apart = np.abs(values - np.median(values))
        if (far := apart > _OUTLIER * np.quantile(apart, 0.9)).any():
            k = int(apart.argmax())
            notes.append(
                f"{far.sum()} of column {column!r} lie far from all others ({values[k]:g} of {targets.names[k]}): look at these rows"
            )
    edges = targets.edges
    if np.isfinite(depth).all() and np.ptp(depth) < 1e-9 * max(float(np.abs(depth).max()), 1.0):
        notes.append(f"column {columns.depth!r} is {depth[0]:g} in all images: depth is not learned")
        edges = tuple(replace(edge, depth_mm=math.nan) for edge in edges)
    return replace(targets, edges=edges, notes=tuple(notes))


def _number(row: dict[str, str], name: str, table: Path, k: int) -> float:
    try:
        value = float(row[name])
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        why = "has a decimal comma" if re.fullmatch(r"\s*[-+]?\d+,\d+\s*", row[name] or "") else "is not a number"
        what = "write a point" if "comma" in why else "correct it or leave the row out"
        raise InputError(f"{table}, row {k + 1}, column {name!r}: {row[name]!r} {why}; {what}")
    return value


def _place(name: str, folder: Path, table: Path) -> Path:
    """A table may name images by their way from itself, although their own folder was given."""
    try:
        bare = folder / Path(name).name
        return bare if not (folder / name).exists() and bare.exists() else folder / name
    except OSError as fault:  # too long
        raise InputError(f"{table} names image {name[:80]!r}, which no file can be called; mend it") from fault
