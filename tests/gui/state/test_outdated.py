"""A line about a sensor or a piece goes when that has changed or gone, and no other does."""

from dataclasses import replace

import pytest

from gui.state.outdated import Outdated, holds
from gui.state.problem import Problem


def change(skin, id, **new):
    return replace(skin, sensors=tuple(replace(s, **new) if s.id == id else s for s in skin.sensors))


def other_piece(skin, id):
    return replace(skin, pieces=tuple(replace(p) if p.id == id else p for p in skin.pieces))


def with_one_on_p2(skin):
    return replace(skin, sensors=(*skin.sensors, replace(skin.sensors[0], id="C3", piece="P2", channel=2)))


@pytest.mark.parametrize(
    ("text", "what", "stays"),
    [
        ("C1 is 1.2 mm outside piece P1, which spans 100 mm", lambda skin: change(skin, "C1", x=40.0), False),
        ("C1 is 1.2 mm outside piece P1, which spans 100 mm", lambda skin: change(skin, "C2", x=40.0), True),
        ("C1 is 1.2 mm outside piece P1, which spans 100 mm", lambda skin: other_piece(skin, "P1"), False),
        ("C1 is 1.2 mm outside piece P1, which spans 100 mm", lambda skin: other_piece(skin, "P2"), True),
        ("piece P2 has no sensor, though there seems to be room: place one there", with_one_on_p2, False),
        ("piece P2 has no sensor, though there seems to be room: place one there", lambda skin: change(skin, "C1", x=40.0), True),
        ("P2.stl: its lip is 2 mm wide, not 5", with_one_on_p2, True),
        ("P2.stl: its lip is 2 mm wide, not 5", lambda skin: replace(skin, pieces=skin.pieces[:1]), False),
        ("P1.gcode: 3 lines are shorter than the nozzle is wide", lambda skin: change(skin, "C2", x=40.0), False),
        ("there is no room on P1 for a copy of C2; make it smaller first", lambda skin: replace(skin, sensors=skin.sensors[:1]), False),
        ("there is no room on P1 for a copy of C2; make it smaller first", lambda skin: replace(skin, sensors=skin.sensors[1:]), False),
        ("cannot write /tmp/C1.svg: the disk is full", with_one_on_p2, True),
        ("C10 and P10 are not of this document", lambda skin: replace(skin, sensors=(), pieces=()), True),
    ],
)
def test_it_holds_as_long_as_what_it_names_is_the_same(skin, text, what, stays):
    assert holds(text, skin, what(skin)) is stays


def test_lines_go_with_the_step_that_outdates_them(session):
    Outdated(session)
    first = Problem("C1 is 1.2 mm outside piece P1", "export")
    second = Problem("cannot write out/flat.svg", "export")
    own = Problem("C1 is 1.2 mm outside piece P1; move it", "sensors")
    session.report("export", [first, second])
    session.report("sensors", [own])
    session.do("move C2", change(session.skin, "C2", x=40.0))
    assert set(session.problems) == {first, second, own}
    session.do("move C1", change(session.skin, "C1", x=40.0))
    assert set(session.problems) == {second, own}, "of sensors, whoever checks them says anew what holds"
    session.report("export", [first])
    session.do("move C2", change(session.skin, "C2", x=45.0))
    assert first in session.problems, "it was said of the document as it was by then"
    session.undo()
    session.undo()
    assert first not in session.problems


def test_nothing_of_one_document_is_said_of_the_next(session, skin):
    Outdated(session)
    wrote = Problem("wrote 20 files into out", "export", kind="note")
    session.report("export", [wrote, Problem("C1 is 1.2 mm outside piece P1", "export")])
    session.open(change(skin, "C1", x=40.0), None)
    assert session.problems == ()
