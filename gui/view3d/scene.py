"""The document as it is to be drawn: colours of faces, lines and what lights up, each kept until what it follows from changes."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gui.shades import CHECK_MM, face_colours
from gui.state.derived import Derived, Part
from gui.state.selection import NOTHING, Target
from gui.state.session import Session
from gui.theme import LIGHT, Theme, rgb
from gui.view3d.lines import Strokes
from gui.view3d.marks import SeamLabels, SeamLines, outline, sensor_strokes
from gui.view3d.painter import Spots
from gui.view3d.shade import Paint
from gui.view3d.solid import Solid
from skinfab.mesh.model import Mesh
from skinfab.skin import Skin

T = TypeVar("T")

#: How much lighter a piece becomes that is selected, or under the pointer: light changes no hue, so that colours keep their meaning.
_SELECT_TINT, _HOVER_TINT = 0.38, 0.20

#: Widths of the outlines of those pieces, pixels at 96 dots per inch.
_SELECT_WIDTH, _HOVER_WIDTH = 4.6, 3.0


class Scene:
    """What the 3D view shows of a session.

    Parameters
    ----------
    session : Session
    derived : Derived
    theme : Theme
    dpi : float
        Multiplies widths of lines: 1 at 96 dots per inch.
    """

    def __init__(self, session: Session, derived: Derived, theme: Theme, *, dpi: float = 1.0) -> None:
        self.theme = theme
        self._session, self._derived, self._dpi = session, derived, dpi
        self._kept: dict[str, tuple[tuple[Hashable, ...], tuple[object, ...], Any]] = {}
        self._overlays: dict[str, Strokes] = {}
        self._lights: dict[str, Spots] = {}

    # What others lay over it

    def show(self, name: str, polylines: list[ArrayLike], colour: str, width: float) -> None:
        """Draw polylines (k, 3) mm, a single point as a dot, "#rrggbb" and `width` pixels, until the name is shown anew or hidden."""
        self._overlays[name] = Strokes.joined([Strokes.polyline(line, rgb(colour), width * self._dpi) for line in polylines])

    def glow(self, name: str, points: ArrayLike, colour: str, *, radius: float, strength: float = 1.0) -> None:
        """Let the surface glow round points (k, 3) mm, out to `radius` mm, `strength` 0 to 1."""
        at = np.asarray(points, dtype=np.float64).reshape(-1, 3)
        at = at[np.isfinite(at).all(axis=1)]
        colours = np.tile([*rgb(colour), float(np.clip(strength, 0, 1))], (len(at), 1))
        self._lights[name] = Spots(at, np.full(len(at), float(radius)), colours)

    def hide(self, name: str) -> bool:
        """Take away what was shown or glows under that name; whether there was something."""
        there = self._overlays.pop(name, None) is not None
        return self._lights.pop(name, None) is not None or there

    @property
    def spots(self) -> Spots | None:
        """All that glows."""
        if not self._lights:
            return None
        return self._once("spots", (), tuple(self._lights.values()), self._all_spots)

    # What the document gives

    def paint(self, skin: Skin) -> Paint:
        """Colours of faces."""
        session, theme = self._session, self.theme
        marked = session.selected.piece if self._whole_piece(session.selected) else "", session.hovered.piece
        key = (session.shading, theme.name, *marked)
        return self._once("paint", key, (skin.mesh, *skin.pieces, skin.marks), lambda: self._paint(skin, *marked))

    def strokes(self, skin: Skin, scale: float) -> Strokes:
        """Seams, conductors and what is shown over them, at `scale` pixels per mm."""
        # The bar of colours is the same in both themes, and light: dark lines are seen on it.
        session = self._session
        theme = LIGHT if session.shading == "distortion" else self.theme
        seams = self._once(
            "seams", (theme.name,), (skin.mesh, skin.seams, skin.marks), lambda: self._lines(skin).strokes(theme, width=self._dpi)
        )
        selected, hovered = session.selected, session.hovered
        lit = {id: c for t, c in ((hovered, theme.hover), (selected, theme.select)) for id in (t.sensor, *t.also) if id}
        key = (round(scale, 6), theme.name, *sorted(lit.items()))
        sensors = self._once(
            "sensors",
            key,
            (skin.object, *skin.pieces, *skin.sensors),
            lambda: sensor_strokes(skin, self._derived, theme, lit, scale=scale, width=self._dpi),
        )
        parts: list[Strokes] = []  # outlines below the seams, which the pointer must find
        for target, colour, width in ((hovered, self.theme.hover, _HOVER_WIDTH), (selected, self.theme.select, _SELECT_WIDTH)):
            if self._whole_piece(target) and target.piece:
                parts.append(self._outline(skin, target.piece, colour, width * self._dpi))
        parts += [seams, sensors]
        for target, colour in ((selected, self.theme.select), (hovered, self.theme.hover)):
            if target.seam >= 0:
                parts.append(self._lit_seam(skin, target.seam, colour))
        if hovered.face >= 0 and not hovered.sensor and hovered.seam < 0:
            parts.append(self._face(skin, hovered.face))
        return Strokes.joined([*parts, *self._overlays.values()])

    def labels(self, skin: Skin) -> SeamLabels:
        """Numbers of seams."""
        return self._derived.once("seam labels", (skin.object, *skin.pieces), lambda: SeamLabels.of(skin))

    def solid(self, mesh: Mesh) -> Solid:
        """The object as it is drawn."""
        return self._derived.once("solid", (mesh,), lambda: Solid.of(mesh))

    @staticmethod
    def parts(skin: Skin) -> Iterable[Part]:
        """What takes long of all this."""
        mesh = skin.object
        yield Part("solid", (mesh,), len(mesh.F), lambda: Solid.of(mesh))
        yield Part("seam labels", (mesh, *skin.pieces), 0, lambda: SeamLabels.of(skin))

    def owner(self, skin: Skin) -> NDArray[np.int64]:
        """(m,) position of each face's piece, -1 where it has none."""
        return self._derived.piece_of_face(skin)

    def sensor_line(self, skin: Skin, k: int) -> NDArray[np.float64]:
        """(k, 3) mm: the k-th sensor on the object."""
        return self._derived.object_line(skin, skin.sensors[k])

    def _paint(self, skin: Skin, selected: str, hovered: str) -> Paint:
        session, theme, m = self._session, self.theme, len(skin.mesh.F)
        colour = self._once(
            "colour",
            (session.shading, theme.name),
            (skin.mesh, *skin.pieces, skin.marks),
            lambda: face_colours(skin, self._derived, session.shading, theme),
        )
        board = session.shading == "checker"
        flat = self._once("flat", (), (skin.mesh, *skin.pieces), lambda: _flat_corners(skin)) if board else None
        tints = np.array([[0, 0, 0, 0], [255, 255, 255, _HOVER_TINT], [255, 255, 255, _SELECT_TINT]], dtype=np.float32)
        tint = np.zeros(m, dtype=np.uint8)
        for piece in skin.pieces:
            if piece.id in (selected, hovered):
                tint[piece.faces] = 2 if piece.id == selected else 1
        return Paint(colour, tint, tints, np.array(rgb(theme.view), dtype=np.uint8), flat)

    def _lines(self, skin: Skin) -> SeamLines:
        return self._once("lines", (), (skin.mesh, skin.seams, skin.marks), lambda: SeamLines.of(skin))

    def _lit_seam(self, skin: Skin, edge: int, colour: str) -> Strokes:
        lines = self._lines(skin)
        return self._once(f"lit {colour}", (edge, colour), (lines,), lambda: lines.lit(skin, edge, colour, width=self._dpi))

    def _outline(self, skin: Skin, piece: str, colour: str, width: float) -> Strokes:
        of = (skin.object, *skin.pieces)
        return self._once(f"outline {width}", (piece, colour, width), of, lambda: outline(skin, piece, colour, width=width))

    def _face(self, skin: Skin, face: int) -> Strokes:
        """The outline of the face under the pointer."""
        if face >= len(skin.mesh.F):
            return Strokes.joined([])
        corners = skin.object.V[skin.mesh.F[face][[0, 1, 2, 0]]]
        return Strokes.polyline(corners, rgb(self.theme.hover), 1.4 * self._dpi)

    def _all_spots(self) -> Spots:
        each = list(self._lights.values())
        return Spots(*(np.concatenate([getattr(s, name) for s in each]) for name in ("points", "radius", "colour")))

    @staticmethod
    def _whole_piece(target: Target) -> bool:
        """Whether the piece itself is meant, not a sensor or a seam on it."""
        return target != NOTHING and not target.sensor and target.seam < 0

    def _once(self, what: str, key: tuple[Hashable, ...], of: tuple[object, ...], make: Callable[[], T]) -> T:
        """What was made last, as long as `key` is equal and every part of `of` the same object."""
        kept = self._kept.get(what)
        if kept is None or kept[0] != key or len(kept[1]) != len(of) or any(a is not b for a, b in zip(kept[1], of, strict=True)):
            kept = key, of, make()
            self._kept[what] = kept
        value: T = kept[2]
        return value


def _flat_corners(skin: Skin) -> NDArray[np.float32]:
    """Flat place of each face's corners in squares of the checker board, NaN where a face has none: (m, 3, 2)."""
    flat = np.full((len(skin.mesh.F), 3, 2), np.nan, dtype=np.float32)
    for piece in skin.pieces:
        flat[piece.faces] = (piece.UV[piece.F] / CHECK_MM).astype(np.float32)
    return flat
