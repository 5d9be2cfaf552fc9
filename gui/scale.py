"""Lengths on the screen that are as large on a fine one as on an ordinary one."""

from __future__ import annotations

import tkinter as tk

#: Dots an inch of an ordinary screen, for which lengths are written down.
ORDINARY_DPI = 96


def px(widget: tk.Misc, length: float) -> int:
    """Pixels of this screen for `length` pixels of an ordinary one."""
    return round(length * widget.winfo_fpixels("1i") / ORDINARY_DPI)
