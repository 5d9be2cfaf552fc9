"""Open, save and close."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from gcode.printer import DEFAULT_PRINTER
from gui.actions import Action
from gui.desk import Desk
from gui.jobs import tasks
from gui.state.autosave import Autosave, Left
from gui.state.store import Remembered, remember
from skinfab.document import save_skin
from skinfab.errors import SkinfabError
from skinfab.material import DEFAULT_MATERIAL
from skinfab.skin import Skin


class FileCommands:
    """The File menu but for exports.

    Parameters
    ----------
    desk : Desk
    autosave : Autosave
    remembered : Remembered
        From the last run; `remembered` is kept up to date.
    opened : callable
        Called once a document is open, to show all of it.
    """

    def __init__(self, desk: Desk, autosave: Autosave, remembered: Remembered, *, opened: Callable[[], None]) -> None:
        self._desk, self._autosave, self._opened = desk, autosave, opened
        self.remembered = remembered
        desk.session.listen("skin", self._keep_copy)
        desk.session.listen("file", self._keep_copy)

    def actions(self) -> list[Action]:
        """For the table."""
        has = self._desk.has_skin
        return [
            Action("open", "Open …", "File", self.open, "Control-o", tip="Open a mesh or a skin document.", tool=True),
            Action("save", "Save", "File", self.save, "Control-s", has, "Save the skin document.", tool=True),
            Action("save_as", "Save as …", "File", self.save_as, "Control-Shift-S", has),
        ]

    def fill_recent(self, menu: tk.Menu) -> None:
        """Entries of the recent files."""
        for path in self.remembered.recent:
            menu.add_command(label=path, command=partial(self.open_path, Path(path)))
        if not self.remembered.recent:
            menu.add_command(label="none yet", state="disabled")

    def open(self) -> None:
        """Ask for a file and open it."""
        path = self._desk.dialogs.open_path()
        if path is not None:
            self.open_path(path)

    def open_path(self, path: Path) -> None:
        """Open a mesh or a skin, once unsaved work is seen to."""
        if not self.may_leave():
            return
        left = self._desk.session.skin
        if path.suffix.lower() == ".skin":
            self._desk.work("opening", tasks.open_skin, lambda o: self._take(o, path, left), source="open", path=path)
        else:
            self._desk.work("looking at the mesh", tasks.look_at_mesh, lambda f: self._ask_about(f, path, left), source="open", path=path)

    def _ask_about(self, facts: tasks.MeshFacts, path: Path, left: Skin | None) -> None:
        choice = self._desk.dialogs.how_to_open(facts)
        if choice is None:
            return
        skin = self._desk.session.skin
        printer, material = (skin.printer, skin.material) if skin is not None else (DEFAULT_PRINTER, DEFAULT_MATERIAL)
        self._desk.work(
            "opening",
            tasks.open_mesh,
            lambda o: self._take(o, path, left),
            source="open",
            path=path,
            units=choice.units,
            mend=choice.repair,
            wrap_mm=choice.wrap_mm,
            printer=printer,
            material=material,
        )

    def _take(self, opened: tasks.Opened, path: Path, left: Skin | None) -> None:
        """Show it in place of the document that was given up for it, which may have been changed since."""
        if self._desk.session.skin is not left and not self.may_leave():
            self._desk.say(f"{path.name} was not opened.")
            return
        is_document = path.suffix.lower() == ".skin"
        # A mesh that was only opened holds no work that could be lost.
        self._desk.session.open(opened.skin, path if is_document else None, saved=True)
        self._desk.note("open", opened.notes)
        self._remember(path)
        self._opened()

    def recover(self, left: Left) -> None:
        """Open what a crash has left; it stays unsaved."""

        def load() -> None:
            self._desk.session.open(left.load(), left.path, saved=False)
            left.discard()
            self._keep_copy()
            self._opened()

        self._desk.guarded("open", load)

    def save(self) -> bool:
        """Save where it came from, or ask where; whether it was."""
        path = self._desk.session.path
        return self.save_as() if path is None else self._save(path)

    def save_as(self) -> bool:
        """Ask where, and save; whether it was."""
        stem = Path(self._desk.skin.source.file).stem
        path = self._desk.dialogs.save_path("Save the skin", ".skin", f"{stem}.skin")
        if path is None:
            return False
        return self._save(path if path.suffix.lower() == ".skin" else path.with_name(path.name + ".skin"))

    def may_leave(self) -> bool:
        """Ask about unsaved work where there is some; whether the document may be left."""
        session = self._desk.session
        if not self._desk.settle():
            return False
        if session.skin is None or not session.dirty:
            return True
        name = session.path.name if session.path is not None else session.skin.source.file
        answer = self._desk.dialogs.ask(
            "Unsaved work", f"The skin of {name} has changes that are not saved.", ("Save", "Do not save", "Cancel"), cancel="Cancel"
        )
        return answer == "Do not save" or (answer == "Save" and self.save())

    def _save(self, path: Path) -> bool:
        try:
            save_skin(self._desk.skin, path)
        except SkinfabError as fault:
            self._desk.complain("save", str(fault))
            return False
        self._desk.session.report("save", [])
        self._desk.session.mark_saved(path)
        self._desk.say(f"Saved {path}.")
        self._remember(path)
        return True

    def _remember(self, path: Path) -> None:
        """Among the recent files, written at once: a crash must not take it."""
        self.remembered = self.remembered.with_recent(path)
        self._write()

    def keep(self, *, theme: str, geometry: str | None = None) -> None:
        """Remember the window's colours, and its place too where that is given, from now on."""
        self.remembered = replace(self.remembered, theme=theme, geometry=self.remembered.geometry if geometry is None else geometry)
        self._write()

    def _write(self) -> None:
        self._desk.guarded("remember", lambda: remember(self._desk.state, self.remembered))

    def _keep_copy(self) -> None:
        session = self._desk.session
        if session.skin is not None and session.dirty:
            self._autosave.keep(session.skin, session.path)
        else:
            self._autosave.drop()
