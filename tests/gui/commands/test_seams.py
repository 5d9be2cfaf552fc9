"""Cut by itself; pieces that follow the seams whatever happens meanwhile."""

from dataclasses import replace

import numpy as np
import pytest
from person import CUBE_SPREAD, MESHES


def test_an_automatic_cut_lies_flat_and_is_one_step(cube):
    bare = cube.skin
    cube.press("F5")
    cube.wait()
    assert cube.session.undo_label == "cut automatically" and cube.problems() == []
    assert sum(len(p.faces) for p in cube.skin.pieces) == 12
    cube.press("Control-z")
    cube.wait()
    assert cube.skin is bare


@pytest.fixture
def usual(cube):
    """The window is that of the other tests too, which cut as usual."""
    yield cube
    cube.app.seams.aim = "usual"


def entries(person):
    """The menu of what a cut is for, as it is when it is opened: labels, and which is ticked."""
    bar = person.app.root.nametowidget(person.app.root["menu"])
    seams = next(bar.nametowidget(bar.entrycget(k, "menu")) for k in range(bar.index("end") + 1) if bar.entrycget(k, "label") == "Seams")
    at = next(k for k in range(seams.index("end") + 1) if seams.type(k) == "cascade" and seams.entrycget(k, "label") == "Cut into")
    menu = seams.nametowidget(seams.entrycget(at, "menu"))
    menu.tk.call(menu["postcommand"])
    chosen = menu.tk.globalgetvar(menu.entrycget(0, "variable"))
    return menu, [menu.entrycget(k, "value") for k in range(menu.index("end") + 1)], chosen


def test_a_cut_into_fewest_usual_or_simplest_pieces_is_chosen_once_for_all(usual):
    cube = usual
    menu, values, chosen = entries(cube)
    assert values == ["fewest", "usual", "simplest"] and chosen == "usual"
    menu.invoke(2)
    assert cube.app.runner.job.label == "cutting and flattening", "in a process of its own, which can be cancelled"
    cube.wait()
    assert cube.session.undo_label == "cut into simplest pieces" and len(cube.skin.pieces) == 2
    assert entries(cube)[2] == "simplest"
    cube.press("Control-z")
    cube.wait()
    assert len(cube.skin.pieces) == 0
    cube.press("F5")  # from now on
    cube.wait()
    assert len(cube.skin.pieces) == 2
    entries(cube)[0].invoke(0)
    cube.wait()
    assert cube.session.undo_label == "cut into fewest pieces" and len(cube.skin.pieces) == 1 and cube.problems() == []


def test_a_cut_of_a_kind_can_be_stopped(usual):
    entries(usual)[0].invoke(2)
    usual.app.runner.cancel()
    usual.wait()
    assert usual.skin.pieces == () and len(usual.skin.seams) == 0 and usual.session.undo_label is None
    usual.press("F5")
    usual.wait()
    assert len(usual.skin.pieces) == 2


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
    cube.cut()
    cube.press("Control-z")
    cube.wait()
    assert len(cube.skin.seams) == 0 and cube.skin.pieces == ()
    cube.press("Control-y")
    cube.wait()
    assert len(cube.skin.seams) == 7 and len(cube.skin.pieces) == 1


def test_opening_another_object_during_the_work_leaves_it_alone(cube):
    cube.cut()
    cube.open(MESHES / "dodecahedron.obj")
    assert cube.skin.source.file == "dodecahedron.obj" and cube.skin.pieces == () and not cube.session.dirty


def test_what_was_stopped_can_be_flattened_by_its_key(cube):
    cube.cut()
    assert cube.app.runner.job.label == "flattening"
    cube.app.root.nametowidget("statusbar.work.cancel").invoke()
    cube.wait()
    assert cube.skin.pieces == () and cube.app.runner.job is None and "F6" in cube.app.status.text.get()
    cube.press("F6")
    cube.wait()
    assert len(cube.skin.pieces) == 1


def test_stopped_with_nothing_to_flatten_no_key_is_named_for_it(cube):
    cube.press("F5")
    cube.app.root.nametowidget("statusbar.work.cancel").invoke()
    assert cube.app.runner.job is None and cube.app.status.text.get() == "Stopped."


def test_another_cut_keeps_the_pieces_that_stay_the_same(cube):
    cube.cut()
    cube.wait()
    cube.cut(np.vstack([CUBE_SPREAD, [[0, 2], [4, 6], [5, 1]]]))
    cube.wait()
    assert len(cube.skin.pieces) >= 2 and "P1" in [p.id for p in cube.skin.pieces]
    assert sum(len(p.faces) for p in cube.skin.pieces) == 12


def test_a_seam_too_short_to_open_it_is_a_warning_at_its_place(cube):
    cube.cut(np.array([[0, 1]]))
    cube.wait()
    assert cube.problems() == [] and len(cube.problems("warning")) == 1
    cube.press("Control-z")
    cube.wait()
    assert [p for p in cube.session.problems if p.kind == "warning" and p.target] == []


def test_flattened_anew_by_another_method_from_the_menu(cube):
    cube.cut()
    cube.wait()
    before = cube.skin.pieces[0].UV
    cube.app.seams.choose_method("lscm")
    cube.wait()
    assert cube.app.seams.method == "lscm" and cube.session.undo_label == "flatten (lscm)"
    assert cube.skin.pieces[0].UV is not before
    cube.app.seams.method = "auto"


def test_what_is_said_of_pieces_flattened_anew_is_said_of_these(cube):
    cube.cut()
    cube.wait()
    assert cube.problems("warning") == []
    cube.app.seams.choose_method("harmonic")  # onto a disk, as which no cube lies well
    cube.wait()
    (said,) = cube.problems("warning")
    assert "over the bound" in said
    cube.press("Control-z")
    cube.wait()
    assert cube.problems("warning") == []
    cube.press("Control-y")
    cube.wait()
    assert cube.problems("warning") == [said]
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
    cube.cut()
    cube.wait()
    cube.app.actions.do("flatten")
    assert cube.app.runner.job.label == "flattening"
    cube.app.actions.do("undo")
    assert cube.app.runner.job is None
    cube.wait()
    assert len(cube.skin.seams) == 0 and cube.skin.pieces == () and cube.session.redo_label == "cut"
    assert any("flattening was stopped" in text for text in cube.problems("warning"))
    cube.app.actions.do("auto_cut")
    cube.wait()
    assert not any("was stopped" in text for text in cube.problems("warning")), "said until work is asked for again"


def test_seams_that_changed_during_an_automatic_cut_stop_it_and_are_flattened(cube):
    cube.app.actions.do("auto_cut")
    cube.cut()
    assert cube.app.runner.job is None, "what could not be used any more keeps nothing waiting"
    cube.app.root.update()
    assert cube.app.runner.job.label == "flattening"
    cube.wait()
    assert cube.session.undo_label == "cut" and len(cube.skin.seams) == 7 and len(cube.skin.pieces) == 1
    assert any("cutting and flattening was stopped" in text for text in cube.problems("warning"))


def test_an_undo_during_an_automatic_cut_can_still_be_redone(cube):
    cube.session.do("another seed", replace(cube.skin, seed=77))
    cube.app.actions.do("auto_cut")
    cube.app.actions.do("undo")
    assert cube.app.runner.job is None
    assert cube.app.status.text.get() == "Undone: another seed. Cutting and flattening was stopped."
    cube.wait()
    assert cube.session.redo_label == "another seed" and cube.skin.pieces == ()


def test_one_thing_asked_for_does_not_stop_another(cube):
    cube.cut()
    cube.wait()
    cube.app.actions.do("auto_cut")
    cube.app.actions.do("auto_place")
    assert cube.app.runner.job.label == "cutting and flattening"
    (text,) = cube.problems()
    assert "cutting and flattening is still going on" in text and "placing sensors" in text and "Cancel" in text
    cube.wait()
    assert cube.session.undo_label == "cut automatically" and cube.problems() == [] and cube.skin.sensors == ()


def test_a_thickness_that_folds_is_said_in_the_windows_words_and_the_materials_own_is_rounded_off(person):
    person.open(MESHES / "cup.obj")
    person.cut(person.skin.mesh.topology.E[:1])
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
