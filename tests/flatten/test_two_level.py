"""Relaxing: as low as Newton's method with all its factorisations, and what it says is left is what is left."""

import numpy as np
import pytest
import shapes

from skinfab.bench.disks import bumpy_cap
from skinfab.flatten.carry import carrier
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import distortion_of, shaped_areas, singular_values
from skinfab.flatten.isometric import IsometricSolver
from skinfab.flatten.two_level import CoarseCorrection, relax
from skinfab.mesh.decimate import decimate


def mean_d(V: np.ndarray, F: np.ndarray, uv: np.ndarray) -> float:
    return float(np.average(distortion_of(singular_values(V, F, uv)), weights=shaped_areas(V, F)[0]))


def start(V: np.ndarray, F: np.ndarray, share: int) -> tuple[np.ndarray, CoarseCorrection]:
    few = decimate(V, F, faces=len(F) // share)
    flat, onto = flatten_isometric(few.V, few.F), carrier(V, few)
    return onto.carry(flat), CoarseCorrection(IsometricSolver(few.V, few.F), flat, onto.interpolation)


@pytest.mark.parametrize("share", [4, 16, 40])
@pytest.mark.parametrize("shape", [bumpy_cap(6000), shapes.cap(30, 1.3), shapes.wavy(50)], ids=["bumps", "cap", "wavy"])
def test_the_effect_bounds_what_is_left(shape: tuple[np.ndarray, np.ndarray], share: int) -> None:
    V, F = shape
    solver = IsometricSolver(V, F)
    uv, correction = start(V, F, share)
    relaxed = relax(solver, uv, correction)
    least = solver.refine(relaxed.UV, tolerance=1e-9).energy[-1]
    assert relaxed.mean_d == pytest.approx(mean_d(V, F, relaxed.UV), abs=1e-9)
    assert 0 <= relaxed.mean_d - least <= relaxed.effect < 4e-4
    assert mean_d(V, F, uv) > relaxed.mean_d


def test_the_fine_mesh_is_never_factored() -> None:
    V, F = bumpy_cap(6000)
    solver = IsometricSolver(V, F)
    uv, correction = start(V, F, 16)
    relaxed = relax(solver, uv, correction)
    assert solver.factorisations == 0 and relaxed.products <= 40


def test_without_the_coarse_solve_more_is_left() -> None:
    """Each vertex on its own sees only the short waves."""
    V, F = bumpy_cap(6000)
    solver = IsometricSolver(V, F)
    uv, correction = start(V, F, 40)
    blind = relax(solver, uv, lambda residual: 0 * residual)  # type: ignore[arg-type]
    seeing = relax(solver, uv, correction)
    least = solver.refine(seeing.UV, tolerance=1e-9).energy[-1]
    assert blind.mean_d - least > 3 * (seeing.mean_d - least)


def test_at_the_least_d_nothing_is_left() -> None:
    V, F = bumpy_cap(2000)
    solver = IsometricSolver(V, F)
    _, correction = start(V, F, 8)
    best = solver.refine(flatten_isometric(V, F), tolerance=1e-10).UV
    relaxed = relax(solver, best, correction)
    assert relaxed.effect < 1e-8 and relaxed.mean_d <= mean_d(V, F, best) + 1e-12


def test_a_plane_has_nothing_to_gain() -> None:
    V, F = shapes.grid(30, 30)
    _, correction = start(V, F, 8)
    relaxed = relax(IsometricSolver(V, F), V[:, :2].copy(), correction)
    assert relaxed.mean_d == pytest.approx(4, abs=1e-12) and relaxed.effect < 1e-12
