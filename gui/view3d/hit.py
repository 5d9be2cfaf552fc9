"""What a pixel of the 3D view shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gui.state.selection import Target
from gui.view3d.camera import Camera
from gui.view3d.painter import Painter
from skinfab.skin import Skin

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Hit:
    """A point of the object.

    Parameters
    ----------
    face : int
        Face of ``skin.mesh``.
    barycentric : (3,) float
        Weights of its corners.
    point : (3,) float, mm
        On the object.
    vertex : int
        Of the face, the one nearest on the screen.
    edge : int
        Of the face, likewise: an id of ``skin.mesh.topology``.
    target : Target
        With the sensor or seam within reach of the pointer, and the piece the face is on.
    """

    face: int
    barycentric: FloatArray
    point: FloatArray
    vertex: int
    edge: int
    target: Target


def hit(skin: Skin, painter: Painter, owner: NDArray[np.int64], column: int, row: int, *, reach: int) -> Hit | None:
    """What is at a pixel of the last picture; lines count within `reach` pixels. None beside the object.

    Parameters
    ----------
    skin : Skin
    painter : Painter
        That drew it.
    owner : (m,) int64
        Position of each face's piece, -1 where it has none.
    column, row : int
    reach : int, pixels
    """
    item = painter.item_near(column, row, reach=reach)
    face = painter.face_at(column, row)
    camera = painter.camera
    if face < 0 or face >= len(skin.mesh.F) or camera is None:
        return None
    corners = skin.object.V[skin.mesh.F[face]]
    at = np.array([column + 0.5, row + 0.5])
    weights = _weights(camera.to_screen(corners)[:, :2], at)
    piece = skin.pieces[owner[face]].id if owner[face] >= 0 else ""
    on = painter.strokes.targets[item] if item >= 0 else Target()
    target = Target(face, on.piece or piece, on.sensor, on.seam)
    vertex, edge = _nearest(skin, camera, face, at)
    return Hit(face, weights, weights @ corners, vertex, edge, target)


def _nearest(skin: Skin, camera: Camera, face: int, at: FloatArray) -> tuple[int, int]:
    """Corner and edge of a face nearest to a place of the screen."""
    corners = skin.mesh.F[face]
    screen = camera.to_screen(skin.object.V[corners])[:, :2]
    vertex = int(corners[np.argmin(np.hypot(*(screen - at).T))])
    along = np.roll(screen, -1, axis=0) - screen
    square = np.einsum("ki,ki->k", along, along)
    t = np.clip(np.einsum("ki,ki->k", at - screen, along) / np.where(square > 0, square, 1), 0, 1)
    edge = int(np.argmin(np.hypot(*(screen + t[:, None] * along - at).T)))
    return vertex, int(skin.mesh.topology.FE[face, edge])


def _weights(screen: FloatArray, at: FloatArray) -> FloatArray:
    """Weights of a triangle's corners at a place of the screen, those of the nearest place in the triangle where it lies beside it."""
    e, f, p = screen[1] - screen[0], screen[2] - screen[0], at - screen[0]
    area = e[0] * f[1] - e[1] * f[0]
    if area == 0:
        return np.full(3, 1 / 3)
    u, v = (p[0] * f[1] - p[1] * f[0]) / area, (e[0] * p[1] - e[1] * p[0]) / area
    weights = np.clip([1 - u - v, u, v], 0, 1)
    result: FloatArray = weights / weights.sum()
    return result
