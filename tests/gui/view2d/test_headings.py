"""Pieces are named where their names are seen and taken for no other's."""

from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from gui.view2d import view as view_module
from gui.view2d.background import BAR_PX, RULER_PX, faces_under
from gui.view2d.headings import paint_names
from gui.view2d.labels import Taken


class Row:
    """The view's own ground and pen with other pieces: boxes whose lower left and upper right corners are given in pixels."""

    def __init__(self, ground, pen, face):
        self.ground, self.pen, self.face = ground, pen, np.full_like(face, -1)
        self.words = []

    def named(self, *corners, shading="pieces", sensor=None):
        """Boxes and words."""
        to_mm = self.ground.plane.to_mm
        pieces = []
        for k, (left, low, right, high) in enumerate(corners):
            uv = np.array([to_mm((x, y)) for x, y in ((left, low), (right, low), (right, high))])
            pieces.append(SimpleNamespace(id=f"P{k + 1}", UV=uv, size=np.ptp(uv, axis=0)))
        sheet = SimpleNamespace(pieces=tuple(pieces), offset=np.zeros((len(pieces), 2)))
        taken, said = Taken(self.pen.width, self.pen.height, self.pen.ratio), []
        if sensor is not None:
            taken.box(sensor)
        own = self.pen.text
        try:
            self.pen.text = lambda at, words, *rest, **more: (said.append(words), own(at, words, *rest, **more))[1]
            boxes = paint_names(replace(self.ground, sheet=sheet, shading=shading), self.pen, self.face, taken)
        finally:
            del self.pen.text
        return boxes, [words.split()[0] if len(words.split()) > 1 else words + " alone" for words in said]


@pytest.fixture
def row(window, monkeypatch):
    seen = []

    def keep(*what):
        seen[:] = what
        return paint_names(*what)

    monkeypatch.setattr(view_module, "paint_names", keep)
    window.view.redraw()
    window.view.surface.draw()
    return Row(*seen[:3])


def apart(one, other):
    """Pixels between two boxes on one line; negative where they overlap."""
    return max(one[0], other[0]) - min(one[2], other[2])


def test_a_piece_is_named_where_its_name_hides_no_other(row):
    piece = (200, 200, 400, 300)
    (usual,), _ = row.named(piece)
    assert usual[1] > 300 and abs(usual[0] - 200) < 5
    left, low, _, high = (int(v) for v in usual)
    row.face[row.pen.height - high : row.pen.height - low, left : left + 20] = 0
    (moved,), _ = row.named(piece)
    assert faces_under(usual, row.face) > 0 == faces_under(moved, row.face)
    assert moved[1] > 300 and abs(moved[2] - 400) < 5, "the other corner is free"


def test_small_pieces_in_a_row_beside_the_ruler_keep_their_names_above_them_and_whole(row):
    edge = RULER_PX * row.pen.ratio
    for first in (edge + 2, edge + 20):
        corners = [(first + 64 * k, 200, first + 64 * k + 36, 225) for k in range(4)]
        boxes, words = row.named(*corners)
        assert [w.split()[0] for w in words] == ["P1", "P2", "P3", "P4"]
        assert all(box[0] >= edge - 1 and box[1] >= 225 for box in boxes)
        assert all(apart(a, b) >= 4 for a, b in pairwise(boxes))
        middles = [(box[0] + box[2]) / 2 for box in boxes]
        assert all(left - 12 <= x <= right + 30 for x, (left, _, right, _) in zip(middles, corners, strict=True))


def test_none_runs_under_the_colour_bar(row):
    end = row.pen.width - BAR_PX * row.pen.ratio
    piece = (end - 40, 200, end - 2, 225)
    assert row.named(piece)[0][0][2] > end >= row.named(piece, shading="distortion")[0][0][2] - 1


def test_one_that_a_sensor_lies_on_goes_elsewhere(row):
    piece = (200, 200, 500, 300)
    (usual,), _ = row.named(piece)
    (moved,), (words,) = row.named(piece, sensor=usual)
    assert apart(usual, moved) >= 0 and words == "P1"


def test_a_sensor_between_pieces_is_drawn_over_the_headings(window, monkeypatch):
    order = []
    monkeypatch.setattr(view_module, "paint_names", lambda *what: order.append("headings") or [])
    real = view_module.Marker.sensors
    monkeypatch.setattr(view_module.Marker, "sensors", lambda self, *what, **more: order.append("sensors") or real(self, *what, **more))
    window.view.redraw()
    window.view.surface.draw()
    assert order[:2] == ["headings", "sensors"]
