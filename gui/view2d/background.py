"""The still part of the flat view: faces, outlines, seams, grid, rulers, colour bar."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gui.shades import CHECK_MM, HEAT_RANGE, heat
from gui.theme import Theme, rgb
from gui.view2d.pen import Box, Pen
from gui.view2d.plane import Plane
from gui.view2d.sheet import Sheet
from skinfab.skin import SeamMarks

Float = NDArray[np.float64]

#: Pixels of an ordinary screen.
RULER_PX = 24
#: What the colour bar takes at the right.
BAR_PX = 64
NOTCH_PX = 6.0
LABEL_PX = NAME_PX = 11.0
#: A seam shorter than this on the screen has no label: it would hide what it names.
LEAST_SEAM_PX = 26.0


@dataclass(frozen=True, eq=False)
class Ground:
    """What the still part is drawn from.

    Parameters
    ----------
    sheet : Sheet
    plane : Plane
    theme : Theme
    colours : (faces of the mesh, 3) uint8
    shading : str
    marks : SeamMarks, optional
    zero : (2,) float, mm of the sheet
        Where the rulers begin to count.
    grid : bool
    """

    sheet: Sheet
    plane: Plane
    theme: Theme
    colours: NDArray[np.uint8]
    shading: str
    marks: SeamMarks | None
    zero: Float
    grid: bool = True


def paint_faces(ground: Ground, face: NDArray[np.int32], picture: NDArray[np.uint8]) -> None:
    """Colour the pixels (rows, columns, 4) of a picture by the triangles they show."""
    table = np.full((len(ground.sheet.F) + 1, 4), 255, dtype=np.uint8)
    table[:-1, :3] = ground.colours[ground.sheet.face]
    table[-1, :3] = rgb(ground.theme.view)
    # One number a pixel; -1, no triangle, is the last.
    np.take(table.view(np.uint32).ravel(), face, out=picture.view(np.uint32)[:, :, 0], mode="wrap")
    if ground.shading == "checker":
        _checker(ground, face, picture)


def paint_lines(ground: Ground, pen: Pen) -> None:
    """Grid, outlines, seams and their notches."""
    if ground.grid:
        _grid(ground, pen)
    sheet, plane, theme = ground.sheet, ground.plane, ground.theme
    edges = sheet.edges
    # Inside a piece there are holes of the object, and cuts that reach no border.
    inner, cut = edges.side < 0, ~sheet.mesh.topology.is_boundary[edges.mesh]
    pen.lines(list(plane.to_px(edges.ends[inner & ~cut])), theme.text, 1.2)
    pen.lines(list(plane.to_px(edges.ends[inner & cut])), theme.seam, 1.8)
    sides = [plane.to_px(side.points + sheet.offset[side.piece]) for side in sheet.sides]
    pen.lines([px for px, side in zip(sides, sheet.sides, strict=True) if side.kind == "border"], theme.text, 1.4)
    pen.lines([px for px, side in zip(sides, sheet.sides, strict=True) if side.kind != "border"], theme.seam, 1.8)
    if ground.marks is not None:
        locked = np.isin(edges.mesh, sheet.mesh.topology.edge_ids(ground.marks.locked))
        pen.lines(list(plane.to_px(edges.ends[locked])), theme.locked, 3.0)
    for side in sheet.sides:
        if not side.label:
            continue
        at = plane.to_px(side.notch + sheet.offset[side.piece])
        pen.line([at, at + side.inward * NOTCH_PX * pen.ratio], theme.seam, 1.8)


def faces_under(box: Box, face: NDArray[np.int32]) -> float:
    """How much of a box lies over pieces, from 0 to 1; `face` (rows, columns) counts rows down."""
    height = len(face)
    part = face[max(int(height - box[3]), 0) : max(int(height - box[1]), 0) + 1, max(int(box[0]), 0) : max(int(box[2]), 0) + 1]
    return float((part >= 0).mean()) if part.size else 0.0


def paint_frame(ground: Ground, pen: Pen) -> None:
    """Rulers, and the colour bar where there are colours to read."""
    _rulers(ground, pen)
    if ground.shading == "distortion":
        _colour_bar(ground, pen)


def _checker(ground: Ground, face: NDArray[np.int32], picture: NDArray[np.uint8]) -> None:
    """Every other square of each piece's own plane is darker."""
    rows, columns = face.shape
    mm = ground.plane.to_mm(np.stack([np.arange(columns) + 0.5, np.full(columns, 0.0)], axis=1))[:, 0]
    up = ground.plane.to_mm(np.stack([np.full(rows, 0.0), rows - (np.arange(rows) + 0.5)], axis=1))[:, 1]
    owner = np.append(ground.sheet.owner, -1)[face]
    for k, (x, y) in enumerate(ground.sheet.offset):
        across, along = np.floor((mm - x) / CHECK_MM), np.floor((up - y) / CHECK_MM)
        odd = ((along[:, None] + across[None]) % 2 == 1) & (owner == k)
        picture[odd, :3] = picture[odd, :3] * 0.72


def _ticks(ground: Ground, pen: Pen, axis: int, least: float) -> tuple[Float, Float, float]:
    """Numbers of the ruler, where they are in pixels, and the step between them, mm."""
    size = (pen.width, pen.height)[axis]
    step = ground.plane.step(least * pen.ratio)
    ends = [0.0, 0.0], [float(pen.width), float(pen.height)]
    low, high = (ground.plane.to_mm(end)[axis] - ground.zero[axis] for end in ends)
    numbers = np.arange(np.ceil(low / step), np.floor(high / step) + 1) * step
    places = np.zeros((len(numbers), 2))
    places[:, axis] = numbers + ground.zero[axis]
    px = ground.plane.to_px(places)[:, axis]
    inside = (px > RULER_PX * pen.ratio) & (px < size)
    return numbers[inside], px[inside], step


def _grid(ground: Ground, pen: Pen) -> None:
    for least, alpha in ((14.0, 0.16), (70.0, 0.34)):
        parts = []
        for axis in (0, 1):
            for at in _ticks(ground, pen, axis, least)[1]:
                line = np.array([[0.0, 0.0], [pen.width, pen.height]])
                line[:, axis] = np.floor(at) + 0.5
                parts.append(line)
        pen.lines(parts, ground.theme.faint, 1.0, alpha=alpha)


def _rulers(ground: Ground, pen: Pen) -> None:
    theme, wide = ground.theme, RULER_PX * pen.ratio
    pen.box((0, 0, pen.width, wide), theme.panel)
    pen.box((0, 0, wide, pen.height), theme.panel)
    pen.lines([np.array([[wide, wide], [pen.width, wide]]), np.array([[wide, wide], [wide, pen.height]])], theme.border, 1.0)
    for axis in (0, 1):
        numbers, places, step = _ticks(ground, pen, axis, 70.0)
        marks = []
        for number, at in zip(numbers, places, strict=True):
            mark = np.array([[wide - 6 * pen.ratio] * 2, [wide] * 2])
            mark[:, axis] = at
            marks.append(mark)
            digits = max(0, int(np.ceil(-np.log10(step) - 1e-9)))
            centre = np.array([(wide - 5 * pen.ratio) / 2] * 2)
            centre[axis] = at
            # Numbers beside the left ruler stand above their marks: it is narrower than they are long.
            anchor = (0.5, 0.5) if axis == 0 else (0.5, 0.0)
            pen.text(centre, f"{number + 0.0:.{digits}f}", theme.faint, size=9, anchor=anchor, inside=True)
        pen.lines(marks, theme.faint, 1.0)
    pen.box((0, 0, wide, wide), theme.panel)
    pen.text((wide / 2, wide / 2), "mm", theme.faint, size=9)


def _colour_bar(ground: Ground, pen: Pen) -> None:
    theme, ratio = ground.theme, pen.ratio
    left, low, wide = pen.width - 52 * ratio, (RULER_PX + 40) * ratio, 12 * ratio
    high = min(low + 180 * ratio, pen.height - 40 * ratio)
    if high - low < 60 * ratio:
        return
    pen.box((left - 8 * ratio, low - 12 * ratio, pen.width - 4 * ratio, high + 26 * ratio), theme.view, theme.border, alpha=0.9)
    steps = np.linspace(*HEAT_RANGE, 65)
    heights = np.linspace(low, high, len(steps))
    for k, colour in enumerate(heat((steps[1:] + steps[:-1]) / 2)):
        pen.box((left, heights[k], left + wide, heights[k + 1]), "#{:02x}{:02x}{:02x}".format(*colour))
    for d in np.linspace(*HEAT_RANGE, 5):
        y = low + (high - low) * (d - HEAT_RANGE[0]) / (HEAT_RANGE[1] - HEAT_RANGE[0])
        pen.text((left + wide + 4 * ratio, y), f"{d:.2f}", theme.text, size=10, anchor=(0.0, 0.5))
    pen.text((left, high + 6 * ratio), "d", theme.text, size=12, anchor=(0.0, 0.0), bold=True)
