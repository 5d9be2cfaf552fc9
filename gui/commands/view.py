"""How things are shown."""

from __future__ import annotations

from collections.abc import Callable
from tkinter import ttk

from gui.actions import Action
from gui.desk import Desk
from gui.state.session import SHADINGS
from gui.theme import THEMES
from gui.view2d.view import View2D
from gui.view3d.view import View3D

_LABELS = {
    "pieces": "Colour by piece",
    "distortion": "Distortion",
    "checker": "Checker board",
    "preferences": "Where seams are wanted",
}


class ViewCommands:
    """The View menu.

    Parameters
    ----------
    desk : Desk
    view3d, view2d : the views
    theme : callable
        Name of the theme now.
    use_theme : callable
        Takes another.
    """

    def __init__(self, desk: Desk, view3d: View3D, view2d: View2D, *, theme: Callable[[], str], use_theme: Callable[[str], None]) -> None:
        self._desk, self._view3d, self._view2d = desk, view3d, view2d
        self._theme, self._use_theme = theme, use_theme

    def actions(self) -> list[Action]:
        """For the table."""
        session = self._desk.session

        def shading(k: int, name: str) -> Action:
            return Action(
                f"shade_{name}",
                _LABELS[name],
                "View",
                lambda: session.shade(name),
                f"Control-Key-{k + 1}",
                checked=lambda: session.shading == name,
            )

        return [
            *(shading(k, name) for k, name in enumerate(SHADINGS)),
            Action("fit", "Show all", "View", self.fit, "Home", self._desk.has_skin),
            Action("point3d", "Cursor on the object", "View", self._view3d.cursor.begin, "F3", self._desk.has_skin),
            Action("point2d", "Cursor on the flat skin", "View", self._point_at_flat, "F4", self._desk.has_skin),
            Action("grid", "Grid", "View", self._toggle_grid, "Control-g", checked=lambda: self._view2d.grid_shown),
            Action("dark", "Dark", "View", self._toggle_dark, "Control-d", checked=lambda: self._theme() == "dark"),
        ]

    def fit(self) -> None:
        """All of the object and all pieces."""
        self._view3d.fit()
        self._view2d.fit()

    def _point_at_flat(self) -> None:
        tabs = self._view2d.master
        if isinstance(tabs, ttk.Notebook):  # another of its tabs may be in front
            tabs.select(self._view2d)
            self._view2d.update_idletasks()
        self._view2d.cursor.begin()

    def _toggle_grid(self) -> None:
        self._view2d.show_grid(not self._view2d.grid_shown)

    def _toggle_dark(self) -> None:
        names = list(THEMES)
        self._use_theme(names[1 - names.index(self._theme())])
