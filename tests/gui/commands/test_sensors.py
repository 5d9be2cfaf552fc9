"""Sensors by themselves."""

from dataclasses import replace

import pytest
from person import MESHES

from gui.state.selection import Target


@pytest.fixture
def cup(person):
    """A cube of 40 mm, cut by itself."""
    person.open(MESHES / "cube.obj")
    person.press("F5")
    person.wait()
    return person


def test_placed_cleared_and_taken_back(cup):
    cup.press("F7")
    cup.wait()
    placed = cup.skin.sensors
    assert len(placed) >= 1 and cup.session.undo_label == "place automatically" and cup.problems() == []
    assert len({s.channel for s in placed}) == len(placed)
    cup.session.select(Target(piece=placed[0].piece, sensor=placed[0].id))
    cup.app.actions.do("clear")
    assert cup.skin.sensors == () and not cup.session.selected and not cup.app.actions.do("clear")
    cup.press("Control-z")
    assert cup.skin.sensors == placed


def test_pieces_changed_meanwhile_are_said(cup):
    cup.press("F7")
    assert cup.app.runner.job is not None
    keep = cup.skin
    # Without the session's word the seams stay those the pieces belong to, so that the work goes on.
    cup.session.do("fewer", replace(keep, pieces=keep.pieces[:-1]))
    assert cup.app.runner.job is not None
    cup.wait()
    assert cup.skin.sensors == () and any("the pieces changed" in text for text in cup.problems())
    cup.press("Control-z")


def test_without_pieces_there_is_nowhere_to_place(person):
    person.open(MESHES / "cube.obj")
    assert not person.app.actions.do("auto_place")
    person.press("F7")
    assert person.app.runner.job is None
