"""Seams by clicks on the real picture; the pieces follow."""

import itertools
from dataclasses import replace

import pytest
from person import MESHES

from gui.tools import seams as seam_tools

#: A way over the cube's eight corners along its sides: cut there, it opens into one flat piece.
ROUND = (0, 1, 3, 2, 6, 7, 5, 4)


@pytest.fixture
def cube(person):
    person.open(MESHES / "cube.obj")
    return person


def seams(person):
    return {tuple(sorted(pair)) for pair in person.skin.seams.tolist()}


def cut_open(person):
    person.press("c")
    for vertex in ROUND:
        person.click_vertex(vertex)
    person.wait()


def test_a_cube_is_cut_open_by_clicks_and_lies_flat(cube):
    assert cube.skin.pieces == () and cube.problems() == []
    cut_open(cube)
    assert seams(cube) == {tuple(sorted(pair)) for pair in itertools.pairwise(ROUND)}
    (piece,) = cube.skin.pieces
    assert len(piece.faces) == 12 and cube.session.undo_label == "cut"
    assert cube.app.derived.distortion(cube.skin.mesh, piece).mean == pytest.approx(4.0, abs=1e-6)
    assert cube.view2d.sheet.pieces is cube.skin.pieces and cube.problems("warning") == []


def test_every_click_is_one_step_back_and_forth(cube):
    bare = cube.skin
    cut_open(cube)
    whole = cube.skin
    assert [cube.app.actions.do("undo") for _ in ROUND] == [True] * 7 + [False]
    cube.wait()
    assert cube.skin.seams is bare.seams and cube.skin.pieces == ()
    while cube.app.actions.do("redo"):
        pass
    cube.wait()
    assert cube.skin is whole and cube.view2d.sheet.pieces is whole.pieces


def test_a_begun_line_is_dropped_by_escape_and_the_tool_by_a_second(cube):
    cube.press("c")
    cube.click_vertex(0)
    assert cube.app.toolbox.held.begun
    cube.press("Escape")
    assert not cube.app.toolbox.held.begun and cube.session.tool == "cut"
    cube.click_vertex(3)
    assert seams(cube) == set(), "the first point was dropped"
    cube.press("Escape")
    cube.press("Escape")
    assert cube.session.tool == "select"


def test_a_line_begun_on_one_object_does_not_end_on_the_next(cube):
    cube.press("c")
    cube.click_vertex(7)
    cube.open(MESHES / "dodecahedron.obj")
    assert not cube.app.toolbox.held.begun
    cube.click_vertex(19)
    cube.wait()
    assert seams(cube) == set() and cube.problems() == []


def test_after_undo_and_redo_the_line_goes_on_from_where_it_ended_then(cube):
    cube.press("c")
    for vertex in (0, 1, 3, 2):
        cube.click_vertex(vertex)
    assert seams(cube) == {(0, 1), (1, 3), (2, 3)}
    cube.press("Control-z")
    cube.click_vertex(7)
    assert seams(cube) == {(0, 1), (1, 3), (3, 7)}, "from the point before, not from the one undone"
    cube.press("Control-z")
    cube.press("Control-z")
    cube.press("Control-y")
    cube.click_vertex(2)
    assert seams(cube) == {(0, 1), (1, 3), (2, 3)}
    cube.wait()


def test_undone_to_before_its_first_point_a_line_begins_anew(cube):
    cube.session.do("another seed", replace(cube.skin, seed=77))
    cube.press("c")
    cube.click_vertex(0)
    cube.session.do("another seed", replace(cube.skin, seed=78))
    cube.click_vertex(1)
    assert seams(cube) == {(0, 1)}, "what else is done meanwhile does not end it"
    for _ in range(3):
        cube.press("Control-z")
    assert not cube.app.toolbox.held.begun
    cube.press("Control-y")
    cube.click_vertex(3)
    assert seams(cube) == set() and cube.app.toolbox.held.begun
    cube.press("Escape")
    cube.wait()


def test_the_way_is_shown_before_it_is_cut(cube, monkeypatch):
    shown = {}
    monkeypatch.setattr(cube.view3d, "show", lambda name, lines, colour, width: shown.update({name: lines}))
    cube.press("c")
    cube.click_vertex(0)
    ((dot,),) = [shown["way"]]
    assert dot.tolist() == [cube.skin.object.V[0].tolist()]
    x, y = cube._see(cube.skin.object.V[7], lambda hit: hit.vertex == 7)
    cube.view3d.canvas.event_generate("<Motion>", x=x, y=y)
    cube.app.root.update()
    ((way,),) = [shown["way"]]
    assert way[0].tolist() == [0.0, 0.0, 0.0] and way[-1].tolist() == [40.0, 40.0, 40.0]
    assert len(way) == 4, "along the sharp sides, not across a face"
    cube.press("Escape")


def test_a_seam_is_glued_by_a_click(cube):
    cut_open(cube)
    cube.press("g")
    cube.click_edge(0, 1)
    cube.wait()
    assert seams(cube) == set() and cube.session.undo_label == "glue", "a seam without branches is one"
    cube.click_edge(0, 1)
    assert cube.app.status.text.get() == "There is no seam there; click on one."
    cube.press("Control-z")
    cube.wait()
    assert len(cube.skin.pieces) == 1


def test_a_locked_seam_is_kept_by_an_automatic_cut_and_cannot_be_glued(cube):
    cube.press("c")
    cube.click_vertex(6)
    cube.click_vertex(7)
    cube.wait()
    cube.press("l")
    cube.click_edge(6, 7)
    assert cube.skin.marks.locked.tolist() == [[6, 7]] and cube.session.undo_label == "lock"
    cube.press("g")
    cube.click_edge(6, 7)
    assert cube.problems() == ["this seam is locked; unlock it before gluing it"] and (6, 7) in seams(cube)
    cube.press("F5")
    cube.wait()
    assert (6, 7) in seams(cube) and len(cube.skin.pieces) >= 1 and cube.session.undo_label == "cut automatically"
    cube.press("l")
    cube.click_edge(6, 7)
    assert cube.session.undo_label == "unlock" and cube.skin.marks is None


def test_where_it_is_forbidden_no_seam_runs_until_it_is_allowed(cube):
    cube.press("c")
    cube.click_vertex(6)
    cube.click_vertex(7)
    cube.press("x")
    cube.click_edge(6, 7)
    assert seams(cube) == set() and cube.skin.marks.forbidden.tolist() == [[6, 7]], "a seam that is forbidden is glued"
    cube.press("c")
    cube.click_vertex(6)
    cube.click_vertex(7)
    assert (6, 7) not in seams(cube) and len(seams(cube)) >= 2, "the cut goes round it"
    cube.press("x")
    cube.click_edge(6, 7, shift=True)
    assert cube.skin.marks is None and cube.session.undo_label == "allow seams"
    cube.click_edge(6, 7, shift=True)
    assert cube.app.status.text.get() == "Nothing is forbidden there."


def test_between_two_points_it_is_forbidden_too(cube):
    cube.press("x")
    cube.click_vertex(0)
    cube.click_vertex(1)
    assert cube.skin.marks.forbidden.tolist() == [[0, 1]] and cube.session.undo_label == "forbid seams"
    cube.press("Escape")


def test_the_flat_view_takes_clicks_on_seams_too(cube):
    cut_open(cube)
    hits = {}
    width, height = cube.view2d.surface.size
    for x in range(0, int(width), 3):
        for y in range(0, int(height), 3):
            hit = cube.view2d.hit(x, y)
            if hit is not None and hit.target.seam >= 0:
                hits.setdefault("on" if hit.face >= 0 else "beside", (x, y, hit))
    x, y, hit = hits["beside"]
    cube.press("c")
    cube.click_flat((x, y))
    assert not cube.app.toolbox.held.begun and "no point of the object" in cube.app.status.text.get()
    for tool, label in (("l", "lock"), ("l", "unlock"), ("g", "glue")):
        cube.press(tool)
        cube.click_flat(hits["on"][:2])
        assert cube.session.undo_label == label
    assert cube.problems() == []
    cube.wait()


@pytest.mark.parametrize("base", [seam_tools._Way, seam_tools._OnSeam])
def test_a_tool_that_does_not_say_what_it_does_is_none(base):
    with pytest.raises(TypeError, match="abstract"):
        type("Half", (base,), {"id": "half"})(None)
