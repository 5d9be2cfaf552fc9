"""Lines of the width asked for, hidden where the object is in front of them, and found again under the pointer."""

import numpy as np
import pytest
from shapes import sphere

from gui.state.selection import Target
from gui.view3d.camera import Camera
from gui.view3d.lines import Strokes, lay_over, stroke
from gui.view3d.painter import Painter
from gui.view3d.shade import Paint
from gui.view3d.solid import Solid
from skinfab.mesh.model import Mesh


def covered(a, b, width, shape=(60, 80), depth=0.0):
    surface = np.full(shape, depth, dtype=np.float32)
    cover, owner = np.empty(shape, dtype=np.uint8), np.empty(shape, dtype=np.int32)
    ends = (np.array([p], dtype=np.float32) for p in (a, b))
    stroke(*ends, np.zeros(1, np.int32), np.array([width], np.float32), surface, 0.5, 1, cover, owner)
    return cover, owner


@pytest.mark.parametrize("width", [1.0, 2.5, 6.0])
@pytest.mark.parametrize("end", [(70.0, 30.0), (70.0, 55.0), (12.0, 50.0)])
def test_what_is_covered_is_length_times_width_and_round_ends(width, end):
    a, b = np.array([10.0, 10, 0]), np.array([*end, 0.0])
    cover, _ = covered(a, b, width)
    length = np.hypot(*(b - a)[:2])
    assert cover.sum() / 255 == pytest.approx(width * length + np.pi * width**2 / 4, rel=0.03, abs=1.5)


def test_a_stroke_without_length_is_a_dot():
    cover, owner = covered((40.0, 30.0, 0.0), (40.0, 30.0, 0.0), 8.0)
    assert cover.sum() / 255 == pytest.approx(np.pi * 16, rel=0.05) and owner[30, 40] == 0


def test_behind_the_surface_nothing_is_drawn_and_just_below_it_all():
    a, b = (10.0, 10.0), (60.0, 50.0)
    assert not covered((*a, 2.0), (*b, 2.0), 3.0)[0].any()
    assert np.array_equal(covered((*a, 0.4), (*b, 0.4), 3.0)[0], covered((*a, 0.0), (*b, 0.0), 3.0)[0])


def test_a_stroke_that_dives_is_cut_where_it_does():
    cover, _ = covered((5.0, 30.0, -10.0), (75.0, 30.0, 10.0), 3.0)
    seen = np.flatnonzero(cover[30])
    assert seen.min() <= 6 and abs(seen.max() - (40 + 0.5 * 3.5)) <= 3


@pytest.mark.parametrize("ends", [((-500.0, 20.0), (900.0, 40.0)), ((-50.0, -50.0), (-10.0, 90.0)), ((20.0, 300.0), (30.0, 400.0))])
def test_strokes_may_leave_the_picture(ends):
    cover, owner = covered((*ends[0], 0.0), (*ends[1], 0.0), 2.0)
    assert (owner[cover > 0] == 0).all() and bool(cover.any()) == (ends[0][1] == 20.0 and ends[0][0] < 0)


def test_the_last_lies_on_top():
    one = Strokes.segments([[0, 10, 0]], [[50, 10, 0]], [[255, 0, 0]], [4.0], [Target(seam=1)])
    two = Strokes.segments([[20, 0, 0]], [[20, 40, 0]], [[0, 0, 255]], [4.0], [Target(seam=2)])
    for strokes, top in ((Strokes.joined([one, two]), [0, 0, 255]), (Strokes.joined([two, one]), [255, 0, 0])):
        image, cover, owner = np.zeros((50, 60, 3), np.uint8), np.empty((50, 60), np.uint8), np.empty((50, 60), np.int32)
        stroke(strokes.a, strokes.b, strokes.item, strokes.width, np.zeros((50, 60), np.float32), 0.1, 1, cover, owner)
        lay_over(cover, owner, strokes.colour, image)
        assert image[10, 20].tolist() == top
        assert image[10, 40].tolist() == [255, 0, 0] and image[30, 20].tolist() == [0, 0, 255]


def test_soft_edges_mix_with_what_is_below():
    image = np.full((1, 1, 3), 100, np.uint8)
    lay_over(np.array([[51]], np.uint8), np.zeros((1, 1), np.int32), np.array([[200, 0, 100]], np.uint8), image)
    assert image[0, 0].tolist() == pytest.approx([120, 80, 100], abs=1)


@pytest.fixture
def ball():
    """A ball of radius 10 with its equator, that of the front an item of its own."""
    mesh = Mesh(10 * sphere(4)[0], sphere(4)[1])
    a = np.linspace(0, np.pi, 90)
    arcs = [np.column_stack([10 * np.cos(a), s * 10 * np.sin(a), 0 * a]) for s in (-1, 1)]
    return mesh, Strokes.joined([Strokes.polyline(arc, (200, 0, 0), 3.0, Target(seam=k)) for k, arc in enumerate(arcs)])


def test_of_a_ball_only_the_front_is_seen(ball):
    mesh, equator = ball
    painter, m = Painter(), len(mesh.F)
    paint = Paint(np.full((m, 3), 150, np.uint8), np.zeros(m, np.uint8), np.zeros((1, 4), np.float32), np.zeros(3, np.uint8))
    for side, item in (("front", 0), ("back", 1)):
        camera = Camera.fitted(mesh.V, 200, 160).seen_from(side).whole()
        for sharper in (1, 2):
            painter.draw(Solid.of(mesh), camera, paint, equator, sharper=sharper)
            assert painter.item_near(100, 80, reach=3) == item
            assert painter.item_near(100, 84, reach=4) == item and painter.item_near(100, 90, reach=4) == -1
            along = [painter.item_near(x, 80, reach=3) for x in range(45, 155)]
            assert set(along) == {item}


def test_what_stands_for_nothing_is_not_found(ball):
    mesh, _ = ball
    painter, m = Painter(), len(mesh.F)
    paint = Paint(np.full((m, 3), 150, np.uint8), np.zeros(m, np.uint8), np.zeros((1, 4), np.float32), np.zeros(3, np.uint8))
    dot = Strokes.polyline([[0, -10, 0]], (1, 2, 3), 9.0)
    image = painter.draw(Solid.of(mesh), Camera.fitted(mesh.V, 200, 160).seen_from("front"), paint, dot)
    assert image[80, 100].tolist() == [1, 2, 3] and painter.item_near(100, 80, reach=3) == -1


def test_nothing_joined_is_nothing():
    none = Strokes.joined([])
    assert none.a.shape == (0, 3) and none.targets == () and Strokes.polyline(np.zeros((0, 3)), (0, 0, 0), 1).a.shape == (0, 3)
