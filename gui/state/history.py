"""Undo and redo: documents are values, so the past is a list of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Generic, TypeVar

T = TypeVar("T")

#: Steps that can be undone. Documents share their arrays, so a step costs what it changed.
MOST_STEPS = 200


@dataclass
class History(Generic[T]):
    """A value, those before it and those undone.

    Parameters
    ----------
    now : T

    Examples
    --------
    >>> history = History(1)
    >>> history.do("two", 2); history.do("three", 3)
    >>> history.undo(), history.undo(), history.redo(), history.now
    ('three', 'two', 'two', 2)
    """

    now: T
    #: The step that made the present: 0 before any; each `do` has a number of its own, which undo and redo come back to.
    step: int = 0
    _past: list[tuple[str, T, int]] = field(default_factory=list)
    _future: list[tuple[str, T, int]] = field(default_factory=list)
    _merging: object = None
    _newest: int = 0

    def do(self, label: str, value: T, *, merge: object = None) -> None:
        """Make `value` the present; what was undone is forgotten.

        Steps in a row with the same `merge`, such as those of one drag, are undone as one.
        """
        if merge is None or merge != self._merging or not self._past:
            self._past.append((label, self.now, self.step))
            del self._past[:-MOST_STEPS]
        self._merging = merge
        self._future.clear()
        self.now = value
        self._newest += 1
        self.step = self._newest

    def amend(self, value: T) -> None:
        """Replace the present by what belongs to it; no step of its own."""
        self.now = value

    def undo(self) -> str | None:
        """Go one step back; the label of the step, or None where there is none."""
        return self._step(self._past, self._future)

    def redo(self) -> str | None:
        """Go one step forth again; its label, or None."""
        return self._step(self._future, self._past)

    @property
    def undo_label(self) -> str | None:
        """What `undo` would take back."""
        return self._past[-1][0] if self._past else None

    @property
    def redo_label(self) -> str | None:
        """What `redo` would do again."""
        return self._future[-1][0] if self._future else None

    def _step(self, source: list[tuple[str, T, int]], target: list[tuple[str, T, int]]) -> str | None:
        if not source:
            return None
        label, value, step = source.pop()
        target.append((label, self.now, self.step))
        self.now, self.step, self._merging = value, step, None
        return label
