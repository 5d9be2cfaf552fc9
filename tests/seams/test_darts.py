"""Darts: from the worst spot by the shortest way to the boundary, and worth their length."""

import numpy as np
import pytest
import shapes

from skinfab.mesh.model import Mesh
from skinfab.seams.cut import open_pieces
from skinfab.seams.darts import grow_dart
from skinfab.seams.judge import Limits, judge
from skinfab.seams.weights import seam_weights


def whole(mesh: Mesh):
    (piece,) = open_pieces(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    return piece


@pytest.mark.parametrize("angle", [1.2, np.pi / 2, 2.4])
def test_relieves_a_sphere_cap(angle: float) -> None:
    mesh = Mesh(*shapes.cap(12, angle))
    piece = whole(mesh)
    before = judge(mesh, piece, Limits(mean=4.0001)).distortion
    dart = grow_dart(mesh, piece, before.d, seam_weights(mesh))
    ends = np.bincount(mesh.topology.E[dart].ravel(), minlength=len(mesh.V))
    assert (ends == 1).sum() == 2 and ends.max() == 2 and (ends == 2).sum() == len(dart) - 1  # one unbranched path
    rim = np.zeros(len(mesh.V), dtype=bool)
    rim[mesh.topology.boundary_loops[0]] = True
    assert (ends > 0)[rim].sum() == 1
    cut = np.zeros(len(mesh.topology.E), dtype=bool)
    cut[dart] = True
    (opened,) = open_pieces(mesh, cut)
    assert opened.is_disk
    assert judge(mesh, opened, Limits(mean=10)).distortion.mean - 4 < 0.7 * (before.mean - 4)


def test_ends_on_the_cone() -> None:
    """A pyramid of 12 sides on a flat skirt: all curvature is at its tip and at its foot."""
    V, F = shapes.cap(12)
    r = np.hypot(V[:, 0], V[:, 1])
    around = V[:, :2] / np.where(r > 0, r, 1)[:, None]
    ring = np.arccos(np.clip(V[:, 2], -1, 1)) / (np.pi / 2)
    mesh = Mesh(np.column_stack([around * ring[:, None], 0.8 * (1 - ring)]), F)
    piece = whole(mesh)
    d = judge(mesh, piece, Limits(mean=4.0001)).distortion.d
    dart = grow_dart(mesh, piece, d, seam_weights(mesh))
    assert 0 in mesh.topology.E[dart]  # the tip


def test_a_needle_does_not_draw_the_dart() -> None:
    mesh = Mesh(*shapes.cap(12))
    piece = whole(mesh)
    d = judge(mesh, piece, Limits(mean=4.0001)).distortion.d
    first = grow_dart(mesh, piece, d, seam_weights(mesh))
    tiny = mesh.V.copy()
    tiny[200] = tiny[201] + 1e-9
    d = d.copy()
    d[np.isin(mesh.F, [200]).any(axis=1) & np.isin(mesh.F, [201]).any(axis=1)] = np.inf
    again = grow_dart(Mesh(tiny, mesh.F), piece, d, seam_weights(mesh))
    start = [int(np.flatnonzero(np.bincount(mesh.topology.E[x].ravel()) == 1)[0]) for x in (first, again)]
    assert start[0] == start[1]


def test_none_without_an_inner_vertex() -> None:
    mesh = Mesh(*shapes.grid(10, 1))
    assert len(grow_dart(mesh, whole(mesh), np.full(20, 9.0), mesh.edge_lengths)) == 0
