"""Computed once for as long as what it follows from stays the same."""

from dataclasses import replace

import numpy as np
import pytest

import gui.state.derived as derived_module
from gui.jobs.worker import Outcome
from gui.state.derived import Derived
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source


@pytest.fixture
def skin():
    """A tent: two faces folded along x = 0, flattened to a square."""
    V = np.array([[0.0, 0, 0], [0, 60, 0], [-40, 0, -30], [40, 0, -30], [40, 60, -30], [-40, 60, -30]])
    F = np.array([[2, 0, 1], [2, 1, 5], [0, 3, 4], [0, 4, 1]])
    UV = np.array([[50.0, 0], [50, 60], [0, 0], [100, 0], [100, 60], [0, 60]])
    piece = Piece("P1", np.arange(4), np.arange(6), F, UV)
    sensor = Sensor("C1", "P1", make_pattern("contact-spiral", {"s": 20}), 40.0, 30.0, 0.0, 0)
    return Skin(Mesh(V, F), Source("tent.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), dtype=np.int64), (piece,), (sensor,))


def test_a_change_of_one_sensor_computes_only_that_anew(skin):
    derived = Derived()
    other = replace(skin.sensors[0], id="C2", x=60.0)
    line, d = derived.object_line(skin, skin.sensors[0]), derived.distortion(skin.mesh, skin.pieces[0])
    changed = replace(skin, sensors=(skin.sensors[0], other))
    assert derived.object_line(changed, changed.sensors[0]) is line
    assert derived.distortion(changed.mesh, changed.pieces[0]) is d
    assert derived.object_line(changed, other) is not line


def test_a_sensor_keeps_its_length_across_a_fold(skin):
    line = Derived().object_line(skin, skin.sensors[0])
    length = np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
    assert np.isfinite(line).all() and (line[:, 0] < 0).any() and (line[:, 0] > 0).any()
    assert length == pytest.approx(skin.sensors[0].printed_path.length, rel=0.02)  # chords of 1 mm cut curves


def test_what_lies_beside_the_piece_has_no_place_on_the_object(skin):
    beside = replace(skin.sensors[0], x=95.0)
    assert np.isnan(Derived().object_line(skin, beside)).any()


def test_faces_know_their_piece(skin):
    partly = replace(skin, pieces=(replace(skin.pieces[0], faces=np.array([0, 1]), F=skin.pieces[0].F[:2]),))
    assert Derived().piece_of_face(partly).tolist() == [0, 0, -1, -1]


def test_no_pieces_have_no_sheet(skin):
    derived = Derived()
    assert derived.offsets(()) == {}
    assert derived.offsets(skin.pieces)["P1"].tolist() == [0.0, 0.0]


class Later:
    """Answers when it is told to; the newest question of a key alone, as the window's own does."""

    def __init__(self):
        self.asked = {}

    def ask(self, key, question, answered):
        self.asked[key] = question, answered

    def answer(self, sentence=""):
        for question, answered in [self.asked.pop(key) for key in list(self.asked)]:
            if not sentence:
                question()
            answered(Outcome(sentence=sentence))


@pytest.fixture
def later(skin, monkeypatch):
    monkeypatch.setattr(derived_module, "AT_ONCE", 1)  # every document is a large one
    asker = Later()
    return Derived(asker), asker


def test_a_large_document_is_ready_once_its_parts_were_made_elsewhere(skin, later, monkeypatch):
    derived, asker = later
    told = []
    assert not derived.ready(skin, lambda: told.append("one")) and not derived.ready(skin, lambda: told.append("two"))
    assert told == []
    asker.answer()
    assert told == ["one", "two"] and derived.ready(skin, lambda: None) and asker.asked == {}
    monkeypatch.setattr(derived_module, "measure", None)
    monkeypatch.setattr(derived_module, "FlatMap", None)
    assert all(np.isfinite(derived.object_line(skin, s)).all() for s in skin.sensors)  # nothing of it is made again
    assert derived.distortion(skin.mesh, skin.pieces[0]).mean > 0
    moved = replace(skin, sensors=(replace(skin.sensors[0], x=21.0), *skin.sensors[1:]))
    assert derived.ready(moved, lambda: None), "a sensor that moves waits for nothing"


def test_only_the_newest_document_is_waited_for(skin, later):
    derived, asker = later
    other = replace(skin, pieces=tuple(replace(p, UV=p.UV + 1.0) for p in skin.pieces))
    told = []
    derived.ready(skin, lambda: told.append("old"))
    derived.ready(other, lambda: told.append("new"))
    asker.answer()
    assert told == ["new"] and derived.ready(other, lambda: None)


def test_what_cannot_be_made_elsewhere_is_asked_for_where_it_is_seen(skin, later):
    derived, asker = later
    told = []
    derived.ready(skin, lambda: told.append(derived.ready(skin, lambda: None)))
    asker.answer("no room")
    assert told == [True]


def test_small_documents_and_those_without_a_thread_wait_for_nothing(skin):
    asker = Later()
    assert Derived(asker).ready(skin, lambda: None) and Derived().ready(skin, lambda: None) and asker.asked == {}
