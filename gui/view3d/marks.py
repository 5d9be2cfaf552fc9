"""What is drawn on the object besides its faces: seams in their colours, conductors, and the labels of all."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gui.state.derived import Derived
from gui.state.selection import Target
from gui.theme import Theme, rgb
from gui.view3d.lines import Strokes
from skinfab.drawings.seam_sides import seam_sides
from skinfab.seams.edit import chain
from skinfab.skin import Skin

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Widths, pixels at 96 dots per inch.
SEAM_WIDTH, MARKED_WIDTH, LIT_WIDTH = 2.2, 3.4, 4.6


@dataclass(frozen=True, eq=False)
class SeamLines:
    """The seams of a document, and edges where none may run.

    Parameters
    ----------
    edges : (k,) int64
        Edge ids: seams first, then forbidden edges.
    ends : (k, 2, 3) float, mm
    kind : (k,) int64
        0 a seam, 1 a locked one, 2 forbidden.
    """

    edges: IntArray
    ends: FloatArray
    kind: IntArray

    @staticmethod
    def of(skin: Skin) -> SeamLines:
        """Of a document."""
        top, marks = skin.mesh.topology, skin.marks
        none = np.empty(0, dtype=np.int64)
        seams = _edges(skin, skin.seams)
        locked = none if marks is None else _edges(skin, marks.locked)
        forbidden = none if marks is None else np.setdiff1d(_edges(skin, marks.forbidden), seams)
        edges = np.concatenate([seams, forbidden])
        kind = np.concatenate([np.isin(seams, locked).astype(np.int64), np.full(len(forbidden), 2)])
        return SeamLines(edges, skin.object.V[top.E[edges]], kind)

    def strokes(self, theme: Theme, *, width: float = 1.0) -> Strokes:
        """An item an edge; `width` multiplies widths on fine screens."""
        colours = np.array([rgb(theme.seam), rgb(theme.locked), rgb(theme.forbidden)], dtype=np.uint8)[self.kind]
        widths = np.array([SEAM_WIDTH, MARKED_WIDTH, SEAM_WIDTH])[self.kind] * width
        return Strokes.segments(self.ends[:, 0], self.ends[:, 1], colours, widths, [Target(seam=e) for e in self.edges.tolist()])

    def lit(self, skin: Skin, edge: int, colour: str, *, width: float = 1.0) -> Strokes:
        """The whole seam that an edge is on, in one colour; of an edge that is forbidden, the edge alone."""
        if edge not in set(self.edges.tolist()):
            return Strokes.joined([])
        on_seam = bool((self.kind[self.edges == edge] < 2).any())
        ids = chain(skin.mesh, skin.seams, edge) if on_seam else np.array([edge])
        ends = skin.object.V[skin.mesh.topology.E[ids]]
        count = len(ids)
        colours = np.tile(np.array(rgb(colour), dtype=np.uint8), (count, 1))
        return Strokes.segments(ends[:, 0], ends[:, 1], colours, np.full(count, LIT_WIDTH * width), [Target(seam=int(e)) for e in ids])


def sensor_strokes(skin: Skin, derived: Derived, theme: Theme, lit: dict[str, str], *, scale: float, width: float = 1.0) -> Strokes:
    """Conductors as wide as their bead, at `scale` pixels per mm; `lit` names colours of those that are not plain ink."""
    parts = []
    for sensor in skin.sensors:
        wide = max(sensor.pattern.bead * scale, 1.6 * width)
        if sensor.id in lit:
            wide = max(wide, LIT_WIDTH * width)
        target = Target(piece=sensor.piece, sensor=sensor.id)
        parts.append(Strokes.polyline(derived.object_line(skin, sensor), rgb(lit.get(sensor.id, theme.ink)), wide, target))
    return Strokes.joined(parts)


def outline(skin: Skin, id: str, colour: str, *, width: float = 1.0) -> Strokes:
    """The border of the piece of that id, darts and holes included; nothing where there is none of that id."""
    parts = []
    for piece in skin.pieces:
        if piece.id == id:
            ends = skin.object.V[piece.vertices[piece.topology.E[piece.topology.is_boundary]]]
            line = np.concatenate([ends, np.full((len(ends), 1, 3), np.nan)], axis=1)
            parts.append(Strokes.polyline(line.reshape(-1, 3), rgb(colour), width))
    return Strokes.joined(parts)


@dataclass(frozen=True, eq=False)
class SeamLabels:
    """Numbers of seams, the same as beside the flat pieces, at their notches.

    Parameters
    ----------
    text : tuple of str
    points : (k, 3) float, mm
    normals : (k, 3) float
        Outward, of a face there.
    """

    text: tuple[str, ...]
    points: FloatArray
    normals: FloatArray

    @staticmethod
    def of(skin: Skin) -> SeamLabels:
        """Of a document; seams that run into each other without pieces yet have none."""
        top, text, at, faces = skin.mesh.topology, [], [], []
        for side in seam_sides(skin.pieces) if skin.pieces else ():
            if not side.label or side.label in text:
                continue
            piece = skin.pieces[side.piece]
            loop = piece.topology.boundary_loops[0]
            # A notch is the middle of one edge of the outline, computed in just this way.
            middles = (piece.UV[loop] + piece.UV[np.roll(loop, -1)]) / 2
            k = int(np.argmin(np.hypot(*(middles - side.notch).T)))
            ends = piece.vertices[[loop[k], loop[(k + 1) % len(loop)]]]
            text.append(side.label)
            at.append(skin.object.V[ends].mean(axis=0))
            faces.append(int(top.EF[top.edge_ids(ends)[0], 0]))
        return SeamLabels(tuple(text), np.array(at).reshape(-1, 3), skin.object.face_normals[np.array(faces, dtype=np.int64)])


def _edges(skin: Skin, pairs: IntArray) -> IntArray:
    edges = skin.mesh.topology.edge_ids(pairs)
    return np.unique(edges[edges >= 0])
