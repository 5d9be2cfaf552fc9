"""The distance of a run from pieces, against dense sampling."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcode.clearance import Laid, chords, distance
from gcode.geometry import Curve, Straight

point = st.tuples(st.floats(-10, 10), st.floats(-10, 10))


@given(point, point, st.lists(st.tuples(point, point), min_size=1, max_size=5))
def test_distance_is_that_of_the_nearest_points(a: tuple, b: tuple, pieces: list) -> None:
    t = np.linspace(0, 1, 201)[:, None]
    run = np.array(a) * (1 - t) + np.array(b) * t
    sampled = min(np.linalg.norm(run[:, None] - (np.array(p) * (1 - t) + np.array(q) * t)[None], axis=2).min() for p, q in pieces)
    found = distance((a, b), np.array(pieces))
    assert found <= sampled + 1e-9
    assert sampled - found <= 0.3  # two sampled points are at most two half steps of 28 mm / 200 away


def test_crossing_touching_and_nothing() -> None:
    assert distance([(0, 0), (2, 2)], np.array([[(0, 2), (2, 0)]])) == 0
    assert distance([(0, 0), (1, 0)], np.array([[(1, 0), (1, 5)]])) == 0
    assert distance([(0, 0), (1, 0)], np.array([[(3, 0), (3, 0)]])) == 2
    assert distance([(0, 0), (1, 0)], np.empty((0, 2, 2))) == math.inf


def test_chords_of_mixed_shapes() -> None:
    pieces = chords([Straight((0, 0), (1, 0)), Curve((1, 0), (3, 0), (2, 0), clockwise=True)])
    assert len(pieces) > 5 and pieces.shape[1:] == (2, 2)
    assert (pieces[1:, 0] == pieces[:-1, 1]).all()
    assert chords([]).shape == (0, 2, 2)


def test_laid_ink_is_cut_into_chords_once(monkeypatch: pytest.MonkeyPatch) -> None:
    shapes = [Curve((k, 0.0), (k + 1.0, 0.0), (k + 0.5, 0.0), clockwise=bool(k % 2)) for k in range(200)]
    cut = []
    monkeypatch.setattr("gcode.clearance.chords", lambda waiting: cut.append(len(waiting)) or chords(waiting))
    laid, run = Laid(), ((0.3, 2.0), (150.0, 1.5))
    for k, shape in enumerate(shapes):
        laid.add(shape)
        if k % 7 == 0:
            assert laid.distance(run) == distance(run, chords(shapes[: k + 1]))
    assert sum(cut) == 197 and Laid().distance(run) == math.inf
