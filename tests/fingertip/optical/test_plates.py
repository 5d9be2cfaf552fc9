"""Distances from plates against densely drawn edges, and plates that cannot be."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.fingertip.optical.plates import Disk, HalfPlane, Moved, Polygon

HEXAGON = 30 * np.c_[np.cos(np.arange(6) * math.pi / 3), np.sin(np.arange(6) * math.pi / 3)]
places = st.tuples(st.floats(-60, 60), st.floats(-60, 60))


def dense(corners: np.ndarray) -> np.ndarray:
    t = np.linspace(0, 1, 2001)[:, None]
    return np.vstack([a + t * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)])


EDGE = dense(HEXAGON)


@given(places)
def test_a_polygons_distance_is_that_of_its_nearest_point(at: tuple[float, float]) -> None:
    d = float(Polygon(HEXAGON).distance(np.array(at)))
    assert abs(d) == pytest.approx(np.linalg.norm(EDGE - at, axis=1).min(), abs=0.01)
    angles = np.arctan2(*(HEXAGON - at).T[::-1])
    turned = (np.roll(angles, -1) - angles + math.pi) % math.tau - math.pi
    if abs(d) > 1e-6:
        assert (d < 0) == (abs(turned.sum()) > math.pi)  # the edge goes round a point that lies on the plate


@given(places, places, st.floats(-7, 7))
def test_a_plate_that_is_moved_is_the_plate_seen_from_there(at: tuple[float, float], seen: tuple[float, float], turn: float) -> None:
    c, s = math.cos(turn), math.sin(turn)
    true = np.array(at) + np.array([[c, -s], [s, c]]) @ np.array(seen)
    for plate in (Disk(30.0), Polygon(HEXAGON), HalfPlane(3.0, 1.0)):
        assert float(Moved(plate, np.array(at), turn).distance(np.array(seen))) == pytest.approx(float(plate.distance(true)), abs=1e-9)


def test_sizes_are_those_of_geometry() -> None:
    assert Polygon(HEXAGON).area == pytest.approx(1.5 * math.sqrt(3) * 900) and Polygon(HEXAGON).length == pytest.approx(180)
    assert Disk(30.0).area == pytest.approx(900 * math.pi) and Disk(30.0).length == pytest.approx(60 * math.pi)
    for plate in (Disk(30.0), Polygon(HEXAGON)):
        assert plate.distance(plate.start) == pytest.approx(0, abs=1e-9)
        np.testing.assert_allclose(plate.distance(plate.outline()), 0, atol=1e-9)


@pytest.mark.parametrize("corners", [HEXAGON[::-1], HEXAGON[:2], HEXAGON * np.nan, HEXAGON[[0, 2, 4, 1, 3, 5]]])
def test_what_is_no_convex_plate_is_refused(corners: np.ndarray) -> None:
    with pytest.raises(InputError, match="corners"):
        Polygon(corners)


def test_a_disk_of_no_size_is_refused() -> None:
    with pytest.raises(InputError, match="positive"):
        Disk(0.0)
