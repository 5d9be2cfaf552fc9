"""A tactel's answer against quadrature, differences, and what mechanics says of it."""

import math

import numpy as np
import pytest

from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.response import add_force, normal_window

SEED = Geometry()


def strain(x: np.ndarray, y: np.ndarray, z: float, nu: float, force: tuple[float, float, float]) -> np.ndarray:
    R = np.sqrt(x**2 + y**2 + z**2)
    return (1 + nu) / (2 * math.pi) * (force[0] * z + force[1] * x + force[2] * y) * (3 * z**2 / R**5 - 2 * nu / R**3)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("force", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.7, -0.2, 0.4)])
def test_the_average_over_an_electrode_is_exact(nu: float, force: tuple[float, float, float]) -> None:
    out = np.zeros(SEED.shape)
    add_force(out, force, (10.0, 20.0), SEED.pitch, SEED.half, 3.8, nu)
    t, w = np.polynomial.legendre.leggauss(24)
    for i, j in ((3, 3), (2, 2), (0, 4)):
        x = i * SEED.ring_pitch - 10.0 + t[:, None] * SEED.half[0]
        y = j * SEED.stripe_pitch - 20.0 + t[None, :] * SEED.half[1]
        assert out[i, j] == pytest.approx(float((strain(x, y, 3.8, nu, force) * np.outer(w, w)).sum() / 4), rel=1e-9)


def test_derivatives_are_those_of_the_reading() -> None:
    window, h = (1, 5, 2, 3), 1e-5
    out = {}
    for name, at in {"": (10.0, 20.0), "x": (10.0 + h, 20.0), "y": (10.0, 20.0 + h)}.items():
        out[name] = np.zeros((3, 5, 3))
        normal_window(out[name], window, at, SEED.pitch, SEED.half, 3.8, 0.4)
    np.testing.assert_allclose((out["x"][0] - out[""][0]) / h, out[""][1], atol=1e-7)
    np.testing.assert_allclose((out["y"][0] - out[""][0]) / h, out[""][2], atol=1e-7)
    whole = np.zeros(SEED.shape)
    add_force(whole, (1.0, 0.0, 0.0), (10.0, 20.0), SEED.pitch, SEED.half, 3.8, 0.4)
    np.testing.assert_allclose(out[""][0], whole[1:6, 2:5], rtol=1e-12)


def test_round_the_finger_nothing_changes() -> None:
    first, turned = np.zeros(SEED.shape), np.zeros(SEED.shape)
    add_force(first, (1.0, 0.2, 0.3), (10.0, 1.0), SEED.pitch, SEED.half, 3.8, 0.5)
    add_force(turned, (1.0, 0.2, 0.3), (10.0, 1.0 + 3 * SEED.stripe_pitch), SEED.pitch, SEED.half, 3.8, 0.5)
    np.testing.assert_allclose(np.roll(first, 3, axis=1), turned, atol=1e-12)


@pytest.mark.parametrize("nu", [0.0, 0.25, 0.5])
def test_the_integral_over_the_plane(nu: float) -> None:
    """F (1 + nu) (1 - 2 nu) / E, which rubber makes zero; this plane ends after 128 mm, where a part of z/R = 0.03 is still to come."""
    out = np.zeros((64, 64))
    add_force(out, (1.0, 0.0, 0.0), (31.5 * 4.0, 31.5 * 4.0), (4.0, 4.0), (2.0, 2.0), 3.8, nu)
    assert out.sum() * 16 == pytest.approx((1 + nu) * (1 - 2 * nu), abs=0.05)
