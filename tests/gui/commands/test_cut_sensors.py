"""Sensors on pieces that are cut anew: which do not fit any more, which are taken off, and how they come back."""

from dataclasses import replace

import numpy as np
import pytest
from person import CUBE_SPREAD, MESHES

from skinfab.flatten.mapping import FlatMap
from skinfab.patterns.registry import make_pattern
from skinfab.placement.edit import middle_of
from skinfab.placement.lifted import Lifted
from skinfab.placement.sensor import Sensor


def with_two(person):
    """Two sensors on the only piece, in an order that is not that of their names."""
    (piece,) = person.skin.pieces
    spiral = make_pattern("contact-spiral", {"s": 20})
    middles = [piece.UV[piece.F[[k, k + 1]].ravel()].mean(axis=0) for k in (0, 4)]
    sensors = tuple(Sensor(id, piece.id, spiral, *xy, 0.0, k) for k, (id, xy) in enumerate(zip(("C2", "C1"), middles, strict=True)))
    person.session.do("two", replace(person.skin, sensors=sensors))


def test_a_piece_that_lies_badly_stands_above_its_sensors_that_do_not_fit(cube):
    """Four sides of the cube as one strip, glued to a ring: what to do about it must be seen at once."""
    V, E = cube.skin.object.V, cube.skin.mesh.topology.E
    straight = E[(V[E[:, 0]] != V[E[:, 1]]).sum(axis=1) == 1]
    lying = straight[V[straight[:, 0], 2] == V[straight[:, 1], 2]]
    (upright,) = [pair for pair in straight.tolist() if (V[pair, :2] == 0).all()]
    cube.cut(np.array([*lying, upright]))
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
    cube.cut(lying, "glue")
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
    cube.cut()
    cube.wait()
    spiral = make_pattern("contact-spiral", {"s": 20})
    (piece,) = cube.skin.pieces
    middles = [piece.UV[piece.F[[k, k + 1]].ravel()].mean(axis=0) for k in (0, 4)]
    first, second = (Sensor(f"C{k + 1}", piece.id, spiral, *xy, 0.0, k) for k, xy in enumerate(middles))
    one = replace(cube.skin, sensors=(first,))
    cube.session.do("one", one)
    both = replace(one, sensors=(first, second))
    cube.session.do("both", both)
    cube.cut(CUBE_SPREAD[:1], "glued")
    cube.wait()
    line = "2 sensors taken off P1 until it lies flat again"
    assert cube.skin.pieces == () == cube.skin.sensors
    assert cube.app.problems.shown[0].text == f"{line}; Ctrl+Z brings them back"
    assert cube.app.status.text.get() == f"{line}; Ctrl+Z brings them back."
    cube.cut(CUBE_SPREAD[1:2])
    cube.wait()
    assert line in cube.problems("warning"), "undo of this step alone would not bring them back"
    cube.cut()
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
    cube.cut()
    cube.wait()
    (piece,) = cube.skin.pieces
    spiral = make_pattern("contact-spiral", {"s": 20})
    cube.session.do(
        "one", replace(cube.skin, sensors=(Sensor("C1", piece.id, spiral, *piece.UV[piece.F[:2].ravel()].mean(axis=0), 0.0, 0),))
    )
    cube.cut(CUBE_SPREAD[:1], "glued")
    cube.wait()
    assert [each.sensor.id for each in cube.session.lifted] == ["C1"]
    cube.cut()
    cube.wait()
    cube.app.actions.do("clear")
    assert cube.session.lifted == ()
    cube.app.actions.do("undo")
    cube.wait()
    assert [s.id for s in cube.skin.sensors] == ["C1"]


def test_sensors_that_are_off_are_saved_and_come_back_in_the_document_that_is_opened_again(cube, tmp_path):
    cube.cut()
    cube.wait()
    with_two(cube)
    before = cube.skin.sensors
    cube.cut(CUBE_SPREAD[:1], "glued")
    cube.wait()
    assert cube.skin.sensors == () and [each.sensor.id for each in cube.skin.lifted] == ["C2", "C1"]
    cube.answers.path = tmp_path / "off.skin"
    assert cube.app.files.save_as() and not cube.session.dirty
    cube.open(MESHES / "cup.obj")
    cube.open(tmp_path / "off.skin")
    assert not cube.session.dirty and "2 sensors taken off P1 until it lies flat again" in cube.problems("warning")
    cube.cut()
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
    cube.cut()
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
