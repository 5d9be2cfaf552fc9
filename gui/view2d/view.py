"""The flat view: pieces side by side, seams with the labels of the 3D view, sensors that can be dragged."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from tkinter import ttk

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gui.cursor import KeyCursor
from gui.shades import face_colours
from gui.state.derived import Derived, Part
from gui.state.session import Session
from gui.theme import Theme
from gui.view2d.background import BAR_PX, RULER_PX, Ground, paint_faces, paint_frame, paint_lines
from gui.view2d.fill import fill
from gui.view2d.hands import Hands
from gui.view2d.headings import paint_names
from gui.view2d.hit import REACH_PX, Hit2D, hit
from gui.view2d.labels import Taken, paint_labels, paint_small_names
from gui.view2d.lines import Lines
from gui.view2d.live import Live
from gui.view2d.marking import HANDLE_PX, Marker, Shown
from gui.view2d.pen import Pen
from gui.view2d.plane import Plane
from gui.view2d.sheet import Sheet
from gui.view2d.surface import Surface
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin

Float = NDArray[np.float64]

#: Pixels left free round the pieces when they are fitted into the view.
_BORDER_PX = 44


class View2D(ttk.Frame):
    """The flat pieces of the open document.

    Parameters
    ----------
    master : tkinter widget
    session : Session
    derived : Derived
    theme : Theme
    on_click, on_drag, on_release, on_point : callable, optional
        What the current tool does with a `Hit2D` (``on_click`` also takes whether Shift is down; ``on_point`` is told where
        the pointer is while nothing is pressed, None where it has left). The tool "select" this view knows itself: it is told
        of no clicks. They may be set later.
    name : str
        Tk name.
    """

    def __init__(
        self,
        master: tk.Misc,
        session: Session,
        derived: Derived,
        theme: Theme,
        *,
        on_click: Callable[[Hit2D, bool], object] | None = None,
        on_drag: Callable[[Hit2D], object] | None = None,
        on_release: Callable[[Hit2D | None], object] | None = None,
        on_point: Callable[[Hit2D | None], object] | None = None,
        name: str = "view2d",
    ) -> None:
        super().__init__(master, name=name)
        self.session, self.derived, self.theme = session, derived, theme
        self.on_click, self.on_drag, self.on_release, self.on_point = on_click, on_drag, on_release, on_point
        self.lines, self.live = Lines(), Live()
        self.plane = Plane()
        self.sheet: Sheet | None = None
        self.grid_shown = True
        self._fitted = True
        self._face: tuple[object, ...] = ()
        self._triangles = np.zeros((0, 0), dtype=np.int32)
        self._shown: dict[str, Shown] = {}
        self.surface = Surface(self, still=self._draw_still, moving=self._draw_moving)
        self.surface.widget.pack(fill="both", expand=True)
        self.hands = Hands(self)
        self.cursor = KeyCursor(self.hands, self.surface.widget, colours=lambda: (self.theme.accent, self.theme.view))
        session.listen("skin", self._on_skin)
        session.listen("file", self.fit)
        session.listen("shading", self.redraw)
        session.listen("tool", self._on_tool)
        session.listen("selection", self._on_selection)
        session.listen("hover", self.surface.refresh)
        self._skin: Skin | None = None
        derived.needs(self._parts)
        self.restyle(theme)
        self._on_skin()

    # What is seen

    def restyle(self, theme: Theme) -> None:
        """Change colours."""
        self.theme = theme
        # A line round it shows that keys go there, as round the object.
        self.surface.widget.configure(highlightthickness=1, highlightbackground=theme.border, highlightcolor=theme.accent)
        self.redraw()

    def fit(self) -> None:
        """Show all pieces as large as they fit, also when the window changes its size."""
        self._fitted = True
        self.redraw()

    def look(self, plane: Plane) -> None:
        """Show another part of the sheet."""
        self.plane, self._fitted = plane, False
        self.redraw()

    def zoom(self, factor: float, at: ArrayLike | None = None) -> None:
        """So many times as large, about a pixel or the middle."""
        self.look(self.plane.zoomed(factor, np.array(self.surface.size) / 2 if at is None else at))

    def show_grid(self, shown: bool) -> None:
        """With or without lines every round number of mm."""
        self.grid_shown = shown
        self.redraw()

    def show(self, name: str, lines: Sequence[tuple[str, ArrayLike]], colour: str, width: float = 2.0, *, words: str = "") -> None:
        """Put lines over the pieces until `hide` is called with the same name: pairs of a piece's id and points (k, 2) mm of it."""
        if self.sheet is None:
            return
        parts = tuple(np.asarray(points, dtype=float).reshape(-1, 2) + self.sheet.offset_of(piece) for piece, points in lines)
        self._shown[name] = Shown(parts, colour, width, words)
        self.surface.refresh()

    def hide(self, name: str) -> None:
        """Take them away again."""
        if self._shown.pop(name, None) is not None:
            self.surface.refresh()

    def redraw(self) -> None:
        """Draw everything anew, soon; many calls are one."""
        self.surface.draw_idle()

    # What is where

    def pixel(self, x: int, y: int) -> Float:
        """Of an event's place, counted right and up."""
        return np.array([x + 0.5, self.surface.size[1] - y - 0.5])

    def mm(self, pixels: float) -> float:
        """How long so many pixels of an ordinary screen are on the sheet."""
        return pixels * self.surface.ratio / self.plane.scale

    def hit(self, x: int, y: int) -> Hit2D | None:
        """What is under an event's place; None before anything is opened."""
        skin, sheet = self._skin, self.sheet
        if skin is None or sheet is None or skin is not self.session.skin:
            return None
        at = self.plane.to_mm(self.pixel(x, y))
        return hit(skin, sheet, self.lines, at, self.triangle(x, y), reach=self.mm(REACH_PX))

    def triangle(self, x: int, y: int) -> int:
        """Index into ``sheet.F`` of what is under an event's place; -1 where there is none."""
        rows, columns = self._triangles.shape
        return int(self._triangles[y, x]) if 0 <= y < rows and 0 <= x < columns else -1

    def handle(self) -> tuple[Sensor, Float] | None:
        """The sensor that has a handle to turn it, and where that is, mm of the sheet."""
        skin, target = self._skin, self.session.selected
        if skin is None or self.sheet is None or target.also:
            return None
        for sensor in skin.sensors:
            if sensor.id == target.sensor:
                return sensor, self.lines.handle(sensor, self.sheet, beyond=self.mm(HANDLE_PX))
        return None

    def place_of(self, sensor: str) -> tuple[int, int]:
        """Where the middle of a sensor is, as events count: for a menu or a test."""
        assert self._skin is not None and self.sheet is not None
        (found,) = (s for s in self._skin.sensors if s.id == sensor)
        x, y = self.plane.to_px(self.lines.middle(found, self.sheet))
        return round(x), round(self.surface.size[1] - y)

    # What has changed

    def _on_skin(self) -> None:
        skin = self.session.skin
        self.hands.document_changed()
        if skin is None:
            self._skin = self.sheet = None
            self.redraw()
            return
        if not self.derived.ready(skin, self._on_skin):
            return  # until it can be shown, the one before stays
        self._skin = skin
        sheet = self.derived.once("sheet view", _sheet_of(skin), lambda: Sheet(skin, self.derived))
        if self.sheet is not sheet:
            self.sheet = sheet
            self._shown.clear()
        self.live.look(skin)
        self.session.report("sensors", self.live.problems(skin))
        if not self.hands.changes_skin():
            self.redraw()

    def _parts(self, skin: Skin) -> Iterable[Part]:
        """What takes long of what this view shows."""
        yield Part("sheet view", _sheet_of(skin), sum(len(p.F) for p in skin.pieces) // 4, lambda: Sheet(skin, self.derived).prepared())
        yield from self.live.parts(skin)

    def _on_selection(self) -> None:
        # The rulers count from the selected piece.
        self.redraw() if self._zero() != self._drawn_zero else self.surface.refresh()

    def _on_tool(self) -> None:
        self.hands.let_go()
        self.surface.widget.configure(cursor="" if self.session.tool == "select" else "crosshair")
        self.surface.refresh()

    # How it is drawn

    _drawn_zero = ""

    def _zero(self) -> str:
        """Id of the piece whose frame the rulers show."""
        pieces = () if self.sheet is None else self.sheet.pieces
        chosen = self.session.selected.piece
        if self.session.selected.sensor and self._skin is not None:
            chosen = next((s.piece for s in self._skin.sensors if s.id == self.session.selected.sensor), chosen)
        return next((p.id for p in pieces if p.id == chosen), pieces[0].id if pieces else "")

    def _draw_still(self, pen: Pen) -> None:
        skin, sheet = self._skin, self.sheet
        if skin is None or sheet is None or not skin.pieces:
            pen.box((0, 0, pen.width, pen.height), self.theme.view)
            words = (
                ""
                if self.session.skin is not skin
                else "open a mesh or a skin document"
                if skin is None
                else "no flat pieces yet: cut the object"
            )
            pen.text((pen.width / 2, pen.height / 2), words, self.theme.faint, size=13)
            self._triangles = np.full((pen.height, pen.width), -1, dtype=np.int32)
            self._face = ()
            return
        if self._fitted:
            ruler = RULER_PX * pen.ratio
            bar = BAR_PX * pen.ratio if self.session.shading == "distortion" else 0.0
            plane = Plane.fitted(*sheet.box, pen.width - ruler - bar, pen.height - ruler, border=_BORDER_PX * pen.ratio)
            self.plane = plane.moved(ruler, ruler)
        self._find_triangles(sheet, pen.width, pen.height)
        self._drawn_zero = self._zero()
        colours = face_colours(skin, self.derived, self.session.shading, self.theme)
        zero = sheet.offset_of(self._drawn_zero)
        ground = Ground(sheet, self.plane, self.theme, colours, self.session.shading, skin.marks, zero, grid=self.grid_shown)
        paint_faces(ground, self._triangles, self.surface.picture)
        paint_lines(ground, pen)
        marker = self._marker(pen, sheet)
        held = {s.id for s in self.hands.sensors}
        lying = [s for s in skin.sensors if s.id not in held]
        findings = {k: v for k, v in self.live.findings.items() if k not in held}
        taken = Taken(pen.width, pen.height, pen.ratio)
        taken.lines(self.plane.to_px(self.lines.of(sensor, sheet)) for sensor in lying)
        headings = paint_names(ground, pen, self._triangles, taken)
        for box in (*headings, *marker.sensors(lying, findings)):  # a sensor that lies between pieces is hidden by no heading
            taken.box(box)
        paint_small_names(marker.small(lying, findings), ground, pen, taken)
        paint_labels(ground, pen, self._triangles, taken)
        paint_frame(ground, pen)

    def _draw_moving(self, pen: Pen) -> None:
        skin, sheet = self._skin, self.sheet
        if skin is None or sheet is None:
            return
        marker, hands = self._marker(pen, sheet), self.hands
        held = {s.id: s for s in hands.sensors}
        sensors = {s.id: s for s in skin.sensors} | held
        selected, hovered = self.session.selected, self.session.hovered
        if not held and hovered != replace(selected, face=hovered.face):
            marker.hovered(hovered, sensors)
        marker.selected(selected, sensors, handle=self.session.tool == "select")
        marker.sensors(held.values(), hands.findings)
        marker.guides(hands.guides)
        for shown in self._shown.values():
            marker.shown(shown)
        if hands.rectangle is not None:
            marker.rectangle(*hands.rectangle)
        if held:
            marker.beside(hands.pointer, hands.findings, hands.sensors)
        marker.place(hands.place())

    def _marker(self, pen: Pen, sheet: Sheet) -> Marker:
        # The scale of distortions begins with near white, whatever the theme: light lines need an edge there.
        cased = self.theme.name == "dark" and self.session.shading == "distortion"
        return Marker(pen, self.plane, sheet, self.theme, self.lines, cased)

    def _find_triangles(self, sheet: Sheet, width: int, height: int) -> None:
        """Which triangle each pixel shows, anew only where something moved."""
        now = (sheet, self.plane, width, height)
        if now == self._face:
            return
        if self._triangles.shape != (height, width):
            self._triangles = np.empty((height, width), dtype=np.int32)
        px = self.plane.to_px(sheet.UV)
        fill(np.stack([px[:, 0], height - px[:, 1]], axis=1), sheet.F, self._triangles)
        self._face = now


def _sheet_of(skin: Skin) -> tuple[object, ...]:
    return skin.mesh, skin.pieces
