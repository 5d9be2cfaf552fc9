"""What the keys do, and what this is."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from gui.actions import Action
from gui.desk import Desk
from skinfab import __version__


class HelpCommands:
    """The Help menu.

    Parameters
    ----------
    desk : Desk
    keys : callable
        All keys and what they do.
    """

    def __init__(self, desk: Desk, keys: Callable[[], Iterable[tuple[str, str]]]) -> None:
        self._desk, self._keys = desk, keys

    def actions(self) -> list[Action]:
        """For the table."""
        return [
            Action("keys", "Keys and mouse", "Help", self.show_keys, "F1"),
            Action("about", "About skinfab", "Help", self.about),
        ]

    def show_keys(self) -> None:
        """A list of all keys, in two columns of text."""
        mouse = (
            "Object: drag turns, Ctrl+drag or the middle button moves, wheel zooms, click selects; arrows turn, 1 to 6 show the sides.\n"
            "Flat skin: drag a sensor to move it (Ctrl: without snapping), its handle to turn it; drag beside selects, the middle or right "
            "button moves the sheet, wheel zooms; arrows nudge by 0.1 mm, with Shift by 1 mm, [ and ] turn.\n"
            "By keys alone: F3 or F4 (or Enter in a view) begins a cursor; arrows move it, with Shift by a pixel, Enter clicks, "
            "Shift+Enter is Shift+click, Ctrl+arrows turn the object or move the sheet, + and - enlarge, Esc ends.\n\n"
        )
        self._desk.dialogs.ask("Keys and mouse", mouse + "\n".join(f"{key}:  {what}" for key, what in self._keys()), ("Close",))

    def about(self) -> None:
        """Name, version, licence."""
        text = f"skinfab {__version__}\nFrom a 3D model to a printed, calibrated soft sensor skin.\nLicence: GPL-3.0-or-later."
        self._desk.dialogs.ask("About skinfab", text, ("Close",))
