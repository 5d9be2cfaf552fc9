"""The fewest pieces, and little seam: a short slit, then dart after dart, and no more of them than the fine mesh needs.

The darts are found on a mesh of some 1500 triangles, from a few starts. A finer mesh is bent less by each of its triangles
and shows less d: there the last darts are found anew, and mostly fewer of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.model import Mesh
from skinfab.seams.coarse import coarsen, transfer
from skinfab.seams.creases import without_scraps
from skinfab.seams.cut import OpenPiece, mesh_edges, open_pieces
from skinfab.seams.disk import cut_to_disk, far_points
from skinfab.seams.glue import glue_pieces
from skinfab.seams.graph import edge_graph, shortest_tree, trace
from skinfab.seams.growth import Grown, grow_darts, laid_apart, lay_out
from skinfab.seams.judge import Limits, verdict_of
from skinfab.seams.refine import Judged, refine_seams
from skinfab.seams.rules import EdgeRules, coarse_rules
from skinfab.seams.weights import seam_weights

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

#: Darts are found on about this many triangles, ...
_COARSE_FACES = 1500

#: ... and tried on at most about this many.
_MIDDLE_FACES = 8000

#: Places of the first slit in a closed piece that are tried, far from each other.
_STARTS = 3

#: The first slit is this part of the root of the area long: just enough to lay the rest out.
_SLIT = 0.25

#: A finer mesh shows less d: darts that the coarse one needed for less than so many times what the bound allows above 4 are cut
#: there only where it needs them too.
_COARSE_EXCESS = 1.6

#: In the search a flattening need not be driven to the end: d is known to 1 % of what is above 4.
_SEARCH_DECREASE = 1e-2


@dataclass(frozen=True, eq=False)
class _Level:
    """One resolution of the surface, and what a person's marks mean on it."""

    mesh: Mesh
    weight: FloatArray
    locked: BoolArray
    forbidden: BoolArray


@dataclass(frozen=True, eq=False)
class _Plan:
    """What was found for one part of the coarse surface: what opens it to a disk, and its darts."""

    faces: IntArray
    opening: IntArray
    grown: Grown


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
    fine = _level(mesh, mesh, rules)
    small = fine if (few := coarsen(mesh, _COARSE_FACES)) is mesh else _level(mesh, few, rules)
    middle = fine if (some := coarsen(mesh, _MIDDLE_FACES)) is mesh else _level(mesh, some, rules)
    plans = _plans(small, limits.mean, lambda done: report(0.5 * done))
    cut, pieces = _grown_on(
        middle, _carried(small, _first_darts(small, plans, limits.mean), middle), limits, lambda done: report(0.5 + 0.3 * done)
    )
    covered = sum(len(piece.faces) for piece, _ in pieces) == len(mesh.F)
    if middle is not fine or not covered or not all(verdict.accepted for _, verdict in pieces):
        forbidden = None if rules is None else rules.forbidden
        cut, pieces = refine_seams(
            mesh,
            _carried(middle, cut, fine),
            limits,
            fine.weight,
            tolerance=_SEARCH_DECREASE,
            forbidden=forbidden,
            progress=lambda done: report(0.8 + 0.2 * done),
        )
    locked = None if rules is None else rules.locked
    return glue_pieces(mesh, cut, pieces, limits, neck=neck, excess=np.inf, tolerance=_SEARCH_DECREASE, locked=locked)


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
    return without_scraps(other.mesh, (carried & ~other.forbidden) | other.locked) | other.locked


def _plans(small: _Level, bound: float, report: Callable[[float], None]) -> list[_Plan]:
    """For each part between the locked seams, the shortest of what is found from a few starts."""
    mesh, plans, done = small.mesh, [], 0
    for part in open_pieces(mesh, small.locked):
        found: list[_Plan] = []
        starts = _openings(small, part)
        for k, opening in enumerate(starts):
            report((done + k / len(starts) * len(part.faces)) / len(mesh.F))
            cut = small.locked.copy()
            cut[opening] = True
            opened = open_pieces(mesh, cut, faces=part.faces)
            if len(opened) != 1 or not opened[0].is_disk:
                continue
            rival = min((plan.grown for plan in found if plan.grown.mean <= bound), key=lambda grown: grown.length, default=None)
            start = lay_out(mesh, opened[0])
            grown = grow_darts(mesh, start, bound, small.weight, cut=cut, forbidden=small.forbidden, rival=rival)
            if grown.mean <= bound or rival is None:
                found.append(_Plan(part.faces, opening, grown))
        done += len(part.faces)
        if found:
            plans.append(_shortest(small, found, bound))
    return plans


def _shortest(small: _Level, found: list[_Plan], bound: float) -> _Plan:
    """The plan with the least seam within the bound; it alone is laid out anew where it covers itself, which takes far longer."""
    lengths = small.mesh.edge_lengths
    plan = min(found, key=lambda plan: (plan.grown.mean > bound, plan.grown.length + float(lengths[plan.opening].sum())))
    if plan.grown.good or plan.grown.mean > bound:
        return plan
    cut = small.locked.copy()
    cut[plan.opening] = True
    grown = grow_darts(small.mesh, laid_apart(small.mesh, plan.grown), bound, small.weight, cut=cut, forbidden=small.forbidden)
    return _Plan(plan.faces, plan.opening, grown)


def _openings(small: _Level, part: OpenPiece) -> list[IntArray]:
    """Sets of edges each of which makes a disk of a part; for a closed one slits at points far from each other."""
    if part.is_disk:
        return [np.zeros(0, dtype=np.int64)]
    topology = part.topology
    weight = small.weight[mesh_edges(small.mesh, part, np.arange(len(topology.E)))]
    if topology.euler != 2 or topology.is_boundary.any():
        return [mesh_edges(small.mesh, part, cut_to_disk(topology, weight, len(part.vertices)))]
    graph = edge_graph(topology, weight, len(part.vertices))
    size = float(np.sqrt(small.mesh.face_areas[part.faces].sum()))
    slits = []
    for point in far_points(graph, _STARTS).tolist():
        distance, before = shortest_tree(graph, np.array([point]))
        way = mesh_edges(small.mesh, part, topology.edge_ids(trace(before, int(np.argmax(distance)))[::-1]))
        count = int((np.cumsum(small.mesh.edge_lengths[way]) < _SLIT * size).sum())
        slits.append(way[: max(count, 2)])  # one edge alone does not open
    return slits


def _first_darts(small: _Level, plans: list[_Plan], bound: float) -> BoolArray:
    """Seams with those darts that a finer mesh is likely to need as well."""
    cut, enough = small.locked.copy(), 4 + _COARSE_EXCESS * (bound - 4)
    for plan in plans:
        cut[plan.opening] = True
        # Without gaps, as darts end on the ones before them; kept apart, d is above what it was before.
        count = max((k + 1 for k, dart in enumerate(plan.grown.darts) if dart.mean > enough), default=0)
        for dart in plan.grown.darts[:count]:
            cut[dart.edges] = True
    return cut


def _grown_on(level: _Level, cut: BoolArray, limits: Limits, report: Callable[[float], None]) -> tuple[BoolArray, list[Judged]]:
    """As many more darts on a finer mesh as it takes there, and its pieces that are disks."""
    mesh, cut, pieces, done = level.mesh, cut.copy(), [], 0
    for piece in open_pieces(mesh, cut):
        report(done / len(mesh.F))
        done += len(piece.faces)
        if not piece.is_disk:
            continue
        bounds = cut.copy()
        grown = grow_darts(mesh, lay_out(mesh, piece), limits.mean, level.weight, cut=bounds, forbidden=level.forbidden, p99=limits.p99)
        if grown.mean <= limits.mean and not grown.good:
            grown = grow_darts(
                mesh, laid_apart(mesh, grown), limits.mean, level.weight, cut=bounds, forbidden=level.forbidden, p99=limits.p99
            )
        for dart in grown.darts:
            cut[dart.edges] = True
        pieces.append((grown.piece, verdict_of(mesh, grown.piece, grown.UV, limits)))
    return cut, pieces
