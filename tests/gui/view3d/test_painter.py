"""Only what changed is done anew."""

from dataclasses import replace

import numpy as np
from shapes import sphere

from gui.state.selection import Target
from gui.view3d import painter as module
from gui.view3d.camera import Camera
from gui.view3d.lines import Strokes
from gui.view3d.painter import Painter, warm
from gui.view3d.shade import Paint
from gui.view3d.solid import Solid
from skinfab.mesh.model import Mesh

NONE = Strokes.joined([])


def scene():
    ball = Mesh(*sphere(3))
    m = len(ball.F)
    paint = Paint(np.full((m, 3), 150, np.uint8), np.zeros(m, np.uint8), np.zeros((1, 4), np.float32), np.zeros(3, np.uint8))
    return Solid.of(ball), Camera.fitted(ball.V, 200, 160), paint


def counted(monkeypatch):
    calls = []

    def count(name):
        really = getattr(module, name)
        monkeypatch.setattr(module, name, lambda *arguments: calls.append(name) or really(*arguments))

    for name in ("rasterise", "shade", "stroke"):
        count(name)
    return calls


def test_lines_alone_neither_draw_nor_colour_triangles(monkeypatch):
    calls, painter, (solid, camera, paint) = counted(monkeypatch), Painter(), scene()
    before = painter.draw(solid, camera, paint, NONE).copy()
    line = Strokes.polyline([[0, -1, -1], [0, -1, 1]], (255, 255, 255), 2)
    assert (painter.draw(solid, camera, paint, line) == 255).any()
    assert np.array_equal(painter.draw(solid, camera, paint, NONE), before)
    assert calls == ["rasterise", "shade", "stroke", "stroke", "stroke"]


def test_colours_draw_no_triangle(monkeypatch):
    calls, painter, (solid, camera, paint) = counted(monkeypatch), Painter(), scene()
    painter.draw(solid, camera, paint, NONE)
    painter.draw(solid, camera, replace(paint, tint=paint.tint), NONE)
    assert calls.count("rasterise") == 1 and calls.count("shade") == 2
    painter.draw(solid, camera.panned(1, 0), paint, NONE)
    painter.draw(solid, camera.panned(1, 0), paint, NONE, sharper=2)
    assert calls.count("rasterise") == 3


def test_another_size_gives_another_picture():
    painter, (solid, camera, paint) = Painter(), scene()
    for width, height in ((200, 160), (90, 310), (200, 160)):
        for sharper in (1, 2):
            assert painter.draw(solid, camera.sized(width, height), paint, NONE, sharper=sharper).shape == (height, width, 3)
            assert painter.face_at(width // 2, height // 2) >= 0 and painter.face_at(0, 0) == -1


def test_depth_and_faces_are_those_of_the_picture():
    painter, (solid, camera, paint) = Painter(), scene()
    for sharper in (1, 2):
        painter.draw(solid, camera, paint, NONE, sharper=sharper)
        assert abs(painter.depth_at(100, 80) + 1) < 0.02 and np.isinf(painter.depth_at(0, 0)) and np.isinf(painter.depth_at(-1, 900))
        columns, rows, faces = painter.faces(8)
        assert all(painter.face_at(*each) == face for *each, face in zip(columns, rows, faces, strict=True))


def test_before_anything_is_drawn_there_is_nothing():
    painter = Painter()
    assert painter.face_at(0, 0) == -1 and painter.item_near(0, 0, reach=3) == -1 and not len(painter.faces(8)[0])


def test_nothing_can_be_drawn():
    painter, (_, camera, _) = Painter(), scene()
    empty = Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=int))
    paint = Paint(np.zeros((0, 3), np.uint8), np.zeros(0, np.uint8), np.zeros((1, 4), np.float32), np.full(3, 7, np.uint8))
    assert (painter.draw(Solid.of(empty), camera, paint, NONE) == 7).all()


def test_warming_up_compiles_everything():
    warm()
    assert all(len(getattr(module, name).signatures) for name in ("rasterise", "project", "shade", "shade_quickly", "stroke", "shine"))


def test_a_coarse_picture_answers_in_the_pixels_of_the_camera():
    solid, camera, paint = scene()
    camera, V = camera.sized(401, 301), solid.V.astype(float)
    strokes = Strokes.polyline(V[:40], (255, 0, 0), 3.0, Target(seam=4))
    fine, coarse = Painter(), Painter()
    whole, half = fine.draw(solid, camera, paint, strokes), coarse.draw(solid, camera, paint, strokes, coarser=2)
    assert whole.shape == (301, 401, 3) and half.shape == (151, 201, 3)
    rows, columns = np.mgrid[2:300:7, 2:400:7]
    places = list(zip(columns.ravel().tolist(), rows.ravel().tolist(), strict=True))
    there = [[painter.face_at(*at) >= 0 for at in places] for painter in (fine, coarse)]
    assert np.mean(np.equal(*there)) > 0.97
    apart = [abs(fine.depth_at(*at) - coarse.depth_at(*at)) for at, a, b in zip(places, *there, strict=True) if a and b]
    assert np.median(apart) < 0.05 * camera.radius
    seen = camera.to_screen(V)
    assert np.mean(fine.is_seen(seen) == coarse.is_seen(seen)) > 0.9
    for painter in (fine, coarse):
        c, r, f = painter.faces(8)
        assert abs(c.mean() - 200) < 6 and abs(r.mean() - 150) < 6 and (f >= 0).all()
    found = [[painter.item_near(*at, reach=4) for at in places] for painter in (fine, coarse)]
    assert np.mean(np.equal(*found)) > 0.95 and max(found[1]) == 0
