"""A flat skin of two pieces, and a window that shows it."""

from __future__ import annotations

import tkinter as tk
from types import SimpleNamespace

import numpy as np
import pytest

from gui.state.derived import Derived
from gui.state.session import Session
from gui.theme import LIGHT, apply
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source


@pytest.fixture
def skin() -> Skin:
    """120 x 60 mm, cut along x = 60 into P1 and P2; C1 in the middle of P1, C2 above it in P2."""
    x, y = np.meshgrid(np.arange(0, 121, 5.0), np.arange(0, 61, 5.0))
    V = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    a = (np.arange(12)[:, None] * 25 + np.arange(24)).ravel()
    F = np.concatenate([np.column_stack([a, a + 1, a + 26]), np.column_stack([a, a + 26, a + 25])])
    pieces = []
    for k, right in enumerate((False, True)):
        faces = np.flatnonzero((V[F].mean(axis=1)[:, 0] > 60) == right)
        vertices, local = np.unique(F[faces], return_inverse=True)
        pieces.append(Piece(f"P{k + 1}", faces, vertices, local.reshape(-1, 3), V[vertices, :2] - (60.0 * k, 0.0)))
    on = np.flatnonzero(V[:, 0] == 60)
    spiral = make_pattern("contact-spiral", {"s": 15})
    sensors = (Sensor("C1", "P1", spiral, 20.0, 30.0, 0.0, 0), Sensor("C2", "P2", spiral, 20.0, 40.0, 0.0, 1))
    return Skin(Mesh(V, F), Source("flat.obj", "0" * 64, "mm", 1.0), np.stack([on[:-1], on[1:]], axis=1), tuple(pieces), sensors)


class Pointer:
    """A mouse over the view."""

    def __init__(self, root: tk.Tk, view: object) -> None:
        self.root, self.view = root, view
        self.widget: tk.Canvas = view.surface.widget  # type: ignore[attr-defined]

    def press(self, x: int, y: int, state: int = 0, button: int = 1) -> None:
        self.widget.event_generate(f"<ButtonPress-{button}>", x=x, y=y, state=state)
        self.root.update()

    def move(self, x: int, y: int, state: int = 0) -> None:
        self.widget.event_generate("<Motion>", x=x, y=y, state=state)
        self.root.update()

    def release(self, x: int, y: int, state: int = 0x100, button: int = 1) -> None:
        self.widget.event_generate(f"<ButtonRelease-{button}>", x=x, y=y, state=state)
        self.root.update()

    def drag(self, start: tuple[int, int], by: tuple[int, int], state: int = 0) -> None:
        (x, y), (dx, dy) = start, by
        self.press(x, y, state)
        for part in (0.5, 1.0):
            self.move(round(x + part * dx), round(y + part * dy), state | 0x100)
        self.release(x + dx, y + dy, state | 0x100)

    def key(self, name: str) -> None:
        self.widget.focus_force()
        self.root.update()
        self.widget.event_generate(f"<{name}>")
        self.root.update()


@pytest.fixture
def window(root: tk.Tk, skin: Skin) -> SimpleNamespace:
    """The flat view of the skin in a window: root, view, session, pointer."""
    from gui.view2d.view import View2D

    root.geometry("900x700+0+0")
    apply(root, LIGHT)
    session, derived = Session(), Derived()
    view = View2D(root, session, derived, LIGHT)
    view.pack(fill="both", expand=True)
    session.open(skin, None)
    root.update()
    return SimpleNamespace(root=root, view=view, session=session, skin=skin, pointer=Pointer(root, view))
