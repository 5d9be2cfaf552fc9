"""Curves against closed forms: power basis, slope, inverse, and the best curve that does not turn."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibration.strain.curve import Curve, bernstein, fit_curve
from skinfab.errors import InputError

ordinates = st.lists(st.floats(-2, 2), min_size=2, max_size=7)


@given(ordinates)
def test_the_power_form_is_the_same_polynomial(values: list[float]) -> None:
    curve = Curve(10.0, 80.0, np.array(values))
    at = np.linspace(10, 80, 23)
    np.testing.assert_allclose(np.polynomial.polynomial.polyval(at, curve.coefficients), curve.signal(at), atol=1e-8)
    np.testing.assert_allclose(np.gradient(curve.signal(at), at)[1:-1], curve.slope(at)[1:-1], atol=0.2)


@given(st.lists(st.floats(0.05, 1), min_size=1, max_size=6), st.floats(-1, 1), st.sampled_from([-1, 1]))
def test_there_and_back(steps: list[float], start: float, sign: int) -> None:
    curve = Curve(10.0, 80.0, start + sign * np.cumsum([0.0, *steps]))
    angles = np.linspace(10, 80, 57)
    back, outside = curve.angle(curve.signal(angles))
    assert curve.monotone and curve.monotone_range == (10.0, 80.0)
    np.testing.assert_allclose(back, angles, atol=0.02)
    assert not outside[1:-1].any()
    beyond = curve.ordinates[-1] + sign
    assert [float(each[0]) for each in curve.angle([beyond])] == [80.0, 1.0]
    # One at a time to the last bit, also what is outside, or no number.
    readings = [*curve.signal(np.linspace(10, 80, 83)).tolist(), *curve.ordinates.tolist(), beyond, start - sign, np.inf, -np.inf, np.nan]
    for reading, angle, out in zip(readings, *(each.tolist() for each in curve.angle(readings)), strict=True):
        np.testing.assert_equal(curve.angle_of(reading), (angle, out))


def test_least_squares_is_numpys() -> None:
    rng = np.random.default_rng(0)
    angle = rng.uniform(10, 80, 300)
    signal = 1e-5 * angle**2 + 0.01 * rng.standard_normal(300)
    mine = fit_curve(angle, signal, degree=3).coefficients
    np.testing.assert_allclose(mine, np.polynomial.Polynomial.fit(angle, signal, 3).convert().coef, rtol=1e-6)


@pytest.mark.parametrize("sign", [1, -1])
def test_a_curve_that_turns_says_so_and_is_fitted_once_more(sign: int) -> None:
    angle = np.linspace(10, 80, 200)
    signal = sign * np.sin((angle - 10) / 70 * 2.4)  # turns at 55.8 degrees
    plain = fit_curve(angle, signal, degree=4)
    low, high = plain.monotone_range
    assert low == 10 and high == pytest.approx(10 + 70 * np.pi / 2 / 2.4, abs=0.5) and not plain.monotone
    with pytest.raises(InputError, match=r"turns within 10 to 80 degrees.*two angles.*10 to 56 degrees"):
        plain.angle([0.1])
    sound = fit_curve(angle, signal, degree=4, monotone=True)
    assert sound.monotone and np.all(sign * np.diff(sound.ordinates) >= 0)
    # No other curve of that shape is nearer: not a little more of any step.
    basis = bernstein((angle - 10) / 70, 4)
    best = np.sum((basis @ sound.ordinates - signal) ** 2)
    rng = np.random.default_rng(1)
    for _ in range(300):
        steps = np.maximum(sign * np.diff(sound.ordinates) + 0.02 * rng.standard_normal(4), 0)
        other = np.cumsum([sound.ordinates[0] + 0.02 * rng.standard_normal(), *(sign * steps)])
        assert np.sum((basis @ other - signal) ** 2) >= best - 1e-12


def test_what_rises_already_is_left_alone() -> None:
    angle = np.linspace(10, 80, 50)
    one, two = (fit_curve(angle, angle**2, degree=3, monotone=wanted) for wanted in (True, False))
    np.testing.assert_array_equal(one.ordinates, two.ordinates)


@pytest.mark.parametrize("angle", [[20.0, 30.0, 40.0], [20.0] * 9])
def test_too_little_to_fit(angle: list[float]) -> None:
    with pytest.raises(InputError, match="a curve of degree 2 needs 4 or more, at different angles"):
        fit_curve(np.array(angle), np.zeros(len(angle)), degree=2)


def test_numbers_and_back() -> None:
    curve = Curve(10.0, 80.0, np.array([0.0, 0.2, 0.3]))
    again = Curve.of_numbers(curve.numbers())
    assert (again.low, again.high, again.ordinates.tolist()) == (10.0, 80.0, [0.0, 0.2, 0.3])
    with pytest.raises(InputError, match="is none"):
        Curve.of_numbers({"low_deg": 80, "high_deg": 10, "bernstein": [0, 1]})
