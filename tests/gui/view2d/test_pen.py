"""What is drawn is within what is said to be touched, and words stay inside."""

import numpy as np
from matplotlib.backends.backend_agg import RendererAgg

from gui.view2d.letters import Letters
from gui.view2d.pen import Pen


def test_all_that_changes_is_touched():
    renderer = RendererAgg(200, 120, 96)
    pen, picture = Pen(renderer, Letters()), np.asarray(renderer.buffer_rgba())
    before = picture.copy()
    pen.line([[20.0, 20], [60, 90], [70, 25]], "#ff0000", 7.0)
    pen.disk((120, 60), 9, "#00ff00", "#000000")
    pen.text((160, 30), "0.6 mm outside P2", "#101010", ground="#ffffff", inside=True)
    pen.text((0, 118), "left", "#101010", ground="#ffffff", inside=True)
    changed = (picture != before).any(axis=2)
    allowed = np.zeros_like(changed)
    for left, low, right, high in pen.touched:
        allowed[max(int(120 - high), 0) : int(120 - low) + 1, max(int(left), 0) : int(right) + 1] = True
    assert changed.any() and not (changed & ~allowed).any() and not allowed.all()


def test_boxes_apart_stay_apart():
    renderer = RendererAgg(200, 120, 96)
    pen = Pen(renderer, Letters())
    pen.line([[5.0, 5], [20, 5]], "#000000", 1.0)
    pen.line([[150.0, 100], [160, 110]], "#000000", 1.0)
    assert len(pen.touched) == 2
    pen.line([[0.0, 0], [199, 119]], "#000000", 1.0)
    assert len(pen.touched) == 1
