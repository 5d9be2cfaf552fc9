"""Newton's search: exact on tactels, few steps, and honest where there is no peak."""

import math

import numpy as np
import pytest

from skinfab.fingertip.array.geometry import Geometry, wrapped
from skinfab.fingertip.array.interpolate import SINC, on_grid, surface_at
from skinfab.fingertip.array.parabola import log_parabola
from skinfab.fingertip.array.peak import PeakFinder, climb
from skinfab.fingertip.array.simulator import Skin

SEED = Geometry()
SKIN = Skin(SEED)
FIND = PeakFinder(SEED)


def test_every_peak_is_found_in_few_steps() -> None:
    rng = np.random.default_rng(0)
    steps = []
    for _ in range(150):
        axial, angle = rng.uniform(4, 22), rng.uniform(-math.pi, math.pi)
        Z = SKIN.pressed(0.5, axial_mm=axial, angle_rad=angle)
        peak = FIND(Z)
        assert peak.state == "peak" and abs(peak.axial_mm - axial) < 0.7 and abs(wrapped(peak.angle_rad - angle)) < math.radians(13)
        steps.append(peak.steps)
        x, y = SEED.to_tactels(peak.axial_mm, peak.angle_rad)
        around = on_grid(Z, SINC, x + np.linspace(-1, 1, 41), y + np.linspace(-1, 1, 41))
        assert around.max() <= peak.height * (1 + 1e-3)
    assert 1.5 < np.mean(steps) < 3 and max(steps) <= 5  # the seed: two or three


def test_on_a_tactel_the_sinc_is_exact() -> None:
    for ring in (1, 3, 6):
        for stripe in (0, 5):
            angle = SEED.from_tactels(0, stripe)[1]
            peak = FIND(SKIN.pressed(0.5, axial_mm=ring * 3.7, angle_rad=angle))
            assert peak.axial_mm == pytest.approx(ring * 3.7, abs=0.11) and wrapped(peak.angle_rad - angle) == pytest.approx(0, abs=1e-9)


def test_turning_the_finger_turns_the_peak() -> None:
    Z = SKIN.pressed(0.5, axial_mm=12.0, angle_rad=0.3)
    first, turned = FIND(Z), FIND(np.roll(Z, 3, axis=1))
    assert turned.axial_mm == pytest.approx(first.axial_mm) and wrapped(turned.angle_rad - first.angle_rad) == pytest.approx(
        3 * math.pi / 4
    )


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e3])
def test_the_unit_of_the_readings_does_not_matter(scale: float) -> None:
    Z = SKIN.pressed(0.5, axial_mm=12.0, angle_rad=0.3)
    assert FIND(scale * Z).axial_mm == pytest.approx(FIND(Z).axial_mm, abs=1e-9)


def test_a_climb_from_a_saddle_goes_to_a_peak() -> None:
    Z = np.zeros((8, 8))
    Z[2, 3] = Z[5, 3] = 1.0
    x, _, height, _, found = climb(Z, SINC, 3.4, 3.0, 0.01)
    assert found and x == pytest.approx(2.0, abs=0.3) and height >= surface_at(Z, SINC, 2.0, 3.0)[0]


@pytest.mark.parametrize("Z", [np.zeros((8, 8)), np.full((8, 8), np.nan), np.full((8, 8), -1.0)], ids=["zero", "nan", "negative"])
def test_nothing_is_no_peak(Z: np.ndarray) -> None:
    peak = PeakFinder(SEED, floor=1e-3)(Z)
    assert peak.state == "none" and math.isnan(peak.axial_mm) and FIND.all(np.minimum(Z, 0)) == ()


def test_two_contacts_far_apart_are_two_peaks() -> None:
    Z = SKIN.points([(0.5, 0, 0), (0.4, 0, 0)], [(5.0, 0.0), (18.0, 1.6)])
    first, second = FIND.all(Z)
    assert first.axial_mm == pytest.approx(5.0, abs=0.7) and second.axial_mm == pytest.approx(18.0, abs=0.7)


def test_log_parabola() -> None:
    assert all(math.isnan(value) for value in log_parabola(np.zeros((8, 8))))
    end = np.zeros((8, 8))
    end[0, 2] = 1.0
    assert log_parabola(end)[0] == 0.0
    Z = SKIN.pressed(0.5, axial_mm=13.0, angle_rad=0.3)
    x, y = log_parabola(Z)
    assert SEED.from_tactels(x, y) == pytest.approx((13.0, 0.3), abs=0.1)


def test_a_summit_that_is_missing_is_no_peak() -> None:
    """The tactel under the contact is at the end of its range: a hole there moved the peak by 2.6 mm, and was told as one."""
    Z = SKIN.pressed(2.0, axial_mm=12.0, angle_rad=0.1)
    assert FIND(Z).state == "peak"
    Z[3, 0] = np.nan
    peak = FIND(Z)
    assert peak.state == "flat" and abs(peak.axial_mm - 12.0) < 1.2
    far = SKIN.pressed(2.0, axial_mm=12.0, angle_rad=0.1)
    far[6, 4] = np.nan
    assert FIND(far).state == "peak"
