"""From the triangle of each pixel to its colour: light, checker board, what lights up, and smooth outlines."""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

Float32 = NDArray[np.float32]
Int32 = NDArray[np.int32]
Bytes = NDArray[np.uint8]

#: Towards the lamp, over the viewer's left shoulder: right, up, towards the viewer.
_LAMP = np.array([-0.42, 0.5, 0.76]) / np.linalg.norm([-0.42, 0.5, 0.76])

#: Light there is everywhere, as a share of the most.
_AMBIENT = np.float32(0.34)

#: Brightness of a surface seen from its inside.
_INSIDE = np.float32(0.62)

#: Darkness of every other square of the checker board.
_DARK_SQUARE = np.float32(0.58)


@dataclass(frozen=True, eq=False)
class Paint:
    """Colours of the faces of a mesh.

    Parameters
    ----------
    colour : (m, 3) uint8
        Of each face.
    tint : (m,) uint8
        Row of `tints` that is laid over it.
    tints : (t, 4) float32
        Red, green and blue from 0 to 255, and how much of it, 0 to 1; the first row is nothing.
    background : (3,) uint8
    flat : (m, 3, 2) float32, optional
        Flat place of each corner in squares of the checker board; NaN where a face has none. Without it there is no board.
    """

    colour: Bytes
    tint: Bytes
    tints: Float32
    background: Bytes
    flat: Float32 | None = None


def brightness(normals: Float32, turn: NDArray[np.float64]) -> Float32:
    """Cosines between unit normals (q, 3) and the lamp, and between them and the viewer: (q, 2); `turn` as a camera's."""
    light = np.empty((len(normals), 2), dtype=np.float32)
    _cosines(normals, np.stack([turn.T @ _LAMP, turn[2]]).astype(np.float32), light)
    return light


@numba.njit(cache=True, nogil=True)
def _cosines(normals: Float32, ways: Float32, light: Float32) -> None:
    """``normals @ ways.T``, which numpy shares among threads that wait for one another: 200 ms where other work has the processors,
    as while an object of 170,000 triangles is cut, instead of one or two."""
    for k in range(len(normals)):
        x, y, z = normals[k, 0], normals[k, 1], normals[k, 2]
        light[k, 0] = x * ways[0, 0] + y * ways[0, 1] + z * ways[0, 2]
        light[k, 1] = x * ways[1, 0] + y * ways[1, 1] + z * ways[1, 2]


#: Stands for no checker board: compiled code takes one type.
NO_BOARD = np.empty((0, 3, 2), dtype=np.float32)


@numba.njit(cache=True, nogil=True, fastmath={"nsz", "arcp", "contract", "reassoc"}, error_model="numpy")
def shade(
    face: Int32,
    screen: Float32,
    F: Int32,
    normal: Int32,
    light: Float32,
    name: Int32,
    colour: Bytes,
    tint: Bytes,
    tints: Float32,
    background: Bytes,
    flat: Float32,
    sharper: int,
    box: tuple[int, int, int, int],
    image: Bytes,
) -> None:
    """Colour a picture of the background where the object is.

    Parameters
    ----------
    face : (sharper * rows, sharper * columns) int32
        As `rasterise` gives it.
    screen : (n, 3) float32
    F, normal : (m, 3) int32
        Corners, and which row of `light` each corner has.
    light : (q, 2) float32
        As `brightness` gives it.
    name : (m,) int32
        Which row of `colour` and `tint` each face has.
    colour, tint, tints, background, flat
        As in `Paint`; `NO_BOARD` for no board.
    sharper : int
        Pixels of `face` to a pixel of the picture, either way; they are averaged.
    box : (top, bottom, left, right)
        Rows and columns of the picture outside which there is no object.
    image : (rows, columns, 3) uint8
        Is painted over.
    """
    top, bottom, left, right = box
    board = flat.shape[0] > 0
    one, half, nothing = np.float32(1), np.float32(0.5), np.float32(0)
    for row in range(top, bottom):
        for column in range(left, right):
            first = face[row * sharper, column * sharper]
            alike = not board
            for i in range(sharper):
                for j in range(sharper):
                    alike = alike and face[row * sharper + i, column * sharper + j] == first
            if first < 0 and alike:
                continue
            # Where all samples are of one triangle, its middle one stands for them.
            samples = 1 if alike else sharper
            red, green, blue = nothing, nothing, nothing
            for i in range(samples):
                for j in range(samples):
                    t = face[row * sharper + i, column * sharper + j]
                    if t < 0:
                        red += background[0]
                        green += background[1]
                        blue += background[2]
                        continue
                    own = name[t]
                    a, b, c = F[t, 0], F[t, 1], F[t, 2]
                    x0, y0 = screen[a, 0], screen[a, 1]
                    x1, y1 = screen[b, 0] - x0, screen[b, 1] - y0
                    x2, y2 = screen[c, 0] - x0, screen[c, 1] - y0
                    area = x1 * y2 - x2 * y1
                    inside = np.float32(sharper) * half if alike else half
                    px = np.float32(column * sharper + j) + inside - x0
                    py = np.float32(row * sharper + i) + inside - y0
                    # The middle of a pixel may lie beside a triangle that has the rest of it.
                    inverse = one / area
                    u = min(max((px * y2 - py * x2) * inverse, nothing), one)
                    v = min(max((py * x1 - px * y1) * inverse, nothing), one - u)
                    w = one - u - v
                    cosine = w * light[normal[t, 0], 0] + u * light[normal[t, 1], 0] + v * light[normal[t, 2], 0]
                    behind = area > 0  # rows count down
                    glow = one
                    if behind:
                        cosine, glow = -cosine, _INSIDE
                    # Half of what is turned away is lit as well, so that no side is a black patch.
                    glow *= _AMBIENT + (one - _AMBIENT) * (half + half * cosine)
                    if board and flat[own, 0, 0] == flat[own, 0, 0]:
                        s = w * flat[own, 0, 0] + u * flat[own, 1, 0] + v * flat[own, 2, 0]
                        r = w * flat[own, 0, 1] + u * flat[own, 1, 1] + v * flat[own, 2, 1]
                        if (int(np.floor(s)) + int(np.floor(r))) % 2 != 0:
                            glow *= _DARK_SQUARE
                    over = tints[tint[own], 3]
                    red += ((one - over) * colour[own, 0] + over * tints[tint[own], 0]) * glow
                    green += ((one - over) * colour[own, 1] + over * tints[tint[own], 1]) * glow
                    blue += ((one - over) * colour[own, 2] + over * tints[tint[own], 2]) * glow
            share = one / np.float32(samples * samples)
            image[row, column, 0] = np.uint8(red * share + half)
            image[row, column, 1] = np.uint8(green * share + half)
            image[row, column, 2] = np.uint8(blue * share + half)


@numba.njit(cache=True, nogil=True, fastmath={"nsz", "arcp", "contract", "reassoc"}, error_model="numpy")
def shade_quickly(
    face: Int32, light: Float32, name: Int32, colour: Bytes, tint: Bytes, tints: Float32, box: tuple[int, int, int, int], image: Bytes
) -> None:
    """The same in a quarter of the time: one brightness for all of a triangle, no averages and no board.

    Parameters
    ----------
    face : (rows, columns) int32
    light : (m, 2) float32
        Of the triangles' own normals.
    name, colour, tint, tints, box, image
        As for `shade`.
    """
    top, bottom, left, right = box
    one, half = np.float32(1), np.float32(0.5)
    red, green, blue = np.uint8(0), np.uint8(0), np.uint8(0)
    last = -1
    for row in range(top, bottom):
        for column in range(left, right):
            t = face[row, column]
            if t < 0:
                continue
            if t != last:
                last = t
                own = name[t]
                cosine, glow = light[t, 0], one
                if light[t, 1] < 0:
                    cosine, glow = -cosine, _INSIDE
                glow *= _AMBIENT + (one - _AMBIENT) * (half + half * cosine)
                k = tint[own]
                over = tints[k, 3]
                rest = (one - over) * glow
                over *= glow
                red = np.uint8(rest * colour[own, 0] + over * tints[k, 0] + half)
                green = np.uint8(rest * colour[own, 1] + over * tints[k, 1] + half)
                blue = np.uint8(rest * colour[own, 2] + over * tints[k, 2] + half)
            image[row, column, 0] = red
            image[row, column, 1] = green
            image[row, column, 2] = blue


@numba.njit(cache=True, nogil=True)
def shine(depth: Float32, spots: Float32, scale: float, radius: Float32, colour: Float32, sharper: int, image: Bytes) -> None:
    """Let spots of the surface glow, whatever its colour.

    Parameters
    ----------
    depth : (sharper * rows, sharper * columns) float32, mm
    spots : (k, 3) float32
        Column, row and depth of each spot's middle.
    scale : float
        Pixels of the picture per mm.
    radius : (k,) float32, mm
        Where the glow of each ends.
    colour : (k, 4) float32
        Red, green and blue from 0 to 255, and how much of it in the middle, 0 to 1.
    image : (rows, columns, 3) uint8
        Is painted over.
    """
    height, width = image.shape[0], image.shape[1]
    for k in range(len(spots)):
        reach = radius[k] * scale
        top, bottom = max(0, int(spots[k, 1] - reach)), min(height - 1, int(spots[k, 1] + reach) + 1)
        left, right = max(0, int(spots[k, 0] - reach)), min(width - 1, int(spots[k, 0] + reach) + 1)
        for row in range(top, bottom + 1):
            for column in range(left, right + 1):
                z = depth[row * sharper, column * sharper]
                if not np.isfinite(z):
                    continue
                dx, dy = (column + 0.5 - spots[k, 0]) / scale, (row + 0.5 - spots[k, 1]) / scale
                square = (dx * dx + dy * dy + (z - spots[k, 2]) ** 2) / (radius[k] * radius[k])
                if square < 1:
                    much = colour[k, 3] * (1 - square) ** 2
                    for c in range(3):
                        image[row, column, c] = np.uint8(image[row, column, c] * (1 - much) + colour[k, c] * much + 0.5)
