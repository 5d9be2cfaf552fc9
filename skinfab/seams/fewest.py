"""The fewest pieces, and little seam: a short slit, then dart after dart; in the end what can be spared is closed again.

The darts are found on a mesh of some 1000 triangles, from a few starts. A finer mesh is bent less by each of its triangles
and shows less d: there as much seam is closed again, or a few more darts are cut, as it takes to use the bound to the full.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.seams.coarse import coarsen, transfer
from skinfab.seams.creases import without_scraps
from skinfab.seams.cut import OpenPiece, mesh_edges, open_pieces
from skinfab.seams.disk import cut_to_disk, far_points
from skinfab.seams.glue import glue_pieces
from skinfab.seams.graph import edge_graph, shortest_tree, trace
from skinfab.seams.growth import grow
from skinfab.seams.judge import Limits, verdict_of
from skinfab.seams.polish import exchange
from skinfab.seams.refine import Judged, refine_seams
from skinfab.seams.rules import EdgeRules, coarse_rules
from skinfab.seams.sheet import Sheet, Surface, lay_apart, lay_out, sheet_of
from skinfab.seams.straighten import straightened
from skinfab.seams.weights import seam_weights
from skinfab.tolerances import SEARCH_DECREASE, SEARCH_GRID, SEARCH_SIZE

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

#: Darts are found on about this many triangles, ...
_COARSE_FACES = 1000

#: ... and tried on at most about this many.
_MIDDLE_FACES = 8000

#: Places of the first slit in a closed piece that are tried, far from each other.
_STARTS = 3

#: They are compared when so many times the d above 4 is left that the bound allows; the best goes on alone.
_COMPARED = 2.0

#: Seams of coarse triangles are drawn straight on fine ones within so many lengths of their edges.
_REACH = 1.0

#: The first slit is this part of the root of the area long: just enough to lay the rest out.
_SLIT = 0.25

#: What covers itself is parted where that is quick: on the coarse mesh if the finer one has so many times its triangles.
_MUCH_FINER = 2.0

#: A finer mesh shows about this part of the d above 4 that a coarse one does; a much finer one, this.
_FINER_SHOWS, _MUCH_FINER_SHOWS = 0.88, 0.75

#: What is left above the bound when a sheet is laid apart weighs, for as much as the bound allows above 4, so many roots of the area.
_EXCESS = 1.5

#: Other starts are looked at where it is more than this part of what the bound allows above 4.
_LITTLE = 0.2

#: How often an end of a seam is tried elsewhere.
_ROUNDS = 8

#: ... and once more on a finer mesh, where keeping it from covering itself took more seam.
_LAST_ROUNDS = 3


@dataclass(frozen=True, eq=False)
class _Level:
    """One resolution of the surface, and what a person's marks mean on it."""

    mesh: Mesh
    weight: FloatArray
    locked: BoolArray
    forbidden: BoolArray


@dataclass(frozen=True, eq=False)
class _Part:
    """What lies between locked seams, as a surface of its own.

    Parameters
    ----------
    piece : OpenPiece
    surface : Surface
        Its edges in the order of the piece's topology.
    edges : (e,) int64
        The mesh's.
    """

    piece: OpenPiece
    surface: Surface
    edges: IntArray


def fewest_seams(
    mesh: Mesh,
    limits: Limits,
    *,
    neck: float = 4.0,
    rules: EdgeRules | None = None,
    progress: Callable[[float], None] | None = None,
) -> tuple[BoolArray, list[Judged]]:
    """Seams that leave as few pieces as can be, and are short: locked seams and components apart, mostly one.

    Parameters
    ----------
    mesh : Mesh
        Manifold, consistently wound; closed or open, any genus, any number of components.
    limits : Limits
    neck : float, mm
        Pieces are not joined across less than this.
    rules : EdgeRules, optional
    progress : callable, optional
        Called with the part that is done, 0 to 1; what it raises ends the search.

    Returns
    -------
    cut : (e,) bool
    pieces : list of (OpenPiece, Verdict)

    Raises
    ------
    InputError, RefusedError
        As `refine_seams`, which has the last word.
    """
    report = progress or (lambda done: None)
    unit, scale = _of_one_size(mesh)
    fine = _level(unit, unit, rules)
    middle = fine if (some := coarsen(unit, _MIDDLE_FACES)) is unit else _level(unit, some, rules)
    small = middle if (few := coarsen(some, _COARSE_FACES)) is some else _level(unit, few, rules)
    much_finer = len(middle.mesh.F) > _MUCH_FINER * len(small.mesh.F)
    shown = 1.0 if small is middle else _MUCH_FINER_SHOWS if much_finer else _FINER_SHOWS
    last, bound = small is middle or much_finer, 4 + (limits.mean - 4) / shown
    parts = _parts(small)
    sheets = [
        _searched(part.surface, bound, last=last, report=lambda done, k=k: report(0.6 * (k + done) / len(parts)))  # type: ignore[misc]
        for k, part in enumerate(parts)
    ]
    if small is not middle:
        cut = _carried(small, _cut_of(small, parts, sheets), middle)
        parts = _parts(middle)
        sheets = [_laid_out(sheet_of(part.surface, _one_disk(part.surface, cut[part.edges]))) for part in parts]
    for k, sheet in enumerate(sheets):
        report(0.6 + 0.2 * k / len(parts))
        sheets[k] = None if sheet is None else _settled(sheet, limits)
    cut = _cut_of(middle, parts, sheets)
    pieces: list[Judged] = []
    if middle is fine:
        opened = {int(piece.faces[0]): piece for piece in open_pieces(mesh, cut)}
        pieces = [
            _judged(mesh, opened[int(part.piece.faces[0])], sheet, scale, limits)
            for part, sheet in zip(parts, sheets, strict=True)
            if sheet is not None
        ]
    if len(pieces) < len(parts) or not all(verdict.accepted for _, verdict in pieces):
        forbidden = None if rules is None else rules.forbidden
        cut, pieces = refine_seams(
            mesh,
            _carried(middle, cut, fine),
            limits,
            scale * fine.weight,
            tolerance=SEARCH_DECREASE,
            forbidden=forbidden,
            progress=lambda done: report(0.8 + 0.2 * done),
        )
    locked = None if rules is None else rules.locked
    return glue_pieces(mesh, cut, pieces, limits, neck=neck, excess=np.inf, tolerance=SEARCH_DECREASE, locked=locked)


def _of_one_size(mesh: Mesh) -> tuple[Mesh, float]:
    """The mesh about the origin at the size of the search, its vertices on a grid, and mm for each of its units of length.

    The seams of an object are so the same in any unit and wherever it lies, for all that roundings differ.
    """
    scale = float(np.sqrt(mesh.area)) / SEARCH_SIZE
    V = (mesh.V - mesh.V.mean(axis=0)) / scale
    return Mesh(np.round(V / SEARCH_GRID) * SEARCH_GRID, mesh.F, mesh.name), scale


def _level(mesh: Mesh, here: Mesh, rules: EdgeRules | None) -> _Level:
    none = np.zeros(len(here.topology.E), dtype=bool)
    if rules is None:
        return _Level(here, seam_weights(here), none, none)
    if here is not mesh:
        rules = coarse_rules(mesh, rules, here, transfer(mesh, rules.locked, here))
    return _Level(here, rules.weights(here), rules.locked, rules.forbidden)


def _carried(one: _Level, cut: BoolArray, other: _Level) -> BoolArray:
    """Seams of one level on another; the locked ones are known exactly, and those found beside them end on them."""
    if one is other:
        return cut
    pinned = np.unique(one.mesh.topology.E[one.locked]), np.unique(other.mesh.topology.E[other.locked])
    carried = transfer(one.mesh, cut & ~one.locked, other.mesh, weight=other.weight, pinned=pinned)
    carried = without_scraps(other.mesh, (carried & ~other.forbidden) | other.locked) | other.locked
    reach = _REACH * float(one.mesh.edge_lengths[cut].mean()) if cut.any() else 0.0
    fixed = other.locked | other.mesh.topology.is_boundary
    return straightened(other.mesh, carried, other.weight, reach=reach, fixed=fixed)


def _parts(level: _Level) -> list[_Part]:
    mesh, parts = level.mesh, []
    for piece in open_pieces(mesh, level.locked):
        edges = mesh_edges(mesh, piece, np.arange(len(piece.topology.E)))
        surface = Surface(Mesh(mesh.V[piece.vertices], piece.F, mesh.name), level.weight[edges], level.forbidden[edges])
        parts.append(_Part(piece, surface, edges))
    return parts


def _cut_of(level: _Level, parts: list[_Part], sheets: list[Sheet | None]) -> BoolArray:
    """The seams of all parts on the mesh."""
    cut = level.locked.copy()
    for part, sheet in zip(parts, sheets, strict=True):
        if sheet is not None:
            cut[part.edges[sheet.cut]] = True
    return cut


def _judged(mesh: Mesh, piece: OpenPiece, sheet: Sheet, scale: float, limits: Limits) -> Judged:
    uv = np.empty((len(piece.vertices), 2))
    uv[piece.F.ravel()] = scale * sheet.UV[sheet.F.ravel()]
    return piece, verdict_of(mesh, piece, uv, limits)


def _searched(surface: Surface, bound: float, *, last: bool, report: Callable[[float], None]) -> Sheet | None:
    """The shortest of what is found from a few starts; None where nothing opens it to a disk.

    Unless it is the `last` word, it may cover itself.
    """
    begun: list[Sheet] = []
    openings, compared = _openings(surface), 4 + _COMPARED * (bound - 4)
    for k, opening in enumerate(openings):
        report(0.7 * k / len(openings))
        cut = np.zeros(len(surface.weight), dtype=bool)
        cut[opening] = True
        start = _laid_out(sheet_of(surface, cut))
        if start is None:
            continue
        shortest = min((sheet.length for sheet in begun if sheet.mean <= compared), default=np.inf)
        begun.append(grow(start, compared, early=False, shorter_than=shortest) if len(openings) > 1 else start)
    if not begun:
        return None
    report(0.7)
    begun.sort(key=lambda sheet: (sheet.mean > compared, sheet.length))
    now = grow(begun[0], bound, early=last)
    if last and not _is_free(now):
        # The barrier takes far more seam on some than on others, which shows as soon as they are laid apart.
        apart = [lay_apart(now)]
        if apart[0].mean - bound > _LITTLE * (bound - 4):
            apart += [_laid_apart(grow(other, bound)) for other in begun[1:]]
        heavy = _EXCESS * surface.size / max(bound - 4, np.finfo(float).tiny)
        now = grow(min(apart, key=lambda sheet: sheet.length + heavy * max(sheet.mean - bound, 0)), bound)
    return exchange(now, bound, rounds=_ROUNDS) if now.mean <= bound else now


def _settled(sheet: Sheet, limits: Limits) -> Sheet:
    """As many more darts as it takes, and no seam more than that."""
    now = _apart(grow(sheet, limits.mean, p99=limits.p99), limits.mean, limits.p99)
    if not now.within(limits.mean, limits.p99):
        return now
    return exchange(now, limits.mean, p99=limits.p99, rounds=_LAST_ROUNDS if now.apart else 0)


def _apart(sheet: Sheet, bound: float, p99: float = np.inf) -> Sheet:
    """Laid out anew where it covers itself, which takes far longer, and grown on."""
    return sheet if sheet.mean > bound or _is_free(sheet) else grow(lay_apart(sheet), bound, p99=p99)


def _is_free(sheet: Sheet) -> bool:
    """Nothing of it covers anything else."""
    return sheet.apart is not None or sheet.is_simple


def _laid_apart(sheet: Sheet) -> Sheet:
    return sheet if _is_free(sheet) else lay_apart(sheet)


def _laid_out(sheet: Sheet | None) -> Sheet | None:
    """None, as for what is no disk, where no layout can be begun: `refine_seams` has the last word on that."""
    try:
        return None if sheet is None else lay_out(sheet)
    except InputError:  # a slit too short for a disk of needles: one opened elsewhere may do
        return None


def _one_disk(surface: Surface, cut: BoolArray) -> BoolArray:
    """Seams (e,) drawn on other triangles may touch, and part off what they did not: the longest edges that mend that are closed,
    and holes are opened to the boundary."""
    topology = surface.mesh.topology
    cut = cut & ~topology.is_boundary
    label = topology.face_components(cut)[1].copy()
    for edge in sorted(np.flatnonzero(cut).tolist(), key=lambda edge: -surface.lengths[edge]):
        one, other = label[topology.EF[edge]]
        if one != other:
            cut[edge] = False
            label[label == other] = one
    (piece,) = open_pieces(surface.mesh, cut)
    edges = mesh_edges(surface.mesh, piece, np.arange(len(piece.topology.E)))
    cut[edges[cut_to_disk(piece.topology, surface.weight[edges], len(piece.vertices))]] = True
    return cut & ~surface.forbidden


def _openings(surface: Surface) -> list[IntArray]:
    """Sets of edges each of which makes a disk of a surface; for a closed one slits at points far from each other."""
    topology, weight, n = surface.mesh.topology, surface.weight, len(surface.mesh.V)
    if topology.euler == 1 and len(topology.boundary_loops) == 1:
        return [np.zeros(0, dtype=np.int64)]
    if topology.euler != 2 or topology.is_boundary.any():
        return [cut_to_disk(topology, weight, n)]
    graph = edge_graph(topology, weight, n)
    slits = []
    for point in far_points(graph, _STARTS).tolist():
        distance, before = shortest_tree(graph, np.array([point]))
        way = topology.edge_ids(trace(before, int(np.argmax(distance)))[::-1])
        count = int((np.cumsum(surface.mesh.edge_lengths[way]) < _SLIT * surface.size).sum())
        slits.append(way[: max(count, 2)])  # one edge alone does not open
    return slits
