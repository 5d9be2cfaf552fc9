"""What lies under a point of the flat view."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gui.state.selection import Target
from gui.view2d.lines import Lines
from gui.view2d.sheet import Sheet
from skinfab.skin import Skin

Float = NDArray[np.float64]

#: Pixels from which a line is hit.
REACH_PX = 5.0


@dataclass(frozen=True, eq=False)
class Hit2D:
    """A point of the sheet and what it is on the object.

    Parameters
    ----------
    sheet : (2,) float, mm of the sheet
    piece : str
        Id; "" beside all pieces.
    face : int
        Of the mesh; -1 beside all pieces.
    barycentric : (3,) float
        Weights of the mesh face's corners; NaN beside all pieces.
    uv : (2,) float, mm of the piece; NaN beside all pieces
    point : (3,) float, mm
        On the object; NaN beside all pieces.
    vertex : int
        Of the mesh: the corner of that face that is nearest; -1 beside all pieces.
    edge : int
        Of the mesh: the seam or border within reach, else the nearest edge of that face; -1 beside all pieces.
    target : Target
    """

    sheet: Float
    piece: str
    face: int
    barycentric: Float
    uv: Float
    point: Float
    vertex: int
    edge: int
    target: Target


def hit(skin: Skin, sheet: Sheet, lines: Lines, at: Float, triangle: int, *, reach: float) -> Hit2D:
    """What is at a point.

    Parameters
    ----------
    at : (2,) float, mm of the sheet
    triangle : int
        Index into ``sheet.F`` of the one under the point; -1 where there is none.
    reach : float, mm
        From how far a line is hit.
    """
    sensor = lines.nearest(at, skin.sensors, sheet, reach=reach)
    near, apart = sheet.nearest_edge(at)
    boundary = int(sheet.edges.mesh[near]) if near >= 0 and apart <= reach else -1
    seam = boundary if boundary >= 0 and skin.mesh.topology.EF[boundary, 1] >= 0 else -1
    if triangle < 0:
        piece = skin.pieces[int(sheet.edges.piece[near])].id if boundary >= 0 else ""
        if sensor:
            piece = next(s.piece for s in skin.sensors if s.id == sensor)
        target = Target(piece=piece, sensor=sensor, seam=-1 if sensor else seam)
        none = np.full(3, np.nan)
        return Hit2D(at, "", -1, none, none[:2], none, -1, boundary, target)
    k, face = int(sheet.owner[triangle]), int(sheet.face[triangle])
    weights = _weights(sheet.UV[sheet.F[triangle]], at)
    corners = skin.mesh.F[face]
    edge = boundary if boundary >= 0 else int(skin.mesh.topology.FE[face, (int(np.argmin(weights)) + 1) % 3])
    target = Target(face=face, piece=skin.pieces[k].id, sensor=sensor, seam=-1 if sensor else seam)
    return Hit2D(
        at,
        skin.pieces[k].id,
        face,
        weights,
        at - sheet.offset[k],
        weights @ skin.object.V[corners],
        int(corners[np.argmax(weights)]),
        edge,
        target,
    )


def _weights(triangle: Float, p: Float) -> Float:
    """Barycentric, of a point within half a pixel of the triangle: cut to it."""
    (ax, ay), (bx, by), (cx, cy) = triangle
    double = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if double == 0:
        return np.full(3, 1 / 3)
    one = ((bx - p[0]) * (cy - p[1]) - (by - p[1]) * (cx - p[0])) / double
    two = ((cx - p[0]) * (ay - p[1]) - (cy - p[1]) * (ax - p[0])) / double
    weights = np.maximum([one, two, 1 - one - two], 0.0)
    return np.asarray(weights / weights.sum())
