"""Flatten a disk so that it nowhere covers itself: d is minimised with the boundary kept from crossing itself.

Most disks do not overlap at their least d, and are done with that. For others BFF's boundary is opened just
far enough, by a share of the way to an even turning all round, to start free of overlap; a barrier keeps it so.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.bff import BffSolver
from skinfab.flatten.disk import lower
from skinfab.flatten.isometric import Apart, IsometricSolver
from skinfab.flatten.overlap import overlap_area
from skinfab.flatten.tutte import tutte_embedding
from skinfab.mesh.topology import Topology
from skinfab.tolerances import APART_REACH, APART_WEIGHT, FLAT_START, NEWTON_DECREASE

FloatArray = NDArray[np.float64]

#: Contacts make many short steps.
_MOST_STEPS = 150

#: Shares of the way to an even turning at which a start free of overlap is looked for; fuller ones distort more than Tutte's.
_OPENINGS = (0.1, 0.2, 0.3, 0.5, 0.7)
#: Opened a bit farther than needed, so that the first steps have room.
_ROOM = 1.3

#: A wide barrier first, which Newton's steps feel before they run into it: times the reach, with few and rough steps each.
_WIDER = (10.0, 3.0)
_ROUGH_STEPS, _ROUGH = 25, 0.03


def flatten_bijective(
    V: FloatArray,
    F: NDArray[np.int64],
    *,
    topology: Topology | None = None,
    tolerance: float = NEWTON_DECREASE,
    hopeless_above: float = np.inf,
) -> FloatArray:
    """The flattening of least d that does not overlap, (n, 2) mm.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        A disk; every vertex in use.
    topology : Topology, optional
    tolerance, hopeless_above : float
        See `IsometricSolver.refine`.
    """
    topology = topology or Topology(F)
    bff = BffSolver(V, F, topology=topology)
    free = bff.free()
    if overlap_area(F, free, topology=topology) == 0:
        flat = lower(V, F, free, topology=topology, tolerance=tolerance, hopeless_above=hopeless_above).UV
        if overlap_area(F, flat, topology=topology) == 0:
            return flat
    solver = IsometricSolver(V, F)
    uv, apart = _opened(solver, bff, topology), keep_apart(V, topology)
    if uv is None:
        uv = tutte_embedding(V, F, topology=topology)
        uv = uv * solver.best_scale(uv)[0]
    for times in _WIDER:
        wide = Apart(apart.loop, times * apart.reach, apart.weight)
        uv = solver.refine(uv, max_steps=_ROUGH_STEPS, tolerance=max(_ROUGH, tolerance), hopeless_above=hopeless_above, apart=wide).UV
    return solver.refine(uv, max_steps=_MOST_STEPS, tolerance=tolerance, hopeless_above=hopeless_above, apart=apart).UV


def keep_apart(V: FloatArray, topology: Topology) -> Apart:
    """The barrier for a disk: a reach that suits its boundary's edges."""
    loop = topology.boundary_loops[0]
    edge = np.linalg.norm(V[loop] - V[np.roll(loop, -1)], axis=1)
    return Apart(loop, APART_REACH * float(np.median(edge)), APART_WEIGHT)


def _opened(solver: IsometricSolver, bff: BffSolver, topology: Topology) -> FloatArray | None:
    """BFF with its boundary's turning so far on the way to an even one that nothing overlaps or is flipped; None if that is too far."""
    length = bff.lengths_mm
    even = bff.scale_of(np.pi * (length + np.roll(length, 1)) / length.sum())
    for share in _OPENINGS:
        if overlap_area(solver.F, bff.scale(share * even), topology=topology) > 0:
            continue
        for opening in (_ROOM * share, share):
            uv = bff.scale(opening * even)
            scale, thinnest = solver.best_scale(uv)
            if thinnest >= FLAT_START and overlap_area(solver.F, uv, topology=topology) == 0:
                return uv * scale
    return None
