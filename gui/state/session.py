"""The open document and everything the panels and views share. It knows no widget."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Literal

from gui.state.history import History
from gui.state.problem import Problem
from gui.state.selection import NOTHING, Target
from skinfab.placement.lifted import Lifted
from skinfab.skin import Skin

#: What a listener can be told of.
Topic = Literal["skin", "file", "selection", "hover", "problems", "shading", "theme", "tool"]

#: How faces are coloured: by piece, by distortion d, as a checker board, or by painted seam preferences.
SHADINGS = ("pieces", "distortion", "checker", "preferences")


class Session:
    """One open document, its history, what is selected and what is wrong with it.

    Everything that shows a part of it listens to the topics it needs and reads the rest; everything that changes
    it goes through `do`, so that it can be undone.

    Examples
    --------
    >>> session = Session()
    >>> session.skin is None, session.dirty
    (True, False)
    >>> told = []
    >>> session.listen("selection", lambda: told.append(session.selected.piece))
    >>> session.select(Target(piece="P1")); told
    ['P1']
    """

    def __init__(self) -> None:
        self._history: History[Skin | None] = History(None)
        self._saved: Skin | None = None
        self._listeners: dict[str, list[Callable[[], None]]] = {}
        self.path: Path | None = None
        self.selected: Target = NOTHING
        self.hovered: Target = NOTHING
        self.shading = "pieces"
        self.tool = "select"
        self._problems: dict[str, tuple[Problem, ...]] = {}

    # What is open

    @property
    def skin(self) -> Skin | None:
        """The document as it is now; None before anything is opened."""
        return self._history.now

    @property
    def lifted(self) -> tuple[Lifted, ...]:
        """Sensors that lost their spot to a cut and come back once it lies flat again."""
        return () if self.skin is None else self.skin.lifted

    @property
    def step(self) -> int:
        """The step that made the document as it is: larger the later it was done first, the same again after undo and redo."""
        return self._history.step

    @property
    def dirty(self) -> bool:
        """Whether there is something that was not saved."""
        return self.skin is not self._saved

    def open(self, skin: Skin, path: Path | None, *, saved: bool = True) -> None:
        """Begin anew with `skin`; `saved` says whether it is what lies at `path`."""
        self._history = History(skin)
        self._saved = skin if saved else None
        self.path = path
        self.selected = self.hovered = NOTHING
        self._problems.clear()
        for topic in ("file", "skin", "selection", "hover", "problems"):
            self._tell(topic)

    def do(self, label: str, skin: Skin, *, merge: object = None) -> None:
        """Change the document; `label` ("move C1") is what undo says, `merge` joins the steps of one drag."""
        self._history.do(label, skin, merge=merge)
        self._forget_missing()
        self._tell("skin")

    def amend(self, skin: Skin) -> None:
        """Complete the document by what follows from its last step, such as the flat pieces of a cut: undone with that step."""
        saved = not self.dirty
        self._history.amend(skin)
        if saved:
            self._saved = skin
        self._forget_missing()
        self._tell("skin")

    def undo(self) -> str | None:
        """Take the last step back; its label."""
        return self._went(self._history.undo())

    def redo(self) -> str | None:
        """Do the last undone step again; its label."""
        return self._went(self._history.redo())

    @property
    def undo_label(self) -> str | None:
        """What undo would take back."""
        return self._history.undo_label

    @property
    def redo_label(self) -> str | None:
        """What redo would do again."""
        return self._history.redo_label

    def mark_saved(self, path: Path) -> None:
        """The document as it is now lies at `path`."""
        self._saved, self.path = self.skin, path
        self._tell("file")

    # What is looked at

    def select(self, target: Target) -> None:
        """Select something, or `NOTHING`."""
        if target != self.selected:
            self.selected = target
            self._tell("selection")

    def hover(self, target: Target) -> None:
        """Say what the pointer is on."""
        if target != self.hovered:
            self.hovered = target
            self._tell("hover")

    def shade(self, shading: str) -> None:
        """Colour faces another way, one of `SHADINGS`."""
        if shading not in SHADINGS:
            raise ValueError(f"no shading {shading!r}; there are {', '.join(SHADINGS)}")
        self.shading = shading
        self._tell("shading")

    def take_up(self, tool: str) -> None:
        """Change what clicks do."""
        self.tool = tool
        self._tell("tool")

    # What is wrong

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Errors first, then warnings, then notes."""
        order = ("error", "warning", "note")
        return tuple(sorted((p for each in self._problems.values() for p in each), key=lambda p: order.index(p.kind)))

    def report(self, source: str, problems: Iterable[Problem]) -> None:
        """Replace what `source` said before."""
        new = tuple(problems)
        if new != self._problems.get(source, ()):
            self._problems[source] = new
            self._tell("problems")

    # Who is told

    def listen(self, topic: Topic, callback: Callable[[], None]) -> None:
        """Call `callback` whenever `topic` has changed."""
        self._listeners.setdefault(topic, []).append(callback)

    def _tell(self, topic: str) -> None:
        # Where one of them fails, the others must still not show what is no longer so.
        faults: list[Exception] = []
        for callback in self._listeners.get(topic, ()):
            try:
                callback()
            except Exception as fault:
                faults.append(fault)
        if faults:
            raise faults[0]

    def _went(self, label: str | None) -> str | None:
        if label is not None:
            self._forget_missing()
            self._tell("skin")
        return label

    def _forget_missing(self) -> None:
        """What is selected may be gone."""
        skin = self.skin
        if skin is None:
            return
        pieces, sensors = {p.id for p in skin.pieces}, {s.id for s in skin.sensors}
        for name in ("selected", "hovered"):
            target: Target = getattr(self, name)
            if (target.piece and target.piece not in pieces) or (target.sensor and target.sensor not in sensors):
                setattr(self, name, NOTHING)
                self._tell("selection" if name == "selected" else "hover")
