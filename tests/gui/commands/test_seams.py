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


def test_flattening_anew_never_brings_back_a_cut_that_was_undone(cube):
    cut(cube)
    cube.wait()
    cube.app.actions.do("flatten")
    assert cube.app.runner.job.label == "flattening"
    cube.app.actions.do("undo")
    cube.wait()
    assert len(cube.skin.seams) == 0 and cube.skin.pieces == () and cube.session.redo_label == "cut"
    assert any("is let go" in text for text in cube.problems("warning"))
    cube.app.actions.do("auto_cut")
    cube.wait()
    assert not any("is let go" in text for text in cube.problems("warning")), "said until work is asked for again"


def test_seams_that_changed_during_an_automatic_cut_are_kept_and_flattened(cube):
    cube.app.actions.do("auto_cut")
    cut(cube)
    assert cube.app.runner.job.label == "cutting and flattening", "what was asked for is not stopped by the window's own work"
    cube.wait()
    assert cube.session.undo_label == "cut" and len(cube.skin.seams) == 7 and len(cube.skin.pieces) == 1
    assert any("cut automatically" in text for text in cube.problems("warning"))


def test_an_undo_during_an_automatic_cut_can_still_be_redone(cube):
    cube.session.do("another seed", replace(cube.skin, seed=77))
    cube.app.actions.do("auto_cut")
    cube.app.actions.do("undo")
    cube.wait()
    assert cube.session.redo_label == "another seed" and cube.skin.pieces == ()


def test_one_thing_asked_for_does_not_stop_another(cube):
    cut(cube)
    cube.wait()
    cube.app.actions.do("auto_cut")
    cube.app.actions.do("auto_place")
    assert cube.app.runner.job.label == "cutting and flattening"
    (text,) = cube.problems()
    assert "cutting and flattening is still going on" in text and "placing sensors" in text and "Cancel" in text
    cube.wait()
    assert cube.session.undo_label == "cut automatically" and cube.problems() == [] and cube.skin.sensors == ()


def test_a_fault_of_a_sensor_is_said_once_and_goes_with_it(cube):
    """Two sensors in one place: the window's own check says so, the automatic cut does not say it again."""
    cube.app.actions.do("auto_cut")
    cube.wait()
    cube.app.actions.do("auto_place")
    cube.wait()
    sensors = cube.skin.sensors
    one = replace(sensors[0], id="C98", channel=98)
    cube.session.do("twice", replace(cube.skin, sensors=(sensors[0], one)))
    cube.wait()
    assert [text for text in cube.problems() if "C98" in text] == [f"{sensors[0].id} overlaps C98; move, turn or shrink it"]
    cube.app.actions.do("auto_cut")
    cube.wait()
    lines = [p.text for p in cube.session.problems if "C98" in p.text]
    assert len([text for text in lines if "overlaps" in text]) == 1 and not any("anew" in text for text in lines)
    cube.app.actions.do("clear")
    assert [p.text for p in cube.session.problems if "C98" in p.text] == []


def test_a_sensor_that_a_cut_took_off_is_said_until_sensors_change(cube):
    cut(cube)
    cube.wait()
    cube.app.actions.do("auto_place")
    cube.wait()
    sensors = cube.skin.sensors
    cut(cube, SPREAD[:1], "glued")
    cube.wait()
    lost = [text for text in cube.problems("warning") if "was taken off" in text]
    assert cube.skin.pieces == () and len(lost) == len(sensors) >= 1
    cube.app.actions.do("undo")
    cube.wait()
    assert cube.skin.sensors == sensors and not any("was taken off" in text for text in cube.problems("warning"))


def test_a_thickness_that_folds_is_said_in_the_windows_words_and_the_materials_own_is_rounded_off(person):
    person.open(MESHES / "cup.obj")
    cut(person, person.skin.mesh.topology.E[:1])
    person.wait()
    form = person.app.root.nametowidget("body.middle.side.forms.properties.document")
    entry = form.nametowidget("thickness.entry")
    entry.delete(0, "end")
    entry.insert(0, "1")
    form.thickness.commit()
    person.wait()
    assert entry.get() == "0", "the field says what still is"
    entry.insert(0, "0.5")  # 0.50
    form.thickness.commit()
    person.app.root.nametowidget("statusbar.work.cancel").invoke()
    person.wait()
    assert entry.get() == "0" and person.skin.thickness == 0
    (text,) = [p for p in person.problems() if "mm thick" in p]
    assert text.startswith("a skin 1 mm thick: ") and "give 0.96 mm or less" in text and "--" not in text and "skinfab make" not in text
    assert form.usual.cget("text") == "Take 2.5 mm, as the material pours"
    form.usual.invoke()
    person.wait()
    assert person.skin.thickness == 2.5 and person.problems() == [] and any("rounded off" in text for text in person.problems("warning"))
