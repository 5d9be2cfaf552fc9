"""Find seams by itself: few good pieces, cut on creases where there are any.

For the usual pieces two ways are tried on a mesh of a few thousand triangles and the better one is kept: from the regions between
sharp edges (exact for polyhedra and machined parts), and from the whole surface opened by one cut (best for
organic shapes). A finer mesh then gets the seams by shortest paths, and every piece is judged anew on it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.mesh.model import Mesh
from skinfab.seams.coarse import coarsen, transfer
from skinfab.seams.creases import crease_seams, without_scraps
from skinfab.seams.cut import open_pieces, seam_length
from skinfab.seams.fewest import fewest_seams
from skinfab.seams.finish import finished
from skinfab.seams.glue import glue_pieces
from skinfab.seams.judge import Limits
from skinfab.seams.naming import named_edges
from skinfab.seams.parted import carried_parted
from skinfab.seams.refine import Judged, refine_seams
from skinfab.seams.rules import EdgeRules, coarse_rules
from skinfab.seams.simplest import simplest_seams
from skinfab.seams.weights import seam_weights
from skinfab.tolerances import SEARCH_DECREASE

BoolArray = NDArray[np.bool_]

#: What automatic seams are to give, see `find_seams`.
Aim = Literal["fewest", "usual", "simplest"]

#: So often seams are searched for a p99 that evening out is to bring within its bound.
_P99_TRIES = 2

#: Seams are searched on about this many triangles.
_COARSE_FACES = 6000

#: The search aims below the bound by this part of what it allows above 4, because the fine mesh shows more.
_AIM = 0.7

#: Gluing may cost this part of what the bound allows above 4.
_GLUE_EXCESS = 0.1

#: This part of what the bound allows above 4 weighs as much as a piece.
_STRETCH = 0.1

#: Where a bound gives several pieces, those of tighter ones are looked at too: what keeps to one keeps to any looser one.
_TIGHTER = (4.05, 4.1)

#: An object that falls into more pieces than this is hardly meant for a skin: the second way is not tried.
_MANY = 100


#: On the fine mesh only pieces under this part of the surface are worth trying to glue.
_SMALL = 0.03


@dataclass(frozen=True, eq=False)
class Seams:
    """A seam set and the good pieces it gives.

    Parameters
    ----------
    cut : (e,) bool
        Per edge of the mesh.
    pieces : list of (OpenPiece, Verdict)
    """

    cut: BoolArray
    pieces: list[Judged]


def find_seams(
    mesh: Mesh,
    limits: Limits,
    *,
    neck: float = 4.0,
    rules: EdgeRules | None = None,
    aim: Aim = "usual",
    progress: Callable[[float], None] | None = None,
) -> Seams:
    """Seams that part `mesh` into disks within `limits`, without flips or overlap.

    Parameters
    ----------
    mesh : Mesh
        Manifold, consistently wound; closed or open, any genus, any number of components.
    limits : Limits
    neck : float, mm
        Pieces are not joined across less than this.
    rules : EdgeRules, optional
        Seams to keep, edges never to cut, and what others cost.
    aim : "fewest", "usual" or "simplest"
        As few pieces and as little seam as the bound allows, with darts wherever they gain most (`fewest_seams`; never more
        pieces than the usual); simple pieces well within the bound, parted on creases where there are any; or compact pieces
        without darts (`simplest_seams`).
    progress : callable, optional
        Called with the part that is done, 0 to 1.

    Returns
    -------
    Seams
        Flattened as far as it takes to accept them; `finish.finish` drives d to its least.

    Raises
    ------
    InputError
        An edge is both locked and forbidden, or the mesh is not manifold or not consistently wound.
    RefusedError
        No seams give good pieces, or the rules forbid them.
    """
    if rules is not None and (rules.locked & rules.forbidden).any():
        names = named_edges(mesh, np.flatnonzero(rules.locked & rules.forbidden))
        raise InputError(f"{names}: locked, which stays a seam, and forbidden, which is never cut; unlock it or allow it")
    report = progress or (lambda done: None)
    parts = len(open_pieces(mesh, np.zeros(len(mesh.topology.E), dtype=bool) if rules is None else rules.locked))
    if aim == "simplest":
        return Seams(*simplest_seams(mesh, limits, neck=neck, rules=rules, progress=report))
    if aim == "usual":
        return _at_best(mesh, limits, neck, rules, parts, report)
    found = _fewest(mesh, limits, neck, rules, report)
    if len(found.pieces) <= parts:
        return found
    try:
        other = _at_best(mesh, limits, neck, rules, parts, lambda done: report(1.0))
    except RefusedError:  # there is an answer already
        return found
    return min(found, other, key=lambda seams: (len(seams.pieces), seam_length(mesh, seams.cut)))


def _fewest(mesh: Mesh, limits: Limits, neck: float, rules: EdgeRules | None, report: Callable[[float], None]) -> Seams:
    """Where the p99 is bounded, seams that it takes where hot spots are evened out: at first those that the mean alone takes."""
    if not np.isfinite(limits.p99):
        return Seams(*fewest_seams(mesh, limits, neck=neck, rules=rules, progress=report))
    searched = np.inf
    for k in range(_P99_TRIES):

        def further(done: float, k: int = k) -> None:
            report((k + done) / (_P99_TRIES + 1))

        loose = replace(limits, p99=searched)
        cut, pieces = fewest_seams(mesh, loose, neck=neck, rules=rules, progress=further)
        before = max(verdict.distortion.p99 for _, verdict in pieces)
        pieces = [finished(mesh, item, loose) for item in pieces]
        after = max(verdict.distortion.p99 for _, verdict in pieces)
        if after <= limits.p99:
            return Seams(cut, pieces)
        # Evening out takes about the same part of what is above 4 again.
        searched = 4 + (limits.p99 - 4) * max((before - 4) / (after - 4), 1)
    return Seams(*fewest_seams(mesh, limits, neck=neck, rules=rules, progress=lambda done: report((_P99_TRIES + done) / (_P99_TRIES + 1))))


def _at_best(mesh: Mesh, limits: Limits, neck: float, rules: EdgeRules | None, parts: int, report: Callable[[float], None]) -> Seams:
    """The usual pieces of the bound, or of a tighter one if those are fewer."""
    bounds = [bound for bound in _TIGHTER if bound < limits.mean]
    found = _usual(mesh, limits, neck, rules, lambda done: report(done / (1 + len(bounds))))
    for k, bound in enumerate(bounds, start=1):
        if len(found.pieces) <= parts:
            break

        def further(done: float, k: int = k) -> None:
            report((k + done) / (1 + len(bounds)))

        try:
            other = _usual(mesh, replace(limits, mean=bound), neck, rules, further)
        except RefusedError:  # what cannot keep to a tighter bound has its answer already
            continue
        found = min(found, other, key=lambda seams: len(seams.pieces))
    return found


def _usual(mesh: Mesh, limits: Limits, neck: float, rules: EdgeRules | None, report: Callable[[float], None]) -> Seams:
    """Simple pieces well within one bound."""
    inner = replace(limits, mean=4 + _AIM * (limits.mean - 4))
    small = coarsen(mesh, _COARSE_FACES)
    if small is mesh:
        try:
            return _search(mesh, inner, limits, neck, rules, report)
        except RefusedError:
            if rules is None:
                raise
            # What is forbidden may leave no seam for less than the bound, and one for the bound.
            return _search(mesh, limits, limits, neck, rules, lambda done: report(1.0))
    locked = None if rules is None else transfer(mesh, rules.locked, small)
    small_rules = None if rules is None or locked is None else coarse_rules(mesh, rules, small, locked)
    seams = _search(small, inner, limits, neck, small_rules, lambda done: report(0.5 * done))
    cut = _on_fine(mesh, small, seams.cut, rules, locked)
    weight, forbidden = (seam_weights(mesh), None) if rules is None else (rules.weights(mesh), rules.forbidden)
    cut, pieces = refine_seams(
        mesh, cut, limits, weight, forbidden=forbidden, progress=lambda done: report(0.5 + 0.4 * done), tolerance=SEARCH_DECREASE
    )
    pieces = carried_parted(small, seams.pieces, mesh, pieces)
    stay = None if rules is None else rules.locked
    return Seams(
        *glue_pieces(
            mesh, cut, pieces, limits, neck=neck, excess=np.inf, smaller_than=_SMALL * mesh.area, locked=stay, tolerance=SEARCH_DECREASE
        )
    )


def _on_fine(mesh: Mesh, small: Mesh, cut: BoolArray, rules: EdgeRules | None, locked: BoolArray | None) -> BoolArray:
    """The seams found on a small mesh on the fine one, without the scraps between them."""
    if rules is None or locked is None:
        fine = transfer(small, cut, mesh)
    else:
        # Locked seams are known exactly; those found beside them have to end on them.
        pinned = np.unique(small.topology.E[locked]), np.unique(mesh.topology.E[rules.locked])
        fine = transfer(small, cut & ~locked, mesh, weight=rules.weights(mesh), pinned=pinned)
        fine = (fine & ~rules.forbidden) | rules.locked
    fine = without_scraps(mesh, fine)
    return fine if rules is None else fine | rules.locked


def _search(mesh: Mesh, aim: Limits, limits: Limits, neck: float, rules: EdgeRules | None, progress: Callable[[float], None]) -> Seams:
    if rules is None:
        weight, locked, forbidden = seam_weights(mesh), np.zeros(len(mesh.topology.E), dtype=bool), None
    else:
        weight, locked, forbidden = rules.weights(mesh), rules.locked, rules.forbidden
    creases = crease_seams(mesh, forbidden=forbidden)
    starts = [creases | locked] if creases.any() else []
    starts.append(locked)
    found: list[Seams] = []
    for k, start in enumerate(starts):
        begun = k / len(starts)

        def report(done: float, begun: float = begun) -> None:
            progress(begun + 0.8 * done / len(starts))

        cut, pieces = refine_seams(mesh, start, aim, weight, tolerance=SEARCH_DECREASE, forbidden=forbidden, progress=report)
        excess = _GLUE_EXCESS * (limits.mean - 4)
        found.append(Seams(*glue_pieces(mesh, cut, pieces, aim, neck=neck, excess=excess, tolerance=SEARCH_DECREASE, locked=locked)))
        progress((k + 1) / len(starts))
        if len(found[-1].pieces) > _MANY:
            break
    return min(found, key=lambda s: _cost(mesh, s, limits))


def _cost(mesh: Mesh, seams: Seams, limits: Limits) -> float:
    """Pieces, seam length and stretch in one number: a tenth of what the bound allows above 4 (of the usual bound where it is
    tighter) weighs as much as a piece or a root of the area in seam."""
    areas = np.array([mesh.face_areas[piece.faces].sum() for piece, _ in seams.pieces])
    mean = float(np.average([v.distortion.mean for _, v in seams.pieces], weights=areas))
    return (
        len(seams.pieces)
        + seam_length(mesh, seams.cut) / np.sqrt(mesh.area)
        + (mean - 4) / (_STRETCH * max(limits.mean - 4, Limits.mean - 4))
    )
