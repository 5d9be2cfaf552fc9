"""What is wrong with a channel: said once, with the time, and in an order that says the worst first."""

import math
from dataclasses import replace

from calibration.contact.health import Freeze, Health

WELL = Health("S1", 100.0, 0.4, 3.0, 0.0, 0.9, 0.0, 0.0, False, True, 90.0, 150.0, ())


def test_one_that_is_well() -> None:
    assert WELL.faults == () and WELL.state == ""


def test_each_state_has_its_sentence() -> None:
    silent = replace(WELL, masked=1.0, ready=math.nan)
    constant = replace(WELL, constant=True, tells=False)
    moving = replace(WELL, ready=math.nan, r0=math.nan, late=math.nan)
    assert [each.state for each in (silent, constant, moving)] == ["silent", "constant", "never at rest"]
    for each, words in ((silent, "never read anything"), (constant, "read one value all the time"), (moving, "S1 never rested for 3 s")):
        (only,) = each.faults
        assert words in only


def test_a_late_one_says_from_when() -> None:
    (only,) = replace(WELL, ready=33.0, late=30.0).faults
    assert "is watched from 33.00 s on" in only
    assert replace(WELL, late=0.9).faults == ()


def test_a_frozen_one_says_since_when_at_what_and_whether_that_is_an_end() -> None:
    middle = replace(WELL, freezes=(Freeze(12.0, math.nan, 120.0),))
    assert middle.state == "frozen" and "froze at 12.00 s (120), to the end;" in middle.faults[0]
    (top,) = replace(WELL, freezes=(Freeze(12.0, 13.5, 149.9), Freeze(20.0, 31.0, 149.9))).faults
    assert "(149.9, the most that it ever read, as at the end of a range), to 31.00 s, 2 times in between" in top
    assert "the least that it ever read" in replace(WELL, freezes=(Freeze(1.0, 2.0, 90.0),)).faults[0]


def test_all_that_is_wrong_is_said() -> None:
    all_of_it = replace(WELL, late=5.0, tells=False, masked=0.25, saturated=0.125).faults
    words = ("is watched from", "nobody could tell if it froze", "read nothing in 25.0 %", "end of its range in 12.5 %")
    assert len(all_of_it) == 4 and all(word in said for word, said in zip(words, all_of_it, strict=True))
