"""Files dragged in from a file manager."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from pathlib import Path

from tkinterdnd2 import TkinterDnD


def accept_files(root: tk.Tk, dropped: Callable[[Path], object]) -> bool:
    """Call `dropped` with the first of the files that are let go over the window.

    Returns
    -------
    bool
        Whether this screen and Tk can do that; everything else works without.
    """
    try:
        TkinterDnD._require(root)
        root.tk.call("tkdnd::drop_target", "register", root, "DND_Files")
    except (RuntimeError, tk.TclError):  # its library is not made for this Tk or machine
        return False

    def take(data: str) -> str:
        path = first_path(root, data)
        if path is not None:
            # Not within the other program's drag: a question would hold it up.
            root.after_idle(dropped, path)
        return "copy"

    root.tk.call("bind", root, "<<Drop:DND_Files>>", f"{root.register(take)} %D")
    return True


def first_path(root: tk.Misc, data: str) -> Path | None:
    """The first file of what was dropped, as Tk lists it: names with blanks are in braces."""
    names = root.tk.splitlist(data)
    return Path(names[0].removeprefix("file://")) if names else None
