"""Ways out of shapes whose walls are plain."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from shapely.geometry import MultiPolygon, box

from skinfab.material import load_material
from skinfab.wire_ways import Edges, unit

MOULD = load_material().mould


def test_out_of_a_box_all_round() -> None:
    inner, outer = box(0, 0, 40, 30), box(-1.6, -1.6, 41.6, 31.6)
    ways = Edges(MultiPolygon([inner]), MultiPolygon([outer])).ways(np.array([4.0, 12.0]), away=np.array([-1.0, 0.01]), mould=MOULD)
    for begin, end in ways.wall:
        assert shapely.Point(begin).distance(inner.exterior) < 1e-9 and shapely.Point(end).distance(outer.exterior) < 1e-9
        assert np.hypot(*(end - begin)) <= 3 * MOULD.wall
    np.testing.assert_array_equal(ways.wire[:, 1], ways.wall[:, 0])
    assert not ways.narrow.any()
    # The shortest is straight to the left; ways that begin to the right count twice.
    k = int(ways.length.argmin())
    np.testing.assert_allclose(ways.wall[k], [[0, 12], [-1.6, 12]], atol=1e-9)
    wire = ways.wire[:, 1] - ways.wire[:, 0]
    np.testing.assert_allclose(ways.length, np.hypot(*wire.T) * np.where(wire @ [-1, 0.01] < 0, 2, 1), atol=1e-5)
    np.testing.assert_array_equal(ways.only(ways.length < 5).length, ways.length[ways.length < 5])


def test_a_notch_is_narrow() -> None:
    inner = MultiPolygon([box(0, 0, 20, 40), box(28, 0, 50, 40)])
    outer = MultiPolygon([part.buffer(1.6, join_style="mitre") for part in inner.geoms])
    ways = Edges(inner, outer).ways(np.array([10.0, 20.0]), away=np.zeros(2), mould=MOULD)
    right = ways.wall[:, 0, 0] > 19.9
    assert right.any() and ways.narrow[right & (abs(ways.wall[:, 0, 1] - 20) < 3)].all() and not ways.narrow[~right].any()


def test_the_way_out_of_the_edge() -> None:
    cavity = MultiPolygon([box(0, 0, 20, 20), box(-4, 0, -2, 20)])
    edges = Edges(cavity, MultiPolygon([box(-5.6, -1.6, 21.6, 21.6)]))
    out = edges.out(np.array([20.0, 10]), np.array([1.0, 0]))
    assert out is not None and out == pytest.approx([21.6, 10])
    assert edges.out(np.array([0.0, 10]), np.array([-1.0, 0])) is None


def test_unit() -> None:
    np.testing.assert_allclose(unit(np.array([3.0, -4.0])), [0.6, -0.8])
    np.testing.assert_array_equal(unit(np.zeros(2)), [0, 0])
