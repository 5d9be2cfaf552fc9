"""Rows of a table of labels that have the same readings: learned twice, they would weigh double, and judge a model that knows them."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.nail.prints import shared

if TYPE_CHECKING:
    from skinfab.fingertip.nail.labels import Label

#: Where one trial ends and the next begins may be rounded so far apart, s.
_ROUNDED_S = 1e-3
#: Rows that have so many of their readings in common are one row given twice; with fewer, one begins or ends within the other.
_WHOLE = 0.8
#: What rows of the same readings must agree in; a trial's name may differ, as the copy of a row has another number.
_FACTS = ("label", "participant", "part", "x_mm", "y_mm", "angle_deg", "force_n")


def without_doubles(labels: Sequence[Label], logs: Sequence[Hashable], path: Path) -> tuple[list[int], list[str]]:
    """The rows that count, in their order, and what is to be said.

    A row that is there twice counts once.

    Parameters
    ----------
    labels : sequence of n Label
    logs : sequence of n
        What tells each row's log from others: its hash, or its name.
    path : Path
        Of the table, for what is said.

    Raises
    ------
    InputError
        Two rows say different things of the same readings, or have some of their readings in common.

    Examples
    --------
    >>> from skinfab.fingertip.nail.labels import Label
    >>> rows = [Label("a.csv", 0.0, 1.0, "pin"), Label("a.csv", 1.0, 2.0, "none"), Label("a.csv", 0.0, 1.0, "pin")]
    >>> without_doubles(rows, ["a.csv"] * 3, Path("labels.csv"))
    ([0, 1], ['labels.csv: 1 row is there twice, and counts once'])
    """
    dropped: set[int] = set()
    newest: dict[Hashable, int] = {}
    for k in sorted(range(len(labels)), key=lambda k: (labels[k].start_s, labels[k].end_s)):
        before = newest.setdefault(logs[k], k)
        if before == k or labels[k].start_s > labels[before].end_s - _ROUNDED_S:
            newest[logs[k]] = k
            continue
        _require_same(labels[before], labels[k], path)
        dropped.add(max(before, k))
        newest[logs[k]] = min(before, k)
    rows = [k for k in range(len(labels)) if k not in dropped]
    return rows, _said(len(dropped), path)


def without_copies(labels: Sequence[Label], readings: Sequence[NDArray[np.float64]], path: Path) -> tuple[list[int], list[str]]:
    """As `without_doubles`, of rows whose readings are the same in different files: a log that another program saved anew.

    Parameters
    ----------
    labels : sequence of n Label
    readings : sequence of n (m, 6) float
        Of each row's trial.
    path : Path
        Of the table, for what is said.

    Raises
    ------
    InputError
        Two rows say different things of the same readings, or have some of their readings in common.
    """
    dropped: set[int] = set()
    for (i, j), part in shared(readings).items():
        a, b = labels[i], labels[j]
        if part < _WHOLE:
            raise InputError(
                f"{path}: the rows of {_when(a)} and of {_when(b)} have {part:.0%} of their readings in common, which would judge a "
                "model that knows them; shorten one of them or leave it out"
            )
        _require_agreed(a, b, f"{path}: the rows of {_when(a)} and of {_when(b)} have the same readings")
        dropped.add(j)
    return [k for k in range(len(labels)) if k not in dropped], _said(len(dropped), path, " (the same readings in another file)")


def _when(label: Label) -> str:
    return f"{label.log}, {label.start_s:g} to {label.end_s:g} s,"


def _said(count: int, path: Path, how: str = "") -> list[str]:
    rows = "1 row is there twice, and counts once" if count == 1 else f"{count} rows are there twice, and count once"
    return [f"{path.name}: {rows}{how}"] if count else []


def _require_same(a: Label, b: Label, path: Path) -> None:
    """Refuse two rows of overlapping times that are not one row given twice."""
    where = a.log if a.log == b.log else f"{a.log} and {b.log} (the same log)"
    if max(abs(a.start_s - b.start_s), abs(a.end_s - b.end_s)) > _ROUNDED_S:
        raise InputError(
            f"{path}: rows of {a.start_s:g} to {a.end_s:g} s and of {b.start_s:g} to {b.end_s:g} s of {where} have readings in common, "
            "which would judge a model that knows them; shorten one of them or leave it out"
        )
    _require_agreed(a, b, f"{path}: {where} has {a.start_s:g} to {a.end_s:g} s twice")


def _require_agreed(a: Label, b: Label, what: str) -> None:
    for name in _FACTS:
        one, other = getattr(a, name), getattr(b, name)
        if one != other and (one == one or other == other):  # NaN twice is the same
            raise InputError(f"{what}, with {name} {one!r} and {other!r}; leave one of the rows out")
