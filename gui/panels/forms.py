"""Tabs of forms, as high as the one that is shown: what is left of the height is the list's above them."""

from __future__ import annotations

import tkinter as tk
from tkinter import ttk

from gui.state.session import Session, Topic

#: What may change a form's height.
_TOPICS: tuple[Topic, ...] = ("skin", "file", "selection", "tool")


class Forms(ttk.Notebook):
    """A notebook of forms that follow a session."""

    def __init__(self, master: tk.Misc, session: Session) -> None:
        super().__init__(master, name="forms")
        self._waiting = ""
        self.bind("<<NotebookTabChanged>>", lambda event: self._soon())
        self.bind("<Destroy>", self._destroyed, add=True)
        for topic in _TOPICS:
            session.listen(topic, self._soon)

    def _soon(self) -> None:
        # The forms change first, and then say how much room they need.
        if not self._waiting:
            self._waiting = self.after(1, self._fit)

    def _fit(self) -> None:
        self._waiting = ""
        self.update_idletasks()
        shown = self.select()
        if shown:
            self.configure(height=self.nametowidget(shown).winfo_reqheight())

    def _destroyed(self, event: tk.Event) -> None:
        if event.widget is self:
            if self._waiting:
                self.after_cancel(self._waiting)
            self._waiting = "none from now on"
