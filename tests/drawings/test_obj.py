"""The flat OBJ is read back by other libraries and by the letter."""

from __future__ import annotations

from pathlib import Path

import igl
import numpy as np
import pytest
from numpy.typing import NDArray

from skinfab.drawings.obj import write_flat_obj
from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece


def grid(n: int) -> tuple[Mesh, Piece]:
    """A wavy n x n sheet and a flat piece of it."""
    x, y = np.meshgrid(np.arange(n + 1) / 3, np.arange(n + 1) / 7, indexing="ij")
    at = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    a, b, c, d = (at[s].ravel() for s in (np.s_[:-1, :-1], np.s_[1:, :-1], np.s_[1:, 1:], np.s_[:-1, 1:]))
    F = np.vstack([np.c_[a, b, c], np.c_[a, c, d]])
    V = np.c_[x.ravel(), y.ravel(), np.sin(x + y).ravel()]
    return Mesh(V, F, "sheet"), Piece("P1", np.arange(len(F)), np.arange(len(V)), F, V[:, :2].copy())


def split(mesh: Mesh, faces: NDArray[np.int64], id: str) -> Piece:
    used, F = np.unique(mesh.F[faces], return_inverse=True)
    return Piece(id, faces, used, F.reshape(-1, 3), mesh.V[used, :2] - mesh.V[used, :2].min(axis=0))


def test_read_back_is_identical_in_face_order(tmp_path: Path) -> None:
    mesh, _ = grid(6)
    rng = np.random.default_rng(3)
    first = np.sort(rng.permutation(len(mesh.F))[:30])
    pieces = [split(mesh, first, "P1"), split(mesh, np.setdiff1d(np.arange(len(mesh.F)), first), "P2")]
    offsets = np.array([[0.0, 0.0], [1 / 3 + 100, 1e-5]])
    write_flat_obj(mesh, pieces, offsets, tmp_path / "flat.obj")
    V, TC, _, F, FTC, _ = igl.readOBJ(str(tmp_path / "flat.obj"))
    np.testing.assert_allclose(V, mesh.V, rtol=1e-12, atol=1e-12)
    assert np.array_equal(F, mesh.F)
    for piece, offset in zip(pieces, offsets, strict=True):
        np.testing.assert_allclose(TC[FTC[piece.faces]], (piece.UV + offset)[piece.F], rtol=1e-12, atol=1e-12)


def test_faces_missing_or_double_are_refused(tmp_path: Path) -> None:
    mesh, piece = grid(2)
    part = split(mesh, np.arange(1, 8), "P1")
    with pytest.raises(InputError, match="face 0 of sheet lies on 0 pieces"):
        write_flat_obj(mesh, [part], np.zeros((1, 2)), tmp_path / "flat.obj")
    with pytest.raises(InputError, match="face 1 of sheet lies on 2 pieces"):
        write_flat_obj(mesh, [piece, part], np.zeros((2, 2)), tmp_path / "flat.obj")
    assert not list(tmp_path.iterdir())
