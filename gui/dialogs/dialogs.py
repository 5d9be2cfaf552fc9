"""All that the window asks, in one place, so that a test can answer instead of a person."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Sequence
from pathlib import Path
from tkinter import filedialog

from gui.dialogs.number import ask_number
from gui.dialogs.open_mesh import MeshChoice, ask_how_to_open
from gui.dialogs.question import ask
from gui.jobs.tasks import MeshFacts

MESHES = "*.obj *.stl *.ply *.off *.glb *.gltf"


class Dialogs:
    """Real windows over `master`."""

    def __init__(self, master: tk.Misc) -> None:
        self._master = master

    def ask(self, title: str, text: str, answers: Sequence[str], *, cancel: str = "") -> str:
        """One of `answers`, or `cancel`."""
        return ask(self._master, title, text, answers, cancel=cancel)

    def open_path(self) -> Path | None:
        """A mesh or a skin to open."""
        kinds = [("meshes and skins", f"*.skin {MESHES}"), ("skins", "*.skin"), ("meshes", MESHES), ("all files", "*")]
        chosen = filedialog.askopenfilename(parent=self._master, title="Open a mesh or a skin", filetypes=kinds)
        return Path(chosen) if chosen else None

    def sensors_path(self) -> Path | None:
        """A sensors file."""
        chosen = filedialog.askopenfilename(parent=self._master, title="A sensors file", filetypes=[("sensors", "*.toml")])
        return Path(chosen) if chosen else None

    def number(self, title: str, text: str, *, least: int, most: int, value: int) -> int | None:
        """A whole number; None for no answer."""
        return ask_number(self._master, title, text, least=least, most=most, value=value)

    def open_file(self, title: str, kinds: Sequence[tuple[str, str]]) -> Path | None:
        """A file of one of these kinds: names with their patterns."""
        chosen = filedialog.askopenfilename(parent=self._master, title=title, filetypes=list(kinds))
        return Path(chosen) if chosen else None

    def save_path(self, title: str, suffix: str, name: str) -> Path | None:
        """Where to write a file; an existing one has been asked about."""
        chosen = filedialog.asksaveasfilename(
            parent=self._master, title=title, defaultextension=suffix, initialfile=name, filetypes=[(suffix[1:], f"*{suffix}")]
        )
        return Path(chosen) if chosen else None

    def folder(self, title: str) -> Path | None:
        """A folder for results."""
        chosen = filedialog.askdirectory(parent=self._master, title=title)
        return Path(chosen) if chosen else None

    def how_to_open(self, facts: MeshFacts) -> MeshChoice | None:
        """How to read a mesh file; None not to."""
        return ask_how_to_open(self._master, facts)
