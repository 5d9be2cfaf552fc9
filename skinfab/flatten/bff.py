"""Boundary first flattening of a disk (Sawhney and Crane 2017), from one Cholesky factorisation.

The factor of the interior block of the cotangent Laplacian serves all three steps: the scale factors
(Dirichlet solve), the boundary's new curvature (Dirichlet-to-Neumann map) and the extension of the
boundary curve into the interior (two harmonic functions). Numbers in comments are the paper's sections.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from skinfab.errors import InputError
from skinfab.flatten.distortion import best_scale
from skinfab.flatten.laplacian import intrinsic
from skinfab.linalg import Cholesky
from skinfab.mesh.topology import Topology

FloatArray = NDArray[np.float64]


def flatten_disk(V: FloatArray, F: NDArray[np.int64], *, scale: FloatArray | None = None, topology: Topology | None = None) -> FloatArray:
    """Conformal flattening of a disk whose boundary scale factors are given.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        A disk: one component, one boundary loop, Euler number 1; every vertex in use.
    scale : (n,) float, optional
        Log scale factors u; only the boundary's are read. Zero, the default, is the free boundary: of all
        conformal flattenings the one with the least area distortion (section 4.2).
    topology : Topology, optional
        Of `F`, where it is at hand.

    Returns
    -------
    (n, 2) float64, mm

    Raises
    ------
    InputError
        The mesh is not a disk, or a coordinate is not finite.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 0]])
    >>> F = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    >>> uv = flatten_disk(V, F)
    >>> float(np.linalg.norm(uv[2] - uv[0]).round(9))
    1.414213562
    """
    topology = topology or Topology(F)
    loop = require_disk(topology, len(V))
    if not np.isfinite(V).all():
        wrong = int(np.flatnonzero(~np.isfinite(V).all(axis=1))[0])
        raise InputError(f"vertex {wrong} has a coordinate that is not a finite number; mend it in the mesh")
    corners = intrinsic(V, F)
    u = np.zeros(len(V)) if scale is None else scale
    inner = np.ones(len(V), dtype=bool)
    inner[loop] = False
    free = np.flatnonzero(inner)

    L = corners.stiffness()
    L_ff, L_bf = L[free][:, free], L[loop][:, free]
    cholesky = Cholesky(csc_array(L_ff)) if len(free) else None
    curvature = np.where(inner, 2 * np.pi, np.pi) - corners.angle_sum

    # New boundary curvature: the old one less the normal derivative of u (4.1).
    u_b = u[loop]
    if cholesky is None:
        slope = L[loop][:, loop] @ u_b
    else:
        u_i = cholesky.solve(-curvature[free] - L_bf.T @ u_b)
        slope = L_bf @ u_i + L[loop][:, loop] @ u_b
    turning = curvature[loop] + slope

    curve = _close_curve(V, loop, turning, u_b)
    uv = np.empty((len(V), 2))
    uv[loop] = curve
    if cholesky is not None:
        uv[free] = cholesky.solve(-(L_bf.T @ curve))
    return uv


def flatten_scaled(V: FloatArray, F: NDArray[np.int64]) -> FloatArray:
    """Free-boundary BFF at the scale of the least d, (n, 2) mm."""
    uv = flatten_disk(V, F)
    return uv * best_scale(V, F, uv)


def require_disk(topology: Topology, n_vertices: int) -> NDArray[np.int64]:
    """The boundary loop of a disk; InputError says what else it is."""
    components, _ = topology.face_components()
    loops = topology.boundary_loops
    if components != 1 or len(loops) != 1 or topology.euler != 1 or len(topology.used_vertices) != n_vertices:
        unused = n_vertices - len(topology.used_vertices)
        raise InputError(
            f"only a disk can be flattened: this has {components} components, {len(loops)} boundary loops, Euler number "
            f"{topology.euler} and {unused} unused vertices; cut it first (skinfab segment)"
        )
    return loops[0]


def _close_curve(V: FloatArray, loop: NDArray[np.int64], turning: FloatArray, u: FloatArray) -> FloatArray:
    """The closed polygon with these turning angles whose edge lengths are nearest to the scaled ones (4.3)."""
    length = np.linalg.norm(V[np.roll(loop, -1)] - V[loop], axis=1) * np.exp((u + np.roll(u, -1)) / 2)
    direction = np.cumsum(turning) - turning[0]
    T = np.stack([np.cos(direction), np.sin(direction)])
    # Weighted least squares: a long edge takes its share of the closing error.
    weighted = T * length
    closed = length - length * (T.T @ np.linalg.solve(weighted @ T.T, T @ length))
    steps = closed * T
    return np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=1).T[:-1]])
