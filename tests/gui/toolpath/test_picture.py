"""What is done is strong, what is to come is pale, at every time, however it was come to."""

import numpy as np
import pytest

from gcode.printer import load_printer
from gui.theme import DARK, LIGHT, apply, rgb
from gui.toolpath.picture import PathPicture, Scene, colours


@pytest.fixture
def picture(root, marlin):
    root.geometry("700x500+0+0")
    apply(root, LIGHT)
    steps = []
    made = PathPicture(root, LIGHT, on_step=steps.append)
    made.steps = steps
    made.widget.pack(fill="both", expand=True)
    wall = np.array([[[145.0, 155], [205, 155]], [[205, 155], [205, 195]], [[205, 195], [145, 195]], [[145, 195], [145, 155]]])
    made.show(Scene(marlin, wall, load_printer()), marlin.at(marlin.end))
    root.update()
    return made


def pixels(picture, points):
    """(k, 3) the colours at places on the bed."""
    px = picture.plane.to_px(points)
    rows = picture.size[1] - px[:, 1]
    return picture.picture[rows.astype(int), px[:, 0].astype(int), :3].astype(int)


def middles(line, role):
    """Middles of the drawn parts of a role, and their steps."""
    from gui.toolpath.timeline import ROLE_NAMES

    mine = line.role[line.part_step] == ROLE_NAMES.index(role)
    return line.parts[mine].mean(axis=1), line.part_step[mine]


def test_ink_that_is_laid_is_strong_and_the_rest_pale(root, picture, marlin):
    places, steps = middles(marlin, "print")
    ink = np.array(rgb(LIGHT.ink))
    for share in (0.2, 0.7, 0.5):
        now = marlin.at(share * marlin.end)
        picture.seek(now)
        root.update()
        far = np.linalg.norm(places - now.at[:2], axis=1) > 3.0  # beside the head's mark
        shown = pixels(picture, places)
        done, to_come = far & (steps < now.step), far & (steps > now.step)
        assert done.sum() > 10 and to_come.sum() > 10
        # A later step may cross an earlier one, whose colour is then seen.
        assert np.median(np.abs(shown[done] - ink).max(axis=1)) < 12
        assert np.median(shown[to_come].mean(axis=1)) > ink.mean() + 100


def test_any_way_to_a_time_gives_the_same_picture(root, picture, marlin):
    target = marlin.at(0.37 * marlin.end)
    picture.seek(target)
    root.update()
    straight = picture.picture.copy()
    for share in (0.9, 0.0, 0.31, 1.0, 0.36, 0.38):
        picture.seek(marlin.at(share * marlin.end))
        root.update()
    picture.seek(target)
    root.update()
    assert np.array_equal(picture.picture, straight)
    picture.draw()
    assert np.array_equal(picture.picture, straight)


def test_the_head_is_where_it_is(root, picture, marlin):
    now = marlin.at(0.6 * marlin.end)
    picture.seek(now)
    root.update()
    assert np.abs(pixels(picture, now.at[None, :2])[0] - rgb(LIGHT.select)).max() < 60


def test_a_click_on_a_line_asks_for_its_step(root, picture, marlin):
    places, steps = middles(marlin, "print")
    k = len(places) // 2
    x, y = picture.plane.to_px(places[k])
    place = {"x": int(x), "y": int(picture.size[1] - y)}
    picture.widget.event_generate("<ButtonPress-1>", **place)
    picture.widget.event_generate("<ButtonRelease-1>", **place)
    root.update()
    assert len(picture.steps) == 1 and abs(picture.steps[0] - steps[k]) <= 3
    picture.widget.event_generate("<ButtonPress-1>", x=3, y=3)
    picture.widget.event_generate("<ButtonRelease-1>", x=3, y=3)
    assert len(picture.steps) == 1


def test_dragging_moves_the_wheel_zooms_a_double_click_fits(root, picture):
    before = picture.plane
    widget = picture.widget
    widget.event_generate("<ButtonPress-1>", x=100, y=100)
    widget.event_generate("<B1-Motion>", x=130, y=90, state=0x100)
    widget.event_generate("<ButtonRelease-1>", x=130, y=90)
    assert (picture.plane.x - before.x, picture.plane.y - before.y) == (30.0, 10.0) and picture.steps == []
    at = picture.plane.to_mm((200.5, picture.size[1] - 100.5))
    widget.event_generate("<Button-4>", x=200, y=100)
    assert picture.plane.scale == pytest.approx(1.2 * before.scale)
    assert picture.plane.to_mm((200.5, picture.size[1] - 100.5)) == pytest.approx(at)
    widget.event_generate("<Button-5>", x=200, y=100)
    root.update()
    for kind in ("ButtonPress", "ButtonRelease", "ButtonPress", "ButtonRelease"):
        widget.event_generate(f"<{kind}-1>", x=1, y=1)
    root.update()
    assert picture.plane == before


def test_it_follows_the_size_of_the_window(root, picture, marlin):
    root.geometry("500x400+0+0")
    for _ in range(5):
        root.update()
    assert picture.size[0] == 500
    picture.seek(marlin.at(0.5 * marlin.end))
    places, _ = middles(marlin, "print")
    px = picture.plane.to_px(places)
    assert (px > 0).all() and (px < picture.size).all()


def test_dark_has_light_ink_and_nothing_to_show_is_empty(root, picture, marlin):
    picture.restyle(DARK)
    root.update()
    places, _ = middles(marlin, "print")
    assert np.median(pixels(picture, places)) > 200 and colours(DARK)["print"] == DARK.ink
    picture.show(None, None)
    root.update()
    assert (picture.picture[..., :3] == rgb(DARK.view)).all()
    picture.seek(marlin.at(1.0))
    assert picture.step_near(100, 100) is None


def test_only_what_changes_is_touched(root, picture, marlin):
    """A step of a scrub costs the pixels it changes, not the picture."""
    seen = []
    compose = picture._compose
    picture._compose = lambda rows, columns: (
        seen.append((rows.stop - rows.start) * (columns.stop - columns.start)),
        compose(rows, columns),
    )
    for t in np.linspace(0.2, 0.4, 60) * marlin.end:
        picture.seek(marlin.at(float(t)))
    whole = picture.size[0] * picture.size[1]
    assert seen[1:] and np.median(seen[1:]) < whole / 10
