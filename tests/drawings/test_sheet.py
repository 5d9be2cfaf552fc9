"""No two pieces touch on the sheet, and the sheet is not wasteful."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from skinfab.drawings.sheet import sheet_offsets
from skinfab.pieces import Piece

sizes = st.lists(st.tuples(st.floats(0.1, 400), st.floats(0.1, 400)), min_size=1, max_size=25)


def rectangle(w: float, h: float, at: tuple[float, float] = (0.0, 0.0)) -> Piece:
    UV = np.array([[0, 0], [w, 0], [w, h], [0, h]]) + at
    return Piece("P", np.arange(2), np.arange(4), np.array([[0, 1, 2], [0, 2, 3]]), UV)


@given(sizes, st.floats(0, 30), st.tuples(st.floats(-50, 50), st.floats(-50, 50)))
def test_boxes_keep_their_spacing(sizes: list[tuple[float, float]], spacing: float, at: tuple[float, float]) -> None:
    pieces = [rectangle(w, h, at) for w, h in sizes]
    offsets = sheet_offsets(pieces, spacing=spacing)
    low = np.array([p.UV.min(axis=0) for p in pieces]) + offsets
    high = np.array([p.UV.max(axis=0) for p in pieces]) + offsets
    for i in range(len(pieces)):
        for j in range(i):
            apart = np.maximum(low[i] - high[j], low[j] - high[i]).max()
            assert apart >= spacing - 1e-9
    np.testing.assert_allclose(low.min(axis=0), 0, atol=1e-9)


def test_twelve_equal_pieces_make_a_block_not_a_row() -> None:
    pieces = [rectangle(30, 20)] * 12
    offsets = sheet_offsets(pieces, spacing=10)
    width, height = (offsets + np.array([30, 20])).max(axis=0)
    # 12 x (40 x 30) with one spacing less each way: 3 x 4 or 4 x 3.
    assert max(width, height) <= 150 and min(width, height) >= 80


def test_same_input_same_sheet() -> None:
    pieces = [rectangle(10 + k % 3, 20 + k % 2) for k in range(9)]
    assert np.array_equal(sheet_offsets(pieces), sheet_offsets(list(pieces)))


def test_no_piece_no_offset() -> None:
    assert sheet_offsets([]).shape == (0, 2)
