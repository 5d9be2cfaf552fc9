"""A new sensor gets the next free name and channel, and its middle where it was asked for."""

import dataclasses

import numpy as np
import pytest

from skinfab.patterns.registry import make_pattern
from skinfab.placement.add import add_at
from skinfab.placement.edit import middle_of, remove

SPIRAL = make_pattern("contact-spiral", {"s": 20})
LINES = make_pattern("strain-lines", {"l1": 53, "l2": 43, "b": 6})


@pytest.mark.parametrize("angle", [0.0, 1.0, np.pi])
@pytest.mark.parametrize("pattern", [SPIRAL, LINES], ids=["spiral", "lines"])
def test_its_middle_is_where_it_was_asked_for(pattern, angle):
    _, new = add_at([], pattern, "P2", [30.0, 40.0], angle=angle)
    assert middle_of(new) == pytest.approx([30.0, 40.0]) and new.piece == "P2" and new.angle == angle


def test_gaps_in_names_and_channels_are_filled():
    sensors = ()
    for pattern in (SPIRAL, SPIRAL, LINES, SPIRAL):
        sensors, _ = add_at(sensors, pattern, "P1", [0, 0])
    assert [(s.id, s.channel) for s in sensors] == [("C1", 0), ("C2", 1), ("S1", 2), ("C3", 3)]
    sensors, new = add_at(remove(sensors, "C2"), SPIRAL, "P1", [0, 0])
    assert (new.id, new.channel) == ("C2", 1) and [s.channel for s in sensors] == [0, 1, 2, 3]


def test_names_of_ones_own_do_not_matter():
    sensors, _ = add_at([], SPIRAL, "P1", [0, 0])
    (named,) = (dataclasses.replace(s, id="palm", channel=7) for s in sensors)
    _, new = add_at([named], SPIRAL, "P1", [0, 0])
    assert (new.id, new.channel) == ("C1", 0)
