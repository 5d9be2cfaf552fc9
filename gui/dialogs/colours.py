"""Tk's own dialogs in the window's colours: what is no ttk widget in them is black on white by itself."""

from __future__ import annotations

import tkinter as tk
from functools import partial

from gui.theme import Theme

#: Names that Tk gives to its file dialogs; they are kept for the next time, with the colours they were made with.
_DIALOGS = ("__tk_filedialog", "__tk_choosedir")
#: What changes what is chosen in the list of files; Tk then writes the rest in black.
_CHOOSING = ("<Button-1>", "<B1-Motion>", "<ButtonRelease-1>", "<KeyPress>", "<KeyRelease>")
#: Words of that list that are not chosen; Tk takes its tags off those that were.
_WORDS = "!icon&&!rect&&!selection&&!selectionText"


def colour_dialogs(root: tk.Tk, theme: Theme) -> None:
    """Give the dialogs that Tk will show the colours of `theme`; call it again to change."""
    for kind in ("TkFDialog", "TkChooseDir"):
        root.option_add(f"*{kind}*Canvas.foreground", theme.text)
    _drop_kept(root, ".")
    root.bind_class("Canvas", "<Map>", partial(_mapped, root, theme))


def _drop_kept(root: tk.Tk, widget: str) -> None:
    """Those that were shown before; by name, since they are no widgets of Python's."""
    for child in root.tk.splitlist(root.tk.call("winfo", "children", widget)):
        if str(child).rpartition(".")[2] in _DIALOGS:
            root.tk.call("destroy", child)
        else:
            _drop_kept(root, str(child))


def _mapped(root: tk.Tk, theme: Theme, event: tk.Event) -> None:
    """The list of files is a canvas that is made white."""
    canvas = str(event.widget)
    dialog, found, _ = canvas.partition(".contents.icons")
    if not found or dialog.rpartition(".")[2] not in _DIALOGS:
        return
    root.tk.call(canvas, "configure", "-background", theme.field)
    for event_name in _CHOOSING:
        script = f"+after idle {{if {{[winfo exists {canvas}]}} {{{canvas} itemconfigure {_WORDS} -fill {theme.text}}}}}"
        root.tk.call("bind", dialog, event_name, script)
