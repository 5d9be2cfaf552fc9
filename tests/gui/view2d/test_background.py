"""What the still part is drawn with."""

import numpy as np

from gui.state.derived import Derived
from gui.theme import LIGHT
from gui.view2d.background import Ground, paint_lines
from gui.view2d.plane import Plane
from gui.view2d.sheet import Edges, Sheet


class Drawn:
    """A pen that keeps what it was told."""

    ratio = 1.0

    def __init__(self):
        self.strokes = []

    def lines(self, parts, colour, width, **_):
        self.strokes += [(np.asarray(part), colour) for part in parts]

    def line(self, *_, **__):
        pass

    text = line


def test_a_cut_that_reaches_no_border_is_a_seam_and_a_hole_of_the_object_is_none(skin):
    sheet, topology = Sheet(skin, Derived()), skin.mesh.topology
    inside, border = (int(np.flatnonzero(topology.is_boundary == each)[0]) for each in (False, True))
    ends = np.array([[[1.0, 2], [3, 4]], [[5.0, 6], [7, 8]]])
    none = np.full(2, -1)
    sheet.__dict__["edges"] = Edges(ends, np.array([inside, border]), np.zeros(2, dtype=int), none)
    pen, plane = Drawn(), Plane()
    paint_lines(Ground(sheet, plane, LIGHT, np.zeros((0, 3), np.uint8), "pieces", None, np.zeros(2), grid=False), pen)
    colours = [next(colour for part, colour in pen.strokes if np.array_equal(part, plane.to_px(each))) for each in ends]
    assert colours == [LIGHT.seam, LIGHT.text]
