"""A row of widgets that goes on below itself where the window is too narrow for it."""

from __future__ import annotations

import tkinter as tk
from tkinter import ttk
from typing import Any

from gui.scale import px


class Flow(ttk.Frame):
    """Lays widgets from left to right, and begins another row where there is no room.

    Parameters
    ----------
    master : widget
    margin : int
        Free at all sides, pixels of an ordinary screen.
    options
        Of the frame.
    """

    def __init__(self, master: tk.Misc, *, margin: int = 4, **options: Any) -> None:
        super().__init__(master, **options)
        self._margin = px(self, margin)
        self._shown: list[tuple[tk.Widget, int, bool]] = []
        self._waiting = ""
        self.bind("<Configure>", lambda event: self._soon(), add=True)
        self.bind("<Destroy>", self._destroyed, add=True)

    def add(self, widget: tk.Widget, *, padx: int = 1, divides: bool = False) -> None:
        """Put a widget, a child of this one, behind the others; one that `divides` is as high as its row, and begins none."""
        self._shown.append((widget, px(self, padx), divides))
        widget.bind("<Configure>", lambda event: self._soon(), add=True)
        self._soon()

    def _soon(self) -> None:
        if not self._waiting:
            self._waiting = self.after_idle(self._lay)

    def _lay(self) -> None:
        self._waiting = ""
        room, rows, used = self.winfo_width() - self._margin, [], self._margin
        row: list[tuple[tk.Widget, int, bool]] = []
        for widget, pad, divides in self._shown:
            wide = widget.winfo_reqwidth() + 2 * pad
            if row and not divides and used + wide > room > self._margin:
                rows.append(row)
                row, used = [], self._margin
            if row or not divides:
                row.append((widget, used + pad, divides))
                used += wide
            else:
                widget.place_forget()
        rows.append(row)
        top = self._margin // 2
        for row in rows:
            high = max((widget.winfo_reqheight() for widget, _, divides in row if not divides), default=0)
            for widget, left, _ in row:
                widget.place(x=left, y=top, height=high, width=widget.winfo_reqwidth())
            top += high
        wanted = top + self._margin // 2
        if wanted != self.winfo_reqheight():
            self.configure(height=wanted)

    def _destroyed(self, event: tk.Event) -> None:
        if event.widget is self and self._waiting:
            self.after_cancel(self._waiting)
            self._waiting = ""
