"""An entry that takes a value when it is a good one, and says what is wrong while it is not."""

from __future__ import annotations

import math
import tkinter as tk
from collections.abc import Callable
from tkinter import ttk

from skinfab.errors import InputError, SkinfabError

#: The bit of an event's state that says Shift is down.
_SHIFT = 0x1


class Field(ttk.Frame):
    """A label, an entry and a unit in a row.

    Enter, Tab or a click elsewhere takes the text; Escape takes it back. What cannot be taken stays, in the colour of errors, with
    its sentence given to `complain`.

    Parameters
    ----------
    master : widget
    label, unit : str
    take : callable
        Called with the text; raises SkinfabError where it is not good.
    complain : callable
        Called with a sentence, or "" once all is well again.
    tip : str
        Shown by `complain` while the pointer is over the label.
    """

    def __init__(
        self,
        master: tk.Misc,
        label: str,
        *,
        take: Callable[[str], None],
        complain: Callable[[str], None],
        unit: str = "",
        tip: str = "",
        name: str,
        width: int = 9,
    ) -> None:
        super().__init__(master, name=name)
        self._take, self._complain = take, complain
        self._shown = ""
        self.columnconfigure(0, weight=1)
        words = ttk.Label(self, text=label)
        words.grid(row=0, column=0, sticky="w")
        self.entry = ttk.Entry(self, width=width, justify="right", name="entry")
        self.entry.grid(row=0, column=1, padx=3)
        ttk.Label(self, text=unit, style="Faint.TLabel", width=3).grid(row=0, column=2, sticky="w")
        for key in ("<Return>", "<KP_Enter>", "<FocusOut>"):
            self.entry.bind(key, lambda event: self.commit())
        self.entry.bind("<Escape>", self._escaped)
        if tip:
            words.bind("<Enter>", lambda event: complain(tip))
            words.bind("<Leave>", lambda event: complain(""))

    def show(self, text: str) -> None:
        """Show a value, unless the user is at work on another."""
        if self.entry.get() != self._shown and self.focus_displayof() is self.entry:
            return
        self._shown = text
        self._write(text)

    @property
    def pending(self) -> bool:
        """Whether there is text in it that was not taken."""
        return self.entry.get().strip() != self._shown

    def commit(self) -> bool:
        """Take the text; whether it could be taken."""
        text = self.entry.get().strip()
        if text == self._shown:
            self._write(self._shown)
            return True
        try:
            self._take(text.replace(",", "."))
        except SkinfabError as fault:
            self.entry.state(["invalid"])
            self._complain(str(fault))
            return False
        self._shown = text
        self.entry.state(["!invalid"])
        self._complain("")
        return True

    def revert(self) -> None:
        """Show the value again that was taken last."""
        self._write(self._shown)
        self._complain("")

    def _escaped(self, event: tk.Event) -> str:
        self.revert()
        return "break"

    def _write(self, text: str) -> None:
        self.entry.state(["!invalid"])
        self.entry.delete(0, "end")
        self.entry.insert(0, text)


def focused(widget: tk.Misc) -> Field | None:
    """The field of the window of `widget` that is being typed in."""
    focus = widget.focus_displayof()
    return focus.master if focus is not None and isinstance(focus.master, Field) else None


def select_all_by_key(root: tk.Misc) -> None:
    """Ctrl+A selects the text of every entry there is and will be; by itself Tk goes to the line's beginning."""

    def pressed(event: tk.Event) -> str | None:
        if int(event.state) & _SHIFT:
            return None  # another key
        # By name: the entries of Tk's own file dialogs are no widgets of Python's.
        root.tk.call(str(event.widget), "selection", "range", 0, "end")
        root.tk.call(str(event.widget), "icursor", "end")
        return "break"

    for kind in ("TEntry", "Entry", "TSpinbox", "Spinbox"):
        for key in ("<Control-a>", "<Control-A>"):  # the second with Caps Lock
            root.bind_class(kind, key, pressed)


def number(text: str, what: str) -> float:
    """A finite number from a field's text.

    Raises
    ------
    InputError
        It is none; names `what`.

    Examples
    --------
    >>> number("12.5", "x")
    12.5
    """
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{what} is {text!r}; it must be a number")
    return value
