"""Sliding along a curve: tangents right, energy down, order kept, and the known conformal map found."""

import numpy as np
import pytest
import shapes

from skinfab.flatten.bff import BffSolver
from skinfab.flatten.bff_descent import SlidingCurve, conformal_energy, slide

SQUARE = np.array([[0.0, 0], [2, 0], [2, 2], [0, 2]])


@pytest.mark.parametrize("target", [SQUARE, np.array([[0.0, 0], [3, 0], [1, 1], [0, 1]]), SQUARE[[0, 0, 1, 2, 2, 3]]])
@pytest.mark.parametrize("w", [1e-3, 0.3, 2.5])
def test_the_average_is_the_mean_of_points_and_its_tangent_the_derivative(target: np.ndarray, w: float) -> None:
    curve = SlidingCurve(target)
    at = np.linspace(0, curve.total_mm, 23)
    place, tangent = curve.averaged(at, w)
    fine = (np.arange(20_000) + 0.5) / 10_000 - 1
    mean = np.array([curve.point(t + w * fine).mean(axis=0) for t in at])
    np.testing.assert_allclose(place, mean, atol=1e-6)
    e = 1e-3 * w
    slope = (curve.averaged(at + e, w)[0] - curve.averaged(at - e, w)[0]) / (2 * e)
    np.testing.assert_allclose(tangent, slope, atol=1e-3)


def test_energy_is_the_excess_of_dirichlet_energy_over_area_and_its_gradient_the_derivative() -> None:
    """For a triangle of the plane stretched by s1, s2: (s1 - s2)^2 / 2 of its area."""
    solver = BffSolver(*shapes.grid(4, 4))
    place = solver._V[solver.boundary, :2] * [3, 1]
    energy, gradient, area = conformal_energy(place, solver._slope)
    assert energy == pytest.approx((3 - 1) ** 2 / 2) and area == pytest.approx(3)
    rng = np.random.default_rng(0).standard_normal(place.shape)
    ahead, behind = (conformal_energy(place + h * rng, solver._slope)[0] for h in (1e-6, -1e-6))
    assert (gradient * rng).sum() == pytest.approx((ahead - behind) / 2e-6, rel=1e-6)


def test_a_flat_sheet_slides_back_onto_its_own_outline() -> None:
    """From places along a square's outline that are off by up to a tenth of its side to the identity."""
    V, F = shapes.grid(16, 16)
    solver = BffSolver(V, F)
    outline = V[solver.boundary, :2]
    curve = SlidingCurve(outline)
    right = np.concatenate([[0.0], np.cumsum(solver.lengths_mm)[:-1]])
    wrong = right + 0.1 * np.sin(np.pi * right / 2) ** 2
    assert (np.diff(wrong) > 0).all()
    energy = [conformal_energy(curve.point(at), solver._slope)[0] for at in (wrong, right)]
    assert energy[0] > 0.003 and energy[1] == pytest.approx(0, abs=1e-12)
    at = slide(curve, wrong, slope_of=solver._slope, values_of=solver._to_dirichlet.pinned)
    assert at[0] == 0 and (np.diff(at) > 0).all() and at[-1] < curve.total_mm
    assert conformal_energy(curve.point(at), solver._slope)[0] < 0.1 * energy[0]
