"""Which pattern the next sensor has: a list with pictures, and the parameters it needs."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from tkinter import ttk

import numpy as np

from gui.panels.field import Field, number
from gui.scale import px
from gui.state.profiles import ProfileShelf
from gui.state.session import Session
from gui.theme import Theme
from skinfab.drawings.catalogue import Entry, catalogue
from skinfab.errors import InputError, SkinfabError
from skinfab.patterns.base import Pattern
from skinfab.patterns.registry import make_pattern
from skinfab.placement.sensor import Sensor
from skinfab.tolerances import PREVIEW_CHORD_MM

#: Height of the picture, px of an ordinary screen.
_PICTURE = 84


class NewSensorPanel(ttk.Frame):
    """A pattern, its picture to shape, and its parameters.

    Parameters
    ----------
    master : widget
    session : Session
    shelf : ProfileShelf
        For the bead and gap of the document's material.
    theme : Theme
    complain : callable
        Shows a sentence, or a hint.
    place : callable
        Called by the button: take up the tool that places it.
    """

    def __init__(
        self,
        master: tk.Misc,
        session: Session,
        shelf: ProfileShelf,
        theme: Theme,
        *,
        complain: Callable[[str], None],
        place: Callable[[], object],
    ) -> None:
        super().__init__(master, name="new_sensor", padding=4)
        self._session, self._shelf, self._theme, self._complain = session, shelf, theme, complain
        self._entries = {entry.kind: entry for entry in catalogue()}
        self._params: dict[str, dict[str, float]] = {kind: dict(e.least) for kind, e in self._entries.items()}
        self.kind = tk.StringVar(self, value=next(iter(self._entries)))
        row = ttk.Frame(self, name="row")
        row.pack(fill="x")
        ttk.Label(row, text="new").pack(side="left")
        box = ttk.Combobox(row, textvariable=self.kind, values=list(self._entries), state="readonly", width=16, name="kind")
        box.pack(side="left", fill="x", expand=True, padx=4)
        box.bind("<<ComboboxSelected>>", lambda event: self._show())
        ttk.Button(row, text="Place", command=place, style="Tool.TButton", name="place").pack(side="right")
        self.picture = tk.Canvas(self, height=px(self, _PICTURE), highlightthickness=1, name="picture")
        self.picture.pack(fill="x", pady=3)
        self.picture.bind("<Configure>", lambda event: self._draw())
        self._fields = ttk.Frame(self, name="fields")
        self._fields.pack(fill="x")
        self._drawn_for = ""
        self.restyle(theme)
        self._show()
        session.listen("skin", self._other_material)

    def pattern(self) -> Pattern:
        """The one that is chosen, with the bead, gap and pad of the document's material.

        Raises
        ------
        InputError
            Its parameters do not go together.
        """
        return self._make(self.kind.get(), self._params[self.kind.get()])

    def restyle(self, theme: Theme) -> None:
        """Other colours."""
        self._theme = theme
        self.picture.configure(background=theme.view, highlightbackground=theme.border)
        self._draw()

    def _make(self, kind: str, params: dict[str, float]) -> Pattern:
        skin = self._session.skin
        given: dict[str, float] = dict(params)
        if skin is not None:
            material = self._shelf.of(skin).material
            given = {"bead": material.ink.bead_width, "gap": material.gap, "pad": material.pad, **given}
        return make_pattern(kind, given)

    def _show(self) -> None:
        """Fields of the chosen pattern: the parameters that must be given; all others follow, and can be changed once it is placed."""
        for child in self._fields.winfo_children():
            child.destroy()
        entry = self._entries[self.kind.get()]
        for parameter in entry.parameters:
            name = parameter.name
            if name in entry.least:
                unit = "mm" if parameter.unit == "mm" else ""
                field = Field(
                    self._fields,
                    name,
                    unit=unit,
                    tip=parameter.meaning,
                    name=name,
                    complain=self._complain,
                    take=self._taker(entry, name),
                )
                field.pack(fill="x", pady=1)
                field.show(f"{self._params[entry.kind][name]:g}")
        self._draw()

    def _taker(self, entry: Entry, name: str) -> Callable[[str], None]:
        def take(text: str) -> None:
            value = number(text, name)
            trial = self._params[entry.kind] | {name: int(value) if value == int(value) else value}
            self._make(entry.kind, trial)
            self._params[entry.kind] = trial
            self._draw()

        return take

    def _other_material(self) -> None:
        """Bead and gap may be others."""
        if self._session.skin is not None and self._session.skin.material != self._drawn_for:
            self._drawn_for = self._session.skin.material
            self._draw()

    def _draw(self) -> None:
        """The stroke as it is printed, as large as it fits."""
        canvas = self.picture
        canvas.delete("all")
        width, height = canvas.winfo_width(), px(self, _PICTURE)
        try:
            pattern = self.pattern()
        except SkinfabError as fault:
            if not isinstance(fault, InputError):
                raise
            canvas.create_text(width / 2, height / 2, text=str(fault), width=width - 10, fill=self._theme.error)
            return
        points = Sensor("", "", pattern, 0.0, 0.0, 0.0, 0).printed_path.to_polyline(tolerance=PREVIEW_CHORD_MM)
        low, size = points.min(axis=0), np.ptp(points, axis=0)
        scale = min((width - 16) / size[0], (height - 16) / size[1])
        if scale <= 0:
            return
        at = (points - low - size / 2) * scale * [1, -1] + [width / 2, height / 2]
        canvas.create_line(
            at.ravel().tolist(), fill=self._theme.ink, width=max(pattern.bead * scale, 1), capstyle="round", joinstyle="round"
        )
        canvas.create_text(6, height - 8, anchor="w", text=f"{size[0]:.0f} x {size[1]:.0f} mm", fill=self._theme.faint)
