"""The object and its flat pieces in one OBJ file, so that anyone can compute the distortion anew."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinfab.decimals import counts, write_rows
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
    corners = np.empty((len(mesh.F), 3), dtype=np.int64)
    first = 0
    for piece in pieces:
        corners[piece.faces] = piece.F + first
        first += len(piece.UV)
    flat = np.vstack([np.zeros((0, 2)), *(piece.UV + offset for piece, offset in zip(pieces, offsets, strict=True))])
    text = b"".join(
        [
            f"# skinfab: v is {' '.join(mesh.name.split())} in mm, vt its flat pieces in mm\n".encode(),
            write_rows(b"v", mesh.V),
            write_rows(b"vt", flat),
            _face_lines(mesh.F, corners, len(flat)),
        ]
    )
    atomic_write(path, text)


# Faces written at a time: bounds the memory, 50 bytes and their mask a face.
_AT_A_TIME = 1 << 18


def _face_lines(F: NDArray[np.int64], corners: NDArray[np.int64], n_flat: int) -> bytes:
    """``f v/vt v/vt v/vt`` a face: each flat point belongs to one vertex, so that ``v/vt`` is made once for all faces about it."""
    vertex = np.zeros(n_flat, dtype=np.int64)
    vertex[corners] = F
    word = [counts(vertex + 1), np.full((n_flat, 1), ord("/"), np.uint8), counts(np.arange(1, n_flat + 1))]
    letters = np.hstack([np.full((n_flat, 1), ord(" "), np.uint8), *word])  # padded with zeros
    parts = []
    for start in range(0, len(corners), _AT_A_TIME):
        some = corners[start : start + _AT_A_TIME]
        line = np.empty((len(some), 3 * letters.shape[1] + 2), dtype=np.uint8)
        line[:, 0], line[:, -1] = ord("f"), ord("\n")
        line[:, 1:-1] = letters[some].reshape(len(some), -1)
        line = line.ravel()
        parts.append(line[line != 0].tobytes())
    return b"".join(parts)
