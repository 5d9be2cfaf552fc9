"""Another field than the simulator's: its own closed form, and how well the matched ways do on it."""

import math

import numpy as np
import pytest
from scipy.special import j0

from skinfab.errors import InputError
from skinfab.fingertip.array.layer import LayerDevice, let_through
from skinfab.fingertip.array.study import IMPROVED, PUBLISHED, on_a_layer, rms, worst


def bonded(S: float, nu: float = 0.49999) -> float:
    """The same out of the four equations of a layer: stress s = 1, no shear on top, no motion below; Airy's function f(z) cos x."""

    def derivatives(z: float) -> np.ndarray:
        c, s = math.cosh(z), math.sinh(z)
        return np.array(
            [[c, z * c, s, z * s], [s, c + z * s, c, s + z * c], [c, 2 * s + z * c, s, 2 * c + z * s], [s, 3 * c + z * s, c, 3 * s + z * c]]
        )

    top, low = derivatives(0.0), derivatives(S)
    along = (1 - nu) * low[2] + nu * low[0]
    down = (1 - nu) * low[3] + nu * low[1] - 2 * low[1]
    return float(low[0] @ np.linalg.solve(np.array([top[0], top[1], along, down]), [1.0, 0, 0, 0]))


def test_what_reaches_the_core() -> None:
    S = np.array([0.1, 0.5, 1.0, 2.0, 5.0])
    np.testing.assert_allclose(let_through(S), [bonded(each) for each in S], rtol=2e-3)
    np.testing.assert_allclose(let_through(np.array([30.0, 800.0])), 0.0, atol=1e-10)


def test_a_tactel_reads_the_mean_pressure_below_it() -> None:
    """By Hankel's transform of a point's pressure, over a raster of the electrode."""
    device = LayerDevice().without(gain_scatter=0.0)
    g, force = device.geometry, 1.0
    k = np.linspace(0, 6, 4001)
    tip = np.exp(-((k * 1.2) ** 2) / 10)
    t = (np.arange(12) + 0.5) / 6 - 1
    x, y = np.meshgrid(11.1 + t * g.half[0] - 12.0, t * g.half[1] - 0.1 * g.core_radius)
    radius = np.hypot(x, y).ravel()
    pressure = [np.trapezoid(let_through(k * g.skin) * tip * j0(k * r) * k, k) / (2 * math.pi) for r in radius]
    read = device.skin.pressed(force, axial_mm=12.0, angle_rad=0.1)[3, 0]
    assert read == pytest.approx(np.mean(pressure) / device.rubber.young, rel=2e-3)


def test_the_matched_ways_hold_on_a_field_that_is_not_theirs() -> None:
    """The aim is half of what the seed measured: 0.25 mm and 5 degrees."""
    found = on_a_layer([0])
    assert worst(found["along"][IMPROVED]) < 0.25 < 0.5 < worst(found["along"][PUBLISHED])
    assert worst(found["around"][IMPROVED]) < 5.0 < 10.0 < worst(found["around"][PUBLISHED])
    assert worst(found["along"]["learned"]) < 0.25 and rms(found["around"]["learned"]) < rms(found["around"][IMPROVED])


def test_a_layer_is_not_pulled() -> None:
    with pytest.raises(InputError, match="straight down"):
        LayerDevice().skin.pressed(1.0, axial_mm=12.0, angle_rad=0.0, shear_n=(0.1, 0.0))
