"""How arcs are written, chosen in one place for what is shown and what is exported. Knows no widget."""

from __future__ import annotations

from collections.abc import Callable

from gcode.emit import Arcs

#: What may be chosen, in words; None: as the printer's profile says.
ARCS: dict[Arcs | None, str] = {None: "by the printer", "native": "G2 and G3", "lines": "straight lines"}


class ArcsChoice:
    """The choice, and who is told of it.

    Examples
    --------
    >>> choice = ArcsChoice()
    >>> told = []
    >>> choice.listen(lambda: told.append(choice.arcs))
    >>> choice.choose("lines"); choice.choose("lines"); told
    ['lines']
    """

    def __init__(self) -> None:
        self.arcs: Arcs | None = None
        self._listeners: list[Callable[[], None]] = []

    def choose(self, arcs: Arcs | None) -> None:
        """Take another."""
        if arcs != self.arcs:
            self.arcs = arcs
            for callback in self._listeners:
                callback()

    def listen(self, callback: Callable[[], None]) -> None:
        """Call `callback` whenever another was chosen."""
        self._listeners.append(callback)
