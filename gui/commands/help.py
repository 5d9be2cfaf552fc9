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
            "Object: drag turns, Shift+drag moves, wheel zooms, click selects.\n"
            "Flat skin: drag a sensor to move it, its handle turns it, drag beside moves the sheet, wheel zooms.\n\n"
        )
        self._desk.dialogs.ask("Keys and mouse", mouse + "\n".join(f"{key}:  {what}" for key, what in self._keys()), ("Close",))

    def about(self) -> None:
        """Name, version, licence."""
        text = f"skinfab {__version__}\nFrom a 3D model to a printed, calibrated soft sensor skin.\nLicence: GPL-3.0-or-later."
        self._desk.dialogs.ask("About skinfab", text, ("Close",))
