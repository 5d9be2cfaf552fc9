"""What meets what: the outlines of the flat pieces, broken into seam sides that are sewn to each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from skinfab.pieces import Piece


@dataclass(frozen=True, eq=False)
class SeamSide:
    """A run of one piece's outline that meets one other run, or nothing.

    Parameters
    ----------
    label : str
        "1", "2", ...: the same on both sides of a seam; empty on the object's own border.
    kind : "seam", "dart" or "border"
        Meets another piece, its own piece, or nothing (the object is open there).
    piece : int
        Position of the piece.
    points : (k, 2) float64, mm
        The run in the piece frame, in the direction of the outline.
    notch : (2,) float64, mm
        A point of the run that is one and the same point of the object on both sides.
    inward : (2,) float64
        Unit vector from the notch into the piece.
    """

    label: str
    kind: Literal["seam", "dart", "border"]
    piece: int
    points: NDArray[np.float64]
    notch: NDArray[np.float64]
    inward: NDArray[np.float64]


def seam_sides(pieces: Sequence[Piece]) -> list[SeamSide]:
    """The seam sides of all pieces, outline by outline.

    Parameters
    ----------
    pieces : sequence of Piece
        Of one mesh: their `vertices` tell which outline edges were opened from the same mesh edge.

    Examples
    --------
    >>> F, UV = np.array([[0, 1, 2]]), np.array([[0.0, 0], [4, 0], [0, 3]])
    >>> left = Piece("P1", np.array([0]), np.array([0, 1, 2]), F, UV)
    >>> right = Piece("P2", np.array([1]), np.array([1, 0, 3]), F, UV)
    >>> [(side.label, side.kind, side.piece) for side in seam_sides([left, right])]
    [('1', 'seam', 0), ('', 'border', 0), ('1', 'seam', 1), ('', 'border', 1)]
    """
    loops = [piece.topology.boundary_loops[0] for piece in pieces]
    at: dict[tuple[int, int], tuple[int, int]] = {}  # mesh vertices from, to -> piece, position on its outline
    for p, (piece, loop) in enumerate(zip(pieces, loops, strict=True)):
        ids = piece.vertices[loop]
        for k, edge in enumerate(zip(ids.tolist(), np.roll(ids, -1).tolist(), strict=True)):
            at[edge] = (p, k)
    partner = {here: at.get((b, a)) for (a, b), here in at.items()}
    labels: dict[tuple[int, int], str] = {}
    notches: dict[tuple[int, int], int] = {}  # outline edge -> which edge of its run has the notch
    sides = []
    for p, loop in enumerate(loops):
        for run in _runs(p, len(loop), loops, partner):
            meets = partner[(p, run[0])]
            label = labels.get((p, run[0]), "")
            if meets is not None and not label:
                label = str(len(set(labels.values())) + 1)
                middle = run[_middle(pieces[p].UV[loop[np.r_[run, (run[-1] + 1) % len(loop)]]])]
                opposite = partner[(p, middle)]
                for k in run:
                    other = partner[(p, k)]
                    assert other is not None and opposite is not None  # a run is sewn along its whole length
                    labels[(p, k)] = labels[other] = label
                    notches[(p, k)] = middle
                    notches[other] = opposite[1]
            kind: Literal["seam", "dart", "border"] = "border" if meets is None else "dart" if meets[0] == p else "seam"
            notch = notches.get((p, run[0]), run[len(run) // 2])
            sides.append(_side(label, kind, p, pieces[p].UV[loop], run, notch))
    return sides


def _runs(p: int, n: int, loops: list[NDArray[np.int64]], partner: dict[tuple[int, int], tuple[int, int] | None]) -> list[list[int]]:
    """Positions of the outline's edges, grouped: in a run, what it meets is a run too, backwards."""

    def breaks(k: int) -> bool:
        before, here = partner[(p, (k - 1) % n)], partner[(p, k)]
        if before is None or here is None:
            return before is not here
        # At the tip of a dart two neighbours meet each other.
        return before == (p, k) or before[0] != here[0] or before[1] != (here[1] + 1) % len(loops[here[0]])

    starts = [k for k in range(n) if breaks(k)] or [0]
    ends = [*starts[1:], starts[0] + n]
    return [[k % n for k in range(a, b)] for a, b in zip(starts, ends, strict=True)]


def _middle(points: NDArray[np.float64]) -> int:
    """Which segment of the polyline has half its length."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    return int(np.clip(np.searchsorted(along, along[-1] / 2) - 1, 0, len(points) - 2))


def _side(
    label: str, kind: Literal["seam", "dart", "border"], p: int, outline: NDArray[np.float64], run: list[int], notch: int
) -> SeamSide:
    n = len(outline)
    a, b = outline[notch], outline[(notch + 1) % n]
    along = (b - a) / max(float(np.hypot(*(b - a))), np.finfo(float).tiny)
    inward = np.array([-along[1], along[0]])  # the outline is counter-clockwise
    return SeamSide(label, kind, p, outline[[*run, (run[-1] + 1) % n]], (a + b) / 2, inward)
