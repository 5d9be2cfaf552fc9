"""Gluing: a polyhedron's sides become its net again, and only where the joined piece keeps to the limits."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from skinfab.mesh.model import Mesh
from skinfab.seams.creases import crease_seams
from skinfab.seams.cut import open_pieces, seam_length
from skinfab.seams.glue import glue_pieces
from skinfab.seams.judge import Limits, Parted, judge


def parted(mesh: Mesh, cut: np.ndarray, limits: Limits):
    return [(p, judge(mesh, p, limits)) for p in open_pieces(mesh, cut)]


@pytest.mark.parametrize(("name", "sides"), [("cube", 6), ("dodecahedron", 12)])
def test_sides_become_one_net(name: str, sides: int) -> None:
    mesh, limits = shapes.object_mesh(name), Limits()
    apart = crease_seams(mesh)
    pieces = parted(mesh, apart, limits)
    assert len(pieces) == sides
    cut, ((net, verdict),) = glue_pieces(mesh, apart, pieces, limits, neck=4.0, excess=1e-6)
    assert verdict.accepted and verdict.distortion.mean == pytest.approx(4, abs=1e-9)
    # A net of n sides keeps n - 1 edges; each side's edge is as long as the next.
    side = mesh.edge_lengths[apart].max()
    assert seam_length(mesh, apart) - seam_length(mesh, cut) == pytest.approx((sides - 1) * side, rel=1e-6)
    assert not (cut & ~apart).any()
    (again,) = open_pieces(mesh, cut)
    np.testing.assert_array_equal(again.F, net.F)


def test_borders_shorter_than_the_neck_stay_open() -> None:
    mesh, limits = shapes.object_mesh("cube"), Limits()
    apart = crease_seams(mesh)
    cut, pieces = glue_pieces(mesh, apart, parted(mesh, apart, limits), limits, neck=40.1, excess=1.0)
    assert len(pieces) == 6 and (cut == apart).all()


def test_only_small_ones_when_asked() -> None:
    mesh, limits = shapes.object_mesh("cube"), Limits()
    apart = crease_seams(mesh)
    assert len(glue_pieces(mesh, apart, parted(mesh, apart, limits), limits, neck=4, excess=1.0, smaller_than=1599.0)[1]) == 6
    assert len(glue_pieces(mesh, apart, parted(mesh, apart, limits), limits, neck=4, excess=1.0, smaller_than=1601.0)[1]) == 1


def strips(count: int) -> tuple[Mesh, np.ndarray]:
    """A flat sheet, 10 mm for each of `count` strips of 40 mm, and the cuts between these."""
    V, F = shapes.grid(count, 4, lambda s, t: np.stack([10 * count * s, 40 * t, 0 * s], axis=1))
    mesh = Mesh(V, F)
    strip = mesh.V[F].mean(axis=1)[:, 0] // 10
    EF = mesh.topology.EF
    return mesh, (EF[:, 1] >= 0) & (strip[EF[:, 0]] != strip[EF[:, 1]])


@pytest.mark.parametrize(("count", "flat"), [(2, True), (3, False)])
def test_what_only_the_bed_keeps_apart_says_so(count: int, flat: bool) -> None:
    mesh, apart = strips(count)
    limits = Limits(size=(41.0, 15.0))
    cut, pieces = glue_pieces(mesh, apart, parted(mesh, apart, limits), limits, neck=4.0, excess=1.0)
    assert (cut == apart).all()
    assert [v.parted for _, v in pieces] == [Parted(0, large=True, neck=0.0, flat=flat)] * count


def test_what_is_joined_after_all_or_known_already_is_not_said_anew() -> None:
    mesh, apart = strips(4)
    limits = Limits(size=(41.0, 25.0))  # two and two
    _, pieces = glue_pieces(mesh, apart, parted(mesh, apart, limits), limits, neck=4.0, excess=1.0)
    assert len(pieces) == 2 and [v.parted for _, v in pieces] == [Parted(0, large=True, neck=0.0, flat=True)] * 2
    known = Parted(7, large=False, neck=3.0, flat=False)
    before = [(piece, replace(verdict, parted=known)) for piece, verdict in pieces]
    cut = np.zeros_like(apart)
    cut[mesh.topology.FE[pieces[0][0].faces].ravel()] = True
    cut &= np.bincount(mesh.topology.FE[pieces[1][0].faces].ravel(), minlength=len(cut)) > 0
    _, after = glue_pieces(mesh, cut, before, limits, neck=4.0, excess=1.0)
    assert [v.parted for _, v in after] == [known] * 2


def test_never_past_the_bound_the_bed_or_the_allowance() -> None:
    """A hemisphere in six lunes: whole it has d = 4.14, halves less."""
    V, F = shapes.cap(12)
    mesh = Mesh(V, F)
    label = (np.arctan2(*V[F].mean(axis=1)[:, 1::-1].T) // (np.pi / 3)).astype(int)
    topology = mesh.topology
    apart = (topology.EF[:, 1] >= 0) & (label[topology.EF[:, 0]] != label[topology.EF[:, 1]])
    for limits, excess in ((Limits(mean=4.05), 1.0), (Limits(mean=9.0), 0.01), (Limits(mean=9.0, size=(2.0, 2.0)), 1.0)):
        lunes = parted(mesh, apart, limits)
        _, pieces = glue_pieces(mesh, apart, lunes, limits, neck=0.1, excess=excess)
        assert 1 < len(pieces) < 6 and all(v.accepted for _, v in pieces)
        assert all((v.parted is not None) == (limits.size == (2.0, 2.0)) for _, v in pieces)
        if excess < 1:
            assert max(v.distortion.mean for _, v in pieces) < 4.0 + 0.04
    assert len(glue_pieces(mesh, apart, parted(mesh, apart, Limits(mean=9.0)), Limits(mean=9.0), neck=0.1, excess=1.0)[1]) == 1


def test_borders_are_not_glued_past_a_cone() -> None:
    """Two halves of a cube meet along four edges through corners: glued edge by edge, never closing a corner."""
    V, F = shapes.cube(2)
    mesh = Mesh(V, F)
    sides = np.abs(mesh.face_normals[:, 0]) > 0.5  # two opposite sides, and the belt of four
    topology = mesh.topology
    apart = sides[topology.EF[:, 0]] != sides[topology.EF[:, 1]]
    belt_open = apart.copy()
    edge = topology.E[~apart]
    along = np.flatnonzero(~apart)[(V[edge][:, :, 1] == 0).all(axis=1) & (V[edge][:, :, 2] == 0).all(axis=1)]
    belt_open[along] = True
    limits = Limits()
    pieces = parted(mesh, belt_open, limits)
    assert len(pieces) == 3
    _, ((_, verdict),) = glue_pieces(mesh, belt_open, pieces, limits, neck=0.1, excess=1e-6)
    assert verdict.distortion.mean == pytest.approx(4, abs=1e-9)  # one edge each, not the whole rim at once
