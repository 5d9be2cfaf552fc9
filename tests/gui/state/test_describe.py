"""One line about what the pointer is on."""

from dataclasses import replace

import pytest

from gui.state.derived import Derived
from gui.state.describe import describe
from gui.state.selection import NOTHING, Target
from skinfab.skin import SeamMarks


@pytest.fixture
def said(session):
    derived = Derived()

    def hover(**target):
        session.hover(Target(**target) if target else NOTHING)
        return describe(session, derived)

    return hover


def test_nothing_is_the_document_in_numbers(session, said):
    assert said() == "plate.obj: 2 pieces, 2 sensors"
    session.do("not flat", replace(session.skin, pieces=(), sensors=()))
    assert said() == "plate.obj: cut, but nothing lies flat yet: cut further by clicks (C) or automatically (F5)"
    session.do("uncut", replace(session.skin, seams=session.skin.seams[:0]))
    assert said() == "plate.obj: no seams yet: cut by clicks (C) or automatically (F5)"


def test_a_sensor_a_piece_a_face(said):
    line = said(piece="P1", sensor="C2", face=1)
    assert line.startswith("C2: contact-spiral, ") and "channel 1" in line and line.endswith("face 1")
    assert "piece P1, 100 x 100 mm, d mean 4.000" in line
    assert said(face=3) == "face 3, not flat yet"


def test_a_seam_and_a_locked_one(session, said):
    (edge,) = session.skin.mesh.topology.edge_ids([[1, 2]])
    assert said(seam=int(edge)) == "seam"
    marks = replace(SeamMarks.none(4), locked=session.skin.seams[:, ::-1])
    session.do("lock", replace(session.skin, marks=marks))
    assert said(seam=int(edge)) == "locked seam"


def test_what_has_gone_under_the_pointer_is_no_fault(session, said):
    assert "C2" in said(piece="P1", sensor="C2")
    session.do("delete C2", replace(session.skin, sensors=session.skin.sensors[:1]))
    assert describe(session, Derived()).startswith("plate.obj: 2 pieces, 1 sensor")
