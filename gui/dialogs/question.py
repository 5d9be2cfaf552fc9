"""A question with a button for each answer, in the window's own colours and reachable by keyboard."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Sequence
from functools import partial
from tkinter import ttk


def place_over(window: tk.Toplevel, master: tk.Misc) -> None:
    """Put a dialog over the middle of its master, all of it on the screen."""
    window.update_idletasks()
    top = master.winfo_toplevel()
    x = top.winfo_rootx() + (top.winfo_width() - window.winfo_reqwidth()) // 2
    y = top.winfo_rooty() + (top.winfo_height() - window.winfo_reqheight()) // 3
    window.geometry(f"+{max(x, 0)}+{max(y, 0)}")


def make_modal(window: tk.Toplevel, master: tk.Misc) -> None:
    """Show a dialog and wait until it is gone."""
    window.transient(master.winfo_toplevel())
    place_over(window, master)
    window.wait_visibility()
    window.grab_set()
    window.focus_set()
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
    ttk.Label(body, text=text, wraplength=460, justify="left", name="text").pack(anchor="w")
    row = ttk.Frame(body, name="buttons")
    row.pack(anchor="e", pady=(14, 0))
    for k, answer in enumerate(answers):
        button = ttk.Button(row, text=answer, command=partial(give, answer), name=f"answer{k}", default="active" if k == 0 else "normal")
        button.bind("<Return>", lambda event: event.widget.invoke())
        button.pack(side="left", padx=(6, 0))
    window.bind("<Escape>", lambda event: give(cancel))
    window.protocol("WM_DELETE_WINDOW", lambda: give(cancel))
    row.nametowidget("answer0").focus_set()
    window.after_idle(row.nametowidget("answer0").focus_set)
    make_modal(window, master)
    return given[0]
