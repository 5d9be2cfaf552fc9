"""A line of the problems list."""

from __future__ import annotations

from dataclasses import dataclass

from gui.state.selection import NOTHING, Target


@dataclass(frozen=True)
class Problem:
    """Something the user should know.

    Parameters
    ----------
    text : str
        One sentence: what, where, what to do.
    source : str
        Who says so ("open", "flatten", "sensors", "export", ...): a new run replaces what the same source said before.
    kind : str
        "error", "warning" or "note".
    target : Target
        What to show when the line is clicked.
    """

    text: str
    source: str
    kind: str = "error"
    target: Target = NOTHING
