"""Sensors by themselves."""

from dataclasses import replace

import pytest
from person import MESHES

from gui.state.selection import Target
from skinfab.patterns.registry import make_pattern
from skinfab.placement.sensor import Sensor


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


def test_pieces_changed_meanwhile_stop_it_and_are_said(cup):
    cup.press("F7")
    cup.session.do("another seed", replace(cup.skin, seed=78))
    assert cup.app.runner.job.label == "placing sensors", "it can still be used"
    keep = cup.skin
    cup.session.do("fewer", replace(keep, pieces=keep.pieces[:-1]))
    assert cup.app.runner.job is None
    assert cup.skin.sensors == () and any("placing sensors was stopped" in text for text in cup.problems("warning"))
    cup.press("Control-z")


def test_without_pieces_there_is_nowhere_to_place(person):
    person.open(MESHES / "cube.obj")
    assert not person.app.actions.do("auto_place")
    person.press("F7")
    assert person.app.runner.job is None


def test_an_undo_while_sensors_are_placed_is_not_overrun(cup):
    cup.session.do("another seed", replace(cup.skin, seed=77))
    cup.app.actions.do("auto_place")
    cup.app.actions.do("undo")
    assert cup.app.runner.job is None and cup.app.status.text.get() == "Undone: another seed. Placing sensors was stopped."
    assert cup.session.redo_label == "another seed" and cup.skin.sensors == ()
    assert any("placing sensors was stopped" in text for text in cup.problems("warning"))


def test_what_is_said_of_placed_sensors_goes_and_comes_with_them(cup, monkeypatch):
    spiral = make_pattern("contact-spiral", {"s": 20})
    one = (Sensor("C1", cup.skin.pieces[0].id, spiral, *cup.skin.pieces[0].UV.mean(axis=0), 0.0, 0),)
    placed = replace(cup.skin, sensors=one), ("piece P9 has no sensor",)
    monkeypatch.setattr(cup.app.runner, "start", lambda label, function, *, done, **rest: done(placed))
    cup.app.actions.do("auto_place")
    cup.wait()
    assert cup.problems("warning") == ["piece P9 has no sensor"]
    cup.app.actions.do("undo")
    assert cup.problems("warning") == []
    cup.press("Control-y")
    assert cup.problems("warning") == ["piece P9 has no sensor"]
    cup.session.do("move C1", replace(cup.skin, sensors=(replace(one[0], x=one[0].x + 1),)))
    assert cup.problems("warning") == ["piece P9 has no sensor"], "as true as before"
    elsewhere = cup.skin.pieces[0].id
    cup.app.actions.do("undo")
    placed = placed[0], (f"C1 is stretched on {elsewhere}",)
    cup.app.actions.do("auto_place")
    cup.wait()
    cup.app.actions.do("clear")
    assert cup.problems("warning") == []
