"""The fewest flips: the second triangulation is made only where the first one flips, and taken only where it helps."""

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.flatten import delaunay
from skinfab.flatten.bff import BffSolver, flatten_disk
from skinfab.flatten.distortion import best_scale, measure
from skinfab.flatten.robust import flatten_robust, turned_over

few = settings(max_examples=25, deadline=None)


@pytest.mark.parametrize(
    ("mesh", "plain"),
    [
        *((shapes.random_disk(seed, 100, 0.1), 1) for seed in range(5)),
        (shapes.random_disk(0, 2000, 0.02), 13),
        (shapes.random_disk(0, 100, 0.3), 42),
    ],
    ids=[*map(str, range(5)), "finer", "spikes"],
)
def test_obtuse_triangles_flip_no_more(mesh, plain: int) -> None:
    V, F = mesh
    assert turned_over(flatten_disk(V, F), F) >= plain
    uv = flatten_robust(V, F)
    figures = measure(V, F, uv * best_scale(V, F, uv))
    assert figures.flipped == 0 and np.isfinite(figures.mean)


@few
@given(st.integers(0, 10_000), st.sampled_from([0.05, 0.3, 1.0]))
def test_never_more_flips_than_plain(seed: int, noise: float) -> None:
    V, F = shapes.random_disk(seed, 60, noise)
    assert turned_over(flatten_robust(V, F), F) <= turned_over(flatten_disk(V, F), F)


def test_spikes_flip_less_than_a_quarter_as_often() -> None:
    plain = robust = 0
    for seed in range(10):
        V, F = shapes.random_disk(seed, 100, 1.0)
        plain, robust = plain + turned_over(flatten_disk(V, F), F), robust + turned_over(flatten_robust(V, F), F)
    assert plain > 700 and robust < plain / 4


@pytest.mark.parametrize("mesh", [shapes.wavy(), shapes.cap(16, 2.8), shapes.grid(5, 1)], ids=["obtuse but sound", "purse", "strip"])
def test_sound_meshes_do_not_pay(mesh, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(delaunay, "delaunay_corners", lambda *_, **__: pytest.fail("flipped edges of a sound mesh"))
    np.testing.assert_array_equal(flatten_robust(*mesh), flatten_disk(*mesh))


def test_flat_sheets_stay_as_they_are_over_either_triangulation() -> None:
    V, F = shapes.random_disk(4, 200, 0)
    V = V * [30.0, 1, 0] @ shapes.rotation(1).T
    for uv in (flatten_robust(V, F), BffSolver(V, F, robust=True).free()):
        assert measure(V, F, uv).max == pytest.approx(4, abs=1e-6)


def test_one_factorisation_each() -> None:
    solver = BffSolver(*shapes.random_disk(0, 100, 0.1), robust=True)
    solver.free()
    solver.scale(np.zeros(len(solver.boundary)))
    assert (solver.factorisations, solver.solves) == (1, 4)


@pytest.mark.parametrize("unit", [1e-6, 1e-3, 1e3, 1e6])
@pytest.mark.parametrize("mesh", [shapes.wavy(), shapes.random_disk(1, 100, 0.1)], ids=["plain", "robust"])
def test_unit_changes_nothing(mesh, unit: float) -> None:
    V, F = mesh
    here = flatten_robust(V, F)
    np.testing.assert_allclose(flatten_robust(unit * V, F) / unit, here, atol=1e-6 * np.abs(here).max())


def test_scale_factors_are_kept_and_triangles_left_out_do_not_count() -> None:
    V, F = shapes.random_disk(1, 100, 0.1)
    u = np.full(len(V), np.log(3))
    np.testing.assert_allclose(flatten_robust(V, F, scale=u), 3 * flatten_robust(V, F), rtol=1e-6, atol=1e-6)
    plain = flatten_disk(V, F)
    p = plain[F]
    e, f = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    sound = e[:, 0] * f[:, 1] - e[:, 1] * f[:, 0] > 0
    order = np.argsort(~sound, kind="stable")
    np.testing.assert_allclose(flatten_robust(V, F[order], counted=int(sound.sum())), flatten_disk(V, F[order]), atol=1e-12)


def test_what_is_no_disk_is_named() -> None:
    with pytest.raises(InputError, match="only a disk can be flattened"):
        flatten_robust(*shapes.sphere())
