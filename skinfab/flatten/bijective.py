"""Flatten a disk so that it nowhere covers itself: d is minimised with the boundary kept from crossing itself.

It starts from Tutte's embedding, which is one-to-one, and stays so: no triangle flips, no boundary vertex
passes a boundary edge.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.distortion import best_scale
from skinfab.flatten.isometric import Apart, IsometricSolver
from skinfab.flatten.tutte import tutte_embedding
from skinfab.mesh.topology import Topology
from skinfab.tolerances import APART_REACH, APART_WEIGHT, NEWTON_DECREASE

#: Contacts make many short steps.
_MOST_STEPS = 150


def flatten_bijective(
    V: NDArray[np.float64],
    F: NDArray[np.int64],
    *,
    topology: Topology | None = None,
    tolerance: float = NEWTON_DECREASE,
    hopeless_above: float = np.inf,
) -> NDArray[np.float64]:
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
    start = tutte_embedding(V, F, topology=topology)
    start = start * best_scale(V, F, start)
    apart = keep_apart(V, topology)
    return IsometricSolver(V, F).refine(start, max_steps=_MOST_STEPS, tolerance=tolerance, hopeless_above=hopeless_above, apart=apart).UV


def keep_apart(V: NDArray[np.float64], topology: Topology) -> Apart:
    """The barrier for a disk: a reach that suits its boundary's edges."""
    loop = topology.boundary_loops[0]
    edge = np.linalg.norm(V[loop] - V[np.roll(loop, -1)], axis=1)
    return Apart(loop, APART_REACH * float(np.median(edge)), APART_WEIGHT)
