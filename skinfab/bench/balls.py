"""A closed surface of any size from a formula, so that seams can be measured on it at every number of triangles."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from skinfab.bench.disks import LEAST, MOST, bumped
from skinfab.errors import InputError

#: Of the ball, mm, and its bumps as a part of that.
_RADIUS, _BUMP = 30.0, 0.08


def bumpy_ball(triangles: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A ball with bumps, which no single cut flattens well: V (n, 3) mm and F (m, 3), closed, wound outward.

    Parameters
    ----------
    triangles : int
        About how many; the nearest 8 k^2 are made, an octahedron's.

    Raises
    ------
    InputError
        Fewer than 150 or more than 4 million.

    Examples
    --------
    >>> V, F = bumpy_ball(300)
    >>> V.shape, F.shape
    ((146, 3), (288, 3))
    """
    if not LEAST <= triangles <= MOST:
        raise InputError(f"a test ball of {triangles} triangles is not made; give {LEAST} to {MOST}")
    k = round((triangles / 8) ** 0.5)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(k + 1), np.arange(k + 1), indexing="ij"))
    up, down = i + j < k, i + j < k - 1
    corners = (
        [(i[up], j[up]), (i[up] + 1, j[up]), (i[up], j[up] + 1)],
        [(i[down] + 1, j[down]), (i[down] + 1, j[down] + 1), (i[down], j[down] + 1)],
    )
    octant = np.concatenate([np.stack([np.stack([a, b, k - a - b], axis=1) for a, b in three], axis=1) for three in corners])
    signs = np.array(list(itertools.product((1, -1), repeat=3)))
    faces = [(octant * sign)[:, :: int(sign.prod())] for sign in signs]  # a mirrored octant is wound the other way
    lattice, F = np.unique(np.concatenate(faces).reshape(-1, 3), axis=0, return_inverse=True)

    # Steps of the same angle along the octahedron's edges, so that no part of the ball has much larger triangles than another.
    towards = np.sin(lattice / k * (np.pi / 2))
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    return bumped(towards, _RADIUS, _BUMP), F.reshape(-1, 3).astype(np.int64)
