"""What is selected in numbers: a sensor's place, parameters and prediction, a piece's figures, or the document's own settings."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from tkinter import ttk

from gui.jobs.background import Background
from gui.panels.document_form import DocumentForm
from gui.panels.piece_facts import PieceFacts
from gui.panels.sensor_form import SensorForm
from gui.scale import px
from gui.state.derived import Derived
from gui.state.profiles import ProfileShelf
from gui.state.selection import Target
from gui.state.session import Session
from skinfab.skin import Skin


class PropertiesPanel(ttk.Frame):
    """One of three forms, by what is selected.

    Parameters
    ----------
    master : widget
    session : Session
    derived : Derived
    shelf : ProfileShelf
    background : Background
        For the strain of wearing.
    complain : callable
        Shows a sentence about what was typed, or a hint.
    make_thick : callable
        Flattens for a skin of so many mm.
    """

    def __init__(
        self,
        master: tk.Misc,
        session: Session,
        derived: Derived,
        shelf: ProfileShelf,
        background: Background,
        *,
        complain: Callable[[str], None],
        make_thick: Callable[[float], object],
    ) -> None:
        super().__init__(master, name="properties", padding=4)
        self._session = session
        self.title = tk.StringVar(self)
        ttk.Label(self, textvariable=self.title, style="Title.TLabel", wraplength=px(self, 290), name="title").pack(anchor="w")
        self._forms: dict[str, SensorForm | PieceFacts | DocumentForm] = {
            "sensor": SensorForm(self, session, shelf, background, complain=complain),
            "piece": PieceFacts(self, session, derived),
            "document": DocumentForm(self, session, complain=complain, make_thick=make_thick),
        }
        self._shown = ""
        session.listen("skin", self._refresh)
        session.listen("selection", self._refresh)
        self._refresh()

    def _refresh(self) -> None:
        skin, selected = self._session.skin, self._session.selected
        if skin is None:
            wanted, title = "", ""
        elif selected.sensor:
            wanted, title = "sensor", self._sensor_title(skin, selected)
        elif selected.piece:
            wanted, title = "piece", f"Piece {selected.piece}"
        else:
            wanted, title = "document", skin.source.file
        self.title.set(title)
        if wanted != self._shown:
            for form in self._forms.values():
                form.pack_forget()
            if wanted:
                self._forms[wanted].pack(fill="both", expand=True)
            self._shown = wanted
        if wanted:
            self._forms[wanted].refresh()

    def _sensor_title(self, skin: Skin, selected: Target) -> str:
        there = {s.id: s for s in skin.sensors}
        sensor, more = there[selected.sensor], sum(id in there for id in selected.also)
        return f"{sensor.id}: {sensor.pattern.kind} on {sensor.piece}" + (f", and {more} more" if more else "")
