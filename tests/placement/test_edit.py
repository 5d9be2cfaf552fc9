"""Changing one sensor of many: what is to stay where it is stays, and nothing else changes."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_patterns import patterns

from skinfab.errors import InputError
from skinfab.patterns.base import PatternError
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.registry import PATTERNS
from skinfab.placement import edit
from skinfab.placement.sensor import Sensor

SPIRAL = ContactSpiral(n=3, x=1.7, b=1.5, l=3, s=15)
ONE = Sensor("C1", "P1", SPIRAL, 10.0, 20.0, 0.5, 0)
TWO = Sensor("C2", "P2", SPIRAL, 1.0, 2.0, 0.0, 1)
BOTH = (ONE, TWO)


@pytest.mark.parametrize("kind", PATTERNS)
@settings(max_examples=100, deadline=None)
@given(data=st.data(), x=st.floats(-300, 300), y=st.floats(-300, 300), angle=st.floats(-7, 7), turn=st.floats(-7, 7))
def test_turning_keeps_the_middle_and_turns_back(kind: str, data: st.DataObject, x: float, y: float, angle: float, turn: float) -> None:
    sensor = Sensor("C1", "P1", data.draw(patterns(kind)), x, y, angle, 0)
    (turned,) = edit.rotate([sensor], "C1", angle=turn)
    np.testing.assert_allclose(edit.middle_of(turned), edit.middle_of(sensor), atol=1e-9)
    assert math.remainder(turned.angle - angle - turn, math.tau) == pytest.approx(0, abs=1e-9)
    (back,) = edit.rotate([turned], "C1", angle=-turn)
    np.testing.assert_allclose([back.x, back.y], [x, y], atol=1e-9)


def test_moves() -> None:
    moved = edit.move(BOTH, "C1", x=3, y=4)
    assert (moved[0].x, moved[0].y, moved[0].piece, moved[0].angle) == (3.0, 4.0, "P1", 0.5) and moved[1] is TWO
    assert edit.move(BOTH, "C1", x=3, y=4, piece="P2")[0].piece == "P2"
    shifted = edit.shift(moved, "C1", dx=-1, dy=0.5)[0]
    assert (shifted.x, shifted.y) == (2.0, 4.5)


def test_resizing_keeps_the_middle_and_the_rest() -> None:
    smaller, other = edit.resize(BOTH, "C1", {"n": 2, "s": 12})
    assert (smaller.pattern.n, smaller.pattern.s, smaller.pattern.x) == (2, 12, 1.7) and other is TWO
    np.testing.assert_allclose(edit.middle_of(smaller), edit.middle_of(ONE), atol=1e-9)
    with pytest.raises(InputError, match=r"C1: contact-spiral: n is 9; .* no more than 3"):
        edit.resize(BOTH, "C1", {"n": 9})
    with pytest.raises(InputError, match=r"C1: contact-spiral: unknown parameter 'm'"):
        edit.resize(BOTH, "C1", {"m": 9})
    assert issubclass(PatternError, InputError)


def test_channels_and_removal() -> None:
    assert [s.channel for s in edit.rewire(BOTH, "C2", channel=7)] == [0, 7]
    assert edit.remove(BOTH, "C1") == (TWO,)
    with pytest.raises(InputError, match="channel is -1"):
        edit.rewire(BOTH, "C2", channel=-1)


def test_a_sensor_that_is_not_there() -> None:
    with pytest.raises(InputError, match=r"^there is no sensor C3 \(did you mean C2\?\); there are C1, C2$"):
        edit.remove(BOTH, "C3")
    with pytest.raises(InputError, match=r"^there is no sensor thumb, nor any other$"):
        edit.find((), "thumb")
