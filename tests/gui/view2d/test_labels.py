"""Labels of seams are seen whatever lies beside the seams."""

from dataclasses import replace

import numpy as np
import pytest

from gui.view2d import view as view_module
from gui.view2d.labels import Taken, paint_labels, paint_small_names
from gui.view2d.marking import WRITTEN_OVER_PX
from skinfab.placement.edit import middle_of


@pytest.fixture
def labels(window, monkeypatch):
    """Where the labels of a skin are drawn."""
    kept = []

    def keep(*what):
        kept[:] = paint_labels(*what)
        return kept

    monkeypatch.setattr(view_module, "paint_labels", keep)

    def drawn(skin):
        window.session.do("other", skin)
        window.root.update()
        window.view.surface.draw()
        return list(kept)

    return drawn


def lines(window, skin):
    """The sensors' lines, pixels."""
    return [window.view.plane.to_px(window.view.lines.of(s, window.view.sheet)) for s in skin.sensors]


def overlap(box, points):
    left, low, right, high = box
    return int(((points > (left, low)) & (points < (right, high))).all(axis=1).sum())


def test_beside_its_notch_where_nothing_is_in_the_way(window, labels):
    skin = replace(window.skin, sensors=())
    view, boxes = window.view, labels(skin)
    assert len(boxes) == 2
    for side, box in zip([s for s in view.sheet.sides if s.label], boxes, strict=True):
        middle = np.array([box[0] + box[2], box[1] + box[3]]) / 2
        notch = view.plane.to_px(side.notch + view.sheet.offset[side.piece])
        assert np.hypot(*(middle - notch)) < 20 * view.surface.ratio and (middle - notch) @ side.inward > 0


def test_none_lies_under_a_sensor(window, labels):
    # Both sensors are moved to where the labels would be.
    sensors = tuple(
        replace(s, x=s.x + x - middle_of(s)[0], y=s.y + 30.0 - middle_of(s)[1])
        for s, x in zip(window.skin.sensors, (54.0, 6.0), strict=True)
    )
    bare = labels(replace(window.skin, sensors=()))
    skin = replace(window.skin, sensors=sensors)
    boxes = labels(skin)
    points = np.concatenate(lines(window, skin))
    assert sum(overlap(box, points) for box in bare) > 10, "they would lie under the sensors"
    assert [overlap(box, points) for box in boxes] == [0, 0]
    (a, b) = boxes
    assert a[2] < b[0] or b[2] < a[0] or a[3] < b[1] or b[3] < a[1]


@pytest.mark.parametrize(("share", "drawn"), [(1.0, 0), (0.35, 0), (0.25, 2)])
def test_one_that_would_hide_what_is_there_is_left_out(window, labels, monkeypatch, share, drawn):
    monkeypatch.setattr(Taken, "share", lambda self, box: share)
    assert len(labels(replace(window.skin, seed=round(100 * share)))) == drawn


@pytest.fixture
def names(window, labels, monkeypatch):
    """Where names of sensors are drawn beside them."""
    kept = []

    def keep(*what):
        kept[:] = paint_small_names(*what)
        return kept

    monkeypatch.setattr(view_module, "paint_small_names", keep)

    def drawn(skin):
        labels(skin)
        return list(kept)

    return drawn


def size_on_screen(window):
    return max(np.ptp(line, axis=0).max() for line in lines(window, window.skin)) / window.view.surface.ratio


def test_the_name_of_a_small_sensor_stands_beside_it(window, names):
    assert size_on_screen(window) > WRITTEN_OVER_PX and names(replace(window.skin, seed=7)) == []
    window.view.zoom(32.0 / size_on_screen(window))
    boxes, small = names(replace(window.skin, seed=8)), lines(window, window.skin)
    assert len(boxes) == 2
    for box, line in zip(boxes, small, strict=True):
        assert overlap(box, np.concatenate(small)) == 0
        middle = np.array([box[0] + box[2], box[1] + box[3]]) / 2
        assert np.hypot(*(middle - (line.min(axis=0) + line.max(axis=0)) / 2)) < 45 * window.view.surface.ratio


def test_a_small_sensor_without_room_beside_it_has_no_name(window, names, monkeypatch):
    monkeypatch.setattr(Taken, "share", lambda self, box: 0.2)
    window.view.zoom(32.0 / size_on_screen(window))
    assert names(replace(window.skin, seed=9)) == []


def test_seams_too_short_on_the_screen_have_none(window, labels):
    window.view.zoom(0.02)
    assert labels(replace(window.skin, seed=6)) == []


def test_what_is_off_the_picture_takes_nothing():
    taken = Taken(90, 60)
    taken.lines([np.array([[-50.0, -50.0], [-10.0, -10.0]]), np.array([[500.0, 5.0], [600.0, 5.0]])])
    taken.box((-20, -20, -5, -5))
    assert taken.share((6, 6, 90, 60)) == 0.0
    taken.box((30, 30, 40, 40))
    assert taken.share((30, 30, 40, 40)) == 1.0 and 0 < taken.share((20, 30, 40, 40)) < 1
