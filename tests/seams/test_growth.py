"""Darts into a sheet: within the bound, without overlap, the forbidden left alone."""

import numpy as np
import pytest
import shapes

from skinfab.flatten.distortion import measure
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import open_pieces
from skinfab.seams.darts import grow_dart
from skinfab.seams.growth import best_darts, grow, with_dart
from skinfab.seams.sheet import Sheet, Surface, lay_apart, lay_out, sheet_of
from skinfab.seams.weights import seam_weights


def whole(mesh: Mesh, forbidden: np.ndarray | None = None) -> Sheet:
    none = np.zeros(len(mesh.topology.E), dtype=bool)
    sheet = sheet_of(Surface(mesh, seam_weights(mesh), none if forbidden is None else forbidden), none)
    assert sheet is not None
    return lay_out(sheet)


@pytest.mark.parametrize("bound", [4.1, 4.02])
def test_a_dome_comes_under_the_bound(bound: float) -> None:
    mesh = Mesh(*shapes.cap(12))
    grown = grow(whole(mesh), bound)
    (opened,) = open_pieces(mesh, grown.cut)
    np.testing.assert_array_equal(opened.F, grown.F)
    d = measure(mesh.V[opened.vertices], opened.F, grown.UV)
    assert opened.is_disk and d.flipped == 0 and d.overlap_mm2 == 0
    assert d.mean == pytest.approx(grown.mean) and d.mean <= bound
    assert grown.length == pytest.approx(mesh.edge_lengths[grown.cut].sum())


def test_less_seam_than_darts_from_the_worst_spots() -> None:
    mesh, bound = Mesh(*shapes.cap(14)), 4.03
    now = whole(mesh)
    while now.mean > bound:
        (piece,) = open_pieces(mesh, now.cut)
        cut = now.cut.copy()
        cut[grow_dart(mesh, piece, now.d, now.surface.weight)] = True
        opened = sheet_of(now.surface, cut)
        assert opened is not None
        now = lay_out(opened)
    assert grow(whole(mesh), bound).length < 0.9 * now.length


def test_every_dart_lowers_d() -> None:
    now = whole(Mesh(*shapes.cap(12)))
    for _ in range(3):
        after = with_dart(now, best_darts(now, 4.02)[0])
        assert after is not None and after.mean < now.mean and after.length > now.length
        now = after


def test_kept_apart_while_it_grows() -> None:
    """A ramp of one turn and a half with a dome's curvature: free it would cover itself."""
    mesh = Mesh(*shapes.helicoid(1.5, 90, 6))
    free = whole(mesh)
    assert measure(mesh.V, mesh.F, free.UV).overlap_mm2 > 0 and not free.is_simple
    before = lay_apart(free)
    grown = grow(before, 4 + 0.7 * (before.mean - 4))
    d = measure(mesh.V[grown.origin], grown.F, grown.UV)
    assert grown.cut.any() and d.overlap_mm2 == 0 and d.flipped == 0 and grown.mean < before.mean


def test_forbidden_edges_stay_whole() -> None:
    mesh = Mesh(*shapes.cap(12))
    cut = grow(whole(mesh), 4.05).cut
    again = grow(whole(mesh, forbidden=cut), 4.05).cut
    assert again.any() and not (cut & again).any()


def test_nothing_helps_when_all_is_forbidden() -> None:
    mesh = Mesh(*shapes.cap(8))
    grown = grow(whole(mesh, forbidden=np.ones(len(mesh.topology.E), dtype=bool)), 4.02)
    assert grown.mean > 4.02 and not grown.cut.any()


def test_given_up_when_it_is_no_shorter() -> None:
    mesh = Mesh(*shapes.cap(12))
    grown = grow(whole(mesh), 4.02)
    late = grow(whole(mesh), 4.02, shorter_than=0.9 * grown.length)
    assert late.mean > 4.02 and late.length < 0.9 * grown.length


def test_hot_spots_are_cut_to_their_own_bound() -> None:
    mesh = Mesh(*shapes.cap(12))
    grown = grow(whole(mesh), 4.05)
    bound = 4 + 0.7 * (grown.p99 - 4)
    held = grow(grown, 4.05, p99=bound)
    assert held.p99 <= bound and held.length > grown.length
