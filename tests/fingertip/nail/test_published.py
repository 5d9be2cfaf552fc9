"""The published features against a slow reading of the paper's equations, and what they do not see."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.fingertip.nail.published import BINS, CONDITIONS, PAIRS, columns, fit, histograms, modes

RNG = np.random.default_rng(1)


def slowly(window: np.ndarray) -> list[int]:
    """Equations 1 to 5, one point after the other."""
    moved = window.copy()
    moved[:, :3] -= moved[:, :3].mean(axis=0)
    out = []
    for x, y in PAIRS.values():
        counts = [0] * 36
        for point in moved:
            degrees = math.degrees(math.atan2(point[y], point[x])) % 360
            counts[int(degrees // 10) % 36] += 1
        out += counts
    return out


def test_the_counts_are_those_of_the_equations() -> None:
    windows = RNG.normal(size=(3, 200, 6)) + np.array([0, 0, 5, 0.3, 0, 0])
    assert histograms(windows).tolist() == [slowly(each) for each in windows]


@settings(max_examples=30, deadline=None)
@given(st.integers(1, 50), st.integers(0, 2**32 - 1))
def test_every_pair_counts_every_reading_once(samples: int, seed: int) -> None:
    found = histograms(np.random.default_rng(seed).normal(size=(2, samples, 6)))
    assert (found.reshape(2, 6, BINS).sum(axis=2) == samples).all()


def test_gravity_goes_and_an_offset_of_angular_velocity_stays() -> None:
    window = RNG.normal(size=(1, 400, 6))
    plain = histograms(window)
    assert (histograms(window + np.array([3.0, -2.0, 1.0, 0, 0, 0])) == plain).all()
    other = histograms(window + np.array([0, 0, 0, 3.0, 0, 0]))
    assert (other[:, : 3 * BINS] == plain[:, : 3 * BINS]).all() and (other[:, 3 * BINS :] != plain[:, 3 * BINS :]).any()


def test_a_louder_reading_of_the_same_shape_looks_the_same() -> None:
    """The features hold no amplitude: the force that quietens the finger is lost on them."""
    window = RNG.normal(size=(1, 400, 6))
    assert (histograms(4.0 * window) == histograms(window)).all()


def test_opposite_quadrants_are_told_apart() -> None:
    """What eq. 1 prints, arctan(y / x), puts both of these into one bin."""
    toward = np.zeros((1, 1, 6))
    toward[..., 3:5] = 1.0
    a, b = histograms(toward)[0], histograms(-toward)[0]
    assert math.atan(1.0 / 1.0) == math.atan(-1.0 / -1.0)
    assert np.flatnonzero(a[columns("GxGy")]).tolist() == [4] and np.flatnonzero(b[columns("GxGy")]).tolist() == [22]


def test_the_least_negative_angle_lies_in_the_last_bin_or_the_first() -> None:
    """-1e-300 mod 2 pi rounds to 2 pi itself, which is none of the 36."""
    window = np.zeros((1, 1, 6))
    window[..., 3:5] = 1.0, -1e-300
    assert np.flatnonzero(histograms(window)[0, columns("GxGy")])[0] in (0, 35)


def test_conditions_take_the_pairs_they_name() -> None:
    assert len(CONDITIONS) == 9 and len(columns("AxAyAzGxGyGz")) == 216
    marked = np.arange(216) // BINS
    assert {name: sorted(set(marked[columns(name)].tolist())) for name in ("GzGx", "AxAyAz")} == {"GzGx": [5], "AxAyAz": [0, 1, 2]}


def test_of_several_modes_the_first_counts() -> None:
    assert modes(np.array([[5, 1, 1, 5], [2, 2, 2, 0], [9, 8, 7, 6]])).tolist() == [5, 2, 9]


@pytest.mark.parametrize(
    ("readings", "says"),
    [
        (np.zeros((10, 6)), "shape"),
        (np.zeros((1, 10, 5)), "six channels"),
        (np.zeros((1, 0, 6)), "shape"),
        (np.full((1, 4, 6), np.nan), "missing"),
        (np.full((1, 4, 6), np.inf), "not finite"),
    ],
)
def test_what_has_no_angles_is_refused(readings: np.ndarray, says: str) -> None:
    with pytest.raises(InputError, match=says):
        histograms(readings)


def test_one_class_alone_and_an_unknown_condition_are_refused() -> None:
    with pytest.raises(InputError, match="one class"):
        fit(np.zeros((4, 36), dtype=np.int64), np.ones(4, dtype=np.int64))
    with pytest.raises(InputError, match="no sensor condition 'AxGx'"):
        columns("AxGx")
