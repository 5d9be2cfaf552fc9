"""Disks of any size from a formula, so that the same surface can be measured at every number of triangles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

#: Fewer triangles do not carry the bumps; more do not fit most memories.
LEAST, MOST = 150, 4_000_000

#: Of the cap, mm, and its bumps as a part of that.
_RADIUS, _BUMP = 50.0, 0.06
#: Degrees from the pole to the rim, mean and its two waves: were the rim round, maps onto a circle would look good here.
_OPENING, _OVAL, _LOBES = 62, 14, 7


def bumpy_cap(triangles: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """An oval spherical cap with bumps, about as hard to flatten as a face scan: V (n, 3) mm and F (m, 3).

    Parameters
    ----------
    triangles : int
        About how many; the nearest 6 k^2 are made.

    Raises
    ------
    InputError
        Fewer than 150 or more than 4 million.

    Examples
    --------
    >>> V, F = bumpy_cap(300)
    >>> V.shape, F.shape
    ((169, 3), (294, 3))
    """
    if not LEAST <= triangles <= MOST:
        raise InputError(f"a test disk of {triangles} triangles is not made; give {LEAST} to {MOST}")
    rings = round((triangles / 6) ** 0.5)
    # A hexagon of the triangular lattice, its rings made round.
    axis = np.arange(-rings, rings + 1)
    q, r = (a.ravel() for a in np.meshgrid(axis, axis, indexing="ij"))
    ring = np.maximum(np.maximum(abs(q), abs(r)), abs(q + r))
    inside = ring <= rings
    angle = np.arctan2(r * np.sqrt(3) / 2, q + r / 2)[inside]
    polar = np.radians(_OPENING + _OVAL * np.cos(2 * angle) + _LOBES * np.sin(3 * angle)) * ring[inside] / rings
    towards = np.stack([np.sin(polar) * np.cos(angle), np.sin(polar) * np.sin(angle), np.cos(polar)], axis=1)
    V = bumped(towards, _RADIUS, _BUMP)

    number = np.full((len(axis) + 1, len(axis) + 1), -1, dtype=np.int64)
    number[q[inside] + rings, r[inside] + rings] = np.arange(len(V))
    here, east, north, corner = number[:-1, :-1], number[1:, :-1], number[:-1, 1:], number[1:, 1:]
    F = np.concatenate([np.stack([a.ravel() for a in three], axis=1) for three in ((here, east, north), (east, corner, north))])
    return V, np.ascontiguousarray(F[(F >= 0).all(axis=1)])


def bumped(towards: NDArray[np.float64], radius: float, height: float) -> NDArray[np.float64]:
    """Points (n, 3) mm of a sphere of that radius, with bumps that are `height` of it high, seen from its middle along unit vectors."""
    x, y, z = towards.T
    bumps = np.sin(5 * x + 1) * np.cos(4 * y) + 0.5 * np.sin(9 * y + 2 * x) * z
    return radius * (1 + height * bumps)[:, None] * towards
