"""What the tables say, in a sentence: every number in it comes from them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from skinfab.bench.contestants import DEFAULT, RIVAL
from skinfab.bench.refinement import NEWTON, SLIM

Table = Sequence[Mapping[str, Any]]

#: Where two refinements are compared: d - 4 this close to the least that was found.
SAME_D = 1.005
#: A mean d that is larger by less than this part is no other: tables have nine digits.
_AS_FLAT = 1 + 1e-8


def pareto_front(points: Sequence[tuple[float, float]]) -> list[int]:
    """Which points no other beats in both coordinates (at least as small in both, smaller in one), by the first coordinate.

    Examples
    --------
    >>> pareto_front([(3, 1), (1, 3), (2, 2), (3, 3)])
    [1, 2, 0]
    """
    front: list[int] = []
    for k in sorted(range(len(points)), key=lambda k: points[k]):
        if not front or points[k][1] < points[front[-1]][1] or points[k] == points[front[-1]]:
            front.append(k)
    return front


def growth_exponent(triangles: Sequence[float], seconds: Sequence[float]) -> float | None:
    """p of the power law seconds ~ triangles^p through these points (least squares of the logarithms); None for a single size.

    Examples
    --------
    >>> round(growth_exponent([100, 200, 400], [1, 2, 4]), 9)
    1.0
    """
    x, y = [math.log(t) for t in triangles], [math.log(s) for s in seconds]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    spread = sum((a - mean_x) ** 2 for a in x)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y, strict=True)) / spread if spread > 0 else None


def exponents(table: Table) -> dict[str, float]:
    """The growth exponent of every method that ran at two sizes or more."""
    found = {}
    for name in dict.fromkeys(row["method"] for row in table):
        rows = [row for row in table if row["method"] == name]
        p = growth_exponent([row["triangles"] for row in rows], [row["seconds"] for row in rows])
        if p is not None:
            found[name] = p
    return found


def reached(refinement: Table, triangles: int) -> tuple[float, float, bool]:
    """Seconds of Newton and of SLIM until d - 4 is within `SAME_D` of the least of both, and whether SLIM got there at all."""
    rows = [row for row in refinement if row["triangles"] == triangles]
    bound = 4 + (min(row["mean_d"] for row in rows) - 4) * SAME_D
    seconds, there = {}, {}
    for method in (NEWTON, SLIM):
        own = [row for row in rows if row["method"] == method]
        good = [row["seconds"] for row in own if row["mean_d"] <= bound]
        seconds[method], there[method] = (good[0] if good else own[-1]["seconds"]), bool(good)
    return seconds[NEWTON], seconds[SLIM], there[SLIM]


def sentence(table: Table, refinement: Table) -> str:
    """What the default is and why, how it stands to SLIM, how time grows, and the memory: one sentence."""
    size = max(row["triangles"] for row in table)
    rows = {row["method"]: row for row in table if row["triangles"] == size}
    default, slim = rows[DEFAULT], rows[RIVAL]
    usable = [row for row in rows.values() if row["usable"]]
    least = min(row["mean_d"] for row in usable)
    newton_s, slim_s, there = reached(refinement, size)
    parts = [
        f"The default is {DEFAULT}: at {size} triangles it reaches a mean d of {default['mean_d']:.5f} (least of all usable results: "
        f"{least:.5f}) in {default['seconds']:.3g} s of processor time, {_beside_the_quicker(usable, default)}",
        f"slim takes {slim['seconds']:.3g} s to {slim['mean_d']:.5f}, so the ratio of times is {default['seconds'] / slim['seconds']:.2f}",
        f"from the same BFF start, until d - 4 is within {SAME_D - 1:.1%} of the least, it is {newton_s / slim_s:.2f}"
        + ("" if there else " at most, as SLIM did not get there"),
    ]
    growth = exponents(table)
    if growth:
        parts.append("time grows with the triangles to the power of " + ", ".join(f"{p:.2f} ({name})" for name, p in growth.items()))
    if default["peak_mb"] is not None and slim["peak_mb"] is not None:
        parts.append(f"memory rises by {default['peak_mb']:.3g} MB (slim: {slim['peak_mb']:.3g} MB)")
    return "; ".join(parts) + "."


def why_isometric(table: Table) -> str:
    """What the default of flattening is, and why, by the largest size."""
    size = max(row["triangles"] for row in table)
    usable = [row for row in table if row["triangles"] == size and row["usable"]]
    default = next(row for row in table if row["triangles"] == size and row["method"] == DEFAULT)
    least = min(row["mean_d"] for row in usable)
    return (
        f"{DEFAULT}: at {size} triangles its mean d is {default['mean_d']:.5f}, the least of all usable results {least:.5f}, "
        + _beside_the_quicker(usable, default)
    )


def why_newton(refinement: Table) -> str:
    """What the default of refinement is, and why, by the largest size."""
    size = max(row["triangles"] for row in refinement)
    newton_s, slim_s, there = reached(refinement, size)
    return (
        f"{NEWTON}, which ends there by itself: at {size} triangles it is within {SAME_D - 1:.1%} of the least d - 4 after "
        f"{newton_s / slim_s:.2f} of SLIM's time" + ("" if there else " at most, as SLIM did not get there")
    )


def _beside_the_quicker(usable: Table, default: Mapping[str, Any]) -> str:
    quicker = [row for row in usable if row["seconds"] < default["seconds"]]
    worse = {
        row["method"]: (row["mean_d"] - 4) / (default["mean_d"] - 4) for row in quicker if row["mean_d"] > _AS_FLAT * default["mean_d"]
    }
    said = ["nothing is quicker"] if not quicker else []
    if worse:
        spread = f"{min(worse.values()):.3g} to {max(worse.values()):.3g}" if len(worse) > 1 else f"{next(iter(worse.values())):.3g}"
        said.append(f"what is quicker ({', '.join(worse)}) leaves {spread} times as much of d - 4")
    said += [f"{row['method']} takes {row['seconds']:.3g} s to no more" for row in quicker if row["method"] not in worse]
    return "and " + ", and ".join(said)
