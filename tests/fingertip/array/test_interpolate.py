"""Interpolators against their definitions: samples, ripple, derivatives, the closed axis."""

import math

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.array.interpolate import GAUSSIAN, KERNELS, SINC, Coefficients, kernel, kind_of, on_grid, surface_at

Z = np.random.default_rng(0).random((8, 8))


@pytest.mark.parametrize("name", ["sinc", "bspline"])
def test_the_surface_goes_through_the_readings(name: str) -> None:
    C = Coefficients(name, Z.shape)(Z)
    found = on_grid(C, KERNELS[name], np.arange(8.0), np.arange(8.0))
    np.testing.assert_allclose(found, Z, atol=1e-12)


@pytest.mark.parametrize("name", KERNELS)
def test_slopes_and_curvatures_are_those_of_the_surface(name: str) -> None:
    C, kind, h = Coefficients(name, Z.shape)(Z), KERNELS[name], 1e-5
    for x, y in ((3.31, 4.47), (3.0, 4.0), (0.2, 7.8), (6.99, -0.6), (3.0 + 2e-3, 2.0 - 9e-3)):
        _, fx, fy, fxx, fxy, fyy = surface_at(C, kind, x, y)
        right, left = surface_at(C, kind, x + h, y), surface_at(C, kind, x - h, y)
        above, below = surface_at(C, kind, x, y + h), surface_at(C, kind, x, y - h)
        assert fx == pytest.approx((right[0] - left[0]) / 2 / h, abs=1e-8) and fy == pytest.approx((above[0] - below[0]) / 2 / h, abs=1e-8)
        assert fxx == pytest.approx((right[1] - left[1]) / 2 / h, abs=1e-3) and fyy == pytest.approx(
            (above[2] - below[2]) / 2 / h, abs=1e-3
        )
        assert fxy == pytest.approx((above[1] - below[1]) / 2 / h, abs=1e-6)


def test_the_closed_axis() -> None:
    for name, kind in KERNELS.items():
        C = Coefficients(name, Z.shape)(Z)
        assert surface_at(C, kind, 3.3, 7.9) == pytest.approx(surface_at(C, kind, 3.3, -0.1), abs=1e-12)
        turned = Coefficients(name, Z.shape)(np.roll(Z, 3, axis=1))
        assert surface_at(turned, kind, 3.3, 4.9)[0] == pytest.approx(surface_at(C, kind, 3.3, 1.9)[0], abs=1e-12)


@pytest.mark.parametrize(("kind", "ripple"), [(SINC, 0.0014), (GAUSSIAN, 0.0017)])
def test_the_ripple_on_a_constant(kind: int, ripple: float) -> None:
    u = np.linspace(0, 1, 101)
    total = [sum(kernel(kind, x - k)[0] for k in range(-4, 6)) for x in u]
    assert max(abs(value - 1) for value in total) == pytest.approx(ripple, rel=0.15)


def test_the_printed_window_is_zero_at_its_own_sample() -> None:
    def printed(n: float) -> float:
        return 0.5 * (1 - math.cos(2 * math.pi * n / 7)) if 0 <= n <= 7 else 0.0

    assert printed(0.0) == 0.0  # so that the seed's f is zero wherever it was measured
    assert kernel(SINC, 0.0)[0] == 1.0


def test_weights_by_turning_are_the_kernel() -> None:
    unit = np.zeros((16, 8))
    unit[8, 0] = 1.0
    for x in np.random.default_rng(1).uniform(4.6, 11.4, 200):
        assert surface_at(unit, SINC, float(x), 0.0)[0] == pytest.approx(kernel(SINC, float(x) - 8)[0], abs=1e-12)


def test_an_unknown_name() -> None:
    with pytest.raises(InputError, match="there are sinc, bspline, gaussian"):
        kind_of("cubic")
