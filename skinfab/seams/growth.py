"""Darts into one disk until it keeps to a bound, each where and as long as it gains the most for its length.

A cut leaves the layout as it is, only free to do better: every layout is begun with the one before. Where a disk that
keeps to the bound covers itself, it is laid out anew without overlap, and goes on with the boundary kept apart.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.bijective import flatten_bijective, keep_apart
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import measure, quantiles
from skinfab.flatten.isometric import Apart, IsometricSolver
from skinfab.flatten.overlap import overlap_area
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import OpenPiece, mesh_edges, open_pieces
from skinfab.seams.darts import dart_ways
from skinfab.seams.release import Way, held_releases, releases, right_of

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

#: Spots that a dart is looked for at, no two nearer than this part of the root of the area; more where none will do.
_CANDIDATES, _SPREAD = 12, 0.1
_MORE = 9

#: Of so many the gain is foretold in full.
_SOLVED = 6

#: A dart is worth what it gains over its length to this power: under 1, so that one long dart may take the place of two.
_LENGTH_POWER = 0.5

#: Gain beyond what is wanted counts for nothing; what is foretold is not all had, so this much more is wanted.
_WANTED = 1.25

#: A shorter dart is worth no more for that, in parts of the root of the area: many tiny ones would follow.
_SHORT = 0.05

#: Once this part of the first excess of d is left, starts can be compared: ...
_SETTLED = 0.1

#: ... one whose darts are this many times as long as another's for the same mean d hardly makes up for it.
_BEHIND = 1.15

#: A piece with this many darts is better parted.
_MOST_DARTS = 60

#: In the search d is known to 1 % of what is above 4.
_DECREASE = 1e-2

#: Sides of a fresh cut begin this part of the barrier's reach off their place, each way; less where triangles are too thin.
_GAPS = (0.25, 0.03, 0.004)


@dataclass(frozen=True, eq=False)
class Dart:
    """A dart, and what it was cut for.

    Parameters
    ----------
    edges : (k,) int64
        Of the mesh.
    mean : float
        The piece's mean d before.
    length : float, mm
    """

    edges: IntArray
    mean: float
    length: float


@dataclass(frozen=True, eq=False)
class Grown:
    """A disk with darts.

    Parameters
    ----------
    darts : tuple of Dart
        In the order that they were cut.
    length : float, mm
        Of all of them.
    piece : OpenPiece
    UV : (n, 2) float64, mm
    mean : float
        Its mean d.
    apart : bool
        Laid out with its boundary kept apart.
    good : bool
        It keeps to the bound, and does not cover itself.
    """

    darts: tuple[Dart, ...]
    length: float
    piece: OpenPiece
    UV: FloatArray
    mean: float
    apart: bool
    good: bool

    def length_at(self, mean: float) -> float:
        """Length of the first of its darts that brought the mean d down to `mean`; endless where none did."""
        if self.mean > mean:
            return np.inf
        return sum(dart.length for dart in self.darts if dart.mean > mean)


def lay_out(mesh: Mesh, piece: OpenPiece) -> Grown:
    """A disk at its least d, without darts yet."""
    V = mesh.V[piece.vertices]
    uv = flatten_isometric(V, piece.F, topology=piece.topology, tolerance=_DECREASE)
    return Grown((), 0.0, piece, uv, measure(V, piece.F, uv, topology=piece.topology).mean, False, False)


def grow_darts(
    mesh: Mesh,
    start: Grown,
    bound: float,
    weight: FloatArray,
    *,
    cut: BoolArray,
    forbidden: BoolArray,
    p99: float = np.inf,
    rival: Grown | None = None,
) -> Grown:
    """Cut darts until the mean d is at most `bound`, and 99 % of the area keep to `p99`.

    Parameters
    ----------
    mesh : Mesh
    start : Grown
        Laid out freely: goes on so. Laid out apart: keeps its boundary apart.
    bound, p99 : float
    weight : (e,) float
        Cost of cutting each mesh edge.
    cut : (e,) bool
        What bounds the disk without its darts.
    forbidden : (e,) bool
        Never cut.
    rival : Grown, optional
        Give up when its darts were much shorter for the same mean d.

    Returns
    -------
    Grown
        Not `good` where it still covers itself, nothing helps any more, or the rival is ahead.
    """
    now, cut = start, cut.copy()
    for dart in start.darts:
        cut[dart.edges] = True
    solver = IsometricSolver(mesh.V[now.piece.vertices], now.piece.F)
    while (now.mean > bound or _exceeds(solver, now.UV, p99)) and len(now.darts) < _MOST_DARTS:
        # Hot spots have no say in the mean: once it keeps to its bound, the dart that gains most of what is above 4.
        way = _best_dart(mesh, now, solver, bound if now.mean > bound else 4.0, weight, forbidden)
        if way is None:
            return now
        edges = mesh_edges(mesh, now.piece, way.edges)
        cut[edges] = True
        parts = open_pieces(mesh, cut, faces=now.piece.faces)
        if rival is not None and now.mean - 4 < _SETTLED * (start.mean - 4) and now.length > _BEHIND * rival.length_at(now.mean):
            return now
        if len(parts) != 1:  # the boundary touches itself there
            return now
        now, solver = _opened(mesh, now, parts[0], way, edges)
    flat = now.apart or overlap_area(now.piece.F, now.UV, topology=now.piece.topology) == 0
    return replace(now, good=bool(now.mean <= bound and not _exceeds(solver, now.UV, p99) and flat))


def laid_apart(mesh: Mesh, grown: Grown) -> Grown:
    """The same piece at its least d without overlap."""
    piece, V = grown.piece, mesh.V[grown.piece.vertices]
    uv = flatten_bijective(V, piece.F, topology=piece.topology, tolerance=_DECREASE)
    return replace(grown, UV=uv, mean=measure(V, piece.F, uv, topology=piece.topology).mean, apart=True)


def _best_dart(mesh: Mesh, now: Grown, solver: IsometricSolver, bound: float, weight: FloatArray, forbidden: BoolArray) -> Way | None:
    """From the boundary to the tip, or None where no dart gains anything."""
    topology = now.piece.topology
    d = _d_of(solver, now.UV)
    size = float(np.sqrt(mesh.face_areas[now.piece.faces].sum()))
    apart = keep_apart(mesh.V[now.piece.vertices], topology) if now.apart else None
    wanted = _WANTED * (now.mean - bound)
    for times in (1, _MORE):
        ways = dart_ways(mesh, now.piece, d, weight, count=times * _CANDIDATES, apart=_SPREAD * size / np.sqrt(times))

        def worth(gains: list[FloatArray], ways: list[Way]) -> list[FloatArray]:
            return [_worth(mesh, now.piece, way, gain, wanted, forbidden) for way, gain in zip(ways, gains, strict=True)]

        rough = [value.max() for value in worth(held_releases(solver, now.UV, topology, ways), ways)]
        ways = [ways[k] for k in np.argsort(rough)[::-1][: times * _SOLVED] if rough[k] > 0]
        if not ways:
            continue
        values = worth(releases(solver, now.UV, topology, ways, apart=apart), ways)
        best = int(np.argmax([value.max() for value in values]))
        if (k := int(np.argmax(values[best]))) >= 0 and values[best][k] > 0:
            end = int(ways[best].ends[k])
            return Way(ways[best].vertices[: end + 1], ways[best].edges[:end])
    return None


def _worth(mesh: Mesh, piece: OpenPiece, way: Way, gains: FloatArray, wanted: float, forbidden: BoolArray) -> FloatArray:
    """Of the dart to each of a way's ends."""
    edges = mesh_edges(mesh, piece, way.edges)
    length = np.cumsum(mesh.edge_lengths[edges])[way.ends - 1]
    allowed = np.cumsum(forbidden[edges])[way.ends - 1] == 0
    size = float(np.sqrt(mesh.face_areas[piece.faces].sum()))
    value: FloatArray = np.minimum(gains, wanted) / np.maximum(length, _SHORT * size) ** _LENGTH_POWER * allowed
    return value


def _opened(mesh: Mesh, now: Grown, piece: OpenPiece, way: Way, edges: IntArray) -> tuple[Grown, IsometricSolver]:
    """The piece with a dart along `way` cut, laid out from where it was."""
    V = mesh.V[piece.vertices]
    solver = IsometricSolver(V, piece.F)
    uv = np.empty((len(V), 2))
    uv[piece.F.ravel()] = now.UV[now.piece.F.ravel()]
    if now.apart:
        apart = keep_apart(V, piece.topology)
        parted = _parted(solver, piece, uv, now, way, apart)
        if parted is None:
            uv = flatten_bijective(V, piece.F, topology=piece.topology, tolerance=_DECREASE)
        else:
            uv = solver.refine(parted, tolerance=_DECREASE, apart=apart).UV
    else:
        uv = solver.refine(uv, tolerance=_DECREASE).UV
    mean = float((_d_of(solver, uv) * solver.weight).sum())
    dart = Dart(edges, now.mean, float(mesh.edge_lengths[edges].sum()))
    return Grown((*now.darts, dart), now.length + dart.length, piece, uv, mean, now.apart, False), solver


def _parted(solver: IsometricSolver, piece: OpenPiece, uv: FloatArray, now: Grown, way: Way, apart: Apart) -> FloatArray | None:
    """The sides of a fresh cut a little off each other, as a barrier cannot part what touches; None where there is no room."""
    path, old = way.vertices, now.piece.topology
    place = np.full(len(now.UV), -1)
    place[path[:-1]] = np.arange(len(path) - 1)
    right = np.zeros(len(piece.F), dtype=bool)
    right[right_of(path, way.edges, old.F, old.FE, old.EF)] = True
    corners = np.flatnonzero(place[now.piece.F.ravel()] >= 0)
    along = np.gradient(now.UV[path], axis=0)
    left = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.maximum(np.linalg.norm(along, axis=1), np.finfo(float).tiny)[:, None]
    off = np.zeros_like(uv)
    off[piece.F.ravel()[corners]] = left[place[now.piece.F.ravel()[corners]]] * np.where(right[corners // 3], -1.0, 1.0)[:, None]
    for share in _GAPS:
        moved = uv + share * apart.reach * off
        if solver.best_scale(moved)[1] > 0 and overlap_area(piece.F, moved, topology=piece.topology) == 0:
            return moved
    return None


def _exceeds(solver: IsometricSolver, UV: FloatArray, p99: float) -> bool:
    """Whether more than a hundredth of the area is distorted by more."""
    return p99 < np.inf and quantiles(_d_of(solver, UV), solver.weight, (0.99,))[0] > p99


def _d_of(solver: IsometricSolver, UV: FloatArray) -> FloatArray:
    """(m,) d of each triangle."""
    J = np.einsum("fkc,fkd->fcd", UV[solver.F], solver.gradients)
    square, det = (J**2).sum(axis=(1, 2)), J[:, 0, 0] * J[:, 1, 1] - J[:, 0, 1] * J[:, 1, 0]
    d: FloatArray = square + square / det**2
    return d
