"""Whoever gets more pieces than the bound asks for is told which length is why."""

from dataclasses import replace

import numpy as np
import pytest
from shapes import grid

from skinfab.mesh.model import Mesh
from skinfab.seams.auto import Aim, find_seams
from skinfab.seams.judge import Limits, Parted
from skinfab.seams.parted import carried_parted, parted_text
from skinfab.seams.partial import auto_cut
from skinfab.skin import Skin, Source

LIMITS = Limits(mean=4.05)

aims = pytest.mark.parametrize("aim", ["fewest", "usual"])


def sheet() -> Mesh:
    V, F = grid(8, 8)
    return Mesh(40 * V, F)


def dumbbell() -> Mesh:
    """Two squares of 21 mm on a strip 3 mm wide."""
    V, F = grid(21, 7, lambda s, t: np.stack([63 * s, 21 * t, 0 * s], axis=1))
    x, y = V[F].mean(axis=1)[:, :2].T
    F = F[(abs(x - 31.5) > 10.5) | (abs(y - 10.5) < 1.5)]
    used, F = np.unique(F, return_inverse=True)
    return Mesh(V[used], F.reshape(-1, 3))


@aims
def test_the_bed(aim: Aim) -> None:
    small = replace(LIMITS, size=(45.0, 30.0))
    found = find_seams(sheet(), small, aim=aim)
    assert len(found.pieces) == 2
    (said,) = parted_text(found.pieces, small)
    assert said.startswith("2 of the pieces are parts of what does not fit the bed") and "(45 x 30 mm); 1 piece would do" in said
    assert parted_text(find_seams(sheet(), LIMITS, aim=aim).pieces, LIMITS) == []


@aims
def test_a_neck(aim: Aim) -> None:
    narrow = replace(LIMITS, neck=4.0)
    mesh = dumbbell()
    found = find_seams(mesh, narrow, aim=aim)
    assert len(found.pieces) == 2
    (said,) = parted_text(found.pieces, narrow)
    assert said.startswith("2 of the pieces are parted at a neck of 3 mm, as 4 mm survive") and "1 piece would do if" in said
    assert len(find_seams(mesh, LIMITS, aim=aim).pieces) == 1
    skin = Skin(mesh, Source("a.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), dtype=np.int64), ())
    assert auto_cut(skin, narrow, aim=aim).notes == (said,)


def test_what_would_not_be_flat_either_is_no_promise() -> None:
    found = find_seams(sheet(), replace(LIMITS, size=(45.0, 30.0)))
    pieces = [(piece, replace(verdict, parted=Parted(0, large=True, neck=0.0, flat=False))) for piece, verdict in found.pieces]
    (said,) = parted_text(pieces, LIMITS)
    assert "there may be fewer on a larger one" in said


def test_a_fine_mesh_knows_what_the_coarse_one_knew() -> None:
    coarse = sheet()
    found = find_seams(coarse, replace(LIMITS, size=(45.0, 30.0)))
    V, F = grid(30, 30)
    fine = Mesh(40 * V, F)
    plain = find_seams(fine, LIMITS).pieces
    assert [verdict.parted for _, verdict in carried_parted(coarse, found.pieces, fine, plain)] == [found.pieces[0][1].parted]
