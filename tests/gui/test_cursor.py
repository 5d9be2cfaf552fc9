"""The cursor that keys move: all that clicks do in the views is done without a mouse."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from person import MESHES

from gui.cursor import STEP

#: A way over the cube's eight corners along its sides: cut there, it opens into one flat piece.
ROUND = (0, 1, 3, 2, 6, 7, 5, 4)


class Keyboard:
    """Someone without a mouse."""

    def __init__(self, person):
        self.person, self.root = person, person.app.root
        self.root.focus_force()
        self.root.update()
        for cursor in (person.view3d.cursor, person.view2d.cursor):
            cursor.end()
            cursor.at = None

    def press(self, *keys):
        """Keys to whatever has the focus, all before the window comes to rest."""
        for key in keys:
            (self.root.focus_get() or self.root).event_generate(f"<{key}>")
        self.root.update()

    def go(self, view, at):
        """Arrows until the cursor is there: by whole steps, then pixel by pixel."""
        for axis, (less, more) in enumerate((("Left", "Right"), ("Up", "Down"))):
            way = at[axis] - view.cursor.at[axis]
            key = more if way > 0 else less
            steps, pixels = divmod(abs(way), STEP)
            self.press(*[key] * steps, *[f"Shift-{key}"] * pixels)
        assert view.cursor.at == tuple(at)

    def to_object(self, point, *, inwards=0.0):
        """To a point of the object, as it is turned now."""
        middle = self.person.skin.object.V.mean(axis=0)
        at = self.person.view3d.camera.to_screen([point + inwards * (middle - point)])[0, :2]
        self.go(self.person.view3d, np.rint(at).astype(int).tolist())


@pytest.fixture
def cube(person):
    person.open(MESHES / "cube.obj")
    person.view3d.look("front")
    person.wait()
    return person


@pytest.fixture
def flat(cube):
    seams = np.array([sorted(pair) for pair in itertools.pairwise(ROUND)])
    cube.session.do("cut", replace(cube.skin, seams=seams))
    cube.wait()
    return cube


@pytest.fixture
def keyboard(person):
    made = Keyboard(person)
    yield made
    person.view3d.cursor.end()
    person.view2d.cursor.end()


def cross(view):
    return view.find_withtag("keycursor")


def test_it_appears_moves_and_ends(cube, keyboard):
    view, status = cube.view3d, cube.app.status.text
    seen = view.camera
    keyboard.press("F3")
    x, y = view.cursor.at
    assert view.cursor.shown and cross(view.canvas) and "Enter clicks" in status.get() and "turn the object" in status.get()
    keyboard.press("Left", "Up", "Shift-Right")
    assert view.cursor.at == (x - STEP + 1, y - STEP) and view.camera is seen
    face = view.hit_at(*view.cursor.at).face
    assert cube.session.hovered.face == face >= 0 and f"face {face}" in status.get()
    box = view.canvas.bbox("keycursor")
    assert abs((box[0] + box[2]) / 2 - view.cursor.at[0]) <= 2 and abs((box[1] + box[3]) / 2 - view.cursor.at[1]) <= 2
    keyboard.press(*["Left"] * 400)
    assert view.cursor.at == (0, y - STEP) and not cube.session.hovered
    keyboard.press("Control-Left")
    assert not np.allclose(view.camera.turn, seen.turn), "the object can still be turned"
    keyboard.press("Escape")
    assert not view.cursor.shown and not cross(view.canvas) and cube.session.tool == "select"
    seen = view.camera
    keyboard.press("Left")
    assert view.camera is not seen and view.cursor.at == (0, y - STEP)
    keyboard.press("Return")
    assert view.cursor.shown, "Enter begins it too"
    view.canvas.event_generate("<ButtonPress-3>", x=50, y=50)
    view.canvas.event_generate("<ButtonRelease-3>", x=50, y=50)
    assert not view.cursor.shown and not cross(view.canvas), "who takes the mouse has the mouse's pointer"


def test_many_keys_in_a_row_are_one_look(cube, keyboard, monkeypatch):
    keyboard.press("F3")
    looked, look = [], cube.view3d.hover_at
    monkeypatch.setattr(cube.view3d, "hover_at", lambda x, y: looked.append((x, y)) or look(x, y))
    for _ in range(40):
        cube.view3d.canvas.event_generate("<Shift-Right>", when="tail")
    cube.app.root.update()
    assert looked[-1] == cube.view3d.cursor.at and len(looked) < 5


def test_what_is_under_it_stays_there_when_it_is_enlarged(cube, keyboard):
    keyboard.press("F3")
    keyboard.to_object(cube.skin.object.V[0], inwards=0.05)
    before = cube.view3d.hit_at(*cube.view3d.cursor.at).point
    keyboard.press("plus", "plus")
    cube.view3d.settle()
    np.testing.assert_allclose(cube.view3d.hit_at(*cube.view3d.cursor.at).point, before, atol=0.3)


def test_a_seam_is_cut_locked_and_glued(cube, keyboard):
    front = [v for v, point in enumerate(cube.skin.object.V) if np.isclose(point[1], cube.skin.object.V[:, 1].min())]
    one, two = next(pair for pair in itertools.pairwise(ROUND) if set(pair) <= set(front))
    V = cube.skin.object.V
    keyboard.press("F3", "c")
    keyboard.to_object(V[one], inwards=0.05)
    assert "way" in cube.view3d.scene._overlays, "the vertex that a line would begin at is shown"
    keyboard.press("Return")
    assert cube.app.toolbox.held.begun
    keyboard.to_object(V[two], inwards=0.05)
    keyboard.press("Return")
    assert {tuple(sorted(pair)) for pair in cube.skin.seams.tolist()} == {tuple(sorted((one, two)))}
    keyboard.press("Escape")
    assert not cube.app.toolbox.held.begun and cube.view3d.cursor.shown, "the line first, then the cursor"
    keyboard.press("l")
    keyboard.to_object(V[[one, two]].mean(axis=0), inwards=0.01)
    keyboard.press("Return")
    assert len(cube.skin.marks.locked) == 1
    keyboard.press("Return", "g", "Return")
    assert cube.skin.marks is None and len(cube.skin.seams) == 0
    keyboard.press("x")
    keyboard.to_object(V[one], inwards=0.05)
    keyboard.press("Return")
    keyboard.to_object(V[two], inwards=0.05)
    keyboard.press("Return", "Escape")
    assert len(cube.skin.marks.forbidden) == 1
    keyboard.to_object(V[[one, two]].mean(axis=0), inwards=0.01)
    keyboard.press("Shift-Return")
    assert cube.skin.marks is None, "with Shift as a click with Shift"
    keyboard.press("Escape")
    assert not cube.view3d.cursor.shown and cube.session.tool == "forbid"


def test_faces_are_painted_and_selected(cube, keyboard):
    keyboard.press("F3", "a", "Return")
    painted = np.flatnonzero(cube.skin.marks.preference == 1)
    assert cube.session.hovered.face in painted
    keyboard.press("Shift-Return")
    assert not (cube.skin.marks is not None and cube.skin.marks.preference.any())
    keyboard.press("Key-space", "Return")
    assert cube.session.selected.face == cube.session.hovered.face >= 0


def test_sensors_are_put_on_the_flat_skin(flat, keyboard):
    flat.app.tabs.select(flat.app.live)
    keyboard.press("F4")
    assert flat.app.tabs.index("current") == 0 and flat.view2d.cursor.shown and "move the sheet" in flat.app.status.text.get()
    piece = flat.skin.pieces[0]
    goal = piece.UV[piece.F[5]].mean(axis=0)
    keyboard.go(flat.view2d, flat.flat_place(piece.id, goal))
    plane = flat.view2d.plane
    keyboard.press("s", "Return")
    (sensor,) = flat.skin.sensors
    assert flat.session.selected.sensor == sensor.id and flat.view2d.plane.scale == plane.scale
    keyboard.press("Key-space", "Escape", "Escape")
    assert not flat.view2d.cursor.shown and not flat.session.selected
    keyboard.press("Return", "Return")
    assert flat.session.selected.sensor == sensor.id, "what is under it is selected"
    keyboard.press("Shift-Return")
    assert not flat.session.selected.sensor
    keyboard.press("Return", "Escape", "Right")
    assert flat.skin.sensors[0].x == pytest.approx(sensor.x + 0.1), "without it, arrows nudge"
    keyboard.press("Return", "Control-Right", "minus")
    assert flat.skin.sensors[0].x == pytest.approx(sensor.x + 0.1) and flat.view2d.plane.scale < plane.scale


def test_on_the_object_too(flat, keyboard):
    keyboard.press("F3", "s", "Return")
    (sensor,) = flat.skin.sensors
    assert flat.session.selected.sensor == sensor.id
    x, y = flat.view3d.cursor.at
    keyboard.press("F4")
    assert flat.view2d.cursor.shown and not flat.view3d.cursor.shown and not cross(flat.view3d.canvas)
    assert flat.session.hovered.piece and "move the sheet" in flat.app.status.text.get()
    keyboard.press("F3")
    assert flat.view3d.cursor.shown and flat.view3d.cursor.at == (x, y) and not cross(flat.view2d.surface.widget)


def test_without_a_document_there_is_nothing_to_point_at(root):
    from gui.state.derived import Derived
    from gui.state.session import Session
    from gui.theme import LIGHT, apply
    from gui.view3d.view import View3D

    apply(root, LIGHT)
    view = View3D(root, Session(), Derived(), LIGHT)
    view.pack()
    root.update()
    view.canvas.focus_force()
    root.update()
    view.canvas.event_generate("<Return>")
    view.canvas.event_generate("<Left>")
    assert not view.cursor.shown and view.cursor.at is None
