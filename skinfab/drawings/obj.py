"""The object and its flat pieces in one OBJ file, so that anyone can compute the distortion anew."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.files import atomic_write
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece


def write_flat_obj(mesh: Mesh, pieces: Sequence[Piece], offsets: NDArray[np.float64], path: str | Path) -> None:
    """Write the mesh as v and the flat pieces as vt, both mm, joined corner by corner.

    Every face of the mesh is written once and in its order, whatever piece it lies on.

    Parameters
    ----------
    mesh : Mesh
        The surface that was flattened.
    pieces : sequence of Piece
        Together they hold each face once.
    offsets : (k, 2) float64, mm
        Where each piece lies on the sheet, see `skinfab.drawings.sheet.sheet_offsets`.
    path : path

    Raises
    ------
    InputError
        A face lies on no piece or on two, or the file cannot be written.
    """
    count = np.bincount(np.concatenate([np.zeros(0, np.int64), *(piece.faces for piece in pieces)]), minlength=len(mesh.F))
    wrong = np.flatnonzero(count != 1)
    if len(wrong) or len(count) > len(mesh.F):
        raise InputError(f"face {wrong[0]} of {mesh.name} lies on {count[wrong[0]]} pieces instead of one; cut and flatten the mesh again")
    corners = np.empty((len(mesh.F), 3, 2), dtype=np.int64)
    corners[:, :, 0] = mesh.F
    first = 0
    for piece in pieces:
        corners[piece.faces, :, 1] = piece.F + first
        first += len(piece.UV)
    flat = np.vstack([np.zeros((0, 2)), *(piece.UV + offset for piece, offset in zip(pieces, offsets, strict=True))])
    text = "".join(
        [
            f"# skinfab: v is {' '.join(mesh.name.split())} in mm, vt its flat pieces in mm\n",
            _lines("v %.12g %.12g %.12g\n", mesh.V),
            _lines("vt %.12g %.12g\n", flat),
            _lines("f %d/%d %d/%d %d/%d\n", corners + 1),
        ]
    )
    atomic_write(path, text)


def _lines(form: str, rows: NDArray[np.float64] | NDArray[np.int64]) -> str:
    """One line a row: a single % over all values is several times faster than a loop or savetxt."""
    return (form * len(rows)) % tuple(rows.ravel().tolist())
