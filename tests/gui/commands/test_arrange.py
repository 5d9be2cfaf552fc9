"""Several sensors are copied, mirrored, aligned and spread from the menu, each in one step."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from gui.commands.arrange import ArrangeCommands
from gui.state.selection import NOTHING, Target
from gui.state.session import Session
from skinfab.errors import SkinfabError
from skinfab.material import load_material
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.check import validate
from skinfab.placement.edit import middle_of
from skinfab.placement.sensor import Sensor
from skinfab.progress import silent
from skinfab.skin import Skin, Source


@pytest.fixture
def desk():
    V = np.array([[0.0, 0, 0], [200, 0, 0], [200, 100, 0], [0, 100, 0]])
    F = np.array([[0, 1, 2], [0, 2, 3]])
    spiral = make_pattern("contact-spiral", {"s": 15})
    sensors = tuple(Sensor(f"C{k + 1}", "P1", spiral, x, y, 0.0, k) for k, (x, y) in enumerate([(20, 30), (60, 40), (150, 35)]))
    piece = Piece("P1", np.arange(2), np.arange(4), F, V[:, :2])
    skin = Skin(Mesh(V, F), Source("a.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), dtype=np.int64), (piece,), sensors)
    session, said = Session(), []
    session.open(skin, None)

    def guarded(source, work):
        try:
            work()
        except SkinfabError as fault:
            said.append(str(fault))

    class Desk(SimpleNamespace):
        @property
        def skin(self):
            return session.skin

    def work(label, function, done, *, source, wanted, **arguments):
        if wanted():
            guarded(source, lambda: done(function(**arguments, progress=silent)))

    made = Desk(session=session, guarded=guarded, work=work, said=said, dropped=said.append)
    made.actions = {a.id: a for a in ArrangeCommands(made).actions()}
    return made


def test_what_can_be_done_depends_on_how_many_are_selected(desk):
    def enabled():
        return {id for id, action in desk.actions.items() if action.enabled()}

    desk.session.select(NOTHING)
    assert enabled() == set()
    desk.session.select(Target(sensor="C1"))
    assert enabled() == {"copy", "mirror_x", "mirror_y"}
    desk.session.select(Target(sensor="C1", also=("C2", "gone")))
    assert "align_left" in enabled() and "spread_x" not in enabled()
    desk.session.select(Target(sensor="C1", also=("C2", "C3")))
    assert enabled() == set(desk.actions)


@pytest.mark.parametrize(("id", "changed"), [("align_middle_y", 2), ("spread_x", 1), ("mirror_x", 3), ("align_left", 2)])
def test_each_is_one_step_that_undo_takes_back(desk, id, changed):
    before = desk.skin
    desk.session.select(Target(sensor="C1", also=("C2", "C3")))
    desk.actions[id].run()
    assert sum(a != b for a, b in zip(before.sensors, desk.skin.sensors, strict=True)) == changed
    desk.session.undo()
    assert desk.skin is before and desk.session.undo_label is None


def test_copies_are_selected(desk):
    desk.session.select(Target(sensor="C1", also=("C3",)))
    desk.actions["copy"].run()
    assert desk.session.selected == Target(piece="P1", sensor="C4", also=("C5",))
    one, two = (middle_of(desk.skin.sensors[new]) - middle_of(desk.skin.sensors[old]) for new, old in ((3, 0), (4, 2)))
    assert one == pytest.approx(two) and np.abs(one).max() > 10 and desk.said == []
    validate(desk.skin, load_material())


def test_without_room_no_copy_is_made(desk):
    wide = make_pattern("contact-spiral", {"s": 45})
    before = replace(desk.skin, sensors=tuple(replace(s, pattern=wide) for s in desk.skin.sensors[:1]))
    small = replace(before.pieces[0], UV=before.pieces[0].UV * 0.5)
    desk.session.do("full", replace(before, pieces=(small,)))
    full = desk.skin
    desk.session.select(Target(sensor="C1"))
    desk.actions["copy"].run()
    assert desk.skin is full and desk.said == [
        "there is no room on P1 for a copy of C1; make it smaller first, or add a sensor to another piece"
    ]


def test_sensors_of_two_pieces_are_refused_in_words(desk):
    skin = desk.skin
    desk.session.do("other", replace(skin, sensors=(skin.sensors[0], replace(skin.sensors[1], piece="P2"))))
    desk.session.select(Target(sensor="C1", also=("C2",)))
    desk.actions["align_left"].run()
    assert "one piece at a time" in desk.said[0]


def test_what_is_changed_meanwhile_gets_no_copies(desk):
    desk.session.select(Target(sensor="C1"))
    work = desk.work

    def slow(*order, **arguments):
        assert arguments["wanted"]()
        desk.session.do("other", replace(desk.skin, seed=3))
        work(*order, **arguments)

    desk.work = slow
    desk.actions["copy"].run()
    assert len(desk.skin.sensors) == 3 and desk.session.undo_label == "other"
