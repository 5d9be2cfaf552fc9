"""The problems list: one sentence a line, what is new first and notes last; a line that names a place shows it when it is clicked."""

from __future__ import annotations

import re
import tkinter as tk
from collections.abc import Mapping, Sequence
from tkinter import font, ttk

from gui.scale import px
from gui.state.problem import Problem
from gui.state.selection import NOTHING
from gui.state.session import Session
from gui.theme import Theme

#: Lines shown at once; the rest is scrolled to.
_ROWS = 3

#: Width of the first column, what a list leaves free beside its text, and the least that lines are made for, px at 96 dots an inch.
_KIND, _BESIDE, _LEAST = 70, 6, 100

#: Parts of a sentence about sensors that do not fit which say nothing of these.
_ADVICE = re.compile(r"move, turn or shrink (it|them)|and \d+ more")

#: Who says what is wrong with a piece, and who with the sensors on it.
_CAUSE, _FOLLOWS = "flatten", "sensors"

_MARKS = {"error": "error", "warning": "warning", "note": "note"}


class ProblemsPanel(ttk.Frame):
    """What `Session.problems` holds."""

    def __init__(self, master: tk.Misc, session: Session, theme: Theme) -> None:
        super().__init__(master, name="problems", padding=(6, 2))
        self._session = session
        #: What is listed, in that order, and when each line came: the how manieth time that the list changed, and at which step.
        self.shown: tuple[Problem, ...] = ()
        self._came: dict[Problem, tuple[int, int]] = {}
        self.title = tk.StringVar(self)
        ttk.Label(self, textvariable=self.title, style="Title.TLabel", name="title").pack(anchor="w")
        rows = ttk.Frame(self)
        rows.pack(fill="both", expand=True)
        self.list = ttk.Treeview(rows, columns=("kind", "text"), show="", height=_ROWS, selectmode="browse", name="list")
        self.list.column("kind", width=px(self, _KIND), stretch=False)
        self.list.column("text", width=px(self, 600))
        bar = ttk.Scrollbar(rows, command=self.list.yview)
        self.list.configure(yscrollcommand=bar.set)
        bar.pack(side="right", fill="y")
        self.list.pack(side="left", fill="both", expand=True)
        self.list.bind("<<TreeviewSelect>>", self._show)
        self._wide, self._font = 0, font.nametofont(str(ttk.Style(self).lookup("Treeview", "font")) or "TkDefaultFont", root=self)
        self.list.bind("<Configure>", self._resized)
        self.restyle(theme)
        session.listen("problems", self._refresh)
        self._refresh()

    def restyle(self, theme: Theme) -> None:
        """Other colours."""
        for kind in _MARKS:
            self.list.tag_configure(kind, foreground={"error": theme.error, "warning": theme.warning, "note": theme.faint}[kind])

    def _refresh(self) -> None:
        self.list.delete(*self.list.get_children())
        latest = 1 + max((when for when, _ in self._came.values()), default=0), self._session.step
        self._came = {p: self._came.get(p, latest) for p in self._session.problems}
        problems = self.shown = tuple(ordered(once(self._session.problems), self._came))
        for k, problem in enumerate(problems):
            # A sentence ends with what to do: it must not be cut off.
            for j, line in enumerate(self._lines(problem.text)):
                mark = "" if j else _MARKS[problem.kind]
                self.list.insert("", "end", iid=f"{k}.{j}" if j else str(k), values=(mark, line), tags=(problem.kind,))
        counts = {kind: sum(p.kind == kind for p in problems) for kind in _MARKS}
        said = ", ".join(f"{n} {kind}{'s' if n > 1 else ''}" for kind, n in counts.items() if n)
        self.title.set(f"Problems: {said}" if said else "No problems")

    def _lines(self, text: str) -> list[str]:
        """A sentence in lines that fit."""
        room = self._wide - px(self, _KIND + 2 * _BESIDE)
        if room < px(self, _LEAST):
            return [text]  # not shown yet
        lines: list[str] = []
        for word in text.split(" "):
            longer = f"{lines[-1]} {word}" if lines else word
            if lines and self._font.measure(longer) <= room:
                lines[-1] = longer
            else:
                lines.append(word)
        return lines

    def _resized(self, event: tk.Event) -> None:
        if event.width != self._wide:
            self._wide = event.width
            self._refresh()

    def _show(self, event: tk.Event) -> None:
        chosen = self.list.selection()
        place = int(chosen[0].partition(".")[0]) if chosen else -1
        if 0 <= place < len(self.shown):
            target = self.shown[place].target
            if target != NOTHING:
                self._session.select(target)


def ordered(problems: Sequence[Problem], came: Mapping[Problem, tuple[int, int]]) -> list[Problem]:
    """What is new first, as only a few lines are seen at once, and notes last; but the cause before what follows from it.

    When a piece comes to lie badly, its sensors do not fit by that same step: what is wrong with the piece stands above them.

    Parameters
    ----------
    problems : sequence of Problem
        The worst first.
    came : mapping of Problem to (int, int)
        When each came, larger the later, and by which step of the document.

    Examples
    --------
    >>> from gui.state.selection import Target
    >>> ring = Problem("P1 is a ring", "flatten", kind="warning", target=Target(piece="P1"))
    >>> outside = Problem("C1 is outside P1", "sensors", target=Target(piece="P1", sensor="C1"))
    >>> ordered([outside, ring], {ring: (1, 7), outside: (2, 7)}) == [ring, outside]
    True
    >>> ordered([outside, ring], {ring: (1, 7), outside: (2, 8)}) == [outside, ring]
    True
    """

    def when(problem: Problem) -> int:
        if problem.source != _CAUSE or not problem.target.piece:
            return came[problem][0]
        follow = (p for p in problems if p.source == _FOLLOWS and p.target.piece == problem.target.piece and came[p][1] == came[problem][1])
        return max(came[p][0] for p in (problem, *follow))

    return sorted(problems, key=lambda p: (p.kind == "note", -when(p), p.source != _CAUSE))


def once(problems: Sequence[Problem]) -> list[Problem]:
    """Without what is said twice, of which the line that shows a place stays: what does not fit has such a line already when it is refused.

    Examples
    --------
    >>> from gui.state.selection import Target
    >>> fit = [Problem(f"{id} is outside P1; move it", "sensors", target=Target(sensor=id)) for id in ("C1", "C2")]
    >>> refused = Problem("C1 is outside P1; C2 is outside P1; move, turn or shrink them", "export")
    >>> once([refused, *fit]) == fit, once([refused, fit[0]]) == [refused, fit[0]]
    (True, True)
    """
    placed = {clause for problem in problems if problem.target != NOTHING for clause in _clauses(problem.text)}
    kept: list[Problem] = []
    for problem in problems:
        if problem.target == NOTHING and (placed.issuperset(_clauses(problem.text)) or any(problem.text == other.text for other in kept)):
            continue
        kept.append(problem)
    return kept


def _clauses(text: str) -> set[str]:
    """What a sentence says, without what it advises or leaves out."""
    return {clause for clause in text.split("; ") if not _ADVICE.fullmatch(clause)} or {text}
