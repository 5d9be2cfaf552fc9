"""Which triangle each pixel shows and how far it is: a compiled z-buffer.

Colours come later (`gui.view3d.shade`), from the numbers of the triangles. So a change of colours, such as what is under the
pointer, draws no triangle anew, and to find what is under a pixel is to look it up.
"""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

Float32 = NDArray[np.float32]
Int32 = NDArray[np.int32]

#: Pixel centres this far (barycentric) outside a triangle are still painted: rounding must open no gap between neighbours.
_EDGE = np.float32(1e-5)


@numba.njit(cache=True, nogil=True)
def project(V: Float32, rows: Float32, shift: Float32, screen: Float32) -> None:
    """Screen places of points.

    Parameters
    ----------
    V : (n, 3) float32, mm
    rows : (3, 3) float32
        What x, y and z add to the column, the row (both pixels) and the depth (mm, larger is farther).
    shift : (3,) float32
    screen : (n, 3) float32
        Is filled with column, row and depth.
    """
    for i in range(V.shape[0]):
        x, y, z = V[i, 0], V[i, 1], V[i, 2]
        for k in range(3):
            screen[i, k] = rows[k, 0] * x + rows[k, 1] * y + rows[k, 2] * z + shift[k]


# Not the whole of fastmath: depth is infinite where there is nothing.
@numba.njit(cache=True, nogil=True, fastmath={"nsz", "arcp", "contract", "reassoc"}, error_model="numpy")
def rasterise(screen: Float32, F: Int32, closed: bool, face: Int32, depth: Float32) -> int:
    """Draw triangles into a grid of pixels, nearest on top.

    Parameters
    ----------
    screen : (n, 3) float32
        Column, row (pixels; the centre of the first pixel is at 0.5, 0.5) and depth of each vertex.
    F : (m, 3) int32
        Counter-clockwise from outside, rows counted down.
    closed : bool
        The surface has no border: triangles seen from behind are hidden anyway, and left out.
    face : (rows, columns) int32
        Is filled with the number of the triangle a pixel shows; -1 where there is none.
    depth : (rows, columns) float32
        Is filled with its depth; infinite where there is none.

    Returns
    -------
    How many triangles touched a pixel's centre line and were looked at pixel by pixel.

    Examples
    --------
    >>> screen = np.array([[0, 0, 1], [0, 3, 1], [4, 0, 1]], dtype=np.float32)
    >>> face, depth = np.empty((3, 4), dtype=np.int32), np.empty((3, 4), dtype=np.float32)
    >>> rasterise(screen, np.array([[0, 1, 2]], dtype=np.int32), True, face, depth), face.tolist()
    (1, [[0, 0, 0, -1], [0, 0, -1, -1], [0, -1, -1, -1]])
    """
    height, width = depth.shape
    face[:] = -1
    depth[:] = np.inf
    drawn = 0
    one, half, nothing = np.float32(1), np.float32(0.5), np.float32(0)  # a literal would make it double precision, and slower
    for t in range(F.shape[0]):
        a, b, c = F[t, 0], F[t, 1], F[t, 2]
        x0, y0 = screen[a, 0], screen[a, 1]
        x1, y1 = screen[b, 0] - x0, screen[b, 1] - y0
        x2, y2 = screen[c, 0] - x0, screen[c, 1] - y0
        area = x1 * y2 - x2 * y1
        if area == 0 or (closed and area > 0):
            continue
        left = max(0, int(np.ceil(x0 + min(min(x1, x2), nothing) - half)))
        right = min(width - 1, int(np.floor(x0 + max(max(x1, x2), nothing) - half)))
        top = max(0, int(np.ceil(y0 + min(min(y1, y2), nothing) - half)))
        bottom = min(height - 1, int(np.floor(y0 + max(max(y1, y2), nothing) - half)))
        if left > right or top > bottom:
            continue
        drawn += 1
        z0 = screen[a, 2]
        z1, z2 = screen[b, 2] - z0, screen[c, 2] - z0
        inverse = one / area
        u_x, u_y = y2 * inverse, -x2 * inverse
        v_x, v_y = -y1 * inverse, x1 * inverse
        px, py = np.float32(left) + half - x0, np.float32(top) + half - y0
        u_row = px * u_x + py * u_y
        v_row = px * v_x + py * v_y
        for row in range(top, bottom + 1):
            u, v = u_row, v_row
            u_row += u_y
            v_row += v_y
            for column in range(left, right + 1):
                if u >= -_EDGE and v >= -_EDGE and u + v <= one + _EDGE:
                    z = z0 + u * z1 + v * z2
                    if z < depth[row, column]:
                        depth[row, column] = z
                        face[row, column] = t
                u += u_x
                v += v_x
    return drawn
