"""The barrier against brute force; ramps that lie on themselves when flat come out free of overlap."""

import numpy as np
import pytest
import shapely
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.flatten import bijective
from skinfab.flatten._barrier import barrier_energy, barrier_gradient, barrier_hessian, first_crossing, near_pairs
from skinfab.flatten._dirichlet import vertex_pattern
from skinfab.flatten.bff import BffSolver
from skinfab.flatten.bijective import flatten_bijective
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import best_scale, measure
from skinfab.flatten.isometric import IsometricSolver
from skinfab.flatten.overlap import overlap_area
from skinfab.flatten.tutte import tutte_embedding
from skinfab.mesh.model import Mesh
from skinfab.mesh.topology import Topology
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
    """Gradient and Hessian of three times the barrier."""
    n = 2 * len(u)
    near = near_pairs(u, loop, 1.5 * reach)
    indptr, indices, place = vertex_pattern(near, len(u))
    data, gradient = np.zeros(len(indices)), np.zeros(n)
    barrier_gradient(u, near, reach, 3.0, gradient)
    barrier_hessian(u, near, place, reach, 3.0, indptr, data)
    H = np.zeros((n, n))
    H[indices, np.repeat(np.arange(n), np.diff(indptr))] = data
    return gradient, H + np.tril(H, -1).T


@few
@given(seeds, st.floats(0.05, 0.5))
def test_near_pairs_are_those_that_shapely_finds(seed: int, within: float) -> None:
    u, loop, _ = star(seed)
    assert sorted(map(tuple, near_pairs(u, loop, within).tolist())) == sorted((p, a, b) for p, a, b, d in pairs(u, loop) if d < within)


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
def test_hessian_is_gauss_newtons(seed: int) -> None:
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
    np.testing.assert_allclose(H, gauss_newton, rtol=1e-7, atol=1e-9 * np.abs(gauss_newton).max())


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


def test_what_does_not_overlap_by_itself_is_the_isometric_flattening() -> None:
    V, F = shapes.cap(8)
    np.testing.assert_array_equal(flatten_bijective(V, F), flatten_isometric(V, F))


@pytest.mark.parametrize("turns", [1.2, 2.0])
def test_the_start_is_opened_until_it_is_free_of_overlap(turns: float) -> None:
    V, F = shapes.helicoid(turns, int(80 * turns))
    topology, solver, bff = Topology(F), IsometricSolver(V, F), BffSolver(V, F)
    assert overlap_area(F, bff.free()) > 0.1
    start = bijective._opened(solver, bff, topology)
    assert start is not None and overlap_area(F, start) == 0 and solver.best_scale(start)[1] > 0
    tutte = tutte_embedding(V, F)
    assert measure(V, F, start).mean < measure(V, F, best_scale(V, F, tutte) * tutte).mean


def test_tutte_starts_where_no_opening_does(monkeypatch: pytest.MonkeyPatch) -> None:
    V, F = shapes.helicoid(1.5, 120)
    monkeypatch.setattr(bijective, "_OPENINGS", ())
    apart = measure(V, F, flatten_bijective(V, F))
    assert apart.flipped == 0 and apart.overlap_mm2 == 0 and apart.mean < 4.03
