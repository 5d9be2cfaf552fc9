"""Open, save, leave: with the right questions, and a sentence where it cannot be."""

import tkinter as tk
from dataclasses import replace

import numpy as np
import pytest
from person import MESHES

from gui.dialogs.open_mesh import MeshChoice
from gui.state.store import recall
from skinfab.document import load_skin


@pytest.fixture
def cube(person):
    person.open(MESHES / "cube.obj")
    person.answers.asked.clear()
    return person


def change(person, seed=3):
    person.session.do("another seed", replace(person.skin, seed=seed))


def test_a_mesh_is_asked_about_and_opened_in_its_unit(person):
    seen = []
    person.answers.choice = lambda facts: seen.append(facts) or MeshChoice("cm", False)
    person.answers.path = MESHES / "cube.obj"
    person.press("Control-o")
    person.wait()
    (facts,) = seen
    assert facts.extent == 40 and facts.units == "mm" and facts.usable and "12 triangles" in facts.headline
    assert np.ptp(person.skin.mesh.V, axis=0).tolist() == [400, 400, 400] and person.skin.source.units == "cm"
    assert person.session.path is None and not person.session.dirty
    assert person.app.root.title() == "cube.obj (not saved as a skin yet) - skinfab"


def test_where_the_dialog_is_cancelled_nothing_changes(cube):
    before = cube.skin
    cube.answers.choice = lambda facts: None
    cube.open(MESHES / "dodecahedron.obj")
    assert cube.skin is before
    cube.answers.path = None
    cube.press("Control-o")
    cube.wait()
    assert cube.skin is before


def test_repair_says_what_it_changed(person, tmp_path):
    lines = (MESHES / "cube.obj").read_text().splitlines()
    (tmp_path / "holed.obj").write_text("\n".join(lines[:-1]) + "\n")
    seen = []
    person.answers.choice = lambda facts: seen.append(facts) or MeshChoice("mm", bool(seen[1:]))
    person.open(tmp_path / "holed.obj")
    assert seen[0].usable and seen[0].repair_does and "11 triangles, with 1 open border" in seen[0].headline
    assert len(person.skin.mesh.F) == 11
    person.open(tmp_path / "holed.obj")
    assert len(person.skin.mesh.F) == 12 and person.problems() == [] and "hole" in " ".join(person.problems("note"))


@pytest.mark.parametrize(
    ("name", "content"),
    [("a.obj", b"v 0 0\nf 1 2 3\n"), ("a.stl", b"\x00" * 90), ("a.skin", b"PK\x03\x04 no"), ("a.xyz", b"1 2 3"), ("gone.skin", None)],
)
def test_a_broken_file_is_one_sentence_and_the_document_stays(cube, tmp_path, name, content):
    before = cube.skin
    if content is not None:
        (tmp_path / name).write_bytes(content)
    cube.open(tmp_path / name)
    (text,) = cube.problems()
    assert name in text and "\n" not in text and "Traceback" not in text
    assert cube.skin is before and cube.view3d.hit_at(*cube.see_face(3)).face == 3
    cube.open(MESHES / "dodecahedron.obj")
    assert cube.problems() == [] and cube.skin.source.file == "dodecahedron.obj"


def test_saved_reopened_and_the_same(cube, tmp_path):
    change(cube, 11)
    cube.app.root.update()
    assert cube.app.root.title() == "*cube.obj (not saved as a skin yet) - skinfab"
    cube.answers.path = tmp_path / "mine"
    cube.press("Control-s")
    assert cube.answers.asked[-1] == "save_path cube.skin"
    path = tmp_path / "mine.skin"
    assert cube.session.path == path and not cube.session.dirty and load_skin(path).seed == 11
    cube.press("F5")
    cube.wait()
    cube.app.root.update()
    assert cube.session.dirty and cube.app.root.title() == "*mine.skin - skinfab"
    cube.press("Control-s")
    kept = cube.skin
    cube.open(path)
    assert len(cube.skin.pieces) == len(kept.pieces) and np.array_equal(cube.skin.pieces[0].UV, kept.pieces[0].UV)
    assert not cube.session.dirty and cube.session.undo_label is None
    cube.answers.path = tmp_path / "other.skin"
    cube.press("Control-Shift-S")
    assert cube.session.path == tmp_path / "other.skin" and path.is_file()


def test_where_it_cannot_be_written_it_stays_unsaved(cube, tmp_path):
    change(cube)
    cube.answers.path = tmp_path / "no" / "such" / "folder.skin"
    cube.press("Control-s")
    assert "folder" in cube.problems()[0] and cube.session.dirty and cube.session.path is None
    cube.answers.path = None
    assert cube.app.files.save() is False
    cube.answers.path = tmp_path / "a.skin"
    cube.press("Control-s")
    assert cube.problems() == [] and not cube.session.dirty


def test_saved_while_the_pieces_are_behind_the_seams(cube, tmp_path):
    cube.session.do("cut", replace(cube.skin, seams=np.array([[0, 1]])))
    assert cube.app.runner.job is not None
    cube.answers.path = tmp_path / "half.skin"
    cube.press("Control-s")
    assert cube.session.path == tmp_path / "half.skin"
    cube.wait()
    cube.open(tmp_path / "half.skin")
    assert cube.problems() == [] and cube.skin.seams.tolist() == [[0, 1]]


@pytest.mark.parametrize(("answer", "left"), [("Save", True), ("Do not save", True), ("Cancel", False)])
def test_unsaved_work_is_asked_about(cube, tmp_path, answer, left):
    change(cube, 21)
    cube.answers.give["Unsaved work"], cube.answers.path = answer, tmp_path / "kept.skin"
    cube.open(MESHES / "dodecahedron.obj")
    assert cube.answers.asked[0] == "Unsaved work: The skin of cube.obj has changes that are not saved."
    assert (cube.skin.source.file == "dodecahedron.obj") is left
    assert (tmp_path / "kept.skin").exists() is (answer == "Save")
    if answer == "Save":
        assert load_skin(tmp_path / "kept.skin").seed == 21
    if not left:
        assert cube.session.dirty and not cube.app.files.may_leave()


def test_save_that_is_broken_off_is_no_leave(cube):
    change(cube)
    cube.answers.give["Unsaved work"], cube.answers.path = "Save", None
    assert cube.app.files.may_leave() is False and cube.session.dirty
    cube.app.close()
    assert cube.app.root.winfo_exists()


def test_undo_back_to_what_was_saved_is_clean(cube):
    change(cube)
    assert cube.session.dirty
    cube.press("Control-z")
    assert not cube.session.dirty and cube.app.files.may_leave() and cube.answers.asked == []


def test_recent_files_are_in_the_menu_and_open(cube, tmp_path):
    cube.open(MESHES / "dodecahedron.obj")
    menu = tk.Menu(cube.app.root)
    cube.app.files.fill_recent(menu)
    first = 1 if menu.type(0) == "tearoff" else 0
    labels = [menu.entrycget(k, "label") for k in range(first, menu.index("end") + 1)]
    assert labels[:2] == [str(MESHES / "dodecahedron.obj"), str(MESHES / "cube.obj")]
    assert recall(cube.app.desk.state).recent[:2] == tuple(labels[:2]), "written at once, so that a crash does not take it"
    menu.invoke(first + 1)
    cube.wait()
    assert cube.skin.source.file == "cube.obj"
    menu.destroy()


def test_a_file_opened_over_a_running_job_leaves_the_pieces_in_step(cube, tmp_path):
    """What takes the place of flattening may fail: then the pieces are flattened after all."""
    seams = np.array([sorted(pair) for pair in ((0, 1), (1, 3), (3, 2), (2, 6), (6, 7), (7, 5), (5, 4))])
    cube.session.do("cut", replace(cube.skin, seams=seams))
    assert cube.app.runner.job.label == "flattening"
    (tmp_path / "a.obj").write_text("v 0 0\n")
    cube.app.files.open_path(tmp_path / "a.obj")
    cube.wait(lambda: len(cube.skin.pieces) == 1 and cube.app.runner.job is None)
    assert "a.obj" in cube.problems()[0]


def test_what_was_changed_while_a_file_was_being_opened_is_asked_about(cube):
    """Nothing was unsaved when it was asked for: so nothing was asked."""
    cube.answers.give["Unsaved work"] = "Cancel"
    cube.app.files.open_path(MESHES / "dodecahedron.obj")
    change(cube, 9)
    cube.wait()
    assert [a.split(":")[0] for a in cube.answers.asked] == ["how_to_open dodecahedron.obj", "Unsaved work"]
    assert cube.skin.source.file == "cube.obj" and cube.skin.seed == 9 and "was not opened" in cube.app.status.text.get()
    cube.answers.give["Unsaved work"] = "Do not save"
    cube.open(MESHES / "dodecahedron.obj")
    assert cube.skin.source.file == "dodecahedron.obj"


def typed(cube, text):
    """In the field for the bound on mean d, with the focus still there."""
    entry = cube.app.root.nametowidget("body.middle.side.forms.properties.document.bound.entry")
    entry.focus_force()
    cube.app.root.update()
    entry.delete(0, "end")
    entry.insert(0, text)
    return entry


def test_a_number_that_is_still_being_typed_is_saved(cube, tmp_path):
    cube.answers.path = tmp_path / "work.skin"
    typed(cube, "4.2")
    cube.press("Control-s")
    assert load_skin(tmp_path / "work.skin").max_distortion == 4.2 and not cube.session.dirty
    typed(cube, "4.3")
    cube.app.actions.do("save")  # as by a button or a menu, which take no focus
    assert load_skin(tmp_path / "work.skin").max_distortion == 4.3 and not cube.session.dirty


def test_a_number_that_cannot_be_taken_stops_what_is_done_after_it(cube, tmp_path):
    cube.answers.path = tmp_path / "work.skin"
    entry = typed(cube, "3")
    for act in (lambda: cube.press("Control-s"), lambda: cube.press("F5"), cube.app.close):
        act()
        assert "must be above 4" in cube.app.status.text.get() and entry.get() == "3"
    assert not (tmp_path / "work.skin").exists() and cube.app.runner.job is None and not cube.app._closed
    cube.press("Escape")
    cube.press("Control-s")
    assert (tmp_path / "work.skin").exists()


def test_undo_takes_back_the_text_first(cube):
    change(cube, 11)
    shown = f"{cube.skin.max_distortion:g}"
    entry = typed(cube, "4.4")
    cube.press("Control-z")
    assert entry.get() == shown and cube.skin.seed == 11 and cube.session.undo_label == "another seed"
    cube.press("Control-z")
    assert cube.skin.seed != 11


def test_a_thickness_that_is_typed_is_flattened_before_it_is_saved(cube, tmp_path):
    cube.answers.path = tmp_path / "work.skin"
    cube.press("F5")
    cube.wait()
    entry = cube.app.root.nametowidget("body.middle.side.forms.properties.document.thickness.entry")
    entry.focus_force()
    cube.app.root.update()
    entry.delete(0, "end")
    entry.insert(0, "1")
    assert not cube.app.actions.do("save")
    assert not (tmp_path / "work.skin").exists() and "flattening for 1 mm was begun" in cube.problems()[0]
    cube.wait()
    cube.press("Control-s")
    assert load_skin(tmp_path / "work.skin").thickness == 1.0
