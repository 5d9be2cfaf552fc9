"""Ink keeps off ink that was laid before: no bead is crossed or retraced, and no nozzle comes down into one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from gcode.check_height import STEP_XY, bead_radius
from gcode.clearance import chords
from gcode.geometry import Curve
from gcode.moves import Finding, Move, Trace
from gcode.printer import Printer
from skinfab.tolerances import INK_CHORD_MM

#: Within a stroke, ink may be near to what was laid less than so many bead radii before, counted along the path: there
#: it turns. A half turn whose ends are a radius apart takes pi/2 of it, a corner of 30 degrees less than 4; a sharper one
#: lies on itself.
TURN = 4.0

#: Where a stroke ends upon its own beginning, as a ring does that closes, its last so many bead radii may be near to its first: a
#: ring that ends on its start meets it within one radius, one with a corner of 42 degrees there within one and a half.
CLOSE = 1.5

#: Pieces that are compared among themselves at once: even where all lie on one heap, their pairs stay a small table.
_AT_ONCE = 1024

#: Chords leave their arcs, and joined pieces what they join, by so much each, of two pieces; and places are rounded.
_SLACK = 4 * INK_CHORD_MM + STEP_XY


@dataclass(frozen=True, eq=False)
class Pieces:
    """Straight pieces of beads in the order they are laid, and places the nozzle comes down at: beads of radius 0.

    Parameters
    ----------
    ends : (n, 2, 2), mm
    radius : (n,), mm
    stroke : (n,) int
        Which stroke it is of: ink without a break.
    begin, end : (n,), mm
        Its way along the stroke.
    move : (n,) int
        Which move of the trace it is of.
    """

    ends: NDArray[np.float64]
    radius: NDArray[np.float64]
    stroke: NDArray[np.int64]
    begin: NDArray[np.float64]
    end: NDArray[np.float64]
    move: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.radius)

    def __getitem__(self, which: NDArray[np.int64] | slice) -> Pieces:
        return Pieces(*(getattr(self, f.name)[which] for f in fields(self)))


def ink_findings(judged: Trace, laid: Pieces) -> Iterator[Finding]:
    """Moves that lay ink upon ink or come down into it, in their order; each is compared with faultless ink before it.

    Beads of two strokes must not touch. Within a stroke, where the rows of a pad lie closer than a bead is wide, no
    centre line may enter a bead laid before, but for the neighbour along the path (`TURN`), and the end of a ring upon its
    start (`CLOSE`). Beads are taken as round.

    Examples
    --------
    >>> from gcode.printer import load_printer
    >>> from gcode.trace import trace
    >>> text = "G28 X Y\\nM83\\nM302 P1\\nG0 X10 Y10 Z1.6 F300\\nG1 X20 E40 F240\\nG1 Y12 E8\\nG1 X15 E20\\nG1 Y5 E28"
    >>> judged = trace(text)
    >>> print(*ink_findings(judged, laid_pieces(judged, load_printer())))
    line 8: near X15.00 Y5.00 it lays ink 0.00 mm from the wet ink of line 5, centre to centre, where 0.37 is needed; \
move one of the two away, or print one of them alone
    """
    pieces = _joined(laid)
    for later, earlier, near, need in _meetings(pieces):
        order = np.lexsort((near, pieces.move[later]))
        _, first = np.unique(pieces.move[later[order]], return_index=True)
        for k in order[first]:
            at, on = (judged.moves[pieces.move[which[k]]] for which in (later, earlier))
            x, y = pieces.ends[later[k], 1]
            yield _finding(at, on, (float(x), float(y)), float(near[k]), float(need[k]))


def _finding(at: Move, on: Move, place: tuple[float, float], near: float, need: float) -> Finding:
    x, y = place
    if not at.is_planar:
        what = f"at X{x:.2f} Y{y:.2f} it comes down into the wet ink of line {on.line}, {near:.2f} mm from its centre line"
        return Finding(at.line, what, f"come down {need:.2f} mm or more beside it", at.pattern)
    what = (
        f"near X{x:.2f} Y{y:.2f} it lays ink {near:.2f} mm from the wet ink of line {on.line}, centre to centre, where {need:.2f} is needed"
    )
    return Finding(at.line, what, "move one of the two away, or print one of them alone", at.pattern)


def laid_pieces(judged: Trace, printer: Printer) -> Pieces:
    """All ink of a trace, and the places where the nozzle comes down."""
    ends: list[Sequence[float]] = []
    counts: list[int] = []  # pieces of each of these moves
    moves: list[int] = []
    strokes: list[int] = []
    stroke = 0
    for k, move in enumerate(judged.moves):
        shape = move.shape
        inked = shape is not None and move.e > 0
        if isinstance(shape, Curve) and inked:
            before = len(ends)
            ends += chords([shape], INK_CHORD_MM).reshape(-1, 4).tolist()
            counts.append(len(ends) - before)
        elif shape is not None and inked:
            ends.append(shape.start + shape.end)
            counts.append(1)
        elif shape is None and _descends(move, printer):
            ends.append((move.end[0] or 0.0, move.end[1] or 0.0) * 2)
            counts.append(1)
        else:
            stroke += shape is not None  # it leaves the bead
            continue
        stroke += not inked
        moves.append(k)
        strokes.append(stroke)
        stroke += not inked
    table = np.array(ends, dtype=float).reshape(-1, 2, 2)
    radii = np.array([bead_radius(judged.moves[k], printer) for k in moves])
    of = np.repeat(np.array(strokes, dtype=np.int64), counts)
    lengths = np.hypot(*(table[:, 1] - table[:, 0]).T)
    end = np.cumsum(lengths)
    begin = end - lengths
    start = begin[np.searchsorted(of, of)]  # strokes are counted upward
    return Pieces(table, np.repeat(radii, counts), of, begin - start, end - start, np.repeat(np.array(moves, dtype=np.int64), counts))


def _descends(move: Move, printer: Printer) -> bool:
    start, end = move.start[2], move.end[2]
    low = end is not None and end < printer.heights.travel - STEP_XY and (start is None or end < start)
    return low and None not in move.end[:2]


def _joined(pieces: Pieces) -> Pieces:
    """Runs of pieces shorter than ``2 * INK_CHORD_MM`` in all as one, so that none has a great many neighbours."""
    if not len(pieces):
        return pieces
    width = 2 * INK_CHORD_MM
    here, there = np.floor(pieces.begin / width), np.floor(pieces.end / width)
    within = (here == there) & (pieces.radius > 0)
    alike = within[1:] & within[:-1] & (here[1:] == here[:-1]) & (pieces.stroke[1:] == pieces.stroke[:-1])
    first = np.flatnonzero(np.concatenate([[True], ~alike]))
    last = np.append(first[1:], len(pieces)) - 1
    lengths = pieces.end - pieces.begin
    total = np.add.reduceat(lengths, first)
    ink = np.add.reduceat(pieces.radius**2 * lengths, first)
    radius = np.sqrt(ink / np.where(total > 0, total, 1.0))
    ends = np.stack([pieces.ends[first, 0], pieces.ends[last, 1]], axis=1)
    return Pieces(ends, radius, pieces.stroke[first], pieces.begin[first], pieces.end[last], pieces.move[last])


def _meetings(
    pieces: Pieces,
) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]]:
    """Faulty pairs (later, earlier, distance, needed), batch by batch.

    Faultless pieces before a batch are kept in trees of ever smaller size, two of one size being made one, so that
    each piece is put into few trees. Faulty ones are left out: were they a heap, each would meet all others.
    """
    import shapely

    grown = pieces.radius[:, None]
    corners = [np.minimum(*pieces.ends.swapaxes(0, 1)) - grown, np.maximum(*pieces.ends.swapaxes(0, 1)) + grown]
    boxes = np.asarray(shapely.linestrings(np.stack(corners, axis=1)))  # the trees ask for no more of a box than its corners
    trees: list[tuple[NDArray[np.int64], shapely.STRtree]] = []
    for start in range(0, len(pieces), _AT_ONCE):
        batch = np.arange(start, min(start + _AT_ONCE, len(pieces)))
        pairs = [(batch[a], of[b]) for of, tree in [*trees, (batch, shapely.STRtree(boxes[batch]))] for a, b in [tree.query(boxes[batch])]]
        later, earlier = (np.concatenate(side) for side in zip(*pairs, strict=True))
        near, need = _distances(pieces, later, earlier)
        met = near < need
        if np.any(met):
            yield later[met], earlier[met], near[met], need[met]
        kept = np.setdiff1d(batch, later[met])
        while trees and len(trees[-1][0]) <= len(kept):
            kept = np.concatenate([trees.pop()[0], kept])
        trees.append((kept, shapely.STRtree(boxes[kept])))


def _distances(pieces: Pieces, later: NDArray[np.int64], earlier: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What lies between pieces and what must, mm; pairs that need not keep apart at all have infinite distance."""
    near = np.full(len(later), np.inf)
    same = pieces.stroke[later] == pieces.stroke[earlier]
    need = pieces.radius[earlier] + np.where(same, 0.0, pieces.radius[later]) - _SLACK
    # The way along the path from which on they must keep apart.
    apart = np.where(same, TURN * pieces.radius[earlier], -np.inf)
    asked = (earlier < later) & (pieces.radius[earlier] > 0) & (need > 0) & (pieces.end[later] - pieces.begin[earlier] > apart)
    asked = np.flatnonzero(asked)
    near[asked] = distance_apart(pieces[earlier[asked]], pieces[later[asked]], apart[asked])
    _let_close(pieces, later, earlier, near, np.flatnonzero(same & (near < need)), apart)
    return near, need


def _let_close(
    pieces: Pieces,
    later: NDArray[np.int64],
    earlier: NDArray[np.int64],
    near: NDArray[np.float64],
    met: NDArray[np.int64],
    apart: NDArray[np.float64],
) -> None:
    """Measure the pairs `met` anew without what `CLOSE` lets be: the end of a stroke against its own beginning.

    All other pairs of places have their later one before that end, or their earlier one behind that beginning.
    """
    length = pieces.end[np.searchsorted(pieces.stroke, pieces.stroke[later[met]], side="right") - 1]
    spare = CLOSE * pieces.radius[earlier[met]]
    ring = np.flatnonzero((pieces.end[later[met]] > length - spare) & (pieces.begin[earlier[met]] < spare))
    met, length, spare = met[ring], length[ring], spare[ring]
    first, last = pieces[earlier[met]], pieces[later[met]]
    near[met] = np.minimum(
        _distance_if_any(first, _within(last, -np.inf, length - spare), apart[met]),
        _distance_if_any(_within(first, spare, np.inf), last, apart[met]),
    )


def _within(pieces: Pieces, low: NDArray[np.float64] | float, high: NDArray[np.float64] | float) -> Pieces:
    """What of each lies between two places along its stroke; its end is before its beginning where nothing does."""
    begin, end = np.maximum(pieces.begin, low), np.minimum(pieces.end, high)
    way = (pieces.end - pieces.begin)[:, None]
    along = pieces.ends[:, 1] - pieces.ends[:, 0]
    cut = [pieces.ends[:, 0] + _ratio((at - pieces.begin)[:, None] * along, np.broadcast_to(way, along.shape)) for at in (begin, end)]
    return replace(pieces, ends=np.stack(cut, axis=1), begin=begin, end=end)


def _distance_if_any(a: Pieces, b: Pieces, apart: NDArray[np.float64]) -> NDArray[np.float64]:
    near = np.full(len(a), np.inf)
    some = np.flatnonzero((a.begin < a.end) & (b.begin < b.end) & (b.end - a.begin > apart))
    near[some] = distance_apart(a[some], b[some], apart[some])
    return near


def distance_apart(a: Pieces, b: Pieces, apart: NDArray[np.float64]) -> NDArray[np.float64]:
    """Least distance, mm, of places on pieces `a` from places on pieces `b` that come `apart` mm later or more, one by one.

    With u and v the ways along both, |p(u) - q(v)| is convex, and v - u >= apart cuts a half-plane out: the least is
    that of the whole pieces, or where it is cut off, it lies on the cut, v = u + apart, where the difference is linear.
    """
    p, q = a.ends[:, 0], b.ends[:, 0]
    along_p, along_q = a.ends[:, 1] - p, b.ends[:, 1] - q
    s, t = _closest(p, along_p, q, along_q)
    near = np.linalg.norm(p + s[:, None] * along_p - q - t[:, None] * along_q, axis=1)
    way_a, way_b = a.end - a.begin, b.end - b.begin
    cut = np.flatnonzero(b.begin + t * way_b - (a.begin + s * way_a) < apart)
    step_p, step_q = along_p[cut] / way_a[cut, None], along_q[cut] / way_b[cut, None]
    low = np.maximum(a.begin[cut], b.begin[cut] - apart[cut])
    high = np.minimum(a.end[cut], b.end[cut] - apart[cut])
    at_low = p[cut] + (low - a.begin[cut])[:, None] * step_p - q[cut] - (low + apart[cut] - b.begin[cut])[:, None] * step_q
    change = step_p - step_q
    on = np.clip(_ratio(-_dot(at_low, change), _dot(change, change)), 0.0, np.maximum(high - low, 0.0))
    near[cut] = np.linalg.norm(at_low + on[:, None] * change, axis=1)
    return near


def _closest(
    p: NDArray[np.float64], along_p: NDArray[np.float64], q: NDArray[np.float64], along_q: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where two straight pieces are closest, as fractions of each (Ericson, Real-Time Collision Detection, 5.1.9)."""
    r = p - q
    a, e, b = _dot(along_p, along_p), _dot(along_q, along_q), _dot(along_p, along_q)
    c, f = _dot(along_p, r), _dot(along_q, r)
    s = np.clip(_ratio(b * f - c * e, a * e - b * b), 0.0, 1.0)
    t = np.clip(_ratio(b * s + f, e), 0.0, 1.0)
    return np.clip(_ratio(b * t - c, a), 0.0, 1.0), t


def _dot(u: NDArray[np.float64], v: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.einsum("ij,ij->i", u, v))


def _ratio(above: NDArray[np.float64], below: NDArray[np.float64]) -> NDArray[np.float64]:
    """Their quotient, 0 where there is nothing below."""
    return np.divide(above, below, out=np.zeros_like(above), where=below > 0)
