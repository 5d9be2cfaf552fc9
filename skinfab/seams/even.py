"""Hot spots evened out: what a layout leaves of the bound on the mean d is spent on its p99."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten._dirichlet import distortions
from skinfab.flatten.bijective import keep_apart
from skinfab.flatten.distortion import quantiles
from skinfab.flatten.isometric import Apart, IsometricSolver
from skinfab.mesh.model import Mesh
from skinfab.seams.judge import Limits, Verdict, verdict_of
from skinfab.seams.refine import Judged
from skinfab.tolerances import FLAT_EXCESS

FloatArray = NDArray[np.float64]

#: By how much more a triangle at the p99 counts than one at d 4: at first, and at most. What that costs the mean grows with the square
#: for small weights, so that three tries come near to the bound.
_FIRST, _MOST, _TRIED = 0.5, 4.0, 3

#: A try aims at this part of what the bound leaves, and near enough is that.
_AIM, _NEAR = 0.9, 0.8

#: The weights follow the layout so often, of which each is two Newton steps.
_ROUNDS, _STEPS = 2, 2


def evened(mesh: Mesh, item: Judged, limits: Limits) -> Judged:
    """An accepted piece with less d where it is worst, for a little more on the mean, within its bound.

    At the least mean d moving costs the mean nothing to first order, and the p99 gains to first order. Triangles are weighted by
    1 + w min((d - 4) / (p99 - 4), 1), anew as the layout follows: of the sum of d with a part that grows with the square of
    d - 4 up to the p99, and in proportion from there. The largest w is taken that the bound on the mean allows and that gains.

    Parameters
    ----------
    mesh : Mesh
    item : (OpenPiece, Verdict)
        At its least mean d.
    limits : Limits

    Returns
    -------
    (OpenPiece, Verdict)
        The same where nothing is left of the bound or nothing gained; no less accepted, and with overlap only where it had some.
    """
    piece, before = item
    if before.distortion.mean >= limits.mean or before.distortion.p99 - 4 < FLAT_EXCESS:
        return item
    V = mesh.V[piece.vertices]
    solver = IsometricSolver(V, piece.F)
    free, covers = _evened(mesh, item, limits, solver, None)
    if free is before and covers:
        free, _ = _evened(mesh, item, limits, solver, keep_apart(V, piece.topology))
    return piece, free


def brought_within(mesh: Mesh, item: Judged, limits: Limits) -> Judged:
    """A piece that would be accepted but for its p99, with hot spots evened out; the same where that is not so."""
    piece, verdict = item
    plain = replace(limits, p99=np.inf)
    if verdict.distortion.p99 <= limits.p99 or verdict.distortion.mean > limits.mean:
        return item
    other = verdict_of(mesh, piece, verdict.UV, plain)
    if not other.accepted:
        return item
    return piece, verdict_of(mesh, piece, evened(mesh, (piece, other), plain)[1].UV, limits)


def _evened(mesh: Mesh, item: Judged, limits: Limits, solver: IsometricSolver, apart: Apart | None) -> tuple[Verdict, bool]:
    """The layout of least p99, and whether the next one covered itself."""
    piece, best = item
    least = best.distortion
    weight, spare = _FIRST, limits.mean - least.mean
    for _ in range(_TRIED):
        found = verdict_of(mesh, piece, _weighted(solver, best.UV, weight, apart), limits)
        if found.distortion.overlap_mm2 > least.overlap_mm2:
            return best, True
        if found.accepted and found.distortion.p99 < best.distortion.p99:
            best = found
        share = (found.distortion.mean - least.mean) / spare
        if _NEAR < share <= 1 or (share < 1 and weight == _MOST):
            break
        weight = min(weight * np.sqrt(_AIM / max(share, _AIM / 16)), _MOST)
    return best, False


def _weighted(solver: IsometricSolver, UV: FloatArray, weight: float, apart: Apart | None) -> FloatArray:
    area = solver.weight
    try:
        for _ in range(_ROUNDS):
            excess = distortions(UV, solver.F, solver.gradients) - 4
            (worst,) = quantiles(excess, area, (0.99,))
            solver.weight = area * (1 + weight * np.clip(excess / worst, 0, 1))
            solver.weight /= solver.weight.sum()
            UV = solver.refine(UV, max_steps=_STEPS, apart=apart).UV
        return UV
    finally:
        solver.weight = area
