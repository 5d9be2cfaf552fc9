"""Grid, lines and round angles."""

import numpy as np
import pytest

from skinfab.placement.snap import snap_angle, snap_point


def test_in_line_goes_before_the_grid_and_the_nearest_of_two():
    found = snap_point((10.4, 20.4), grid=1.0, others=[(10.7, 90.0), (10.5, 70.0), (60.0, 20.9)], reach=0.6)
    assert found.point.tolist() == [10.5, 20.9] and found.lines[:, 1].tolist() == [[10.5, 70.0], [60.0, 20.9]]
    assert snap_point((10.4, 20.4), grid=1.0, others=[(10.7, 90.0)], reach=0.2).point.tolist() == [10.0, 20.0]


def test_without_grid_and_others_the_point_stays():
    found = snap_point((1.23, 4.56), grid=0.0)
    assert found.point.tolist() == [1.23, 4.56] and found.lines.shape == (0, 2, 2)


@pytest.mark.parametrize(("degrees", "to"), [(7.4, 0), (7.6, 15), (-22.6, -30), (359, 360)])
def test_angles(degrees, to):
    assert np.degrees(snap_angle(np.radians(degrees), step=np.radians(15))) == pytest.approx(to)
