"""What the table of automatic seams says, in a sentence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from skinfab.seams.judge import Limits


def at_default(table: Sequence[Mapping[str, Any]]) -> dict[str, list[Mapping[str, Any]]]:
    """By method: the rows at the default bound, and the peer's, of the objects that every method has."""
    rows = [row for row in table if row["bound"] is None or row["bound"] == Limits.mean]
    methods = list(dict.fromkeys(row["method"] for row in rows))
    shared = set.intersection(*({row["object"] for row in rows if row["method"] == method} for method in methods))
    return {method: [row for row in rows if row["method"] == method and row["object"] in shared] for method in methods}


def sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """Where the default sits, and the others beside it: every number in it comes from the table."""
    said = []
    for method, rows in at_default(table).items():
        who = {"usual": f"The default, usual pieces at mean d {Limits.mean:g}, makes", "fewest": "fewest makes"}.get(
            method, f"{method} makes"
        )
        d = np.array([row["mean_d"] if row["mean_d"] is not None else np.inf for row in rows])
        said.append(
            f"{who} {_counted(sum(row['pieces'] for row in rows), 'piece')} of {_counted(len(rows), 'object')}, "
            f"{np.mean([row['seam'] for row in rows]):.2f} of seam over the root of the area on average, "
            f"mean d {d.min():.3f} to {d.max():.3f}, in {sum(row['seconds'] for row in rows):.3g} s"
        )
    return "; ".join(said) + "."


def _counted(number: int, what: str) -> str:
    return f"{number} {what}" + ("" if number == 1 else "s")
