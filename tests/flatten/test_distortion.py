"""d against numpy's singular values and equation 1; what scale, motion and order must not change."""

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.flatten.distortion import best_scale, distortion_of, local_triangles, measure, singular_values

few = settings(max_examples=25, deadline=None)
seeds = st.integers(0, 10_000)


def random_map(seed: int):
    """A rough disk and a flat shape for it, some triangles of which are turned over."""
    V, F = shapes.random_disk(seed, 40)
    rng = np.random.default_rng(seed + 1)
    return V, F, V[:, :2] @ rng.standard_normal((2, 2)) + 0.05 * rng.standard_normal((len(V), 2))


@few
@given(seeds)
def test_singular_values_and_sign_as_numpy_has_them(seed: int) -> None:
    V, F, UV = random_map(seed)
    J = np.linalg.solve(local_triangles(V, F), UV[F[:, 1:]] - UV[F[:, :1]]).transpose(0, 2, 1)
    s = singular_values(V, F, UV)
    np.testing.assert_allclose(np.abs(s), np.linalg.svd(J, compute_uv=False), rtol=1e-9, atol=1e-9 * np.abs(s).max())
    np.testing.assert_allclose(s.prod(axis=1), np.linalg.det(J), rtol=1e-6, atol=1e-9 * np.abs(s).max() ** 2)


@few
@given(st.floats(0.01, 100), st.floats(0.01, 100))
def test_d_is_equation_1(s1: float, s2: float) -> None:
    d = distortion_of(np.array([[s1, s2]]))[0]
    assert d == pytest.approx((1 + s1**-2 * s2**-2) * (s1**2 + s2**2), rel=1e-12)
    assert d >= 4 - 1e-12


def test_collapsed_triangles_are_infinitely_distorted() -> None:
    assert np.isinf(distortion_of(np.array([[1.0, 0.0], [np.nan, np.nan], [np.inf, 1.0]]))).all()


@pytest.mark.parametrize("sheet", [shapes.cylinder_sheet, shapes.cone_sheet])
def test_known_isometries_have_d_4(sheet) -> None:
    V, F = sheet()
    if sheet is shapes.cylinder_sheet:  # chords, not arcs: each column keeps its width
        width = np.hypot(*(V[1] - V[0])[:2])
        UV = np.column_stack([np.tile(np.arange(25) * width, 11), V[:, 2]])
    else:  # rays from the apex keep their lengths, and so the angle between two of them
        slant = np.hypot(2.0, 1.0) * np.hypot(V[:, 0], V[:, 1])
        step = 2 * np.arcsin(np.linalg.norm(V[1] - V[0]) / (2 * slant[0]))
        around = np.tile(np.arange(25) * step, 11)
        UV = slant[:, None] * np.stack([np.cos(around), np.sin(around)], axis=1)
    result = measure(V, F, UV)
    np.testing.assert_allclose(singular_values(V, F, UV), 1, atol=1e-9)
    assert result.mean == pytest.approx(4, abs=1e-12) and result.max == pytest.approx(4, abs=1e-12)
    assert result.flipped == 0 and result.overlap_mm2 == 0


@few
@given(seeds, st.integers(-6, 6))
def test_motion_order_and_unit_change_nothing(seed: int, exponent: int) -> None:
    V, F, UV = random_map(seed)
    before = measure(V, F, UV)
    W, G, place = shapes.relabelled(V, F, seed)
    flat = np.empty_like(UV)
    flat[place] = UV
    c, s = np.cos(seed), np.sin(seed)
    unit = 10.0**exponent
    after = measure(unit * (W @ shapes.rotation(seed).T + 3), G, unit * (flat @ np.array([[c, s], [-s, c]]) - 7))
    for name in ("mean", "p95", "p99", "max"):
        assert getattr(after, name) == pytest.approx(getattr(before, name), rel=1e-6), name
    assert after.flipped == before.flipped
    assert after.overlap_mm2 == pytest.approx(before.overlap_mm2 * unit**2, rel=1e-6, abs=1e-9 * unit**2)


@few
@given(seeds, st.integers(0, 30))
def test_flips_are_counted(seed: int, turned: int) -> None:
    V, F = shapes.random_disk(seed, 40, noise=0)
    F[:turned] = F[:turned, ::-1]
    assert measure(V, F, V[:, :2]).flipped == min(turned, len(F))
    assert measure(V, F, V[:, :2] * [-1, 1]).flipped == len(F) - min(turned, len(F))


def test_triangles_without_area_count_nowhere() -> None:
    V, F = shapes.wavy(6)
    UV = V[:, :2] * 1.1
    plain = measure(V, F, UV)
    # A point-like, a line-like and a folded-back face, wherever their flat corners lie.
    extra = np.array([[0, 1, 1], [0, 1, len(V)], [3, 3, 3]])
    middle = (V[0] + V[1]) / 2
    more = measure(np.vstack([V, middle]), np.vstack([F, extra]), np.vstack([UV, [50.0, -9.0]]))
    assert (more.mean, more.p95, more.p99, more.max, more.flipped) == (plain.mean, plain.p95, plain.p99, plain.max, plain.flipped)
    assert (more.d[-3:] == 4).all()


@few
@given(seeds)
def test_quantiles_weigh_by_area(seed: int) -> None:
    V, F, UV = random_map(seed)
    result = measure(V, F, UV)
    p = V[F]
    area = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1) / 2
    for q, got in ((0.95, result.p95), (0.99, result.p99)):
        # The least d that so much of the area keeps to.
        enough = [d for d in result.d if area[result.d <= d].sum() >= q * area.sum() * (1 - 1e-12)]
        assert got == min(enough)
    assert result.mean == pytest.approx((result.d * area).sum() / area.sum(), rel=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_best_scale_beats_every_other(seed: int) -> None:
    V, F = shapes.random_disk(seed, 40)
    UV = V[:, :2] * [3.0, 0.8]
    best = best_scale(V, F, UV)
    scan = best * np.geomspace(0.5, 2, 201)  # the middle one is `best` itself
    means = [measure(V, F, UV * t).mean for t in scan]
    assert np.argmin(means) == 100


def test_d_is_its_angle_part_times_its_area_part() -> None:
    V, F = shapes.wavy()
    uv = V[:, :2] * [1.3, 0.8]
    found, s = measure(V, F, uv), singular_values(V, F, uv)
    np.testing.assert_allclose(found.angle, s[:, 0] / s[:, 1] + s[:, 1] / s[:, 0])
    np.testing.assert_allclose(found.area, s.prod(axis=1) + 1 / s.prod(axis=1))
    np.testing.assert_allclose(found.d, distortion_of(s))
    flat, G = shapes.grid(3, 3)
    scaled = measure(flat, G, 2 * flat[:, :2])
    np.testing.assert_allclose(scaled.angle, 2)  # as large again, but every angle kept
    np.testing.assert_allclose(scaled.area, 4.25)
