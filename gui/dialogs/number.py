"""A question for a whole number, in the window's own colours."""

from __future__ import annotations

import tkinter as tk
from tkinter import ttk

from gui.dialogs.question import WIDE, make_modal


def ask_number(master: tk.Misc, title: str, text: str, *, least: int, most: int, value: int) -> int | None:
    """Ask, and wait for a number from `least` to `most`.

    Parameters
    ----------
    master : widget
    title, text : str
    least, most, value : int
        Bounds, and what stands there at first.

    Returns
    -------
    int or None
        None for Cancel, Escape, or where the dialog is closed.
    """
    window = tk.Toplevel(master, name="number", background=ttk.Style(master).lookup(".", "background"))
    window.title(title)
    window.resizable(False, False)
    given: list[int] = []
    body = ttk.Frame(window, padding=16, name="body")
    body.pack(fill="both", expand=True)
    ttk.Label(body, text=text, wraplength=WIDE, justify="left", name="text").pack(anchor="w")
    field = ttk.Spinbox(body, from_=least, to=most, width=8, name="field")
    field.set(value)
    field.pack(anchor="w", pady=(10, 0))
    wrong = ttk.Label(body, style="Error.TLabel", name="wrong")
    wrong.pack(anchor="w")

    def take() -> None:
        words = field.get().strip()
        if words.isdecimal() and least <= int(words) <= most:
            given.append(int(words))
            window.destroy()
        else:
            wrong.configure(text=f"a whole number from {least} to {most}, please")
            field.focus_set()
            field.selection_range(0, "end")

    row = ttk.Frame(body, name="buttons")
    row.pack(anchor="e", pady=(10, 0))
    for name, words, command in (("ok", "OK", take), ("cancel", "Cancel", window.destroy)):
        button = ttk.Button(row, text=words, command=command, name=name, default="active" if name == "ok" else "normal")
        button.bind("<Return>", lambda event: event.widget.invoke())
        button.pack(side="left", padx=(6, 0))
    field.bind("<Return>", lambda event: take())
    window.bind("<Escape>", lambda event: window.destroy())
    field.selection_range(0, "end")
    make_modal(window, master, field)
    return given[0] if given else None
