"""The flat view in a real window, led by mouse and keys."""

import time
from dataclasses import replace

import numpy as np
import pytest

from gui.state.selection import Target
from gui.theme import DARK, rgb
from gui.view2d.view import View2D
from skinfab.placement.edit import middle_of


def sensor(window, id="C1"):
    return next(s for s in window.session.skin.sensors if s.id == id)


def at(window, piece, x, y):
    """Where a place of a piece is in the window."""
    px = window.view.plane.to_px(np.array([x, y]) + window.view.sheet.offset_of(piece))
    return round(px[0] - 0.5), round(window.view.surface.size[1] - px[1] - 0.5)


def colour(window, x, y):
    return tuple(int(c) for c in window.view.surface.picture[y, x, :3])


def test_a_sensor_is_dragged_onto_the_grid_and_that_is_undone_as_one(window):
    before = window.session.skin
    window.pointer.drag(window.view.place_of("C1"), (40, 25))
    moved = sensor(window)
    assert moved.piece == "P1" and (moved.x, moved.y) != (20.0, 30.0)
    assert np.allclose(middle_of(moved) % 1.0, 0.0, atol=1e-5)  # its middle, on whole millimetres
    assert window.session.undo_label == "move C1"
    window.session.undo()
    assert window.session.skin is before and window.session.undo_label is None


def test_a_modifier_switches_snapping_off(window):
    scale = window.view.plane.scale
    window.pointer.press(*window.view.place_of("C1"))
    x, y = window.view.place_of("C1")
    window.pointer.move(x + 33, y, 0x100 | 0x8)
    window.pointer.release(x + 33, y, 0x100 | 0x8)
    assert sensor(window).x == pytest.approx(20 + 33 / scale, abs=1e-5)


def rest(window):
    """Hold the pointer still until the document has followed."""
    before, end = window.session.skin, time.monotonic() + 30
    while window.session.skin is before:
        assert time.monotonic() < end
        window.root.update()
        time.sleep(0.005)


def test_while_it_is_dragged_it_says_what_is_wrong_and_the_document_follows_at_rest(window):
    view, x, y = window.view, *window.view.place_of("C1")
    edge = at(window, "P1", 0.0, 30.0)[0]
    window.pointer.press(x, y)
    window.pointer.move(edge, y, 0x100)
    (finding,) = view.hands.findings["C1"]
    assert "mm outside P1" in finding.brief and window.session.problems == ()
    rest(window)
    (problem,) = window.session.problems
    assert "outside piece P1" in problem.text and problem.target == Target(piece="P1", sensor="C1")
    window.pointer.move(x, y, 0x100)
    assert view.hands.findings == {}
    window.pointer.release(x, y)
    assert window.session.problems == ()


def test_what_does_not_fit_is_drawn_in_the_colour_of_errors(window):
    view = window.view
    error = np.array(rgb(view.theme.error))

    def red():
        return int((np.abs(view.surface.picture[:, :, :3].astype(int) - error).sum(axis=2) < 12).sum())

    before = red()
    window.pointer.drag(view.place_of("C1"), (at(window, "P1", 0, 0)[0] - view.place_of("C1")[0], 0))
    assert red() > before + 500
    window.session.undo()
    window.root.update()
    assert red() == before


def test_escape_takes_a_drag_back(window):
    before = window.session.skin
    x, y = window.view.place_of("C1")
    for committed in (False, True):
        window.pointer.press(x, y)
        window.pointer.move(x + 60, y + 20, 0x100)
        if committed:
            rest(window)
            assert window.session.skin is not before
        window.pointer.key("Escape")
        window.pointer.release(x + 60, y + 20)
        assert window.session.skin is before and window.view.hands.sensors == ()


@pytest.mark.parametrize("rested", [False, True])
def test_undo_during_a_drag_ends_it_and_escape_then_takes_nothing_more_back(window, rested):
    view, first = window.view, window.session.skin
    x, y = view.place_of("C1")
    window.session.do("another seed", replace(first, seed=first.seed + 1))
    second = window.session.skin
    window.root.update()
    still = view.surface.picture.copy()
    window.pointer.press(x, y)
    window.pointer.move(x + 60, y + 20, 0x100)
    if rested:
        rest(window)
    window.session.undo()
    window.root.update()
    left = second if rested else first
    assert window.session.skin is left and view.hands.sensors == ()
    assert (view.surface.picture[60:, 60:] != still[60:, 60:]).mean() < 0.02  # the sensor is shown where it is
    window.pointer.key("Escape")
    window.pointer.move(x + 90, y + 40, 0x100)
    window.pointer.release(x + 90, y + 40)
    assert window.session.skin is left and sensor(window).x == 20.0


def test_escape_during_a_drag_takes_back_no_step_of_another(window):
    x, y = window.view.place_of("C1")
    window.pointer.press(x, y)
    window.pointer.move(x + 60, y + 20, 0x100)
    rest(window)
    window.session.do("another seed", replace(window.session.skin, seed=7))
    assert window.view.hands.sensors == ()
    window.pointer.key("Escape")
    window.pointer.release(x + 60, y + 20)
    assert window.session.skin.seed == 7 and window.session.undo_label == "another seed"


def test_a_sensor_is_dropped_on_another_piece(window):
    x, y = window.view.place_of("C1")
    goal = at(window, "P2", 30.0, 12.0)
    window.pointer.drag((x, y), (goal[0] - x, goal[1] - y))
    assert sensor(window).piece == "P2"
    assert np.allclose(middle_of(sensor(window)), (30, 12), atol=1.0)


def test_two_sensors_too_close_are_one_problem_that_names_both(window):
    x, y = window.view.place_of("C1")
    goal = at(window, "P2", 30.0, 38.0)
    window.pointer.drag((x, y), (goal[0] - x, goal[1] - y))
    (problem,) = window.session.problems
    assert "overlaps" in problem.text and "C1" in problem.text and "C2" in problem.text


def test_the_handle_turns_about_the_middle_in_steps(window):
    window.session.select(Target(piece="P1", sensor="C1"))
    middle, view = middle_of(sensor(window)), window.view
    grip, start = view.handle()[1], view.place_of("C1")
    px = view.plane.to_px(grip)
    x, y = round(px[0]), round(view.surface.size[1] - px[1])
    window.pointer.drag((x, y), (start[0] + 3 - x, start[1] - 80 - y))
    assert np.degrees(sensor(window).angle) == pytest.approx(90.0) and np.allclose(middle_of(sensor(window)), middle, atol=1e-6)
    assert window.session.undo_label == "turn C1"


def test_arrow_keys_nudge_and_brackets_turn(window):
    window.session.select(Target(piece="P1", sensor="C1"))
    window.pointer.key("Right")
    window.pointer.key("Shift-Up")
    assert (sensor(window).x, sensor(window).y) == pytest.approx((20.1, 31.0))
    window.pointer.key("bracketleft")
    assert np.degrees(sensor(window).angle) == pytest.approx(15.0)
    window.session.undo()
    window.session.undo()
    assert sensor(window) == window.skin.sensors[0] and window.session.undo_label is None


def test_a_rectangle_and_control_clicks_select_several_and_they_move_together(window):
    wide, high = window.view.surface.size
    window.pointer.drag((32, 4), (wide - 40, high - 40))
    assert {window.session.selected.sensor, *window.session.selected.also} == {"C1", "C2"}
    window.pointer.drag(window.view.place_of("C2"), (0, 30))
    assert sensor(window, "C1").y < 30 and sensor(window, "C2").y < 40 and window.session.undo_label == "move 2 sensors"
    x, y = window.view.place_of("C1")
    window.pointer.press(x, y, 0x4)
    window.pointer.release(x, y, 0x104)
    assert window.session.selected == Target(piece="P2", sensor="C2")


def test_hover_and_click_find_face_piece_and_seam(window):
    x, y = at(window, "P2", 5.0, 5.0)
    window.pointer.move(x, y)
    hovered = window.session.hovered
    assert hovered.piece == "P2" and window.skin.pieces[1].faces.tolist().count(hovered.face) == 1 and not hovered.sensor
    x, y = at(window, "P1", 60.0, 22.0)
    window.pointer.press(x, y)
    window.pointer.release(x, y)
    seam = window.session.selected.seam
    assert sorted(window.skin.mesh.V[window.skin.mesh.topology.E[seam]][:, 1].tolist()) == [20.0, 25.0]
    window.pointer.press(3, 3)
    window.pointer.release(3, 3)
    assert not window.session.selected


def test_what_the_other_view_hovers_lights_up_here_on_both_sides_of_a_seam(window):
    edge = int(window.skin.mesh.topology.edge_ids(window.skin.seams[:1])[0])
    window.session.hover(Target(seam=edge))
    window.root.update()
    for piece, x in (("P1", 60.0), ("P2", 0.0)):
        px, py = at(window, piece, x, 47.0)
        assert colour(window, px, py) == rgb(window.view.theme.hover)
    window.session.hover(Target())
    window.root.update()
    assert colour(window, *at(window, "P1", 60.0, 47.0)) != rgb(window.view.theme.hover)


def test_the_wheel_zooms_about_the_pointer_and_f_fits(window):
    view, (x, y) = window.view, at(window, "P1", 50.0, 50.0)
    fitted = view.plane
    window.pointer.widget.event_generate("<Button-4>", x=x, y=y)
    window.root.update()
    assert view.plane.scale > fitted.scale and np.allclose(at(window, "P1", 50.0, 50.0), (x, y), atol=1)
    window.pointer.press(300, 300, button=2)
    window.pointer.move(340, 320, 0x200)
    window.pointer.release(340, 320, 0x200, button=2)
    assert np.allclose(at(window, "P1", 50.0, 50.0), (x + 40, y + 20), atol=1)
    window.pointer.key("f")
    assert view.plane == fitted


def test_shadings_and_themes_change_the_picture(window):
    seen = set()
    where = at(window, "P1", 3.0, 3.0)
    for theme in (window.view.theme, DARK):
        window.view.restyle(theme)
        for shading in ("pieces", "distortion", "checker", "preferences"):
            window.session.shade(shading)
            window.root.update()
            seen.add(window.view.surface.picture[:, :, :3].tobytes())
    assert len(seen) == 8 and where


def test_a_tool_gets_the_clicks_and_sensors_stay(window):
    told = []
    view = window.view
    view.on_click = lambda hit, shift: told.append(("click", hit.target.sensor, shift))
    view.on_drag = lambda hit: told.append(("drag", hit.piece))
    view.on_release = lambda hit: told.append(("release", hit.piece))
    view.on_point = lambda hit: told.append(("point", hit.piece))
    window.session.take_up("cut")
    x, y = view.place_of("C1")
    window.pointer.drag((x, y), (30, 0), 0x1)
    window.pointer.move(x, y)
    assert told[0] == ("click", "C1", True) and ("drag", "P1") in told and told[-2:] == [("release", "P1"), ("point", "P1")]
    assert window.session.skin is window.skin


def test_a_hit_knows_the_place_on_the_object(window):
    hit = window.view.hit(*at(window, "P2", 31.0, 12.0))
    assert hit.uv == pytest.approx((31, 12), abs=0.2) and hit.point == pytest.approx((91, 12, 0), abs=0.2)
    assert window.skin.mesh.V[hit.vertex] == pytest.approx((90, 10, 0))
    assert hit.barycentric @ window.skin.mesh.V[window.skin.mesh.F[hit.face]] == pytest.approx(hit.point)


def test_lines_of_a_tool_are_shown_and_taken_away(window):
    before = window.view.surface.picture.copy()
    window.view.show("way", [("P1", [[5.0, 5.0], [55.0, 5.0]])], "#00ff00", 3.0, words="50.0 mm")
    window.root.update()
    assert colour(window, *at(window, "P1", 30.0, 5.0)) == (0, 255, 0)
    window.view.hide("way")
    window.root.update()
    assert np.array_equal(window.view.surface.picture, before)


def test_clicks_in_quick_succession_each_count(window):
    x, y = window.view.place_of("C1")
    for _ in range(3):
        window.pointer.press(x, y)
        assert window.view.hands._grabbed is not None
        window.pointer.release(x, y)


def test_an_empty_view_says_what_to_do_and_a_material_that_is_missing_is_a_problem(root, skin):
    from dataclasses import replace

    from gui.state.derived import Derived
    from gui.state.session import Session
    from gui.theme import LIGHT

    session = Session()
    view = View2D(root, session, Derived(), LIGHT)
    view.pack(fill="both", expand=True)
    root.update()
    assert len(np.unique(view.surface.picture.reshape(-1, 4), axis=0)) > 2 and view.hit(50, 50) is None
    session.open(replace(skin, pieces=(), sensors=()), None)
    root.update()
    session.open(replace(skin, material="no-such-ink"), None)
    root.update()
    (problem,) = session.problems
    assert "no-such-ink" in problem.text


@pytest.mark.parametrize("size", ["600x700+0+0", "1200x500+0+0"])
def test_what_is_shown_whole_stays_whole_in_a_view_of_another_shape(window, size):
    view, before = window.view, window.view.plane
    window.root.geometry(size)
    window.root.update()
    low, high = (view.plane.to_px(corner) for corner in view.sheet.box)
    width, height = view.surface.size
    assert view.plane != before and (low > 24).all() and (high < (width, height)).all()
    # As large as it fits: one way or the other it reaches from border to border.
    assert min(width - np.ptp([low[0], high[0]]), height - np.ptp([low[1], high[1]])) < 24 + 2 * 44 + 8
    view.zoom(2.0)
    zoomed = view.plane
    window.root.geometry("900x700+0+0")
    window.root.update()
    assert view.plane.scale == zoomed.scale, "what was chosen is not changed"


def test_a_line_round_it_shows_that_keys_go_there(window):
    from PIL import ImageGrab

    widget, elsewhere = window.view.surface.widget, window.view

    def border():
        window.root.update()
        x, y = widget.winfo_rootx(), widget.winfo_rooty() + widget.winfo_height() // 2
        return ImageGrab.grab(xdisplay=window.root.winfo_screen().rsplit(".", 1)[0] or None, bbox=(x, y, x + 1, y + 1)).getpixel((0, 0))

    widget.focus_force()
    window.root.update()
    assert border() == rgb(window.view.theme.accent)
    elsewhere.focus_force()
    assert border() == rgb(window.view.theme.border)
    window.view.restyle(DARK)
    assert border() == rgb(DARK.border)
