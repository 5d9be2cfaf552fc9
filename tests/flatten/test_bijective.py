"""The barrier against brute force; ramps that lie on themselves when flat come out free of overlap."""

import numpy as np
import pytest
import shapely
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.flatten._barrier import barrier_assemble, barrier_energy, first_crossing
from skinfab.flatten.bijective import flatten_bijective
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import measure
from skinfab.mesh.model import Mesh
from skinfab.tolerances import OVERLAP_FRACTION

few = settings(max_examples=25, deadline=None)
seeds = st.integers(0, 10_000)


def star(seed: int, count: int = 24):
    """A simple polygon with vertices near edges, and its loop in another order than its vertices'."""
    rng = np.random.default_rng(seed)
    angle = 2 * np.pi * (np.arange(count) + 0.3 * rng.random(count)) / count
    radius = rng.uniform(0.3, 1, count)
    loop = rng.permutation(count)
    u = np.empty((count, 2))
    u[loop] = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return u, loop, rng


def pairs(u, loop):
    """Each vertex with each edge that is not its own, by shapely: vertex, edge ends, distance."""
    for k, p in enumerate(loop):
        for j in range(len(loop)):
            a, b = loop[j], loop[(j + 1) % len(loop)]
            if k not in (j, (j + 1) % len(loop)):
                yield p, a, b, shapely.LineString(u[[a, b]]).distance(shapely.Point(u[p]))


@few
@given(seeds, st.floats(0.05, 0.5))
def test_barrier_is_the_sum_over_near_pairs(seed: int, reach: float) -> None:
    u, loop, _ = star(seed)
    want = sum((reach / d - 1) ** 2 for *_, d in pairs(u, loop) if d < reach)
    assert barrier_energy(u, loop, reach) == pytest.approx(want, rel=1e-9)


def test_barrier_is_endless_at_contact_and_nothing_beyond_reach() -> None:
    u, loop, _ = star(0)
    nearest = min(d for *_, d in pairs(u, loop))
    assert barrier_energy(u, loop, 0.999 * nearest) == 0 < barrier_energy(u, loop, 1.001 * nearest)
    u[loop[5]] = (u[loop[9]] + u[loop[10]]) / 2
    assert barrier_energy(u, loop, 0.1) > 1e20


def derivatives(u, loop, reach):
    n = 2 * len(u)
    indptr = np.concatenate([[0], np.cumsum(np.arange(n, 0, -1))])  # a full lower triangle, column by column
    data, gradient = np.zeros(indptr[-1]), np.zeros(n)
    barrier_assemble(u, loop, reach, 3.0, indptr, data, gradient)
    H = np.zeros((n, n))
    H.T[np.triu_indices(n)] = data
    return gradient, H + np.tril(H, -1).T


@few
@given(seeds)
def test_gradient_is_the_barriers(seed: int) -> None:
    u, loop, _ = star(seed, 12)
    reach = 0.4
    gradient, _ = derivatives(u, loop, reach)
    h = 1e-7
    steps = h * np.eye(u.size).reshape(-1, *u.shape)
    difference = [3 * (barrier_energy(u + e, loop, reach) - barrier_energy(u - e, loop, reach)) / (2 * h) for e in steps]
    np.testing.assert_allclose(gradient, difference, rtol=1e-4, atol=1e-4 * np.abs(gradient).max() + 1e-9)


@few
@given(seeds)
def test_hessian_bounds_gauss_newtons_from_above(seed: int) -> None:
    u, loop, _ = star(seed, 12)
    reach = 0.4
    _, H = derivatives(u, loop, reach)
    gauss_newton = np.zeros_like(H)
    for p, a, b, d in pairs(u, loop):
        if d < reach:
            edge = shapely.LineString(u[[a, b]])
            t = edge.project(shapely.Point(u[p]), normalized=True)
            normal = (u[p] - (1 - t) * u[a] - t * u[b]) / d
            w = np.zeros(u.shape)
            w[p], w[a], w[b] = normal, -(1 - t) * normal, -t * normal
            second = 3 * (2 * reach**2 / d**4 + 4 * (reach / d - 1) * reach / d**3)  # of (reach / d - 1)^2 in d
            gauss_newton += second * np.outer(w, w)
    scale = max(np.abs(H).max(), 1e-300)
    assert np.linalg.eigvalsh(H - gauss_newton).min() > -1e-9 * scale
    assert np.linalg.eigvalsh(H).min() > -1e-9 * scale


@settings(max_examples=60, deadline=None)
@given(seeds, st.floats(0.05, 3))
def test_first_crossing_is_the_first(seed: int, size: float) -> None:
    u, loop, rng = star(seed)
    step = size * rng.standard_normal(u.shape)
    t = first_crossing(u, step, loop, 1.0)

    def simple(x: float) -> bool:
        return shapely.LinearRing((u + x * step)[loop]).is_simple

    assert all(simple(x) for x in np.linspace(0, min(t * (1 - 1e-6), 1), 100))
    assert t == np.inf or not simple(t * (1 + 1e-6))


@pytest.mark.parametrize("turns", [1.2, 2.0, 3.0])
def test_ramps_come_out_free_of_overlap(turns: float) -> None:
    V, F = shapes.helicoid(turns, int(80 * turns))
    twice = measure(V, F, flatten_isometric(V, F))
    assert twice.mean < 4.0001 and twice.overlap_mm2 > 0.1  # the case is real: without distortion it lies on itself
    apart = measure(V, F, flatten_bijective(V, F))
    assert apart.flipped == 0 and apart.overlap_mm2 <= OVERLAP_FRACTION * Mesh(V, F).area
    assert apart.mean < 4.06


@pytest.mark.parametrize("mesh", [shapes.wavy(), shapes.cap(8)], ids=["wavy", "hemisphere"])
def test_what_does_not_overlap_is_as_good_as_without_the_barrier(mesh) -> None:
    V, F = mesh
    plain, apart = measure(V, F, flatten_isometric(V, F)).mean, measure(V, F, flatten_bijective(V, F)).mean
    assert apart == pytest.approx(plain, abs=1e-3 * (plain - 4))
