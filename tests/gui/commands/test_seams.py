"""Cut by itself; pieces that follow the seams whatever happens meanwhile."""

from dataclasses import replace

import numpy as np
import pytest
from person import MESHES

from skinfab.flatten.mapping import FlatMap
from skinfab.patterns.registry import make_pattern
from skinfab.placement.edit import middle_of
from skinfab.placement.lifted import Lifted
from skinfab.placement.sensor import Sensor

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


def test_stopped_with_nothing_to_flatten_no_key_is_named_for_it(cube):
    cube.press("F5")
    cube.app.root.nametowidget("statusbar.work.cancel").invoke()
    assert cube.app.runner.job is None and cube.app.status.text.get() == "Stopped."


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


def test_what_is_said_of_pieces_flattened_anew_is_said_of_these(cube):
    cut(cube)
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


def test_a_piece_that_lies_badly_stands_above_its_sensors_that_do_not_fit(cube):
    """Four sides of the cube as one strip, glued to a ring: what to do about it must be seen at once."""
    V, E = cube.skin.object.V, cube.skin.mesh.topology.E
    straight = E[(V[E[:, 0]] != V[E[:, 1]]).sum(axis=1) == 1]
    lying = straight[V[straight[:, 0], 2] == V[straight[:, 1], 2]]
    (upright,) = [pair for pair in straight.tolist() if (V[pair, :2] == 0).all()]
    cut(cube, np.array([*lying, upright]))
    cube.wait()
    strip = max(cube.skin.pieces, key=lambda p: len(p.faces))
    spiral, to_flat = make_pattern("contact-spiral", {"s": 24}), FlatMap(cube.skin.mesh, strip).to_flat
    sensors = []
    for axis, at in ((0, 0), (0, 40), (1, 0), (1, 40)):  # one in the middle of each side
        face = next(f for f in strip.faces.tolist() if (V[cube.skin.mesh.F[f], axis] == at).all())
        corners = V[cube.skin.mesh.F[face]]
        middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
        weights = np.linalg.lstsq(np.vstack([corners.T, np.ones(3)]), [*middle, 1.0], rcond=None)[0]
        x, y = (to_flat([face], [weights])[0] - spiral.middle).tolist()
        sensors.append(Sensor(f"C{len(sensors) + 1}", strip.id, spiral, x, y, 0.0, len(sensors)))
    cube.session.do("sensors", replace(cube.skin, sensors=tuple(sensors)))
    cube.wait()
    assert cube.app.problems.shown == ()
    cut(cube, lying, "glue")
    cube.wait()
    first, *others = cube.app.problems.shown
    assert (first.text, first.kind) == ("P1 is a ring with 2 borders: cut from one border to another", "warning")
    assert {p.source for p in others} == {"sensors"} and "overlaps" in others[0].text
    for key in ("Control-z", "Control-y"):
        cube.press(key)
        cube.wait()
    assert cube.app.problems.shown[0] == first
    # What is done next is the news.
    cube.session.do("another", replace(cube.skin, sensors=(replace(cube.skin.sensors[0], x=500.0), *cube.skin.sensors[1:])))
    assert "outside piece P1" in cube.app.problems.shown[0].text and cube.app.problems.shown[1] == first


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
    assert cube.app.runner.job is None
    cube.wait()
    assert len(cube.skin.seams) == 0 and cube.skin.pieces == () and cube.session.redo_label == "cut"
    assert any("flattening was stopped" in text for text in cube.problems("warning"))
    cube.app.actions.do("auto_cut")
    cube.wait()
    assert not any("was stopped" in text for text in cube.problems("warning")), "said until work is asked for again"


def test_seams_that_changed_during_an_automatic_cut_stop_it_and_are_flattened(cube):
    cube.app.actions.do("auto_cut")
    cut(cube)
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


def test_sensors_that_a_cut_took_off_come_back_once_their_piece_lies_flat_again(cube):
    cut(cube)
    cube.wait()
    spiral = make_pattern("contact-spiral", {"s": 20})
    (piece,) = cube.skin.pieces
    middles = [piece.UV[piece.F[[k, k + 1]].ravel()].mean(axis=0) for k in (0, 4)]
    first, second = (Sensor(f"C{k + 1}", piece.id, spiral, *xy, 0.0, k) for k, xy in enumerate(middles))
    one = replace(cube.skin, sensors=(first,))
    cube.session.do("one", one)
    both = replace(one, sensors=(first, second))
    cube.session.do("both", both)
    cut(cube, SPREAD[:1], "glued")
    cube.wait()
    line = "2 sensors taken off P1 until it lies flat again"
    assert cube.skin.pieces == () == cube.skin.sensors
    assert cube.app.problems.shown[0].text == f"{line}; Ctrl+Z brings them back"
    assert cube.app.status.text.get() == f"{line}; Ctrl+Z brings them back."
    cut(cube, SPREAD[1:2])
    cube.wait()
    assert line in cube.problems("warning"), "undo of this step alone would not bring them back"
    cut(cube)
    cube.wait()
    assert cube.app.status.text.get() == "2 sensors are back on P1."
    assert not any("taken off" in text for text in cube.problems("warning")) and cube.problems() == []
    for old, new in zip(both.sensors, cube.skin.sensors, strict=True):
        maps = [FlatMap(cube.skin.mesh, skin.piece("P1")) for skin in (both, cube.skin)]
        spots = [each.to_object(middle_of(s)[None]).xyz for each, s in zip(maps, (old, new), strict=True)]
        assert spots[0] == pytest.approx(spots[1], abs=1e-6) and replace(new, x=old.x, y=old.y, angle=old.angle) == old
    for _ in range(2):
        cube.app.actions.do("undo")
    cube.wait()
    assert cube.skin.sensors == () and f"{line}; Ctrl+Z brings them back" in cube.problems("warning")
    cube.app.actions.do("undo")
    assert cube.skin is both and not any("taken off" in text for text in cube.problems("warning"))


def test_sensors_taken_off_are_forgotten_when_all_are_placed_anew_or_removed(cube):
    cut(cube)
    cube.wait()
    (piece,) = cube.skin.pieces
    spiral = make_pattern("contact-spiral", {"s": 20})
    cube.session.do(
        "one", replace(cube.skin, sensors=(Sensor("C1", piece.id, spiral, *piece.UV[piece.F[:2].ravel()].mean(axis=0), 0.0, 0),))
    )
    cut(cube, SPREAD[:1], "glued")
    cube.wait()
    assert [each.sensor.id for each in cube.session.lifted] == ["C1"]
    cut(cube)
    cube.wait()
    cube.app.actions.do("clear")
    assert cube.session.lifted == ()
    cube.app.actions.do("undo")
    cube.wait()
    assert [s.id for s in cube.skin.sensors] == ["C1"]


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


def test_sensors_that_are_off_are_saved_and_come_back_in_the_document_that_is_opened_again(cube, tmp_path):
    cut(cube)
    cube.wait()
    with_two(cube)
    before = cube.skin.sensors
    cut(cube, SPREAD[:1], "glued")
    cube.wait()
    assert cube.skin.sensors == () and [each.sensor.id for each in cube.skin.lifted] == ["C2", "C1"]
    cube.answers.path = tmp_path / "off.skin"
    assert cube.app.files.save_as() and not cube.session.dirty
    cube.open(MESHES / "cup.obj")
    cube.open(tmp_path / "off.skin")
    assert not cube.session.dirty and "2 sensors taken off P1 until it lies flat again" in cube.problems("warning")
    cut(cube)
    cube.wait()
    assert [(s.id, s.channel) for s in cube.skin.sensors] == [("C2", 0), ("C1", 1)] and cube.skin.lifted == ()
    assert cube.app.status.text.get() == "2 sensors are back on P1." and cube.problems() == []
    for old, new in zip(before, cube.skin.sensors, strict=True):
        assert (new.x, new.y) == pytest.approx((old.x, old.y), abs=1e-6)
    cube.app.actions.do("undo")
    cube.wait()
    assert cube.skin.sensors == () and len(cube.skin.lifted) == 2
    cube.app.actions.do("redo")
    cube.wait()
    assert [s.id for s in cube.skin.sensors] == ["C2", "C1"] and cube.skin.lifted == ()


def test_a_new_sensor_leaves_names_and_channels_to_those_that_are_off(cube):
    cut(cube)
    cube.wait()
    with_two(cube)
    off = tuple(Lifted(s, cube.skin.pieces[0], place=k) for k, s in enumerate(cube.skin.sensors))
    cube.session.do("off", replace(cube.skin, sensors=(), lifted=off))
    cube.wait()
    cube.press("s")
    (piece,) = cube.skin.pieces
    cube.click_flat(cube.flat_place(piece.id, piece.UV[piece.F[4]].mean(axis=0)))
    assert [(s.id, s.channel) for s in cube.skin.sensors] == [("C3", 2)] and len(cube.skin.lifted) == 2
    cube.app.root.update()


def with_two(person):
    """Two sensors on the only piece, in an order that is not that of their names."""
    (piece,) = person.skin.pieces
    spiral = make_pattern("contact-spiral", {"s": 20})
    middles = [piece.UV[piece.F[[k, k + 1]].ravel()].mean(axis=0) for k in (0, 4)]
    sensors = tuple(Sensor(id, piece.id, spiral, *xy, 0.0, k) for k, (id, xy) in enumerate(zip(("C2", "C1"), middles, strict=True)))
    person.session.do("two", replace(person.skin, sensors=sensors))
