"""What a piece is refused for, each fault by itself."""

import numpy as np
import pytest
import shapes

from skinfab.mesh.model import Mesh
from skinfab.seams.cut import open_pieces
from skinfab.seams.judge import Limits, excess, judge
from skinfab.seams.lenient import fault_of
from skinfab.tolerances import OVERLAP_FRACTION


def verdict(V, F, **limits):
    mesh = Mesh(V, F)
    (piece,) = open_pieces(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    return judge(mesh, piece, Limits(**limits))


def test_a_good_piece_lies_in_its_frame() -> None:
    V, F = shapes.grid(10, 4, lambda s, t: np.stack([30 * s, 12 * t, 0 * s], axis=1))
    good = verdict(V @ shapes.rotation(3).T, F)
    assert good.accepted and not (good.too_distorted or good.overlaps or good.too_large)
    np.testing.assert_allclose(good.UV.min(axis=0), 0, atol=1e-9)
    np.testing.assert_allclose(good.UV.max(axis=0), [30, 12], rtol=1e-6)


def test_distortion_is_held_against_the_bound() -> None:
    V, F = shapes.cap(10, 1.2)
    mean = verdict(V, F, mean=9.0).distortion.mean
    assert verdict(V, F, mean=mean + 1e-6).accepted
    bad = verdict(V, F, mean=mean - 1e-3)
    assert bad.too_distorted and not bad.accepted and not bad.overlaps


def test_the_99_percent_are_held_against_their_own_bound_where_there_is_one() -> None:
    V, F = shapes.cap(10, 1.2)
    d = verdict(V, F, mean=9.0).distortion
    assert d.mean < d.p99 < d.max
    assert verdict(V, F, mean=9.0, p99=d.p99 + 1e-6).accepted
    bad = verdict(V, F, mean=9.0, p99=d.p99 - 1e-3)
    assert bad.too_distorted and not bad.accepted
    assert excess(bad.distortion, Limits(mean=9.0, p99=4.01)) == f"a p99 of d of {d.p99:.3f}, over the bound 4.01"
    assert excess(bad.distortion, Limits(mean=4.01, p99=4.01)) == f"mean d {d.mean:.3f}, over the bound 4.01"


def test_overlap_is_seen_where_it_cannot_be_avoided() -> None:
    V, F = shapes.helicoid()
    twice = verdict(V, F, mean=4.001)
    assert twice.overlaps and not twice.too_distorted and not twice.accepted
    assert twice.distortion.overlap_mm2 > 1


def test_overlap_is_avoided_where_the_bound_allows() -> None:
    """Two turns about a shaft: a wider ring at d = 4.03 lies free where the isometric one lies on itself."""
    V, F = shapes.helicoid()
    apart = verdict(V, F, mean=4.05)
    assert apart.accepted and apart.distortion.overlap_mm2 <= OVERLAP_FRACTION * Mesh(V, F).area
    assert apart.distortion.flipped == 0 and 4.01 < apart.distortion.mean <= 4.05


@pytest.mark.parametrize(("size", "fits"), [((61, 13), True), ((13, 61), True), ((59, 13), False), ((61, 11), False), ((11, 61), False)])
def test_size_either_way_round(size, fits: bool) -> None:
    V, F = shapes.grid(10, 4, lambda s, t: np.stack([60 * s, 12 * t, 0 * s], axis=1))
    assert verdict(V, F, size=size).too_large is not fits


def test_a_neck_is_refused_where_one_is_asked_about() -> None:
    V, F = shapes.grid(60, 8, lambda s, t: np.stack([60 * s, (2 * t - 1) * (6 - 5 * np.exp(-(((s - 0.4) / 0.08) ** 2))), 0 * s], axis=1))
    assert verdict(V, F).accepted
    narrow = verdict(V, F, neck=4.0)
    assert narrow.neck is not None and not narrow.accepted
    assert narrow.neck.width == pytest.approx(2, abs=0.1)
    assert fault_of(narrow, Limits(neck=4.0)) == (
        "has a neck 2.0 mm wide, and 4 mm survive handling: cut it there, or glue a dart beside it"
    )
