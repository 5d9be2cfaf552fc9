"""Drive the flattening of accepted pieces to the end: a search only goes as far as it takes to accept them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from skinfab.flatten.bijective import flatten_bijective, keep_apart
from skinfab.flatten.isometric import IsometricSolver
from skinfab.mesh.model import Mesh
from skinfab.seams.even import evened
from skinfab.seams.judge import Limits, verdict_of
from skinfab.seams.refine import Judged

if TYPE_CHECKING:
    from skinfab.seams.auto import Seams

#: A piece that leaves more of the bound than this stays at its least mean d.
_USED = 0.75

#: Sides in contact creep past each other in hundreds of steps, for next to nothing.
_APART_STEPS = 12


def finish(mesh: Mesh, seams: Seams, limits: Limits) -> Seams:
    """The same pieces, each at its least d, or with fewer hot spots where it uses the bound nearly to the full (`evened`).

    A piece that would cover itself at its least d, be it by less than counts, is driven to the least d without overlap.

    Parameters
    ----------
    mesh : Mesh
    seams : Seams
        Of accepted pieces.
    limits : Limits
        What they were accepted under.
    """
    return replace(seams, pieces=[finished(mesh, item, limits) for item in seams.pieces])


def finished(mesh: Mesh, item: Judged, limits: Limits) -> Judged:
    """`finish` of one piece."""
    piece, verdict = _at_least(mesh, item, limits)
    if verdict.distortion.mean - 4 >= _USED * (limits.mean - 4):
        piece, verdict = evened(mesh, (piece, verdict), limits)
    return piece, replace(verdict, parted=item[1].parted)


def _at_least(mesh: Mesh, item: Judged, limits: Limits) -> Judged:
    piece, before = item
    V = mesh.V[piece.vertices]
    solver = IsometricSolver(V, piece.F)
    free = verdict_of(mesh, piece, solver.refine(before.UV).UV, limits)
    better = free.accepted and free.distortion.mean <= before.distortion.mean
    if free.distortion.overlap_mm2 == 0:
        return (piece, free) if better else item
    # A little overlap is accepted, but none is better where the bound leaves room for it.
    clear = before.distortion.overlap_mm2 == 0
    if clear:
        uv = solver.refine(before.UV, apart=keep_apart(V, piece.topology), max_steps=_APART_STEPS).UV
    else:
        uv = flatten_bijective(V, piece.F, topology=piece.topology, hopeless_above=limits.mean)
    apart = verdict_of(mesh, piece, uv, limits)
    if apart.accepted and apart.distortion.overlap_mm2 == 0 and (apart.distortion.mean <= before.distortion.mean or not clear):
        return piece, apart
    return (piece, free) if better else item
