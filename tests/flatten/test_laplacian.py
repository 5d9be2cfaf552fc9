"""The cotangent matrix against libigl's and against its own null space; needles made safe."""

import igl
import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.flatten.laplacian import intrinsic, mollified_lengths
from skinfab.tolerances import MOLLIFY

few = settings(max_examples=25, deadline=None)


@few
@given(st.integers(0, 10_000), st.sampled_from([1e-6, 1.0, 1e6]))
def test_stiffness_is_libigls_with_the_other_sign(seed: int, unit: float) -> None:
    V, F = shapes.random_disk(seed, 60, noise=0.3)
    L = intrinsic(unit * V, F).stiffness().toarray()
    want = -igl.cotmatrix(V, F).toarray()
    np.testing.assert_allclose(L, want, rtol=1e-6, atol=1e-9 * np.abs(want).max())


@few
@given(st.integers(0, 10_000))
def test_dirichlet_energy_of_a_linear_function(seed: int) -> None:
    """On a flat mesh the energy of a x + b y is (a^2 + b^2) times the area."""
    V, F = shapes.random_disk(seed, 60, noise=0)
    a, b = np.random.default_rng(seed).standard_normal(2)
    u = a * V[:, 0] + b * V[:, 1]
    p = V[F][:, :, :2]
    area = np.abs(np.linalg.det(p[:, 1:] - p[:, :1])).sum() / 2
    assert u @ intrinsic(V, F).stiffness() @ u == pytest.approx((a * a + b * b) * area, rel=1e-6)


@pytest.mark.parametrize("closed", [shapes.sphere, shapes.torus, shapes.cube])
def test_angle_defects_sum_to_the_euler_number(closed) -> None:
    V, F = closed()
    euler = 0 if closed is shapes.torus else 2
    corners = intrinsic(V, F)
    assert (2 * np.pi - corners.angle_sum).sum() == pytest.approx(2 * np.pi * euler, abs=1e-9)
    np.testing.assert_allclose(corners.angle.sum(axis=1), np.pi, rtol=1e-12)


def test_sound_meshes_keep_their_lengths() -> None:
    V, F = shapes.wavy()
    p = V[F]
    opposite = np.linalg.norm(p[:, [1, 2, 0]] - p[:, [2, 0, 1]], axis=2)
    np.testing.assert_array_equal(mollified_lengths(V, F), opposite)


@pytest.mark.parametrize(
    "flat", [(0.5, 0.0), (0.0, 0.0), (1.0, 0.0), (0.3, 1e-14)], ids=["midway", "on a corner", "on the other", "needle"]
)
def test_needles_get_finite_cotangents(flat) -> None:
    V = np.array([[0.0, 0, 0], [1, 0, 0], [*flat, 0], [0.5, 1, 0]])
    F = np.array([[0, 1, 2], [0, 2, 3], [2, 1, 3]])
    length = mollified_lengths(V, F)
    slack = length[:, [1, 2, 0]] + length[:, [2, 0, 1]] - length
    assert slack.min() >= 0.999 * MOLLIFY * length.mean()
    assert np.ptp(length - np.linalg.norm(V[F][:, [1, 2, 0]] - V[F][:, [2, 0, 1]], axis=2)) < 1e-15  # all edges by the same amount
    corners = intrinsic(V, F)
    assert np.isfinite(corners.cotangent).all()
    np.testing.assert_allclose(corners.angle.sum(axis=1), np.pi, rtol=1e-6)
    assert np.linalg.eigvalsh(corners.stiffness().toarray()).min() > -1e-9 * np.abs(corners.cotangent).max()
