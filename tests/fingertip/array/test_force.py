"""Forces and their angles against closed forms."""

import math

import numpy as np
import pytest

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.array.force import angle_by_split, line_force, point_force, split, strain_under_line
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.simulator import Rubber, Skin

SEED = Geometry()


@pytest.mark.parametrize("nu", [0.2, 0.35, 0.5])
def test_force_of_a_line(nu: float) -> None:
    """E / (1 - nu) times the integral; the seed's 2 E holds for nu = 0.5 alone."""
    rubber = Rubber(young=0.7, poisson=nu)
    y = np.arange(-4000, 4000, 0.25)
    e = strain_under_line(y, depth=3.8, rubber=rubber, normal=1.7)
    assert line_force(e, 0.25, rubber) == pytest.approx(1.7, rel=2e-3)
    printed = 2 * rubber.young * e.sum() * 0.25
    assert (printed == pytest.approx(1.7, rel=2e-3)) == (nu == 0.5)


def kernel(y: np.ndarray, P: float, Q: float) -> np.ndarray:
    return strain_under_line(y, depth=3.8, rubber=Rubber(), normal=P, tangential=Q)


@pytest.mark.parametrize("degrees", [-40, -15, 0, 5, 30])
def test_angle_of_a_line_of_force(degrees: float) -> None:
    tangent = math.tan(math.radians(degrees))
    y = np.linspace(-5, 5, 10_001)
    peak = float(y[kernel(y, 1.0, tangent).argmax()]) + 2.0
    found = angle_by_split(lambda at: kernel(at - 2.0, 1.0, tangent), peak, kernel, 3.8)
    assert math.degrees(found) == pytest.approx(degrees, abs=0.3)


def test_no_angle_of_what_is_no_contact() -> None:
    with pytest.raises(InputError, match="no angle of force fits"):
        angle_by_split(lambda y: np.cos(3 * y) + 2.0, 0.0, kernel, 3.8)


def test_odd_and_even() -> None:
    even, odd = split(lambda y: 3 - y**2 - 0.5 * y, 0.0, 1.0)
    assert (even, odd) == pytest.approx((3.0, -0.5))


def test_what_has_no_force() -> None:
    with pytest.raises(RefusedError, match="sum up to nothing"):
        point_force(Skin(SEED).pressed(1.0, axial_mm=13.0, angle_rad=0.0), SEED, Rubber())
