"""BFF that flips the fewest triangles: over the mesh as it is, and where that flips, over its intrinsic Delaunay triangulation.

On sound meshes the second is not made: negative weights alone do little harm (of 21 real and made objects cut to disks, 20 have
some and 3 flip), while edge lengths tell less of needles than their corners do.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.bff import BffSolver
from skinfab.mesh.topology import Topology

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def flatten_robust(
    V: FloatArray, F: IntArray, *, scale: FloatArray | None = None, topology: Topology | None = None, counted: int | None = None
) -> FloatArray:
    """Conformal flattening of a disk with the fewest flipped triangles, (n, 2) mm; one factorisation, two where triangles flip.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        A disk; every vertex in use.
    scale : (n,) float, optional
        Log scale factors; only the boundary's are read. Zero, the default, is the free boundary.
    topology : Topology, optional
        Of `F`, where it is at hand.
    counted : int, optional
        Only the first so many triangles must not flip; default all.

    Raises
    ------
    InputError
        Not a disk, or a coordinate is not finite.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 0]])
    >>> uv = flatten_robust(V, np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]))
    >>> float(np.linalg.norm(uv[2] - uv[0]).round(9))
    1.414213562
    """
    topology = topology or Topology(F)
    plain = _laid(BffSolver(V, F, topology=topology), scale)
    flips = turned_over(plain, F[:counted])
    if not flips:
        return plain
    robust = _laid(BffSolver(V, F, topology=topology, robust=True), scale)
    return robust if turned_over(robust, F[:counted]) < flips else plain


def _laid(solver: BffSolver, scale: FloatArray | None) -> FloatArray:
    return solver.free() if scale is None else solver.scale(scale[solver.boundary])


def turned_over(UV: FloatArray, F: IntArray) -> int:
    """How many triangles are flipped or collapsed.

    Examples
    --------
    >>> turned_over(np.array([[0.0, 0], [1, 0], [0, 1]]), np.array([[0, 1, 2], [0, 2, 1]]))
    1
    """
    a, b, c = (UV[corner] for corner in F.T)
    twice_area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    return int((~(twice_area > 0)).sum())
