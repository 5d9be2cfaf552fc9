"""The default way to flatten one disk: boundary first flattening, then d itself is minimised."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.bff import flatten_disk
from skinfab.flatten.distortion import best_scale, singular_values
from skinfab.flatten.isometric import IsometricSolver
from skinfab.flatten.tutte import tutte_embedding
from skinfab.mesh.topology import Topology
from skinfab.tolerances import FLAT_START, NEWTON_DECREASE

FloatArray = NDArray[np.float64]


def flatten_isometric(
    V: FloatArray,
    F: NDArray[np.int64],
    *,
    topology: Topology | None = None,
    tolerance: float = NEWTON_DECREASE,
    hopeless_above: float = np.inf,
) -> FloatArray:
    """BFF, scaled for the least d, untangled where it flipped, refined by Newton steps.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        A disk; every vertex in use.
    topology : Topology, optional
    tolerance, hopeless_above : float
        When to stop, see `IsometricSolver.refine`.

    Returns
    -------
    (n, 2) float64, mm
        No triangle is flipped.

    Raises
    ------
    InputError
        Not a disk, or a triangle has no area.
    """
    topology = topology or Topology(F)
    uv = flatten_disk(V, F, topology=topology)
    solver = IsometricSolver(V, F)
    uv = uv * best_scale(V, F, uv)
    s = singular_values(V, F, uv)
    if not np.isfinite(s).all() or s[:, 1].min() < FLAT_START * s[:, 0].max():
        # A nearly collapsed triangle stalls the line search as surely as a flipped one.
        uv = tutte_embedding(V, F, topology=topology)
        uv = uv * best_scale(V, F, uv)
    return solver.refine(uv, tolerance=tolerance, hopeless_above=hopeless_above).UV
