"""Light and dark are complete, and words can be read in both."""

import re
import tkinter as tk
from dataclasses import fields
from tkinter import ttk

import pytest

from gui.theme import THEMES, apply, rgb


def luminance(colour):
    """Relative luminance as WCAG 2 defines it."""
    channels = [c / 255 for c in rgb(colour)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a, b):
    light, dark = sorted((luminance(a), luminance(b)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("theme", THEMES.values(), ids=THEMES)
def test_every_colour_is_one(theme):
    assert all(re.fullmatch("#[0-9a-f]{6}", getattr(theme, f.name)) for f in fields(theme) if f.name != "name")


@pytest.mark.parametrize("theme", THEMES.values(), ids=THEMES)
@pytest.mark.parametrize("word", ["text", "faint", "good", "warning", "error"])
def test_words_can_be_read_on_panels_and_fields(theme, word):
    assert min(contrast(getattr(theme, word), getattr(theme, ground)) for ground in ("panel", "field", "window")) >= 4.5


@pytest.mark.parametrize("theme", THEMES.values(), ids=THEMES)
def test_lines_stand_out_from_the_views(theme):
    assert min(contrast(getattr(theme, line), theme.view) for line in ("select", "hover", "seam", "locked", "forbidden", "ink")) >= 2.5


def test_menus_follow(root):
    menu = tk.Menu(root)
    for theme in THEMES.values():
        apply(root, theme)
        assert str(menu.cget("background")) == theme.panel


def test_a_window_can_change_its_theme(root):
    for theme in THEMES.values():
        apply(root, theme)
        assert ttk.Style(root).lookup("Treeview", "background") == theme.field
        assert root.cget("background") == theme.window
