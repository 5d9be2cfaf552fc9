"""Darts into a disk: within the bound, without overlap, the forbidden left alone."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from skinfab.flatten.distortion import measure
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import open_pieces
from skinfab.seams.darts import grow_dart
from skinfab.seams.growth import Grown, grow_darts, laid_apart, lay_out
from skinfab.seams.weights import seam_weights


def grow(mesh: Mesh, bound: float, *, forbidden: np.ndarray | None = None, apart: bool = False) -> tuple[Grown, np.ndarray]:
    none = np.zeros(len(mesh.topology.E), dtype=bool)
    (piece,) = open_pieces(mesh, none)
    start = lay_out(mesh, piece)
    grown = grow_darts(
        mesh,
        laid_apart(mesh, start) if apart else start,
        bound,
        seam_weights(mesh),
        cut=none,
        forbidden=none if forbidden is None else forbidden,
    )
    cut = none.copy()
    for dart in grown.darts:
        cut[dart.edges] = True
    return grown, cut


@pytest.mark.parametrize("bound", [4.1, 4.02])
def test_a_dome_comes_under_the_bound(bound: float) -> None:
    mesh = Mesh(*shapes.cap(12))
    grown, cut = grow(mesh, bound)
    (opened,) = open_pieces(mesh, cut)
    np.testing.assert_array_equal(opened.F, grown.piece.F)
    d = measure(mesh.V[opened.vertices], opened.F, grown.UV)
    assert grown.good and opened.is_disk and d.flipped == 0 and d.overlap_mm2 == 0
    assert d.mean == pytest.approx(grown.mean) and d.mean <= bound
    assert grown.length == pytest.approx(mesh.edge_lengths[cut].sum())


def test_less_seam_than_darts_from_the_worst_spots() -> None:
    mesh, bound = Mesh(*shapes.cap(14)), 4.03
    grown, _ = grow(mesh, bound)
    cut, weight = np.zeros(len(mesh.topology.E), dtype=bool), seam_weights(mesh)
    while True:
        (piece,) = open_pieces(mesh, cut)
        now = lay_out(mesh, piece)
        if now.mean <= bound:
            break
        d = measure(mesh.V[piece.vertices], piece.F, now.UV).d
        cut[grow_dart(mesh, piece, d, weight)] = True
    assert grown.length < 0.9 * mesh.edge_lengths[cut].sum()


def test_every_dart_had_a_reason() -> None:
    mesh = Mesh(*shapes.cap(12))
    grown, _ = grow(mesh, 4.02)
    means = [dart.mean for dart in grown.darts]
    assert len(means) > 1 and (np.diff([*means, grown.mean]) < 0).all() and min(means) > 4.02


def test_kept_apart_while_it_grows() -> None:
    """A ramp of one turn and a half with a dome's curvature: free it would cover itself."""
    V, F = shapes.helicoid(1.5, 90, 6)
    mesh = Mesh(V, F)
    none = np.zeros(len(mesh.topology.E), dtype=bool)
    (piece,) = open_pieces(mesh, none)
    free = lay_out(mesh, piece)
    assert measure(V, F, free.UV).overlap_mm2 > 0
    assert not grow_darts(mesh, free, free.mean + 0.01, seam_weights(mesh), cut=none, forbidden=none).good
    before = laid_apart(mesh, free)
    bound = 4 + 0.7 * (before.mean - 4)
    grown, cut = grow(mesh, bound, apart=True)
    (opened,) = open_pieces(mesh, cut)
    d = measure(V[opened.vertices], opened.F, grown.UV)
    assert grown.darts and d.overlap_mm2 == 0 and d.flipped == 0 and grown.mean < before.mean


def test_forbidden_edges_stay_whole() -> None:
    mesh = Mesh(*shapes.cap(12))
    _, cut = grow(mesh, 4.05)
    again, other = grow(mesh, 4.05, forbidden=cut)
    assert again.darts and not (cut & other).any()


def test_nothing_helps_when_all_is_forbidden() -> None:
    mesh = Mesh(*shapes.cap(8))
    grown, cut = grow(mesh, 4.02, forbidden=np.ones(len(mesh.topology.E), dtype=bool))
    assert not grown.good and not cut.any()


def test_a_rival_far_ahead_ends_it() -> None:
    mesh = Mesh(*shapes.cap(12))
    none = np.zeros(len(mesh.topology.E), dtype=bool)
    grown, _ = grow(mesh, 4.005)
    assert grown.length_at(grown.mean) == pytest.approx(grown.length)
    assert grown.length_at(grown.mean - 1e-9) == np.inf and grown.length_at(grown.darts[0].mean) == 0
    quick = replace(grown, darts=tuple(replace(dart, length=dart.length / 3) for dart in grown.darts), length=grown.length / 3)
    start = lay_out(mesh, open_pieces(mesh, none)[0])
    late = grow_darts(mesh, start, 4.005, seam_weights(mesh), cut=none, forbidden=none, rival=quick)
    assert not late.good and len(late.darts) < len(grown.darts)
    even = grow_darts(mesh, start, 4.005, seam_weights(mesh), cut=none, forbidden=none, rival=grown)
    assert even.good and even.length == grown.length
