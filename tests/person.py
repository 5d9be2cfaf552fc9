"""A person before the window: opens, clicks, presses keys, answers questions, and waits for what follows."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from gui.app import App
from gui.dialogs.open_mesh import MeshChoice
from gui.jobs.tasks import MeshFacts
from gui.view3d.camera import SIDES
from gui.view3d.hit import Hit

MESHES = Path(__file__).parents[1] / "meshes"
#: Seams that let cube.obj lie flat in one piece.
CUBE_SPREAD = np.array([[0, 1], [1, 3], [2, 3], [2, 6], [6, 7], [5, 7], [4, 5]])

#: Nothing that a test waits for takes so long, s, unless it never comes.
PATIENCE = 60.0


@dataclass
class Answers:
    """What is answered instead of a person; what was asked is kept."""

    asked: list[str] = field(default_factory=list)
    give: dict[str, str] = field(default_factory=dict)
    path: Path | None = None
    choice: Callable[[MeshFacts], MeshChoice | None] = lambda facts: MeshChoice(facts.units, False)

    def ask(self, title: str, text: str, answers: Sequence[str], *, cancel: str = "") -> str:
        self.asked.append(f"{title}: {text}")
        answer = self.give.get(title, cancel)
        assert answer in (*answers, cancel)
        return answer

    def open_path(self) -> Path | None:
        self.asked.append("open_path")
        return self.path

    def save_path(self, title: str, suffix: str, name: str) -> Path | None:
        self.asked.append(f"save_path {name}")
        return self.path

    def folder(self, title: str) -> Path | None:
        self.asked.append("folder")
        return self.path

    def how_to_open(self, facts: MeshFacts) -> MeshChoice | None:
        self.asked.append(f"how_to_open {facts.file}")
        return self.choice(facts)


class Person:
    """Drives a window.

    Parameters
    ----------
    app : App
    answers : Answers
        What the window's dialogs are.
    """

    def __init__(self, app: App, answers: Answers) -> None:
        self.app, self.answers = app, answers
        self.session, self.view3d, self.view2d = app.session, app.view3d, app.view2d

    @property
    def skin(self):
        return self.session.skin

    def wait(self, until: Callable[[], object] | None = None) -> None:
        """Let the window run until something is so; by default, until nothing is being worked on and all is drawn."""
        root, end = self.app.root, time.monotonic() + PATIENCE
        while True:
            root.update()
            if until is not None and until():
                return
            if until is None and self.app.runner.job is None:
                root.update()
                if self.app.runner.job is None:
                    return
            assert time.monotonic() < end, f"waited {PATIENCE} s in vain; {[p.text for p in self.session.problems]}"
            time.sleep(0.005)

    def open(self, path: Path) -> None:
        self.app.files.open_path(path)
        self.wait()

    def cut(self, seams: np.ndarray = CUBE_SPREAD, label: str = "cut") -> None:
        """Other seams, as one step."""
        self.session.do(label, replace(self.skin, seams=seams))

    def problems(self, kind: str = "error") -> list[str]:
        return [p.text for p in self.session.problems if p.kind == kind]

    def press(self, key: str) -> None:
        """A key, wherever the focus is."""
        root = self.app.root
        widget = root.focus_get()
        if widget is None:
            root.focus_force()
            root.update()
            widget = root.focus_get() or root
        widget.event_generate(f"<{key}>")
        root.update()

    # On the object

    def click_vertex(self, vertex: int, *, shift: bool = False) -> None:
        """Click near a vertex of the object, from a side that shows it."""
        self._click(self._see(self.skin.object.V[vertex], lambda hit: hit.vertex == vertex), shift)

    def click_face(self, face: int, *, shift: bool = False) -> None:
        """Click the middle of a face."""
        self._click(self.see_face(face), shift)

    def see_face(self, face: int) -> tuple[int, int]:
        """Turn the object so that a face is seen; where its middle is."""
        mesh = self.skin.object
        return self._see(mesh.V[mesh.F[face]].mean(axis=0), lambda hit: hit.face == face)

    def click_edge(self, a: int, b: int, *, shift: bool = False) -> None:
        """Click beside the middle of an edge."""
        mesh = self.skin.object
        (edge,) = mesh.topology.edge_ids([[a, b]])
        self._click(self._see(mesh.V[[a, b]].mean(axis=0), lambda hit: edge in (hit.target.seam, hit.edge)), shift)

    def drag3d(self, start: tuple[int, int], *to: tuple[int, int]) -> None:
        """Press, move over places, let go."""
        canvas, root = self.view3d.canvas, self.app.root
        canvas.event_generate("<ButtonPress-1>", x=start[0], y=start[1])
        for x, y in to:
            canvas.event_generate("<B1-Motion>", x=x, y=y, state=0x100)
            root.update()
        canvas.event_generate("<ButtonRelease-1>", x=to[-1][0], y=to[-1][1], state=0x100)
        root.update()

    def _see(self, point: np.ndarray, meant: Callable[[Hit], bool]) -> tuple[int, int]:
        """Turn the object until a place of it is seen, and meant by a click there; where that is."""
        middle = self.skin.object.V.mean(axis=0)
        for side in SIDES:
            self.view3d.look(side)
            self.view3d.settle()
            for inwards in (0.03, 0.06, 0.1):
                x, y = np.rint(self.view3d.camera.to_screen([point + inwards * (middle - point)])[0, :2]).astype(int).tolist()
                hit = self.view3d.hit_at(x, y)
                if hit is not None and meant(hit):
                    return x, y
        raise AssertionError(f"no side shows {point}")

    def _click(self, at: tuple[int, int], shift: bool) -> None:
        canvas, state = self.view3d.canvas, 0x1 if shift else 0
        canvas.event_generate("<Motion>", x=at[0], y=at[1], state=state)
        self.app.root.update()
        canvas.event_generate("<ButtonPress-1>", x=at[0], y=at[1], state=state)
        canvas.event_generate("<ButtonRelease-1>", x=at[0], y=at[1], state=state | 0x100)
        self.app.root.update()

    # On the flat skin

    def flat_place(self, piece: str, uv: Sequence[float]) -> tuple[int, int]:
        """Where a point of a piece is in the flat view, pixels."""
        view = self.view2d
        self.wait()
        assert view.sheet is not None
        px = view.plane.to_px(np.asarray(uv, dtype=float) + view.sheet.offset_of(piece))
        return round(px[0] - 0.5), round(view.surface.size[1] - px[1] - 0.5)

    def click_flat(self, at: tuple[int, int], *, shift: bool = False) -> None:
        widget, state = self.view2d.surface.widget, 0x1 if shift else 0
        widget.event_generate("<Motion>", x=at[0], y=at[1], state=state)
        self.app.root.update()
        widget.event_generate("<ButtonPress-1>", x=at[0], y=at[1], state=state)
        widget.event_generate("<ButtonRelease-1>", x=at[0], y=at[1], state=state | 0x100)
        self.app.root.update()
