import math

import pytest

from gui.live.dial import Dial
from gui.theme import DARK, LIGHT


@pytest.fixture
def dial(root):
    made = Dial(root, LIGHT)
    made.pack()
    root.update()
    return made


def texts(dial):
    return [dial.itemcget(i, "text") for i in dial.find_all() if dial.type(i) == "text"]


def needle(dial):
    return [dial.coords(i) for i in dial.find_all() if dial.type(i) == "line"]


def test_the_needle_turns_with_the_angle(dial):
    ends = {}
    for angle in (0.0, 60.0, 120.0, 200.0):
        dial.show(angle, "", 10.0, 80.0)
        ((_, _, x, y),) = needle(dial)
        ends[angle] = x, y
        assert texts(dial)[0] == f"{angle:.1f}\N{DEGREE SIGN}"
    assert ends[0.0][0] < ends[60.0][0] < ends[120.0][0] and ends[60.0][1] < ends[0.0][1] and ends[200.0] == ends[120.0]


def test_no_angle_is_no_needle_and_says_why(dial):
    dial.show(math.nan, "saturated", 10.0, 80.0)
    assert needle(dial) == [] and texts(dial) == ["-", "saturated"]


def test_a_doubtful_angle_has_another_colour_in_both_themes(dial):
    for theme in (LIGHT, DARK):
        dial.restyle(theme)
        for doubtful, colour in ((False, theme.text), (True, theme.warning)):
            dial.show(50.0, "", 10.0, 80.0, doubtful=doubtful)
            first = next(i for i in dial.find_all() if dial.type(i) == "text")
            assert dial.itemcget(first, "fill") == colour
