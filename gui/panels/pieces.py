"""The list of flat pieces with their size and distortion."""

from __future__ import annotations

import tkinter as tk
from tkinter import font, ttk

from gui.scale import measured, px
from gui.state.derived import Derived
from gui.state.selection import NOTHING, Target
from gui.state.session import Session

#: Name, heading, and px at 96 dots an inch that its values need; a column is wider where its heading, or a value, needs that.
_COLUMNS = (("id", "id", 40), ("size", "size, mm", 74), ("mean", "d mean", 44), ("p99", "p99", 40), ("max", "max", 40))

#: What a cell leaves free beside its words, px at 96 dots an inch.
_BESIDE = 10


class PiecesPanel(ttk.Frame):
    """One line a piece; the selection is the views' own."""

    def __init__(self, master: tk.Misc, session: Session, derived: Derived) -> None:
        super().__init__(master, name="pieces", padding=4)
        self._session, self._derived = session, derived
        self.summary = tk.StringVar(self)
        ttk.Label(self, textvariable=self.summary, style="Faint.TLabel", wraplength=px(self, 290), name="summary").pack(
            anchor="w", pady=(0, 2)
        )
        rows = ttk.Frame(self)
        rows.pack(fill="both", expand=True)
        self.list = ttk.Treeview(rows, columns=[c[0] for c in _COLUMNS], show="headings", height=3, selectmode="browse", name="list")
        for name, heading, width in _COLUMNS:
            self.list.heading(name, text=heading)
            least = max(px(self, width), measured(self, heading))
            self.list.column(name, width=least, minwidth=least, anchor="w" if name == "id" else "e", stretch=name == "size")
        bar = ttk.Scrollbar(rows, command=self.list.yview)
        self.list.configure(yscrollcommand=bar.set)
        bar.pack(side="right", fill="y")
        self.list.pack(side="left", fill="both", expand=True)
        self.list.bind("<<TreeviewSelect>>", self._chosen)
        session.listen("skin", self._refresh)
        session.listen("selection", self._follow)
        self._refresh()

    def _refresh(self) -> None:
        skin = self._session.skin
        if skin is not None and not self._derived.ready(skin, self._refresh):
            return
        self.list.delete(*self.list.get_children())
        if skin is None:
            self.summary.set("Nothing is open.")
            return
        for piece in skin.pieces:
            d = self._derived.distortion(skin.mesh, piece)
            size = f"{piece.size[0]:.0f} x {piece.size[1]:.0f}"
            self.list.insert("", "end", iid=piece.id, values=(piece.id, size, _short(d.mean, 3), _short(d.p99), _short(d.max)))
        self._widen()
        loose = int((self._derived.piece_of_face(skin) < 0).sum())
        words = f"{len(skin.mesh.F)} triangles, {len(skin.pieces)} piece{'' if len(skin.pieces) == 1 else 's'}"
        self.summary.set(words + (f"; {loose} triangles do not lie flat yet" if loose else ""))
        self._follow()

    def _widen(self) -> None:
        """Large pieces have long sizes, bad ones long figures: none is cut off."""
        letters = font.nametofont(str(ttk.Style(self).lookup("Treeview", "font")) or "TkDefaultFont", root=self)
        for name, heading, width in _COLUMNS[1:]:
            shown = [self.list.set(id, name) for id in self.list.get_children()]
            least = max(px(self, width), measured(self, heading), *(letters.measure(words) + px(self, _BESIDE) for words in shown))
            if least != self.list.column(name, "minwidth"):
                self.list.column(name, width=least, minwidth=least)

    def _follow(self) -> None:
        """Select what the session has selected."""
        piece = self._selected_piece()
        wanted = (piece,) if piece and self.list.exists(piece) else ()
        if self.list.selection() != wanted:
            self.list.selection_set(wanted)
            if wanted:
                self.list.see(piece)

    def _selected_piece(self) -> str:
        """The piece that is selected, or on which the selected sensor lies by now: it may have been dragged to another."""
        skin, selected = self._session.skin, self._session.selected
        if skin is None or not selected.sensor:
            return selected.piece
        return next((s.piece for s in skin.sensors if s.id == selected.sensor), selected.piece)

    def _chosen(self, event: tk.Event) -> None:
        chosen = self.list.selection()
        selected = self._session.selected
        if chosen and chosen[0] != self._selected_piece():
            self._session.select(Target(piece=chosen[0]))
        elif not chosen and selected.piece and not selected.sensor:
            self._session.select(NOTHING)


def _short(d: float, digits: int = 2) -> str:
    """So many digits behind the point, where there is one to speak of.

    Examples
    --------
    >>> _short(4.107), _short(23.791), _short(1234567.0)
    ('4.11', '23.79', '1.23e+06')
    """
    return f"{d:.{digits}f}" if d < 100 else f"{d:.3g}"
