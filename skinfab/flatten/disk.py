"""The default way to flatten one disk: boundary first flattening, then d itself is minimised."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.flatten.bff import flatten_disk
from skinfab.flatten.distortion import best_scale, measure, shaped_areas
from skinfab.flatten.isometric import MOST_STEPS, IsometricSolver, Refinement
from skinfab.flatten.rigid_start import rigid_steps
from skinfab.flatten.robust import turned_over
from skinfab.flatten.tutte import tutte_embedding
from skinfab.mesh.topology import Topology
from skinfab.tolerances import FLAT_START, NEWTON_DECREASE, SIMPLIFY_EFFECT

FloatArray = NDArray[np.float64]
Say = Callable[[str], object]

#: From BFF's layout two steps come as near to the least d as two or three of Newton's, at a quarter of the cost.
_RIGID_STEPS = 2

#: On fewer triangles a factorisation costs too little to be saved.
_RIGID_FROM = 5000


def flatten_isometric(
    V: FloatArray,
    F: NDArray[np.int64],
    *,
    topology: Topology | None = None,
    tolerance: float = NEWTON_DECREASE,
    hopeless_above: float = np.inf,
    say: Say | None = None,
) -> FloatArray:
    """BFF, scaled for the least d, untangled where it flipped, brought near by rigid steps, refined by Newton steps.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        A disk; every vertex in use.
    topology : Topology, optional
    tolerance, hopeless_above : float
        When to stop, see `IsometricSolver.refine`.
    say : function, optional
        Is told in one sentence where BFF's layout had to be untangled.

    Returns
    -------
    (n, 2) float64, mm
        No triangle is flipped.

    Raises
    ------
    InputError
        Not a disk, or too many triangles have no area.
    """
    topology = topology or Topology(F)
    uv = flatten_disk(V, F, topology=topology)
    found = lower(V, F, uv, topology=topology, tolerance=tolerance, hopeless_above=hopeless_above, say=say)
    _require_better(V, F, uv, found.UV)
    return found.UV


def _require_better(V: FloatArray, F: NDArray[np.int64], bff: FloatArray, found: FloatArray) -> None:
    """Where many triangles have no area, the widths that they are given contradict each other and the steps end far off."""
    shaped = shaped_areas(V, F)[1]
    if shaped.all():
        return
    before, after = measure(V, F[shaped], bff * best_scale(V, F, bff)), measure(V, F[shaped], found)
    if before.flipped == 0 and after.mean > before.mean + SIMPLIFY_EFFECT:
        raise InputError(
            f"{(~shaped).sum()} triangles have no area (first: face {int(np.argmin(shaped))}), too many to be laid flat with the "
            "others; clean the mesh first (skinfab.mesh.repair.clean), or use bff"
        )


def lower(
    V: FloatArray,
    F: NDArray[np.int64],
    UV: FloatArray,
    *,
    topology: Topology | None = None,
    max_steps: int = MOST_STEPS,
    tolerance: float = NEWTON_DECREASE,
    hopeless_above: float = np.inf,
    say: Say | None = None,
) -> Refinement:
    """What `flatten_isometric` makes of BFF's layout `UV`, (n, 2) at any scale.

    Parameters are those of `flatten_isometric` and of `IsometricSolver.refine`.
    """
    solver = IsometricSolver(V, F)
    uv, is_open = _scaled(solver, UV)
    if not is_open:
        if say is not None:
            flips = turned_over(UV, F)
            fault = f"turned {flips} of {len(F)} triangles over" if flips else "squashed a triangle flat"
            say(f"boundary first flattening {fault}, so the layout was begun anew from Tutte's embedding, which turns none")
        # A nearly collapsed triangle stalls the line search as surely as a flipped one.
        uv, _ = _scaled(solver, tutte_embedding(V, F, topology=topology))
    # Where a rough answer will do, Newton's first steps give it by themselves.
    if len(F) >= _RIGID_FROM and tolerance <= NEWTON_DECREASE:
        near, is_open = _scaled(solver, rigid_steps(V, F, uv, steps=_RIGID_STEPS, rest=solver.rest))
        uv = near if is_open else uv
    return solver.refine(uv, max_steps=max_steps, tolerance=tolerance, hopeless_above=hopeless_above)


def _scaled(solver: IsometricSolver, uv: FloatArray) -> tuple[FloatArray, bool]:
    """At the scale of the least d, and whether no triangle is flipped or nearly collapsed."""
    scale, thinnest = solver.best_scale(uv)
    return uv * scale, thinnest >= FLAT_START
