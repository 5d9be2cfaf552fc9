"""Two clicks measure a length, a third an angle: on the flat skin and along the object's surface."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from gui.desk import Desk
from gui.jobs.background import Background
from gui.jobs.worker import Outcome
from gui.theme import Theme
from gui.tools.tool import AnyHit, Tool
from gui.view2d.view import View2D
from gui.view3d.view import View3D
from skinfab.mesh.geodesic import Geodesic, angle_between, geodesic

Float = NDArray[np.float64]

_NAME = "measure"


class Measure(Tool):
    """Straight on the flat piece, where all points lie on one, and the shortest way over the object.

    Parameters
    ----------
    desk : Desk
    view3d, view2d : the views
    background : Background
        Finds ways over the object, which takes some tenths of a second on large ones.
    theme : callable
        The colours now.
    """

    id, label, key = "measure", "Measure", "m"
    tip = "Click two points for their distance, a third for the angle at the second; click again to begin anew."

    def __init__(self, desk: Desk, view3d: View3D, view2d: View2D, background: Background, *, theme: Callable[[], Theme]) -> None:
        self._desk, self._view3d, self._view2d, self._background, self._theme = desk, view3d, view2d, background, theme
        self._hits: list[AnyHit] = []
        self._ways: tuple[Geodesic, ...] = ()
        self.words = ""

    @property
    def begun(self) -> bool:
        """Whether there is a point to go on from."""
        return bool(self._hits)

    def click(self, hit: AnyHit, *, shift: bool) -> None:
        if hit.face < 0:
            self._desk.say("There is nothing to measure there; click on the object or on a flat piece.")
            return
        if len(self._hits) == 3:
            self._hits = []
        self._hits.append(hit)
        self._ways = ()
        self._show()
        if len(self._hits) > 1:
            mesh, hits = self._desk.skin.object, tuple(self._hits)
            ends = [(h.face, h.barycentric) for h in hits]
            pairs = list(itertools.pairwise(ends))
            self._background.ask(_NAME, lambda: tuple(geodesic(mesh, *pair) for pair in pairs), lambda found: self._found(hits, found))

    def stop(self) -> None:
        self._hits, self._ways, self.words = [], (), ""
        self._view3d.hide(_NAME)
        self._view2d.hide(_NAME)
        self._desk.session.report(_NAME, [])

    def _found(self, hits: tuple[AnyHit, ...], outcome: Outcome) -> None:
        if tuple(self._hits) != hits:
            return  # another measurement has begun
        if outcome.sentence:
            self._desk.complain(_NAME, outcome.sentence)
            return
        self._desk.session.report(_NAME, [])
        self._ways = outcome.result
        self._show()

    def _flat(self) -> tuple[str, Float] | None:
        """The one piece that all points lie on, and where, (k, 2) mm of it."""
        skin = self._desk.skin
        owner = self._desk.derived.piece_of_face(skin)[[hit.face for hit in self._hits]]
        if (owner != owner[0]).any() or owner[0] < 0:
            return None
        piece = skin.pieces[int(owner[0])]
        to_flat = self._desk.derived.flat_map(skin.mesh, piece).to_flat
        return piece.id, to_flat([h.face for h in self._hits], [h.barycentric for h in self._hits])

    def _show(self) -> None:
        flat, ways = self._flat(), self._ways
        lines = []
        if len(self._hits) > 1:
            lines.append("flat: " + (_words(flat[1]) if flat else "on different pieces"))
            lines.append("surface: " + (_words_of(ways) if ways else "..."))
        self.words = "\n".join(lines)
        colour = self._theme().accent
        if flat is not None:
            self._view2d.show(_NAME, [(flat[0], flat[1])], colour, 2.0, words=self.words)
        else:
            self._view2d.hide(_NAME)
        points = [hit.point[None] for hit in self._hits]
        self._view3d.show(_NAME, [*(way.points for way in ways), *points], colour, 3.0)
        if lines:
            self._desk.say(",  ".join(lines))


def _words(flat: Float) -> str:
    length = np.linalg.norm(np.diff(flat, axis=0), axis=1)
    if len(length) == 1:
        return f"{length[0]:.1f} mm"
    angle = np.degrees(angle_between(flat[0] - flat[1], flat[2] - flat[1]))
    return f"{length[0]:.1f} + {length[1]:.1f} mm, {angle:.1f} deg"


def _words_of(ways: tuple[Geodesic, ...]) -> str:
    if len(ways) == 1:
        return f"{ways[0].length:.1f} mm"
    one, two = ways
    angle = np.degrees(angle_between(one.points[-2] - one.points[-1], two.points[1] - two.points[0]))
    return f"{one.length:.1f} + {two.length:.1f} mm, {angle:.1f} deg"
