"""The list of sensors: what they are, where, on which channel, and what resistance to expect."""

from __future__ import annotations

import tkinter as tk
from tkinter import ttk

from gui.scale import measured, px
from gui.state.profiles import ProfileShelf
from gui.state.selection import Target
from gui.state.session import Session
from skinfab.electrical import resistance
from skinfab.errors import InputError

_COLUMNS = (("id", "id", 42), ("kind", "pattern", 100), ("piece", "on", 34), ("channel", "ch", 28), ("r", "R, kohm", 92))


class SensorsPanel(ttk.Frame):
    """One line a sensor; the selection is the views' own."""

    def __init__(self, master: tk.Misc, session: Session, shelf: ProfileShelf) -> None:
        super().__init__(master, name="sensors", padding=4)
        self._session, self._shelf = session, shelf
        rows = ttk.Frame(self)
        rows.pack(fill="both", expand=True)
        self.list = ttk.Treeview(rows, columns=[c[0] for c in _COLUMNS], show="headings", height=5, selectmode="browse", name="list")
        for name, heading, width in _COLUMNS:
            self.list.heading(name, text=heading)
            least = max(px(self, width), measured(self, heading))
            self.list.column(name, width=least, minwidth=least, anchor="e" if name in ("channel", "r") else "w", stretch=name == "kind")
        bar = ttk.Scrollbar(rows, command=self.list.yview)
        self.list.configure(yscrollcommand=bar.set)
        bar.pack(side="right", fill="y")
        self.list.pack(side="left", fill="both", expand=True)
        self.list.bind("<<TreeviewSelect>>", self._chosen)
        self.list.bind("<Configure>", lambda event: self.after_idle(self._see))  # the form below grows for what was selected
        session.listen("skin", self._refresh)
        session.listen("selection", self._follow)
        self._refresh()

    def _refresh(self) -> None:
        skin = self._session.skin
        wanted = {} if skin is None else {s.id: s for s in skin.sensors}
        try:
            ink = None if skin is None else self._shelf.of(skin).material.ink
        except InputError:
            ink = None  # the profile is missing: the problems list says so
        self.list.delete(*self.list.get_children())
        for id, s in wanted.items():
            r = None if ink is None else resistance(s.path.length, ink)
            words = "" if r is None else f"{r.low:.0f} to {r.high:.0f}"
            self.list.insert("", "end", iid=id, values=(id, s.pattern.kind, s.piece, s.channel, words))
        self._follow()

    def _follow(self) -> None:
        sensor = self._session.selected.sensor
        wanted = (sensor,) if sensor and self.list.exists(sensor) else ()
        if self.list.selection() != wanted:
            self.list.selection_set(wanted)
            self._see()

    def _see(self) -> None:
        for id in self.list.selection():
            self.list.see(id)

    def _chosen(self, event: tk.Event) -> None:
        chosen, skin = self.list.selection(), self._session.skin
        if chosen and skin is not None and chosen[0] != self._session.selected.sensor:
            piece = next(s.piece for s in skin.sensors if s.id == chosen[0])
            self._session.select(Target(piece=piece, sensor=chosen[0]))
