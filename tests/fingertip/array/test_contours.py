"""Contours: on their height, closed where they are, once round the peak."""

import math

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.array.contours import contour, enclosed
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.interpolate import SINC, on_grid, surface_at
from skinfab.fingertip.array.peak import PeakFinder
from skinfab.fingertip.array.simulator import Skin

SEED = Geometry()
Z = Skin(SEED).pressed(0.5, axial_mm=13.0, angle_rad=0.3)
PEAK = PeakFinder(SEED)(Z)


@pytest.mark.parametrize("part", [0.2, 0.5, 0.75, 0.97])
def test_a_contour_keeps_its_height_and_closes(part: float) -> None:
    points, closed = contour(Z, SINC, SEED, PEAK, part=part)
    assert closed and np.allclose(points[0], points[-1])
    heights = [surface_at(Z, SINC, *SEED.to_tactels(x, a))[0] for x, a in points[:-1]]
    np.testing.assert_allclose(heights, part * PEAK.height, rtol=3e-6)
    steps = np.hypot(*(np.diff(points, axis=0) / [3.7, math.pi / 4]).T)
    assert steps.max() < 0.08  # nothing was jumped over


def test_it_encloses_what_is_higher() -> None:
    points, _ = contour(Z, SINC, SEED, PEAK, part=0.5)
    x, y = np.linspace(0, 7, 281), np.linspace(-3, 4, 281)
    cells = (on_grid(Z, SINC, x, y) > 0.5 * PEAK.height).sum() * (x[1] - x[0]) * 3.7 * (y[1] - y[0]) * math.pi / 4
    assert enclosed(points) == pytest.approx(cells, rel=0.02)


def test_a_line_round_the_whole_finger_closes() -> None:
    ring = np.zeros((8, 8))
    ring[3] = 1.0
    points, closed = contour(ring, SINC, SEED, PeakFinder(SEED)(np.eye(8)), part=0.5)
    assert not len(points) or not closed  # no peak of this frame: nothing to go round
    from skinfab.fingertip.array.contours import follow

    points, closed = follow(ring, SINC, 3.6, 0.0, 0.5, 0.05, 1e-6)
    assert closed and abs(points[-1, 1] - points[0, 1]) == pytest.approx(8, abs=0.05) and np.ptp(points[:, 0]) < 0.02


def test_a_line_that_leaves_the_array_is_followed_both_ways() -> None:
    edge = Skin(SEED).pressed(0.5, axial_mm=0.5, angle_rad=0.3)
    points, closed = contour(edge, SINC, SEED, PeakFinder(SEED)(edge), part=0.3)
    assert not closed and points[0, 0] < 0.3 and points[-1, 0] < 0.3 and np.ptp(points[:, 1]) > 0.3


@pytest.mark.parametrize("part", [0.0, 1.0, 1.2])
def test_parts_that_are_none(part: float) -> None:
    with pytest.raises(InputError, match="between 0 and 1"):
        contour(Z, SINC, SEED, PEAK, part=part)
