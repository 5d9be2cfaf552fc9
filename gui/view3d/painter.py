"""One picture after another of a solid: what changed since the last decides what is done anew."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gui.view3d.camera import Camera
from gui.view3d.lines import Strokes, lay_over, seen_of, stroke
from gui.view3d.raster import project, rasterise
from gui.view3d.shade import NO_BOARD, Paint, brightness, shade, shade_quickly, shine
from gui.view3d.solid import Solid
from skinfab.mesh.model import Mesh

Float32 = NDArray[np.float32]
Int32 = NDArray[np.int32]
Bytes = NDArray[np.uint8]


#: With more triangles than this, the light of a picture of a moving object is not smoothed within them.
_MANY = 20_000


@dataclass(frozen=True, eq=False)
class Spots:
    """Places that glow.

    Parameters
    ----------
    points : (k, 3) float, mm
    radius : (k,) float, mm
    colour : (k, 4) float
        Red, green and blue from 0 to 255, and how strong, 0 to 1.
    """

    points: NDArray[np.float64]
    radius: NDArray[np.float64]
    colour: NDArray[np.float64]


class Painter:
    """Draws a solid and lines on it, and says afterwards what is where.

    Examples
    --------
    >>> from skinfab.mesh.model import Mesh
    >>> mesh = Mesh(np.array([[0.0, 0, 0], [9, 0, 0], [0, 0, 9]]), np.array([[0, 1, 2]]))
    >>> paint = Paint(np.full((1, 3), 200, np.uint8), np.zeros(1, np.uint8), np.zeros((1, 4), np.float32), np.zeros(3, np.uint8))
    >>> painter, camera = Painter(), Camera.fitted(mesh.V, 60, 40).seen_from("front")
    >>> image = painter.draw(Solid.of(mesh), camera, paint, Strokes.joined([]))
    >>> image.shape, painter.face_at(28, 21), painter.face_at(0, 0)
    ((40, 60, 3), 0, -1)
    """

    def __init__(self) -> None:
        self.camera: Camera | None = None
        self.sharper = self.coarser = 1
        self.face: Int32 = np.full((1, 1), -1, dtype=np.int32)
        self.depth: Float32 = np.full((1, 1), np.inf, dtype=np.float32)
        self.slack = 0.0
        self._drawn: tuple[object, ...] = ()
        self._shaded: tuple[object, ...] = ()
        self._screen: Float32 = np.empty((0, 3), dtype=np.float32)
        self._solid: Solid | None = None
        self.strokes = Strokes.joined([])
        self._resize(1, 1, 1)

    def draw(
        self,
        solid: Solid,
        camera: Camera,
        paint: Paint,
        strokes: Strokes,
        *,
        sharper: int = 1,
        coarser: int = 1,
        spots: Spots | None = None,
    ) -> Bytes:
        """A picture (height, width, 3), overwritten by the next; a view of `pixels`.

        With `sharper` 2 it has smooth edges for four times the pixels; with `coarser` 2 it has half as many rows and columns, rounded
        up, and is meant to be enlarged. What is asked of it later is in the camera's pixels all the same.
        """
        wanted: tuple[object, ...] = (solid, camera, sharper, coarser)
        if not _same(wanted, self._drawn):
            self._triangles(solid, camera, sharper, coarser)
            self._drawn, self._shaded = wanted, ()
        if not _same((paint, spots), self._shaded):
            self._colours(solid, camera, paint, spots)
            self._shaded = (paint, spots)
        self.strokes = strokes
        np.copyto(self.pixels, self._base)
        a, b = self._placed(strokes.a), self._placed(strokes.b)
        stroke(a, b, strokes.item, strokes.width / np.float32(coarser), self.depth, self.slack, sharper, self._cover, self._owner)
        lay_over(self._cover, self._owner, strokes.colour, self.pixels)
        return self.pixels[:, :, :3]

    def face_at(self, column: int, row: int) -> int:
        """Face of the document's mesh at a pixel of the picture; -1 where there is none."""
        column, row = column // self.coarser, row // self.coarser
        if self._solid is None or not (0 <= row < self.pixels.shape[0] and 0 <= column < self.pixels.shape[1]):
            return -1
        t = int(self.face[row * self.sharper, column * self.sharper])
        return int(self._solid.name[t]) if t >= 0 else -1

    def faces(self, step: int) -> tuple[Int32, Int32, Int32]:
        """Column, row and mesh face of every `step`-th pixel that shows the object: three (k,) arrays."""
        if self._solid is None:
            none = np.empty(0, dtype=np.int32)
            return none, none, none
        step = max(step // self.coarser, 1)
        few = self.face[:: step * self.sharper, :: step * self.sharper]
        step_px = step * self.coarser
        rows, columns = np.nonzero(few >= 0)
        return (columns * step_px).astype(np.int32), (rows * step_px).astype(np.int32), self._solid.name[few[rows, columns]]

    def depth_at(self, column: int, row: int) -> float:
        """Depth of the surface at a pixel, mm; infinite where there is none."""
        column, row = column // self.coarser, row // self.coarser
        if not (0 <= row < self.pixels.shape[0] and 0 <= column < self.pixels.shape[1]):
            return float("inf")
        return float(self.depth[row * self.sharper, column * self.sharper])

    def item_near(self, column: int, row: int, *, reach: int) -> int:
        """The strokes' item nearest to a pixel among those that stand for something and come within `reach` pixels; -1 where none is."""
        column, row, reach = column // self.coarser, row // self.coarser, max(reach // self.coarser, 1)
        low_row, low_column = max(row - reach, 0), max(column - reach, 0)
        near = self._owner[low_row : row + reach + 1, low_column : column + reach + 1]
        rows, columns = np.nonzero(near >= 0)
        away = (rows + low_row - row) ** 2 + (columns + low_column - column) ** 2
        for k in np.argsort(away, kind="stable").tolist():
            item = int(near[rows[k], columns[k]])
            if away[k] <= reach * reach and self.strokes.targets[item]:
                return item
        return -1

    def is_seen(self, screen: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Which points (k, 3) of the screen (column, row, depth) are in the picture and not hidden, (k,)."""
        at: Float32 = screen.astype(np.float32).reshape(-1, 3)
        at[:, :2] /= self.coarser
        found: NDArray[np.bool_] = seen_of(at, self.depth, self.slack, self.sharper)
        return found

    def _triangles(self, solid: Solid, camera: Camera, sharper: int, coarser: int) -> None:
        self._resize(-(-camera.width // coarser), -(-camera.height // coarser), sharper)
        self.coarser = coarser
        rows, shift = camera.projection(sharper / coarser)
        if len(self._screen) != len(solid.V):
            self._screen = np.empty_like(solid.V)
        project(solid.V, rows.astype(np.float32), shift.astype(np.float32), self._screen)
        rasterise(self._screen, solid.F, solid.closed, self.face, self.depth)
        self._solid, self.camera, self.sharper, self.slack = solid, camera, sharper, solid.slack

    def _colours(self, solid: Solid, camera: Camera, paint: Paint, spots: Spots | None) -> None:
        height, width = self._base.shape[:2]
        self._base.reshape(height, -1)[:] = np.tile(
            np.append(paint.background, np.uint8(255)), width
        )  # whole rows: several times as fast as pixel by pixel
        box = self._box(solid, camera)
        look = paint.colour, paint.tint, paint.tints
        if self.sharper == 1 and len(solid.F) > _MANY and paint.flat is None:
            light = brightness(solid.normals[-len(solid.F) :], camera.turn)  # those of the faces come last
            shade_quickly(self.face, light, solid.name, *look, box, self._base)
        else:
            light = brightness(solid.normals, camera.turn)
            flat = NO_BOARD if paint.flat is None else paint.flat
            how = solid.F, solid.normal, light, solid.name
            shade(self.face, self._screen, *how, *look, paint.background, flat, self.sharper, box, self._base)
        if spots is not None and len(spots.points):
            at = self._placed(spots.points.astype(np.float32))
            sizes = spots.radius.astype(np.float32), spots.colour.astype(np.float32)
            shine(self.depth, at, camera.scale / self.coarser, *sizes, self.sharper, self._base)

    def _box(self, solid: Solid, camera: Camera) -> tuple[int, int, int, int]:
        """Rows and columns of the picture that the object may touch."""
        at = camera.to_screen(solid.corners)[:, :2] / self.coarser
        height, width = self._base.shape[:2]
        low, high = np.floor(at.min(axis=0)) - 1, np.ceil(at.max(axis=0)) + 2
        (left, right), (top, bottom) = (np.clip([low[k], high[k]], 0, n).astype(int).tolist() for k, n in ((0, width), (1, height)))
        return top, bottom, left, right

    def _placed(self, points: Float32) -> Float32:
        assert self.camera is not None
        rows, shift = self.camera.projection(1 / self.coarser)
        screen = np.empty_like(points)
        project(points, rows.astype(np.float32), shift.astype(np.float32), screen)
        return screen

    def _resize(self, width: int, height: int, sharper: int) -> None:
        if self.face.shape != (height * sharper, width * sharper) or self.sharper != sharper:
            self.face = np.full((height * sharper, width * sharper), -1, dtype=np.int32)
            self.depth = np.full(self.face.shape, np.inf, dtype=np.float32)
        if not hasattr(self, "pixels") or self.pixels.shape[:2] != (height, width):
            # Four bytes a pixel, the last of which says nothing: so the window system takes them as they are.
            self._base: Bytes = np.full((height, width, 4), 255, dtype=np.uint8)
            self.pixels: Bytes = np.full_like(self._base, 255)
            self._cover: Bytes = np.zeros((height, width), dtype=np.uint8)
            self._owner: Int32 = np.full((height, width), -1, dtype=np.int32)


def _same(these: tuple[object, ...], those: tuple[object, ...]) -> bool:
    return len(these) == len(those) and all(a is b or (isinstance(a, int) and a == b) for a, b in zip(these, those, strict=True))


def warm() -> None:
    """Draw a triangle with everything there is, so that what is compiled is loaded, or compiled where it never was."""
    mesh = Mesh(np.array([[0.0, 0, 0], [9, 0, 0], [0, 0, 9]]), np.array([[0, 1, 2]]))
    plain = np.zeros(1, np.uint8), np.zeros((1, 4), np.float32), np.zeros(3, np.uint8)
    paint = Paint(np.zeros((1, 3), np.uint8), *plain, flat=np.zeros((1, 3, 2), np.float32))
    painter, camera = Painter(), Camera.fitted(mesh.V, 16, 16)
    painter.draw(
        Solid.of(mesh), camera, paint, Strokes.polyline(mesh.V, (0, 0, 0), 1.0), spots=Spots(mesh.V[:1], np.ones(1), np.ones((1, 4)))
    )
    painter.is_seen(camera.to_screen(mesh.V))
    light = np.zeros((1, 2), np.float32)
    shade_quickly(painter.face, light, np.zeros(1, np.int32), paint.colour, *plain[:2], (0, 16, 0, 16), np.zeros((16, 16, 4), np.uint8))
