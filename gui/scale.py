"""Lengths on the screen that are as large on a fine one as on an ordinary one."""

from __future__ import annotations

import tkinter as tk
from tkinter import font

#: Dots an inch of an ordinary screen, for which lengths are written down.
ORDINARY_DPI = 96


def px(widget: tk.Misc, length: float) -> int:
    """Pixels of this screen for `length` pixels of an ordinary one."""
    return round(length * widget.winfo_fpixels("1i") / ORDINARY_DPI)


def fitting(root: tk.Tk, size: tuple[int, int]) -> tuple[int, int]:
    """A window's size at the screen's own dots an inch; of a screen that is smaller than that, the share it is of one of 1280 x 800."""
    (wide, high), screen = size, (root.winfo_screenwidth(), root.winfo_screenheight())
    return min(px(root, wide), screen[0] * wide // 1280), min(px(root, high), screen[1] * high // 800)


def measured(widget: tk.Misc, words: str) -> int:
    """Pixels that the heading of a column needs for its words."""
    return font.nametofont("TkHeadingFont", root=widget).measure(words) + px(widget, 12)
