"""The view in a real window, moved, pointed at and clicked."""

import time
from dataclasses import replace

import numpy as np
import pytest

import gui.view3d.view as view_module
from gui.state.derived import Derived
from gui.state.selection import NOTHING, Target
from gui.state.session import Session
from gui.theme import DARK, LIGHT, apply, rgb
from gui.view3d.view import View3D
from skinfab.mesh.model import Mesh


class Window:
    """A view on a document, and what it tells."""

    def __init__(self, root, skin, theme=LIGHT):
        apply(root, theme)
        self.root, self.session, self.told, self.takes = root, Session(), [], False
        root.geometry("800x600+0+0")
        self.view = View3D(
            root,
            self.session,
            Derived(),
            theme,
            on_click=lambda hit, shift: self.told.append(("click", hit, shift)),
            on_drag=lambda hit: self.told.append(("drag", hit)) or self.takes,
            on_release=lambda hit: self.told.append(("release", hit)),
            name="view3d",
        )
        self.view.pack(fill="both", expand=True)
        root.update()
        self.session.open(skin, None)
        root.update()
        self.view.look("front")
        self.settle()

    def settle(self):
        self.root.update()
        self.view.settle()
        self.root.update()

    def pixel(self, x, z):
        """Where a point of the wall is on the canvas."""
        return np.floor(self.view.camera.to_screen([[x, 0, z]])[0, :2]).astype(int).tolist()

    def send(self, event, at=(0, 0), **options):
        self.view.canvas.event_generate(event, x=at[0], y=at[1], **options)
        self.root.update()

    def drag(self, start, end, button=1, **options):
        self.send(f"<ButtonPress-{button}>", start, **options)
        for t in np.linspace(0, 1, 6)[1:]:
            at = [round(a + t * (b - a)) for a, b in zip(start, end, strict=True)]
            self.send(f"<B{button}-Motion>", at, **options)
        self.send(f"<ButtonRelease-{button}>", end, **options)

    def colour(self, at):
        """What is on the screen there."""
        from PIL import ImageGrab

        x, y = self.view.canvas.winfo_rootx() + at[0], self.view.canvas.winfo_rooty() + at[1]
        return ImageGrab.grab(xdisplay=self.root.winfo_screen().rsplit(".", 1)[0] or None, bbox=(x, y, x + 1, y + 1)).getpixel((0, 0))


@pytest.fixture
def window(root, skin):
    return Window(root, skin)


def test_it_can_be_found_by_its_name(window):
    assert window.root.nametowidget("view3d") is window.view
    assert window.root.nametowidget("view3d.canvas") is window.view.canvas


def test_the_pointer_tells_what_it_is_on(window, skin):
    told = []
    window.session.listen("hover", lambda: told.append(window.session.hovered))
    window.send("<Motion>", window.pixel(22, 41))
    assert window.session.hovered.piece == "P1" and window.session.hovered.face >= 0
    window.send("<Motion>", window.pixel(60, 33))
    assert window.session.hovered.seam in skin.mesh.topology.edge_ids(skin.seams)
    window.send("<Motion>", (3, 3))
    assert window.session.hovered == NOTHING and len(told) == 3
    window.send("<Motion>", window.pixel(22, 41))
    window.send("<Leave>")
    assert window.session.hovered == NOTHING


def test_many_motions_in_a_row_are_one_look(window, monkeypatch):
    looked = []
    monkeypatch.setattr(window.view, "hover_at", lambda x, y: looked.append((x, y)))
    for x in range(100, 200):
        window.view.canvas.event_generate("<Motion>", x=x, y=300, when="tail")
    window.root.update()
    assert looked[-1] == (199, 300) and len(looked) < 5


def test_a_click_goes_to_the_tool_and_turns_nothing(window):
    turn = window.view.camera.turn
    at = window.pixel(30, 20)
    window.send("<ButtonPress-1>", at, state=0x1)
    window.send("<B1-Motion>", (at[0] + 2, at[1] + 1))
    window.send("<ButtonRelease-1>", (at[0] + 2, at[1] + 1))
    ((what, hit, shift),) = window.told
    assert what == "click" and shift and hit.target.piece == "P1" and window.view.camera.turn is turn
    window.told.clear()
    window.send("<ButtonPress-1>", (2, 2))
    window.send("<ButtonRelease-1>", (2, 2))
    assert window.told == [("click", None, False)]


def test_a_drag_turns_unless_the_tool_takes_it(window):
    turn = window.view.camera.turn
    window.drag(window.pixel(30, 20), window.pixel(50, 40))
    assert [what for what, *_ in window.told] == ["drag"] and not np.allclose(window.view.camera.turn, turn)
    window.view.look("front")
    window.settle()
    window.told.clear()
    window.takes, turn = True, window.view.camera.turn
    window.drag(window.pixel(30, 20), window.pixel(50, 40))
    assert window.view.camera.turn is turn
    kinds = [what for what, *_ in window.told]
    assert kinds[0] == "drag" and kinds[-1] == "release" and len(kinds) >= 5
    np.testing.assert_allclose(window.told[0][1].point, [30, 0, 20], atol=0.3)
    np.testing.assert_allclose(window.told[-1][1].point, [50, 0, 40], atol=0.3)
    window.drag((3, 3), (90, 90))  # beside the object there is nothing to take
    assert window.view.camera.turn is not turn


def test_the_right_button_always_turns_and_the_middle_one_moves(window):
    window.takes = True
    turn = window.view.camera.turn
    window.drag((400, 300), (430, 310), button=2)
    assert window.view.camera.turn is turn and window.view.camera.pan == (30, 10)
    window.drag((400, 300), (390, 280), button=1, state=0x4)
    assert window.view.camera.pan == (20, -10)
    window.drag((400, 300), (430, 310), button=3)
    assert window.view.camera.turn is not turn and window.told == []


def test_the_wheel_enlarges_what_is_under_the_pointer(window):
    at = window.pixel(100, 50)
    before, scale = window.view.camera.to_space(*at, 0.0), window.view.camera.scale
    window.send("<Button-4>", at)
    assert window.view.camera.scale > scale
    np.testing.assert_allclose(window.view.camera.to_screen([before])[0, :2], at, atol=1e-6)
    window.send("<Button-5>", at)
    assert window.view.camera.scale == pytest.approx(scale)


def test_keys_turn_enlarge_and_show_the_sides(window):
    canvas, view = window.view.canvas, window.view
    canvas.focus_force()
    window.root.update()

    def press(key):
        before = view.camera
        canvas.event_generate(f"<{key}>")
        window.root.update()
        return before, view.camera

    for key in ("Left", "Right", "Up", "Down"):
        before, after = press(key)
        assert not np.allclose(before.turn, after.turn)
        before, after = press(f"Shift-{key}")
        assert np.allclose(before.turn, after.turn) and before.pan != after.pan
    for key, larger in (("plus", True), ("KP_Add", True), ("minus", False)):
        before, after = press(key)
        assert (after.scale > before.scale) == larger
    press("f")
    assert view.camera.pan == (0, 0)
    seen = [press(f"Key-{k}")[1].turn for k in range(1, 7)]
    assert len({tuple(turn.ravel()) for turn in seen}) == 6


def test_a_side_that_is_none_is_refused(window):
    with pytest.raises(ValueError, match="front, back"):
        window.view.look("inside")


def test_many_changes_are_one_picture_and_rest_makes_it_smooth(window):
    view = window.view
    before = view.pictures
    for _ in range(20):
        view.move(view.camera.turned(0.01, 0))
    window.root.update()
    assert view.pictures == before + 1 and view.painter.sharper == 1
    end = time.monotonic() + 5
    while view.painter.sharper == 1 and time.monotonic() < end:
        window.root.update()
        time.sleep(0.01)
    assert view.painter.sharper == 2 and view.pictures == before + 2


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
def test_colours_reach_the_screen(root, skin, theme):
    window = Window(root, skin, theme)
    assert window.colour((5, 300)) == rgb(theme.view)
    seam = window.colour(window.pixel(60, 22.5))
    assert np.abs(np.subtract(seam, rgb(theme.seam))).max() < 40
    plain = window.colour(window.pixel(22, 41))
    window.session.select(Target(piece="P1"))
    window.settle()
    assert window.colour(window.pixel(22, 41)) != plain


def test_another_theme_is_taken_at_once(window):
    apply(window.root, DARK)
    window.view.restyle(DARK)
    window.settle()
    assert window.colour((5, 300)) == rgb(DARK.view)


def test_paths_and_lights_are_shown_and_hidden(window):
    at = window.pixel(20, 45)
    plain = window.colour(at)
    window.view.show("path", [[[10, 0, 45], [40, 0, 45]]], "#00ff00", 6)
    window.settle()
    assert window.colour(at) == (0, 255, 0)
    window.view.hide("path")
    window.view.glow("C1", [[20, 0, 45]], "#ff0000", radius=8)
    window.settle()
    assert window.colour(at)[0] > plain[0] + 40
    window.view.hide("C1")
    window.settle()
    assert window.colour(at) == plain


def test_labels_axes_and_scale_are_there(window):
    canvas = window.view.canvas
    words = {canvas.itemcget(item, "text") for item in canvas.find_all() if canvas.type(item) == "text"}
    assert {"P1", "P2", "C1", "1", "x", "z"} <= words and any(word.endswith(" mm") for word in words)
    window.session.shade("distortion")
    window.settle()
    assert canvas.find_withtag("legend")


def test_hovering_alone_makes_no_label_anew(window, monkeypatch):
    made = []
    monkeypatch.setattr(window.view._furniture, "labels", lambda labels, theme: made.append(labels))
    window.send("<Motion>", window.pixel(22, 41))
    window.send("<Motion>", window.pixel(82, 41))
    assert window.session.hovered.piece == "P2" and not made
    window.view.move(window.view.camera.panned(1, 0))
    window.root.update()
    assert len(made) == 1


def test_another_document_is_seen_whole_and_the_same_object_from_where_it_was(window, skin):
    window.view.move(window.view.camera.zoomed(3, (100, 100)))
    window.settle()
    camera = window.view.camera
    window.session.do("move C1", replace(skin, sensors=(replace(skin.sensors[0], x=33.0),)))
    window.settle()
    assert window.view.camera is camera
    V, F = 3 * skin.mesh.V + 500, skin.mesh.F[:-40]
    window.session.open(replace(skin, mesh=Mesh(V, F), seams=skin.seams[:0], pieces=(), sensors=(), marks=None), None)
    window.settle()
    screen = window.view.camera.to_screen(V[F].reshape(-1, 3))[:, :2]
    assert (screen > 0).all() and (screen < [800, 600]).all()
    assert window.view.hit_at(400, 300).target.piece == ""


def test_without_a_document_it_says_so(root):
    view = View3D(root, Session(), Derived(), LIGHT, name="view3d")
    view.pack(fill="both", expand=True)
    root.update()
    (words,) = view.canvas.find_withtag("notice")
    assert "Open" in view.canvas.itemcget(words, "text")
    assert view.hit_at(10, 10) is None and view.hover_at(10, 10) == NOTHING
    view.fit()
    view.settle()


def test_a_window_of_another_size_gets_a_picture_of_that_size(window):
    for size in ("1280x700", "300x200", "40x40"):
        window.root.geometry(f"{size}+0+0")
        window.settle()
        width, height = (int(n) for n in size.split("x"))
        assert (window.view.camera.width, window.view.camera.height) == (width, height)
        assert window.view.painter.depth.shape == (2 * height, 2 * width)


def test_an_object_that_is_shown_whole_stays_so_in_a_window_of_another_shape(window):
    """Fitted in a wide pane by its width, it would lose both ends in a tall one's scale, and the other way round."""
    for size in ("1200x300", "300x700", "1200x700"):
        window.root.geometry(f"{size}+0+0")
        window.settle()
        assert window.view.camera.zoom == pytest.approx(window.view.camera.whole().zoom)
    window.view.move(replace(window.view.camera, zoom=3.0))
    window.root.geometry("900x700+0+0")
    window.settle()
    assert window.view.camera.zoom == 3.0, "what was enlarged on purpose stays"
    window.view.fit()
    window.root.geometry("300x700+0+0")
    window.settle()
    assert window.view.camera.zoom == pytest.approx(window.view.camera.whole().zoom)


def test_a_view_that_is_gone_is_told_nothing(window, skin):
    window.view.move(window.view.camera.turned(0.1, 0))
    window.view.destroy()
    window.session.select(Target(piece="P1"))
    window.session.do("same", replace(skin))
    window.root.update()


def test_a_document_that_is_being_prepared_leaves_the_picture_as_it_was(window, skin, monkeypatch):
    view, session = window.view, window.session
    view.settle()
    before, waiting = view.painter, []
    x, y = view.canvas.winfo_width() // 2, view.canvas.winfo_height() // 2
    assert view.hit_at(x, y) is not None
    monkeypatch.setattr(view._derived, "ready", lambda skin, then: not waiting.append(then) and len(waiting) > 1)
    smaller = replace(skin, mesh=Mesh(skin.mesh.V * [1, 1, 0.5], skin.mesh.F))
    session.do("half as high", smaller)
    view.settle()
    assert view._mesh is skin.object and view.hit_at(x, y) is None, "shown, but not what a click would mean"
    waiting[0]()
    view.settle()
    assert view._mesh is smaller.object and view.painter is before


def test_a_large_picture_is_coarse_while_it_moves_and_fine_at_rest(window, monkeypatch):
    view = window.view
    monkeypatch.setattr(view_module, "_COARSE", 10_000)
    at = window.pixel(20, 20)
    before = window.colour(at)
    assert view.painter.coarser == 1
    view.move(view.camera.panned(0, 0))
    window.root.update()
    assert view.painter.coarser == 2 and view.painter.pixels.shape[1] == -(-view.camera.width // 2)
    assert view.hit_at(*at) is not None and np.abs(np.subtract(window.colour(at), before)).max() < 30
    view.move(view.camera.panned(40, 0))
    window.root.update()
    assert np.abs(np.subtract(window.colour((at[0] + 40, at[1])), before)).max() < 30, "only what differs is sent, and all of that"
    window.settle()
    assert view.painter.coarser == 1
