"""The object in space, its pieces coloured, its seams and sensors drawn where they can be seen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.locate import Locator
from skinfab.pieces import Piece
from skinfab.report.raster import is_visible, rasterise
from skinfab.skin import Skin

FloatArray = NDArray[np.float64]

#: One colour a piece, light enough for black lines on it; pieces beyond the last begin again.
PIECE_COLOURS = np.array(
    [
        [0.55, 0.75, 0.93],
        [0.99, 0.75, 0.44],
        [0.62, 0.85, 0.58],
        [0.95, 0.62, 0.62],
        [0.78, 0.69, 0.90],
        [0.84, 0.71, 0.62],
        [0.96, 0.72, 0.86],
        [0.78, 0.80, 0.45],
        [0.50, 0.85, 0.85],
        [0.80, 0.80, 0.80],
    ]
)
SEAM_COLOUR = (0.75, 0.05, 0.05)
SENSOR_COLOUR = (0.08, 0.08, 0.10)

_SUPERSAMPLING = 2
#: How far a line may lie behind the surface it is drawn on and still be seen, as a fraction of the object's diagonal.
_SLACK = 0.004
#: Share of a sensor that must be seen from a side for its name to be written there.
_ENOUGH = 0.3
#: Pixels between the object and the picture's edge.
_BORDER = 6


@dataclass(frozen=True)
class View:
    """Where one looks from: degrees about z, and degrees above the horizon."""

    azimuth: float
    elevation: float

    def axes(self) -> FloatArray:
        """Right, down and away as rows, (3, 3)."""
        a, e = np.radians([self.azimuth, self.elevation])
        away = -np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        return np.stack([right, np.cross(away, right), away])


def piece_colour(k: int) -> FloatArray:
    """Colour of the k-th piece, (3,) RGB."""
    colour: FloatArray = PIECE_COLOURS[k % len(PIECE_COLOURS)]
    return colour


@dataclass(frozen=True, eq=False)
class SensorPoints:
    """Points of all conductors on the object.

    Parameters
    ----------
    at : (k, 3) float, mm
    normal : (k, 3) float
        Of the face each lies on, outward.
    sensor : (k,) int
        Index into ``skin.sensors``.
    """

    at: FloatArray
    normal: FloatArray
    sensor: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Picture:
    """The object seen from one side; rows count down, pixels.

    Parameters
    ----------
    image : (height, width, 3) float
        RGB, 0 to 1, on white.
    piece : (height, width) int
        Index of the piece each pixel shows; -1 where it shows none.
    drawn : (height, width) bool
        Where a seam or a sensor is drawn.
    sensors : dict of int to (column, row)
        Where the name of each sensor belongs that faces this side: its middle, or the part of it that is seen.
    """

    image: FloatArray
    piece: NDArray[np.int64]
    drawn: NDArray[np.bool_]
    sensors: dict[int, tuple[float, float]]


def object_picture(skin: Skin, view: View, lines: SensorPoints, *, width: int, height: int) -> Picture:
    """The object as it is seen from one side, as large as fits the picture.

    Parameters
    ----------
    skin : Skin
    view : View
    lines : SensorPoints
        As `sensor_points` gives them.
    width, height : int, pixels
    """
    columns, rows = width * _SUPERSAMPLING, height * _SUPERSAMPLING
    axes = view.axes()
    seen = skin.mesh.V[skin.mesh.topology.used_vertices] @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    border = _BORDER * _SUPERSAMPLING
    scale = min((n - 2 * border) / max(size, np.finfo(float).tiny) for n, size in zip((columns, rows), (high - low)[:2], strict=True))
    shift = np.array([columns, rows, 0]) / 2 - scale * (low + high) / 2

    def project(points: FloatArray) -> FloatArray:
        return scale * points @ axes.T + shift

    face, depth = rasterise(project(skin.mesh.V), skin.mesh.F, shape=(rows, columns))
    image = np.append(_shaded_faces(skin, view), [[1.0, 1.0, 1.0]], axis=0)[face]  # -1, no face, is the white at the end
    slack = _SLACK * scale * float(np.linalg.norm(high - low))
    on_screen = project(lines.at)
    drawn = np.zeros((rows, columns), dtype=bool)
    for colour, points in [(SEAM_COLOUR, project(_seam_points(skin, 0.5 / scale))), (SENSOR_COLOUR, on_screen)]:
        _dot(image, drawn, points[is_visible(points, depth, slack=slack)], colour)
    small = slice(None, None, _SUPERSAMPLING)
    piece = _piece_of_face(skin)[face[small, small]]
    facing = is_visible(on_screen, depth, slack=slack) & (lines.normal @ axes[2] < 0)
    return Picture(
        image=image.reshape(height, _SUPERSAMPLING, width, _SUPERSAMPLING, 3).mean(axis=(1, 3)),
        piece=piece,
        drawn=np.asarray(drawn.reshape(height, _SUPERSAMPLING, width, _SUPERSAMPLING).any(axis=(1, 3))),
        sensors=_name_places(lines.sensor, on_screen[:, :2] / _SUPERSAMPLING, facing),
    )


def sensor_points(skin: Skin, *, spacing: float) -> SensorPoints:
    """Points of all conductors on the object, at most `spacing` mm apart when flat."""
    at, faces, which = [np.empty((0, 3))], [np.empty(0, np.int64)], [np.empty(0, np.int64)]
    for piece in skin.pieces:
        mine = [k for k, sensor in enumerate(skin.sensors) if sensor.piece == piece.id]
        paths = [skin.sensors[k].path for k in mine]
        flat = [path.point_at(np.linspace(0, 1, max(int(np.ceil(path.length / spacing)), 1) + 1)) for path in paths]
        if flat:
            placed, face, on = on_object(skin, piece, np.vstack(flat))
            at.append(placed)
            faces.append(face)
            which.append(np.repeat(mine, [len(each) for each in flat])[on])
    return SensorPoints(np.vstack(at), skin.mesh.face_normals[np.concatenate(faces)], np.concatenate(which))


def on_object(skin: Skin, piece: Piece, points: FloatArray) -> tuple[FloatArray, NDArray[np.int64], NDArray[np.bool_]]:
    """Where points of the flat piece (k, 2) mm lie on the object.

    Returns
    -------
    at : (j, 3) float, mm
        Of those points that lie on the piece.
    face : (j,) int
        The mesh's face each lies on.
    on : (k,) bool
        Which points lie on the piece.
    """
    face, weights = Locator(piece.UV, piece.F).barycentric(points)
    on = face >= 0
    placed: FloatArray = np.einsum("kc,kcx->kx", weights[on], skin.mesh.V[piece.vertices[piece.F[face[on]]]])
    return placed, piece.faces[face[on]], on


def _name_places(sensor: NDArray[np.int64], at: FloatArray, facing: NDArray[np.bool_]) -> dict[int, tuple[float, float]]:
    """For each sensor of which enough is seen, the seen point nearest to the middle of what is seen."""
    places = {}
    for k in np.unique(sensor[facing]).tolist():
        mine = at[(sensor == k) & facing]
        if len(mine) >= _ENOUGH * (sensor == k).sum():
            x, y = mine[np.argmin(np.linalg.norm(mine - mine.mean(axis=0), axis=1))]
            places[k] = (float(x), float(y))
    return places


def _piece_of_face(skin: Skin) -> NDArray[np.int64]:
    """Index of each face's piece, and -1 at the end for no face, (m + 1,)."""
    piece = np.full(len(skin.mesh.F) + 1, -1, dtype=np.int64)
    for k, each in enumerate(skin.pieces):
        piece[each.faces] = k
    return piece


def _shaded_faces(skin: Skin, view: View) -> FloatArray:
    """Colour of each face in the light of a lamp over the left shoulder, (m, 3)."""
    colours = np.full((len(skin.mesh.F), 3), 0.92)
    for k, piece in enumerate(skin.pieces):
        colours[piece.faces] = piece_colour(k)
    right, down, away = view.axes()
    lamp = -away - 0.5 * right - 0.6 * down
    # An open mesh shows its inside too: light both sides alike.
    brightness = np.abs(skin.mesh.face_normals @ (lamp / np.linalg.norm(lamp)))
    shaded: FloatArray = colours * (0.45 + 0.55 * brightness)[:, None]
    return shaded


def _seam_points(skin: Skin, spacing: float) -> FloatArray:
    """Points along the seams at most `spacing` mm apart, (k, 3) mm."""
    ends = skin.mesh.V[np.reshape(skin.seams, (-1, 2))]
    length = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    count = np.ceil(length / spacing).astype(np.int64) + 1
    which = np.repeat(np.arange(len(ends)), count)
    t = (np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)) / count[which]
    points: FloatArray = ends[which, 0] + t[:, None] * (ends[which, 1] - ends[which, 0])
    return points


def _dot(image: FloatArray, drawn: NDArray[np.bool_], points: FloatArray, colour: tuple[float, float, float]) -> None:
    """Paint pixels and their neighbours, and note where."""
    at = np.rint(points[:, 1::-1]).astype(np.int64)
    for rows in (-1, 0, 1):
        for columns in (-1, 0, 1):
            row = np.clip(at[:, 0] + rows, 0, image.shape[0] - 1)
            column = np.clip(at[:, 1] + columns, 0, image.shape[1] - 1)
            image[row, column] = colour
            drawn[row, column] = True
