"""Drive the flattening of accepted pieces to the end: a search only goes as far as it takes to accept them."""

from __future__ import annotations

from dataclasses import replace

from skinfab.flatten.bijective import keep_apart
from skinfab.flatten.isometric import IsometricSolver
from skinfab.mesh.model import Mesh
from skinfab.seams.auto import Seams
from skinfab.seams.judge import Limits, verdict_of
from skinfab.seams.refine import Judged


def finish(mesh: Mesh, seams: Seams, limits: Limits) -> Seams:
    """The same pieces, each at its least d.

    A piece that would cover itself at its least d is driven to the least d without overlap.

    Parameters
    ----------
    mesh : Mesh
    seams : Seams
        Of accepted pieces.
    limits : Limits
        What they were accepted under.
    """
    return replace(seams, pieces=[_finish(mesh, item, limits) for item in seams.pieces])


def _finish(mesh: Mesh, item: Judged, limits: Limits) -> Judged:
    piece, before = item
    V = mesh.V[piece.vertices]
    solver = IsometricSolver(V, piece.F)
    for apart in (None, keep_apart(V, piece.topology)):
        after = verdict_of(mesh, piece, solver.refine(before.UV, apart=apart).UV, limits)
        if after.accepted and after.distortion.mean <= before.distortion.mean:
            return piece, after
        if not after.overlaps:
            break
    return item
