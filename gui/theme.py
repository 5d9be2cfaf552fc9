"""Light and dark: the colours of every widget and view, from one table, on plain ttk."""

from __future__ import annotations

import tkinter as tk
from dataclasses import dataclass
from tkinter import font, ttk

from gui.scale import px


@dataclass(frozen=True)
class Theme:
    """Colours, "#rrggbb".

    Parameters
    ----------
    name : "light" or "dark"
    window, panel, field : str
        Backgrounds: of the window, of panels and lists, of entries.
    view : str
        Background of the 3D and the flat view.
    text, faint, border : str
    accent, on_accent : str
        What is chosen or pressed, and words on it.
    select, hover : str
        What is selected, or under the pointer, in the views.
    seam, locked, forbidden : str
        Lines of seams.
    ink : str
        Conductors that fit.
    good, warning, error : str
        In words and in the views: fits, look here, does not fit.
    """

    name: str
    window: str
    panel: str
    field: str
    view: str
    text: str
    faint: str
    border: str
    accent: str
    on_accent: str
    select: str
    hover: str
    seam: str
    locked: str
    forbidden: str
    ink: str
    good: str
    warning: str
    error: str


LIGHT = Theme(
    name="light",
    window="#eceef1",
    panel="#f8f9fa",
    field="#ffffff",
    view="#ffffff",
    text="#1d2430",
    faint="#5d6878",
    border="#c3c9d2",
    accent="#1f5fae",
    on_accent="#ffffff",
    select="#e07b00",
    hover="#2f8fe0",
    seam="#b3122b",
    locked="#5b2a86",
    forbidden="#7a7f87",
    ink="#15181d",
    good="#1c7c3c",
    warning="#9a5b00",
    error="#c01530",
)

DARK = Theme(
    name="dark",
    window="#20242b",
    panel="#272c35",
    field="#1a1e24",
    view="#16191e",
    text="#e4e8ee",
    faint="#9aa5b4",
    border="#434b58",
    accent="#5aa2f0",
    on_accent="#0d1420",
    select="#ffab3d",
    hover="#6cc0ff",
    seam="#ff5c72",
    locked="#c79bf2",
    forbidden="#8d949e",
    ink="#f2f4f7",
    good="#5fd08a",
    warning="#f0b45a",
    error="#ff6b7e",
)

THEMES = {theme.name: theme for theme in (LIGHT, DARK)}


def rgb(colour: str) -> tuple[int, int, int]:
    """Three numbers from 0 to 255.

    Examples
    --------
    >>> rgb("#1f5fae")
    (31, 95, 174)
    """
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def apply(root: tk.Misc, theme: Theme) -> None:
    """Give every ttk widget, and tk's menus and lists, the colours of `theme`; call it again to change."""
    style = ttk.Style(root)
    style.theme_use("clam")
    base = {"background": theme.panel, "foreground": theme.text, "bordercolor": theme.border, "focuscolor": theme.accent}
    edges = {"lightcolor": theme.panel, "darkcolor": theme.panel, "troughcolor": theme.window}
    style.configure(".", **base, **edges, fieldbackground=theme.field, insertcolor=theme.text, arrowcolor=theme.text)
    style.configure("Window.TFrame", background=theme.window)
    style.configure("Faint.TLabel", foreground=theme.faint)
    style.configure("Title.TLabel", font=_bold(root))
    for kind in ("error", "warning", "good"):
        style.configure(f"{kind.title()}.TLabel", foreground=getattr(theme, kind))
    style.configure("TButton", padding=(8, 3), relief="raised", background=theme.panel)
    style.configure("Tool.TButton", padding=(6, 3), width="", relief="flat")
    style.configure("Tool.Toolbutton", padding=(5, 3), background=theme.panel)
    shades = [("pressed", theme.accent), ("active", theme.window)]
    style.map("TButton", background=shades, foreground=[("disabled", theme.faint), ("pressed", theme.on_accent)])
    chosen = [("disabled", theme.panel), ("selected", theme.accent), ("active", theme.window)]
    words = [("disabled", theme.faint), ("selected", theme.on_accent)]
    for name in ("Toolbutton", "Tool.Toolbutton"):
        style.map(name, background=chosen, foreground=words)
    for name in ("TCheckbutton", "TRadiobutton"):
        style.configure(name, upperbordercolor=theme.faint, lowerbordercolor=theme.faint, indicatorsize=px(root, 10))
        # The style's own map is stronger than what is configured, and white in any theme.
        style.map(name, background=[("active", theme.window)], indicatorbackground=[("selected", theme.accent), ("!selected", theme.field)])
        style.map(name, indicatorforeground=[("selected", theme.on_accent), ("!selected", theme.text)])
    for name in ("TEntry", "TSpinbox", "TCombobox"):
        style.configure(name, fieldbackground=theme.field, foreground=theme.text, padding=2, arrowsize=px(root, 12))
        style.map(name, fieldbackground=[("readonly", theme.field)], foreground=[("disabled", theme.faint), ("invalid", theme.error)])
    style.configure("Treeview", background=theme.field, fieldbackground=theme.field, foreground=theme.text, rowheight=_row_height(root))
    style.configure("Treeview.Heading", background=theme.window, relief="flat", padding=(4, 2))
    style.map("Treeview", background=[("selected", theme.accent)], foreground=[("selected", theme.on_accent)])
    style.configure("TNotebook", background=theme.window, borderwidth=0)
    style.configure("TNotebook.Tab", background=theme.window, padding=(10, 3))
    style.map("TNotebook.Tab", background=[("selected", theme.panel)], lightcolor=[], bordercolor=[])
    style.configure("TNotebook.Tab", lightcolor=theme.border, bordercolor=theme.border)
    style.configure("TSeparator", background=theme.border)
    style.configure("Sash", sashthickness=px(root, 6))
    style.configure("TScrollbar", background=theme.panel, troughcolor=theme.window, bordercolor=theme.border, arrowsize=px(root, 13))
    style.map("TScrollbar", background=[("disabled", theme.window), ("active", theme.border)], arrowcolor=[("disabled", theme.faint)])
    style.configure("TProgressbar", background=theme.accent)
    style.configure("TPanedwindow", background=theme.window)
    for option, value in (("background", theme.panel), ("foreground", theme.text)):
        root.option_add(f"*Menu.{option}", value)
        root.option_add(f"*Listbox.{option}", value)
        root.option_add(f"*TCombobox*Listbox.{option}", value)
    root.option_add("*TCombobox*Listbox.selectBackground", theme.accent)
    if isinstance(root, (tk.Tk, tk.Toplevel)):
        root.configure(background=theme.window)
    for child in root.winfo_children():
        _restyle_menus(child, theme)


def _restyle_menus(widget: tk.Misc, theme: Theme) -> None:
    """Menus are no ttk widgets: those that are there already are told."""
    if isinstance(widget, tk.Menu):
        widget.configure(background=theme.panel, foreground=theme.text, selectcolor=theme.text, borderwidth=0)
        widget.configure(activebackground=theme.accent, activeforeground=theme.on_accent, disabledforeground=theme.faint)
    for child in widget.winfo_children():
        _restyle_menus(child, theme)


def _bold(root: tk.Misc) -> font.Font:
    named = font.nametofont("TkDefaultFont", root=root).copy()
    named.configure(weight="bold")
    return named


def _row_height(root: tk.Misc) -> int:
    """A list's row at the screen's own resolution."""
    return int(font.nametofont("TkDefaultFont", root=root).metrics("linespace") * 1.35)
