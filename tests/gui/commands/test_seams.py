"""Cut by itself; pieces that follow the seams whatever happens meanwhile."""

from dataclasses import replace

import numpy as np
import pytest
from person import MESHES

SPREAD = np.array([[0, 1], [1, 3], [2, 3], [2, 6], [6, 7], [5, 7], [4, 5]])


@pytest.fixture
def cube(person):
    person.open(MESHES / "cube.obj")
    return person


def cut(person, seams=SPREAD, label="cut"):
    person.session.do(label, replace(person.skin, seams=seams))


def test_an_automatic_cut_lies_flat_and_is_one_step(cube):
    bare = cube.skin
    cube.press("F5")
    cube.wait()
    assert cube.session.undo_label == "cut automatically" and cube.problems() == []
    assert sum(len(p.faces) for p in cube.skin.pieces) == 12
    cube.press("Control-z")
    cube.wait()
    assert cube.skin is bare


def test_a_change_during_a_running_cut_is_kept(cube):
    cube.press("F5")
    assert cube.app.runner.job is not None
    cube.session.do("another seed", replace(cube.skin, seed=77))
    cube.wait()
    assert cube.skin.seed == 77 and len(cube.skin.pieces) >= 1
    labels = []
    while (label := cube.session.undo_label) is not None:
        labels.append(label)
        cube.session.undo()
    assert labels == ["cut automatically", "another seed"]
    cube.wait()


def test_undone_during_the_work_the_pieces_are_those_of_the_seams(cube):
    cut(cube)
    cube.press("Control-z")
    cube.wait()
    assert len(cube.skin.seams) == 0 and cube.skin.pieces == ()
    cube.press("Control-y")
    cube.wait()
    assert len(cube.skin.seams) == 7 and len(cube.skin.pieces) == 1


def test_opening_another_object_during_the_work_leaves_it_alone(cube):
    cut(cube)
    cube.open(MESHES / "dodecahedron.obj")
    assert cube.skin.source.file == "dodecahedron.obj" and cube.skin.pieces == () and not cube.session.dirty


def test_what_was_stopped_can_be_flattened_by_its_key(cube):
    cut(cube)
    assert cube.app.runner.job.label == "flattening"
    cube.app.root.nametowidget("statusbar.work.cancel").invoke()
    cube.wait()
    assert cube.skin.pieces == () and cube.app.runner.job is None and "F6" in cube.app.status.text.get()
    cube.press("F6")
    cube.wait()
    assert len(cube.skin.pieces) == 1


def test_another_cut_keeps_the_pieces_that_stay_the_same(cube):
    cut(cube)
    cube.wait()
    cut(cube, np.vstack([SPREAD, [[0, 2], [4, 6], [5, 1]]]))
    cube.wait()
    assert len(cube.skin.pieces) >= 2 and "P1" in [p.id for p in cube.skin.pieces]
    assert sum(len(p.faces) for p in cube.skin.pieces) == 12


def test_a_seam_too_short_to_open_it_is_a_warning_at_its_place(cube):
    cut(cube, np.array([[0, 1]]))
    cube.wait()
    assert cube.problems() == [] and len(cube.problems("warning")) == 1
    cube.press("Control-z")
    cube.wait()
    assert [p for p in cube.session.problems if p.kind == "warning" and p.target] == []


def test_flattened_anew_by_another_method_from_the_menu(cube):
    cut(cube)
    cube.wait()
    before = cube.skin.pieces[0].UV
    cube.app.seams.choose_method("lscm")
    cube.wait()
    assert cube.app.seams.method == "lscm" and cube.session.undo_label == "flatten (lscm)"
    assert cube.skin.pieces[0].UV is not before
    cube.app.seams.method = "auto"


def test_what_cannot_be_cut_is_a_sentence(cube):
    cube.session.do("hopeless", replace(cube.skin, material="no-such-ink"))
    cube.press("F5")
    cube.wait()
    assert any("no-such-ink" in text for text in cube.problems())
    cube.press("Control-z")
    cube.press("F5")
    cube.wait()
    assert cube.problems() == [] and len(cube.skin.pieces) >= 1
