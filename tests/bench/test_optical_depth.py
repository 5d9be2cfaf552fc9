"""The table of depths counts what is wrong and what is called sure, of a model that knows and of one that guesses."""

import math
from dataclasses import replace

import numpy as np

from skinfab.bench.optical_depth import depth_row, measure_depths
from skinfab.fingertip.optical.edge import Edge
from skinfab.fingertip.optical.simulator import Fingertip


class Guess:
    """Says the same of every image."""

    def __init__(self, confidence: float) -> None:
        self.said = Edge(0.0, 0.0, confidence=confidence)

    def edge(self, _: np.ndarray) -> Edge:
        return self.said


def test_what_is_called_sure_and_wrong_is_counted() -> None:
    sure, unsure = (depth_row(Guess(c), Fingertip(), (1.0, 2.0), 1.5, 100) for c in (0.9, 0.25))  # type: ignore[arg-type]
    assert sure.sure == 1 and sure.sure_wrong == sure.wrong > 0.6 and 70 < sure.angle_deg < 110
    assert unsure == replace(sure, sure=0.0, sure_wrong=0.0, followed_wrong=0.0)
    assert sure.followed_wrong == sure.wrong  # what a follower takes as well


def test_a_follower_does_not_take_what_is_far_off() -> None:
    far = Guess(0.9)
    far.said = replace(far.said, offset_mm=7.0)
    row = depth_row(far, Fingertip(), (1.0, 2.0), 1.5, 20)  # type: ignore[arg-type]
    assert row.sure_wrong == row.wrong > 0.9 and row.followed_wrong == 0


def test_a_row_for_every_range_and_depth() -> None:
    rows = measure_depths(ranges=((1.6, 2.4),), tried_mm=(0.5, 2.0), images=120, frames=20)
    assert [(row.learned_from_mm, row.depth_mm, row.simulated) for row in rows] == [(1.6, 0.5, True), (1.6, 2.0, True)]
    light, pressed = rows
    assert light.wrong > 0.8 > 0.2 > pressed.wrong and light.sure <= pressed.sure and not math.isnan(light.offset_mm)
