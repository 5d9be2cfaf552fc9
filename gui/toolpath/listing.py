"""The text of a program, the line under the head marked."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable, Sequence
from tkinter import ttk

from gui.theme import Theme


class Listing(ttk.Frame):
    """Numbered lines; a click on one asks for its moment.

    Parameters
    ----------
    master : widget
    theme : Theme
    on_line : callable
        Called with the number of a line that was clicked, from 1.
    """

    def __init__(self, master: tk.Misc, theme: Theme, *, on_line: Callable[[int], None]) -> None:
        super().__init__(master, name="listing")
        self._on_line = on_line
        self._lines: Sequence[str] = ()
        self.marked = 0
        self.text = tk.Text(self, height=6, width=10, wrap="none", font="TkFixedFont", borderwidth=0, name="text", cursor="arrow", padx=6)
        bar = ttk.Scrollbar(self, command=self.text.yview)
        self.text.configure(yscrollcommand=bar.set, state="disabled")
        bar.pack(side="right", fill="y")
        self.text.pack(side="left", fill="both", expand=True)
        self.text.bind("<ButtonRelease-1>", self._clicked)
        self.restyle(theme)

    def restyle(self, theme: Theme) -> None:
        """Other colours."""
        self.text.configure(background=theme.field, foreground=theme.text, insertbackground=theme.text, highlightthickness=0)
        self.text.configure(selectbackground=theme.border, selectforeground=theme.text)
        self.text.tag_configure("number", foreground=theme.faint)
        self.text.tag_configure("now", background=theme.accent, foreground=theme.on_accent)
        self.text.tag_raise("now")

    def show(self, lines: Sequence[str]) -> None:
        """Another text; the same one is left as it is."""
        if lines == self._lines:
            return
        self._lines, self.marked = lines, 0
        wide = len(str(len(lines)))
        words = [part for k, line in enumerate(lines, 1) for part in (f"{k:>{wide}}  ", "number", f"{line}\n", "")]
        self.text.configure(state="normal")
        self.text.delete("1.0", "end")
        if words:
            self.text.insert("end", *words)
        self.text.configure(state="disabled")

    def mark(self, line: int) -> None:
        """Mark a line and bring it into sight."""
        if line == self.marked:
            return
        self.marked = line
        self.text.tag_remove("now", "1.0", "end")
        self.text.tag_add("now", f"{line}.0", f"{line + 1}.0")
        # What comes next is seen too.
        for near in (line + 2, line - 2, line):
            self.text.see(f"{max(near, 1)}.0")

    def _clicked(self, event: tk.Event) -> None:
        line = int(self.text.index(f"@{event.x},{event.y}").split(".")[0])
        if line <= len(self._lines) and not self.text.tag_ranges("sel"):
            self._on_line(line)
