"""Lengths and angles by clicks: flat and along the surface, and across pieces."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from gui.jobs.background import Background
from gui.state.derived import Derived
from gui.state.session import Session
from gui.theme import LIGHT
from gui.tools.measure import Measure
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece
from skinfab.skin import Skin, Source


def folded() -> Skin:
    """Two squares of 40 mm at a right angle along x = 40, flat as one piece; a third beside them on a piece of its own."""
    V = np.array([[0.0, 0, 0], [40, 0, 0], [40, 40, 0], [0, 40, 0], [40, 0, -40], [40, 40, -40], [0, 0, -40], [0, 40, -40]])
    F = np.array([[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2], [4, 6, 7], [4, 7, 5]])
    one = Piece("P1", np.arange(4), np.arange(6), F[:4], np.array([[0.0, 0], [40, 0], [40, 40], [0, 40], [80, 0], [80, 40]]))
    two = Piece(
        "P2", np.arange(4, 6), np.array([4, 5, 6, 7]), np.array([[0, 2, 3], [0, 3, 1]]), np.array([[0.0, 0], [0, 40], [40, 0], [40, 40]])
    )
    return Skin(Mesh(V, F), Source("fold.obj", "0" * 64, "mm", 1.0), np.array([[4, 5]]), (one, two))


@pytest.fixture
def desk(root):
    session, said = Session(), []
    session.open(folded(), None)
    shown: dict[str, list] = {}
    view = SimpleNamespace(show=lambda name, lines, *a, **k: shown.__setitem__(name, lines), hide=lambda name: shown.pop(name, None))
    flat: dict[str, str] = {}
    view2d = SimpleNamespace(show=lambda name, lines, *a, words="": flat.__setitem__(name, words), hide=lambda name: flat.pop(name, None))
    desk = SimpleNamespace(session=session, derived=Derived(), say=said.append, skin=session.skin, complain=lambda s, t: said.append(t))
    background = Background(root)
    tool = Measure(desk, view, view2d, background, theme=lambda: LIGHT)

    def settle():
        for _ in range(500):
            root.update()
            if "..." not in tool.words:
                return
            root.after(10, lambda: root.setvar("tick", "1"))
            root.wait_variable("tick")

    yield SimpleNamespace(tool=tool, said=said, shown=shown, flat=flat, settle=settle, skin=session.skin)
    background.close()


def click(desk, face, weights):
    weights = np.array(weights, dtype=float)
    point = weights @ desk.skin.mesh.V[desk.skin.mesh.F[face]]
    desk.tool.click(SimpleNamespace(face=face, barycentric=weights, point=point), shift=False)


def test_over_a_fold_the_surface_is_as_long_as_the_flat_skin(desk):
    click(desk, 0, (0, 0.5, 0.5))  # (40, 20), on the fold itself
    click(desk, 1, (0.5, 0, 0.5))  # (0, 20)
    desk.settle()
    assert desk.tool.words == "flat: 40.0 mm\nsurface: 40.0 mm" and desk.flat["measure"] == desk.tool.words
    desk.tool.stop()
    click(desk, 0, (0.9, 0.05, 0.05))
    click(desk, 2, (0.05, 0.05, 0.9))
    desk.settle()
    flat, surface = (float(line.split()[1]) for line in desk.tool.words.split("\n"))
    assert surface == pytest.approx(flat, abs=0.1) and flat > 75


def test_a_third_point_gives_the_angle_and_a_fourth_begins_anew(desk):
    for weights in [(0.8, 0.1, 0.1), (0.1, 0.8, 0.1), (0.1, 0.1, 0.8)]:
        click(desk, 0, weights)
    desk.settle()
    assert desk.tool.words.count("90.0 deg") == 2 and len(desk.shown["measure"]) == 5
    click(desk, 0, (1, 0, 0))
    assert desk.tool.words == "" and desk.tool.begun


def test_across_pieces_there_is_only_the_surface(desk):
    click(desk, 2, (1, 0, 0))
    click(desk, 4, (0, 1, 0))
    desk.settle()
    assert desk.tool.words.startswith("flat: on different pieces\nsurface: 80.0 mm") and "measure" not in desk.flat


def test_beside_the_object_it_says_so_and_stop_takes_all_away(desk):
    desk.tool.click(SimpleNamespace(face=-1), shift=False)
    assert "nothing to measure" in desk.said[-1] and not desk.tool.begun
    click(desk, 0, (1, 0, 0))
    desk.tool.stop()
    assert not desk.tool.begun and not desk.shown and not desk.flat
