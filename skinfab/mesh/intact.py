"""Whether a mesh is so plainly in order that there is nothing to clean and nothing to refuse."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.model import Mesh
from skinfab.tolerances import DEGENERATE_HEIGHT

FloatArray = NDArray[np.float64]

# Computed a shorter way than `relative_heights`: faces this many times the bound high are above it, rounding or not.
_CLEAR_OF_ROUNDING = 10.0


def is_intact(mesh: Mesh) -> bool:
    """True where `clean` would do nothing and `require_usable` find nothing to refuse.

    Most meshes are: they are spared the search for what is wrong, which takes ten times as long. False
    says nothing, only that it has to be looked at.

    Parameters
    ----------
    mesh : Mesh
        May hold NaN, and use vertices that do not exist.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [10, 0, 0], [0, 10, 0], [0, 0, 10]])
    >>> F = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    >>> is_intact(Mesh(V, F)), is_intact(Mesh(V, F[:, ::-1]))
    (True, False)
    """
    V, F = mesh.V, mesh.F
    if not len(F) or F.min() < 0 or F.max() >= len(V) or not np.isfinite(V).all():
        return False
    used = np.zeros(len(V), dtype=bool)
    used[F] = True
    if not (used.all() and mesh.topology.is_oriented_manifold):
        return False
    return _all_have_area(V, F) and _no_cracks(mesh) and _closed_face_outward(mesh)


def _all_have_area(V: FloatArray, F: NDArray[np.int64]) -> bool:
    x, y, z = np.ascontiguousarray(V.T)
    a, b, c = np.ascontiguousarray(F.T)

    def side(start: NDArray[np.int64], end: NDArray[np.int64]) -> tuple[FloatArray, FloatArray, FloatArray]:
        return x[end] - x[start], y[end] - y[start], z[end] - z[start]

    with np.errstate(over="ignore", invalid="ignore"):
        ux, uy, uz = side(a, b)
        vx, vy, vz = side(a, c)
        cross = (uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + (ux * vy - uy * vx) ** 2
        # The third side is at most the sum of these two.
        longest_square = 4 * np.maximum(ux**2 + uy**2 + uz**2, vx**2 + vy**2 + vz**2)
        return bool((cross > (_CLEAR_OF_ROUNDING * DEGENERATE_HEIGHT * longest_square) ** 2).all())


def _no_cracks(mesh: Mesh) -> bool:
    """No two vertices at the same place, or no border along which they could be joined."""
    if not mesh.topology.is_boundary.any():
        return True
    # One number a vertex, for a single sort; where two agree by chance the mesh is looked at in full.
    bits = (mesh.V + 0.0).view(np.uint64)  # -0.0 and 0.0 are one number
    factors = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], dtype=np.uint64)
    mixed = (bits ^ (bits >> np.uint64(29))) * factors
    place = np.sort(mixed[:, 0] ^ (mixed[:, 1] >> np.uint64(7)) ^ (mixed[:, 2] << np.uint64(9)) ^ mixed[:, 1] ^ mixed[:, 2])
    return not (place[1:] == place[:-1]).any()


def _closed_face_outward(mesh: Mesh) -> bool:
    """Every closed component has positive volume; cavities are for `clean` to tell from parts inside out."""
    top = mesh.topology
    count, label = top.face_components()
    closed = np.ones(count, dtype=bool)
    closed[label[top.EF[top.is_boundary, 0]]] = False
    if not closed.any():
        return True
    p = mesh.V[mesh.F] - mesh.V.mean(axis=0)
    volume = np.bincount(label, weights=np.einsum("ij,ij->i", p[:, 0], np.cross(p[:, 1], p[:, 2])), minlength=count)
    return bool((volume[closed] > 0).all())
