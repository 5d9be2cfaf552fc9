"""Sheets cover the whole box, overlap as said, and no fewer would do."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.drawings.tiles import BORDER_MM, FOOT_MM, OVERLAP_MM, tile

lengths = st.floats(1, 900)


@given(lengths, lengths, st.floats(-500, 500))
def test_every_point_is_on_a_sheet(w: float, h: float, at: float) -> None:
    low = np.array([at, -at])
    tiling = tile(low, low + np.array([w, h]))
    assert sorted(tiling.sheet) == [210, 297]
    assert tiling.window == (tiling.sheet[0] - 2 * BORDER_MM, tiling.sheet[1] - 2 * BORDER_MM - FOOT_MM)
    for axis, length in ((0, w), (1, h)):
        starts = tiling.corners[0, :, 0] if axis == 0 else tiling.corners[:, 0, 1]
        assert starts[0] <= low[axis] + 1e-9 and starts[-1] + tiling.window[axis] >= low[axis] + length - 1e-9
        np.testing.assert_allclose(np.diff(starts), tiling.window[axis] - OVERLAP_MM)
        # One sheet less in this direction would not reach.
        assert length > (len(starts) - 1) * (tiling.window[axis] - OVERLAP_MM) or len(starts) == 1


@given(lengths, lengths)
def test_each_cross_is_on_two_sheets_at_least(w: float, h: float) -> None:
    tiling = tile(np.zeros(2), np.array([w, h]))
    corners = tiling.corners.reshape(-1, 2)
    for cross in tiling.joins:
        inside = (cross >= corners).all(axis=1) & (cross <= corners + tiling.window).all(axis=1)
        assert inside.sum() >= 2
    seen = ((tiling.joins[:, None] >= corners) & (tiling.joins[:, None] <= corners + tiling.window)).all(axis=2).sum(axis=0)
    assert len(corners) == 1 or (seen >= 2).all()  # two crosses hold a sheet in place and straight


@pytest.mark.parametrize(("size", "sheets"), [((190, 261), 1), ((191, 261), 2), ((277, 174), 1), ((370, 261), 2), ((370, 510), 4)])
def test_as_many_as_needed(size: tuple[float, float], sheets: int) -> None:
    assert tile(np.zeros(2), np.array(size, dtype=float)).corners.size // 2 == sheets
