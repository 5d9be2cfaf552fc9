"""Pads and conductor together are what is printed, and cutting arcs up changes nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from skinfab.drawings.strokes import pad_paths, short_arcs
from skinfab.paths import Arc, Line, Path
from skinfab.skin import Skin


def test_pads_and_conductor_are_the_printed_stroke(skin: Skin) -> None:
    for sensor in skin.sensors:
        first, last = pad_paths(sensor)
        np.testing.assert_allclose(first.end, sensor.path.start, atol=1e-9)
        np.testing.assert_allclose(last.start, sensor.path.end, atol=1e-9)
        assert first.length + sensor.path.length + last.length == pytest.approx(sensor.printed_path.length)


def test_no_pads_no_strokes(skin: Skin) -> None:
    bare = replace(skin.sensors[0], pattern=replace(skin.sensors[0].pattern, pad=0.0))
    assert pad_paths(bare) == ()


@pytest.mark.parametrize("sweep", [0.5, -2.0, np.pi, -np.pi, 4.5, 2 * np.pi])
@pytest.mark.parametrize("longest", [2 * np.pi / 3, np.pi])
def test_short_arcs_are_the_same_curve(sweep: float, longest: float) -> None:
    path = Path((Line((0, 0), (5, 0)), Arc((5, 2), 2.0, -np.pi / 2, sweep)))
    parts = short_arcs(path, longest=longest)
    assert all(abs(s.sweep) <= longest * (1 + 1e-9) for s in parts if isinstance(s, Arc))
    again = Path(tuple(parts))
    t = np.linspace(0, 1, 50)
    np.testing.assert_allclose(again.point_at(t), path.point_at(t), atol=1e-9)
    assert len(parts) == 1 + int(np.ceil(abs(sweep) / longest - 1e-9))
