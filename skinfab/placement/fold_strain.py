"""What a conductor gains where its path crosses a sharp edge of the object that is folded, not cut."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.creases import SHARP_RAD, turns
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece

Array = NDArray[np.float64]


def fold_lengthening(mesh: Mesh, piece: Piece, ends: Array, distance: float) -> Array:
    """How much longer short pieces of a path get at sharp folds, `distance` outside a surface.

    Bent about an edge, a line at a distance from the neutral surface follows an arc that is longer by that distance times the
    angle, whatever the radius (Steiner); one that crosses askew by the sine of its angle to the edge times that.

    Parameters
    ----------
    mesh : Mesh
        The neutral surface.
    piece : Piece
    ends : (n, 2, 2) mm
        Start and end of each piece of the path, in the piece frame.
    distance : float, mm
        Of the path outside that surface.

    Returns
    -------
    (n,) mm
        Negative in a groove.
    """
    import shapely

    gained = np.zeros(len(ends))
    lines, turn = _folds(mesh, piece)
    if not len(lines) or distance == 0:
        return gained
    which, fold = shapely.STRtree([shapely.LineString(each) for each in lines]).query(shapely.linestrings(ends))
    (p, q), (a, b) = np.moveaxis(ends[which], 1, 0), np.moveaxis(lines[fold], 1, 0)
    r, s = q - p, b - a
    # By signs alone, which come out the same for all that share a point: a path through the end of an edge, or of a piece of it,
    # crosses once.
    crosses = (_cross(s, p - a) < 0) != (_cross(s, q - a) < 0)
    crosses &= (_cross(r, a - p) < 0) != (_cross(r, b - p) < 0)
    sine = np.abs(_cross(r, s)[crosses]) / (np.linalg.norm(r[crosses], axis=1) * np.linalg.norm(s[crosses], axis=1))
    np.add.at(gained, which[crosses], distance * turn[fold[crosses]] * sine)
    return gained


def _folds(mesh: Mesh, piece: Piece) -> tuple[Array, Array]:
    """Interior edges of the piece that are creases, (e, 2, 2) mm in the plane; how they turn, (e,) rad."""
    turn = turns(Mesh(piece.V(mesh), piece.F))
    sharp = np.flatnonzero(np.abs(turn) > SHARP_RAD)
    return piece.UV[piece.topology.E[sharp]], turn[sharp]


def _cross(u: Array, v: Array) -> Array:
    out: Array = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    return out
