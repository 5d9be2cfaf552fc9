"""The tool path in the Tk canvas: all of it drawn once, what is still to come paler, and told apart pixel by pixel at any time."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gcode.preview import ROLES
from gcode.printer import Printer
from gui.theme import Theme
from gui.toolpath.marks import mark
from gui.toolpath.timeline import DRAWN, ROLE_NAMES, Instant, Timeline, runs
from gui.view2d.pen import Pen
from gui.view2d.plane import Plane
from gui.view2d.surface import Surface

Float = NDArray[np.float64]

#: How strong what is still to come is drawn, of 1.
PALE = 0.3

#: Least width of a line, and of one without ink, pixels of an ordinary screen.
_LEAST_PX, _THIN_PX, _DOT_PX = 1.6, 1.1, 3.5

#: Matplotlib's rasteriser takes only so much in one line.
_POINTS_AT_ONCE = 4000

#: Pixels left free round the piece when it is fitted into the view.
_BORDER_PX = 22

#: How near the pointer must be to a line to mean it, pixels of an ordinary screen.
_REACH_PX = 6


def colours(theme: Theme) -> dict[str, str]:
    """The colour of each role: those of the tool path's SVG, but ink is drawn as the theme has it."""
    return {role: colour for role, (colour, _) in ROLES.items()} | {"print": theme.ink}


@dataclass(frozen=True, eq=False)
class Scene:
    """What is drawn.

    Parameters
    ----------
    line : Timeline
    wall : (e, 2, 2) float, mm
        Edges of the piece on the bed.
    printer : Printer
    """

    line: Timeline
    wall: Float
    printer: Printer

    @property
    def box(self) -> tuple[Float, Float]:
        """What is to be seen at first: the piece."""
        points = self.wall.reshape(-1, 2)
        return (points.min(axis=0), points.max(axis=0)) if len(points) else self.line.box


class PathPicture(Surface):
    """Shows a tool path as far as it is done.

    Parameters
    ----------
    master : tkinter widget
    theme : Theme
    on_step : callable
        Called with the index of a step that was clicked.
    """

    def __init__(self, master: tk.Misc, theme: Theme, *, on_step: Callable[[int], None]) -> None:
        self.theme, self.on_step = theme, on_step
        self.scene: Scene | None = None
        self.now: Instant | None = None
        self.plane = Plane()
        self._fitted = True
        self._grip: tuple[int, int, Plane] | None = None
        self._moved = False
        self._pixels_of: tuple[NDArray[np.uint32], NDArray[np.uint32]] | None = None  # done, to come
        self._marks = np.zeros((0, 0), dtype=np.int32)
        self._ends: Float = np.zeros((2, 0, 2))
        self._spare = 0.0
        self._done = -1
        super().__init__(master, still=self._draw_still, moving=self._draw_moving)
        bind = self.widget.bind
        bind("<ButtonPress-1>", self._press)
        bind("<B1-Motion>", self._drag)
        bind("<ButtonRelease-1>", self._release)
        bind("<Double-Button-1>", lambda event: self.fit())
        bind("<MouseWheel>", lambda event: self._wheel(event, event.delta))
        bind("<Button-4>", lambda event: self._wheel(event, 1))
        bind("<Button-5>", lambda event: self._wheel(event, -1))

    def show(self, scene: Scene | None, now: Instant | None) -> None:
        """Show another path; the part of the bed that is seen stays while the piece does."""
        if scene is None or self.scene is None or scene.line.piece != self.scene.line.piece:
            self._fitted = True
        self.scene, self.now, self._pixels_of = scene, now, None
        self.draw_idle()

    def restyle(self, theme: Theme) -> None:
        """Change colours."""
        self.theme = theme
        self.draw_idle()

    def fit(self) -> None:
        """Show all of the piece."""
        self._fitted = True
        self.draw_idle()

    def zoom(self, factor: float, at: ArrayLike | None = None) -> None:
        """So many times as large, about a pixel (right and up) or the middle."""
        self.plane, self._fitted = self.plane.zoomed(factor, np.array(self.size) / 2 if at is None else at), False
        self.draw_idle()

    def seek(self, now: Instant) -> None:
        """Show another time: only what changes is touched."""
        self.now = now
        if self.scene is None or self._pixels_of is None or self._kept is None or self._kept.shape != self.picture.shape:
            return  # everything is about to be drawn
        done = _finished(now)
        if done != self._done:
            self._turn(self.scene.line, done)
        self.refresh_now()

    def step_near(self, x: int, y: int) -> int | None:
        """The step that is drawn at a pixel (counted right and down) or next to it."""
        reach = round(_REACH_PX * self.ratio)
        top, left = max(y - reach, 0), max(x - reach, 0)
        part = self._marks[top : y + reach + 1, left : x + reach + 1]
        rows, columns = np.nonzero(part >= 0)
        if not len(rows):
            return None
        k = np.argmin((rows + top - y) ** 2 + (columns + left - x) ** 2)
        return int(part[rows[k], columns[k]])

    # How it is drawn

    def _turn(self, line: Timeline, done: int) -> None:
        """Make what lies between two numbers of finished steps stronger or paler."""
        low, high = sorted((self._done, done))
        first, last = np.searchsorted(line.part_step, [low + 1, high + 1])
        self._done = done
        if first == last:
            return
        x, y = self._ends[:, first:last]  # a row each: numpy is slow across pairs
        spare = self._spare
        box = (float(x.min()) - spare, float(y.min()) - spare, float(x.max()) + spare, float(y.max()) + spare)
        left, top, right, bottom = self._pixels(box)
        if right > left and bottom > top:
            self._compose(slice(top, bottom), slice(left, right))
            self._touched.append(box)

    def _compose(self, rows: slice, columns: slice) -> None:
        assert self._pixels_of is not None and self._kept is not None
        strong, pale = self._pixels_of
        at = (rows, columns)
        self._kept.view(np.uint32)[:, :, 0][at] = np.where(self._marks[at] <= self._done, strong[at], pale[at])

    def draw(self) -> None:
        """Draw everything."""
        self._pixels_of = None
        super().draw()

    def _draw_still(self, pen: Pen) -> None:
        theme, scene = self.theme, self.scene
        pen.box((0, 0, pen.width, pen.height), theme.view)
        if scene is None:
            self._marks = np.zeros((0, 0), dtype=np.int32)
            return
        if self._fitted:
            self.plane = Plane.fitted(*scene.box, pen.width, pen.height, border=_BORDER_PX * pen.ratio)
        self._ground(pen, scene)
        ground = self.picture.copy()
        drawn_as = colours(theme)
        for role, width, points in runs(scene.line):
            px = self.plane.to_px(points)
            if (points == points[0]).all():
                pen.disk(px[0], self._width(role, width) / 2 / pen.ratio, drawn_as[role], drawn_as[role], 0.5)
                continue
            for a in range(0, len(px) - 1, _POINTS_AT_ONCE):
                pen.line(px[a : a + _POINTS_AT_ONCE + 1], drawn_as[role], self._width(role, width) / pen.ratio)
        strong = self.picture.copy()
        self._mark(scene.line)
        pale = (ground + (strong.astype(np.float32) - ground) * PALE).astype(np.uint8)
        self._pixels_of = strong.view(np.uint32)[:, :, 0], pale.view(np.uint32)[:, :, 0]
        self._done = -1 if self.now is None else _finished(self.now)
        self._kept = self.picture.copy()
        self._compose(slice(None), slice(None))
        self.picture[:] = self._kept

    def _ground(self, pen: Pen, scene: Scene) -> None:
        """Bed, places the nozzle visits, the mould's wall."""
        theme, bed, plane = self.theme, scene.printer.bed, self.plane
        (x, y), (width, depth) = bed.origin, bed.size
        corners = plane.to_px([[x, y], [x + width, y], [x + width, y + depth], [x, y + depth]])
        pen.line(corners, theme.border, 1.5, closed=True)
        for name, place in (("cleaning", scene.printer.cleaning), ("park", scene.printer.park)):
            if place is not None:
                at = plane.to_px([x + place.x, y + place.y])
                across, up = np.array([[5.0, 0.0], [0.0, 5.0]]) * pen.ratio
                pen.lines([np.stack([at - across, at + across]), np.stack([at - up, at + up])], theme.faint, 1.0)
                pen.text(at + 1.5 * across, f"{name} place", theme.faint, size=10, anchor=(0.0, 0.5))
        pen.lines(list(plane.to_px(scene.wall)), theme.faint, 1.6)
        self._scale_bar(pen)

    def _scale_bar(self, pen: Pen) -> None:
        step = self.plane.step(60 * pen.ratio)
        right, low = pen.width - 12 * pen.ratio, 12 * pen.ratio
        left = right - step * self.plane.scale
        pen.line([[left, low + 4], [left, low], [right, low], [right, low + 4]], self.theme.text, 1.2)
        pen.text(((left + right) / 2, low + 10 * pen.ratio), f"{step:g} mm", self.theme.text, size=10)

    def _width(self, role: str, width: float) -> float:
        """Of a line, or across a dot, pixels of this screen."""
        if role in ("prime", "retract"):
            return 2 * _DOT_PX * self.ratio
        least = _LEAST_PX if role.startswith("print") else _THIN_PX
        return max(width * self.plane.scale if role.startswith("print") else 0.0, least * self.ratio)

    def _mark(self, line: Timeline) -> None:
        width, height = self.size
        if self._marks.shape != (height, width):
            self._marks = np.empty((height, width), dtype=np.int32)
        px = self.plane.to_px(line.parts)
        self._ends = np.ascontiguousarray(np.moveaxis(px, 2, 0))
        px[..., 1] = height - px[..., 1]
        layers = np.empty((height, width), dtype=np.int8)
        # As they are drawn (`_width`), and one pixel more for the soft edge.
        least = np.array([self._width(role, 0.0) for role in ROLE_NAMES])[line.role]
        inked = np.isin(line.role, [DRAWN.index(role) for role in DRAWN if role.startswith("print")])
        widths = np.where(inked, np.maximum(line.width * self.plane.scale, least), least)
        reach = widths[line.part_step] / 2 + 1.0
        self._spare = float(reach.max(initial=0.0)) + 2
        mark(px, reach, line.role[line.part_step], line.part_step, self._marks, layers)

    def _draw_moving(self, pen: Pen) -> None:
        scene, now = self.scene, self.now
        if scene is None or now is None or not np.isfinite(now.at[:2]).all():
            return
        role = now.role
        way = scene.line.way(now.step, now.done)
        if len(way) > 1:
            pen.line(self.plane.to_px(way), colours(self.theme)[role], self._width(role, float(scene.line.width[now.step])) / pen.ratio)
        at = self.plane.to_px(now.at[:2])
        if (at > -50).all() and (at < np.array(self.size) + 50).all():
            pen.disk(at, 6.0, self.theme.view, self.theme.select, 2.5)
            pen.disk(at, 1.8, self.theme.select, self.theme.select, 0.5)

    # What the pointer does

    def _press(self, event: tk.Event) -> None:
        self.widget.focus_set()
        self._grip, self._moved = (event.x, event.y, self.plane), False

    def _drag(self, event: tk.Event) -> None:
        if self._grip is None:
            return
        x, y, plane = self._grip
        if self._moved or abs(event.x - x) + abs(event.y - y) > 3 * self.ratio:
            self._moved = True
            self.plane, self._fitted = plane.moved(event.x - x, y - event.y), False
            self.draw_idle()

    def _release(self, event: tk.Event) -> None:
        if self._grip is not None and not self._moved and (step := self.step_near(event.x, event.y)) is not None:
            self.on_step(step)
        self._grip = None

    def _wheel(self, event: tk.Event, way: int) -> None:
        self.zoom(1.2 if way > 0 else 1 / 1.2, (event.x + 0.5, self.size[1] - event.y - 0.5))


def _finished(now: Instant) -> int:
    """The last step that is done."""
    return now.step if now.done >= 1.0 else now.step - 1
