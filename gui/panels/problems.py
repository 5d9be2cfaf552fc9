"""The problems list: one sentence a line, the worst first; a line that names a place shows it when it is clicked."""

from __future__ import annotations

import tkinter as tk
from tkinter import ttk

from gui.scale import px
from gui.state.selection import NOTHING
from gui.state.session import Session
from gui.theme import Theme

#: Lines shown at once; the rest is scrolled to.
_ROWS = 3

_MARKS = {"error": "error", "warning": "warning", "note": "note"}


class ProblemsPanel(ttk.Frame):
    """What `Session.problems` holds."""

    def __init__(self, master: tk.Misc, session: Session, theme: Theme) -> None:
        super().__init__(master, name="problems", padding=(6, 2))
        self._session = session
        self.title = tk.StringVar(self)
        ttk.Label(self, textvariable=self.title, style="Title.TLabel", name="title").pack(anchor="w")
        rows = ttk.Frame(self)
        rows.pack(fill="both", expand=True)
        self.list = ttk.Treeview(rows, columns=("kind", "text"), show="", height=_ROWS, selectmode="browse", name="list")
        self.list.column("kind", width=px(self, 70), stretch=False)
        self.list.column("text", width=px(self, 600))
        bar = ttk.Scrollbar(rows, command=self.list.yview)
        self.list.configure(yscrollcommand=bar.set)
        bar.pack(side="right", fill="y")
        self.list.pack(side="left", fill="both", expand=True)
        self.list.bind("<<TreeviewSelect>>", self._show)
        self.restyle(theme)
        session.listen("problems", self._refresh)
        self._refresh()

    def restyle(self, theme: Theme) -> None:
        """Other colours."""
        for kind in _MARKS:
            self.list.tag_configure(kind, foreground={"error": theme.error, "warning": theme.warning, "note": theme.faint}[kind])

    def _refresh(self) -> None:
        self.list.delete(*self.list.get_children())
        problems = self._session.problems
        for k, problem in enumerate(problems):
            self.list.insert("", "end", iid=str(k), values=(_MARKS[problem.kind], problem.text), tags=(problem.kind,))
        counts = {kind: sum(p.kind == kind for p in problems) for kind in _MARKS}
        said = ", ".join(f"{n} {kind}{'s' if n > 1 else ''}" for kind, n in counts.items() if n)
        self.title.set(f"Problems: {said}" if said else "No problems")

    def _show(self, event: tk.Event) -> None:
        chosen = self.list.selection()
        if chosen and int(chosen[0]) < len(self._session.problems):
            target = self._session.problems[int(chosen[0])].target
            if target != NOTHING:
                self._session.select(target)
