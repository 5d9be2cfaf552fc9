"""Where the drawings' words go: beside what they name, off the ink, and never in a heap."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import shapely
from numpy.typing import NDArray

from skinfab.drawings.seam_sides import SeamSide, seam_sides
from skinfab.drawings.strokes import NOTCH_MM, TEXT_MM
from skinfab.paths import Point
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin
from skinfab.tolerances import PREVIEW_CHORD_MM
from skinfab.wire_exits import wire_pads

#: Height of the letters of a size, mm, and half the arm of the cross at a piece's origin.
SMALL_MM = 2.2
CROSS_MM = 1.5

#: A sans serif's digits and capitals are at most this wide, as a part of their height; so are stops and blanks.
_WIDTH = 0.65
_NARROW = 0.33

#: Least distance of a sensor's name from any ink, mm, and how far from the pads it may go.
_CLEAR_MM = 0.4
_FARTHEST_MM = 15.0

#: How far off the next piece on the sheet is at least, see `skinfab.drawings.sheet.sheet_offsets`.
_NEXT_MM = 10.0

#: A seam's number is this far from its seam where it is not at the end of the notch, so far from the notch at most, and stands
#: outside of the piece where inside there is room only this much farther along, mm.
_OFF_SEAM_MM = 2.4
_ALONG_MM = 30.0
_OUTSIDE_MM = 3.0

#: A name on the far side of the pads is as good as one behind them this much farther off, mm.
_BEHIND_MM = 4.0


@dataclass(frozen=True, eq=False)
class Label:
    """A word of the drawing.

    Parameters
    ----------
    kind : "piece", "size", "sensor" or "seam"
    text : str
    at : (2,) float, mm
        Its middle, or the middle of its left end where `left`.
    height : float, mm
    left : bool
    over_ink : bool
        It lies on a conductor for want of room, and needs white behind it.
    """

    kind: Literal["piece", "size", "sensor", "seam"]
    text: str
    at: Point
    height: float = TEXT_MM
    left: bool = False
    over_ink: bool = False

    @property
    def width(self) -> float:
        """An estimate, mm: a drawing does not know its reader's font."""
        return self.height * sum(_NARROW if letter in ". " else _WIDTH for letter in self.text)

    @property
    def box(self) -> shapely.Polygon:
        low = self.at - np.array([0.0 if self.left else self.width / 2, self.height / 2])
        return shapely.box(*low, *(low + np.array([self.width, self.height])))


def skin_labels(skin: Skin) -> list[list[Label]]:
    """The words of each piece, in order: `piece_labels` of all, for drawings of the same skin to share."""
    sides = seam_sides(skin.pieces)
    return [piece_labels(piece, [s for s in sides if s.piece == k], skin.sensors_on(piece.id)) for k, piece in enumerate(skin.pieces)]


def piece_labels(piece: Piece, sides: Sequence[SeamSide], sensors: Sequence[Sensor]) -> list[Label]:
    """The words of one piece, in its frame.

    A sensor's name stands behind its pads, clear of all ink. A seam's number stands at its notch, or as near to it along
    the seam as it is clear of all ink, inside the piece or else outside; it is left out where it would cover another word,
    or where the seam is shorter than the number.

    Parameters
    ----------
    piece : Piece
    sides : sequence of SeamSide
        Of this piece.
    sensors : sequence of Sensor
        On this piece.
    """
    labels = _name(piece)
    inside = shapely.Polygon(piece.outline).buffer(0)
    ink = shapely.MultiLineString([s.printed_path.to_polyline(tolerance=PREVIEW_CHORD_MM) for s in sensors])
    bead = max((s.pattern.bead for s in sensors), default=0.0)
    for sensor in sensors:
        labels.append(_sensor(sensor, inside, ink, bead, labels))
    for side in sides:
        label = _seam(side, inside, ink, bead, labels)
        if label is not None:
            labels.append(label)
    return labels


def origin_cross() -> NDArray[np.float64]:
    """(2, 2, 2) mm: the two strokes of the cross at a piece's origin."""
    return CROSS_MM * np.array([[[-1.0, 0], [1, 0]], [[0, -1], [0, 1]]])


def _name(piece: Piece) -> list[Label]:
    """Id and size, below the piece from its left edge on; no size where it would run into the next piece's name."""
    low = piece.UV.min(axis=0)
    name = Label("piece", piece.id, low + np.array([CROSS_MM, -CROSS_MM - TEXT_MM / 2]), left=True)
    w, h = piece.size
    at = name.at + np.array([name.width + TEXT_MM / 2, 0.0])
    sizes = [Label("size", text, at, SMALL_MM, left=True) for text in (f"{w:.1f} x {h:.1f} mm", f"{w:.1f} x {h:.1f}")]
    fitting = [size for size in sizes if at[0] + size.width <= low[0] + w + _NEXT_MM - CROSS_MM]
    return [name, *fitting[:1]]


def _sensor(sensor: Sensor, inside: shapely.Polygon, ink: shapely.MultiLineString, bead: float, there: Sequence[Label]) -> Label:
    pads = wire_pads([sensor])
    middle, away = np.mean([pad.at for pad in pads], axis=0), pads[0].away
    radius, angle = np.meshgrid(np.arange(TEXT_MM / 2, _FARTHEST_MM, 0.5), np.linspace(-np.pi, np.pi, 24, endpoint=False), indexing="ij")
    along = np.stack([np.cos(angle), np.sin(angle)], axis=-1).reshape(-1, 2)
    turn = np.array([away, [-away[1], away[0]]])
    places = middle + radius.reshape(-1, 1) * (along @ turn)
    cost = radius.ravel() + _BEHIND_MM * (1 - along[:, 0]) / 2
    places = places[np.argsort(cost.round(6), kind="stable")]
    half = np.array([Label("sensor", sensor.id, middle).width, TEXT_MM]) / 2
    boxes = shapely.box(*(places - half).T, *(places + half).T)
    shapely.prepare(ink)
    clear = ~shapely.dwithin(ink, boxes, bead / 2 + _CLEAR_MM)
    clear &= ~shapely.intersects(boxes, shapely.MultiPolygon([label.box for label in there]).buffer(0))
    best = clear & shapely.contains(inside, boxes)
    # Over the outline if need be; on ink only where there is nothing else for 15 mm round.
    choice = best if best.any() else clear
    return Label("sensor", sensor.id, places[int(np.argmax(choice))])


def _seam(side: SeamSide, inside: shapely.Polygon, ink: shapely.MultiLineString, bead: float, there: Sequence[Label]) -> Label | None:
    """Beside the seam, at its notch or as near to that as it covers nothing: inside the piece rather than outside."""
    length = float(np.hypot(*np.diff(side.points, axis=0).T).sum())
    notched = Label("seam", side.label, side.notch + (NOTCH_MM + 0.6 * TEXT_MM) * side.inward)
    if not side.label or length < notched.width:
        return None
    places, inward, away = _beside(side)
    ins, outs = places + _OFF_SEAM_MM * inward, places - _OFF_SEAM_MM * inward
    at = np.vstack([notched.at[None], ins, side.notch - _OFF_SEAM_MM * side.inward[None], outs])
    cost = np.concatenate([[0.0], away, [_OUTSIDE_MM], away + _OUTSIDE_MM])
    is_in = np.arange(len(at)) <= len(ins)
    order = np.argsort(cost.round(6), kind="stable")
    at, is_in = at[order], is_in[order]
    half = np.array([notched.width, notched.height]) / 2
    boxes = shapely.box(*(at - half).T, *(at + half).T)
    free = ~shapely.intersects(boxes, shapely.MultiPolygon([label.box for label in there]).buffer(0))
    shapely.prepare(ink)
    off_ink = np.asarray(~shapely.dwithin(ink, boxes, bead / 2 + _CLEAR_MM))
    # Over no outline: outside may be the other flank of a dart.
    beside = np.where(is_in, shapely.contains(inside, boxes), shapely.disjoint(inside, boxes))
    # Better over a line than over ink, and better over ink than nowhere, on white.
    for fits in (free & off_ink & beside, free & off_ink & is_in, free & is_in):
        if fits.any():
            best = int(np.argmax(fits))
            return Label("seam", side.label, at[best], over_ink=not off_ink[best])
    return None


def _beside(side: SeamSide) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Places along a seam, (k, 2) mm, the directions into the piece there, and how far from the notch they are, mm."""
    steps = np.diff(side.points, axis=0)
    lengths = np.hypot(*steps.T)
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    ahead = steps / np.maximum(lengths, np.finfo(float).tiny)[:, None]
    from_start = side.notch - side.points[:-1]
    on_step = np.clip(np.sum(from_start * ahead, axis=1), 0, lengths)
    k = int(np.argmin(np.hypot(*(from_start - on_step[:, None] * ahead).T)))
    notch = along[k] + on_step[k]
    # Not so near to the ends that a number would stand for the next seam.
    low, high = max(notch - _ALONG_MM, TEXT_MM / 2), min(notch + _ALONG_MM, along[-1] - TEXT_MM / 2)
    t = np.arange(low, high, 0.5)
    on = np.clip(np.searchsorted(along, t, side="right") - 1, 0, len(steps) - 1)
    places = side.points[on] + (t - along[on])[:, None] * ahead[on]
    # The outline is counter-clockwise.
    return places, np.stack([-ahead[on][:, 1], ahead[on][:, 0]], axis=1), np.abs(t - notch)
