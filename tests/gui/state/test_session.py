"""One document, its history and its listeners."""

from dataclasses import replace

import numpy as np
import pytest

from gui.state.problem import Problem
from gui.state.selection import NOTHING, Target
from gui.state.session import Session
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source


@pytest.fixture
def skin():
    mesh = Mesh(np.array([[0.0, 0, 0], [90, 0, 0], [0, 90, 0]]), np.array([[0, 1, 2]]))
    piece = Piece("P1", np.arange(1), np.arange(3), mesh.F, mesh.V[:, :2])
    sensor = Sensor("C1", "P1", make_pattern("contact-spiral", {"s": 20}), 20.0, 20.0, 0.0, 0)
    return Skin(mesh, Source("flat.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), dtype=np.int64), (piece,), (sensor,))


def test_what_is_done_can_be_undone_and_is_not_saved(skin, tmp_path):
    session = Session()
    session.open(skin, tmp_path / "a.skin")
    assert not session.dirty
    session.do("remove C1", replace(skin, sensors=()))
    assert session.dirty and session.undo_label == "remove C1"
    session.undo()
    assert session.skin is skin and not session.dirty
    session.redo()
    session.mark_saved(tmp_path / "b.skin")
    assert not session.dirty and session.path == tmp_path / "b.skin"
    session.undo()
    assert session.dirty


def test_an_imported_document_is_not_saved_yet(skin):
    session = Session()
    session.open(skin, None, saved=False)
    assert session.dirty and session.undo_label is None


def test_listeners_hear_what_they_asked_for_once_a_change(skin):
    session, heard = Session(), []
    for topic in ("skin", "selection", "hover", "problems", "shading", "tool", "file"):
        session.listen(topic, lambda topic=topic: heard.append(topic))
    session.open(skin, None)
    assert sorted(heard) == ["file", "hover", "problems", "selection", "skin"]
    heard.clear()
    session.select(Target(piece="P1"))
    session.select(Target(piece="P1"))
    session.hover(NOTHING)
    session.shade("distortion")
    session.take_up("cut")
    assert heard == ["selection", "shading", "tool"]


def test_what_is_gone_is_selected_no_more(skin):
    session = Session()
    session.open(skin, None)
    session.select(Target(sensor="C1", piece="P1"))
    session.do("remove C1", replace(skin, sensors=()))
    assert session.selected == NOTHING


def test_each_source_speaks_for_itself_and_errors_come_first(skin):
    session = Session()
    session.open(skin, None)
    session.report("open", [Problem("units were guessed", "open", kind="note")])
    session.report("sensors", [Problem("C1 is outside", "sensors")])
    assert [p.text for p in session.problems] == ["C1 is outside", "units were guessed"]
    session.report("sensors", [])
    assert [p.text for p in session.problems] == ["units were guessed"]


def test_an_unknown_shading_is_refused():
    with pytest.raises(ValueError, match="no shading 'heat'"):
        Session().shade("heat")


def test_what_follows_from_a_step_is_undone_with_it(skin):
    session = Session()
    session.open(skin, None)
    session.amend(replace(skin, seed=1))
    assert not session.dirty and session.undo_label is None
    session.do("cut", replace(skin, seed=2))
    session.amend(replace(skin, seed=3))
    assert session.dirty and session.skin.seed == 3
    session.undo()
    assert session.skin.seed == 1 and not session.dirty
