"""A question with a button for each answer, in the window's own colours and reachable by keyboard."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Sequence
from functools import partial
from tkinter import ttk

#: Longest line of a question, px; more lines in a row than a low screen shows are set in two columns.
WIDE, MOST_LINES = 560, 20


def place_over(window: tk.Toplevel, master: tk.Misc) -> None:
    """Put a dialog over the middle of its master, all of it on the screen."""
    window.update_idletasks()
    top = master.winfo_toplevel()
    x = top.winfo_rootx() + (top.winfo_width() - window.winfo_reqwidth()) // 2
    y = top.winfo_rooty() + (top.winfo_height() - window.winfo_reqheight()) // 3
    window.geometry(f"+{max(x, 0)}+{max(y, 0)}")


def make_modal(window: tk.Toplevel, master: tk.Misc, first: tk.Misc) -> None:
    """Show a dialog with the focus on `first`, and wait until it is gone."""
    window.transient(master.winfo_toplevel())
    place_over(window, master)
    try:
        window.wait_visibility()
    except tk.TclError:
        if window.winfo_exists():
            raise
        return  # closed before it was seen
    window.grab_set()
    first.focus_set()
    window.wait_window()


def ask(master: tk.Misc, title: str, text: str, answers: Sequence[str], *, cancel: str = "") -> str:
    """Ask, and wait for the answer.

    Parameters
    ----------
    master : widget
    title, text : str
    answers : sequence of str
        Buttons, the usual answer first: it is the one that Enter gives.
    cancel : str
        What Escape and closing the dialog give.

    Returns
    -------
    str
        One of `answers`, or `cancel`.
    """
    window = tk.Toplevel(master, name="question", background=ttk.Style(master).lookup(".", "background"))
    window.title(title)
    window.resizable(False, False)
    given = [cancel]

    def give(answer: str) -> None:
        given[0] = answer
        window.destroy()

    body = ttk.Frame(window, padding=16, name="body")
    body.pack(fill="both", expand=True)
    short, long = _parted(text)
    ttk.Label(body, text=short, wraplength=WIDE, justify="left", name="text").pack(anchor="w")
    if long:
        columns = ttk.Frame(body, name="columns")
        columns.pack(fill="x", pady=(12, 0))
        for lines in (long[: (len(long) + 1) // 2], long[(len(long) + 1) // 2 :]):
            ttk.Label(columns, text="\n".join(lines), justify="left").pack(side="left", anchor="n", padx=(0, 24))
    row = ttk.Frame(body, name="buttons")
    row.pack(anchor="e", pady=(14, 0))
    for k, answer in enumerate(answers):
        button = ttk.Button(row, text=answer, command=partial(give, answer), name=f"answer{k}", default="active" if k == 0 else "normal")
        button.bind("<Return>", lambda event: event.widget.invoke())
        button.pack(side="left", padx=(6, 0))
    window.bind("<Escape>", lambda event: give(cancel))
    window.protocol("WM_DELETE_WINDOW", lambda: give(cancel))
    make_modal(window, master, row.nametowidget("answer0"))
    return given[0]


def _parted(text: str) -> tuple[str, list[str]]:
    """What comes before the last blank line, and the lines behind it where they are too many for one column."""
    head, _, tail = text.rpartition("\n\n")
    lines = tail.split("\n")
    return (head, lines) if len(lines) > MOST_LINES else (text, [])
