"""What a dart would gain, at every length of it, told without cutting.

Along a dart the two sides hold each other with forces that vanish once they are apart. With the Hessian of the uncut
layout factored already, letting one side move by itself is a bordered system whose Schur complement is as small as the
dart; the pivots of its Cholesky factor, taken from the boundary inwards, give the decrease for every shorter dart as well.
"""

from __future__ import annotations

from collections.abc import Sequence

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

from skinfab.flatten._dirichlet import assemble, vertex_pattern
from skinfab.flatten.isometric import Apart, IsometricSolver
from skinfab.mesh.topology import Topology
from skinfab.tolerances import NEWTON_RIDGE

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def releases(
    solver: IsometricSolver, UV: FloatArray, topology: Topology, paths: Sequence[IntArray], *, apart: Apart | None = None
) -> list[FloatArray]:
    """By how much each dart lowers the mean d, to second order.

    Parameters
    ----------
    solver : IsometricSolver
    UV : (n, 2) float64, mm
        At its least d, or near it.
    topology : Topology
        Of the piece.
    paths : sequence of (k,) int64
        Vertices from the boundary to the tip.
    apart : Apart, optional
        What keeps the layout from covering itself; it is held as it is.

    Returns
    -------
    list of (k - 1,) float64
        For the dart that ends on the second vertex of the path, on the third, and so on; not falling.
    """
    factor = solver.factored(UV, apart)
    UV = np.ascontiguousarray(UV)
    sides = []
    for path in paths:
        faces = right_of(path, path_edges(topology, path), solver.F, topology.FE, topology.EF)
        sides.append(_other_side(path, faces, UV, solver.F, solver.gradients, solver.weight))
    loads = np.zeros((2 * solver.n, sum(side.shape[1] for _, side, _ in sides)))
    column = 0
    for rows, side, _ in sides:
        loads[rows, column : column + side.shape[1]] = side
        column += side.shape[1]
    moved = factor.solve(loads)
    found, column = [], 0
    for rows, side, force in sides:
        k = side.shape[1]
        # The split vertices come first among the rows.
        stiffness = side[:k] - side.T @ moved[rows, column : column + k]
        stiffness[np.diag_indices(k)] += NEWTON_RIDGE * np.trace(side[:k]) / k
        column += k
        try:
            L = np.linalg.cholesky((stiffness + stiffness.T) / 2)
        except np.linalg.LinAlgError:  # nothing holds that side: such a seam is no dart
            found.append(np.zeros(k // 2))
            continue
        share = solve_triangular(L, force, lower=True, check_finite=False)
        found.append(0.5 * np.cumsum(share**2)[1::2])
    return found


def path_edges(topology: Topology, path: IntArray) -> IntArray:
    """Edges between the vertices of a path, (k - 1,)."""
    return topology.edge_ids(np.stack([path[:-1], path[1:]], axis=1))


@numba.njit(cache=True)
def right_of(path: IntArray, edges: IntArray, F: IntArray, FE: IntArray, EF: IntArray) -> IntArray:
    """Faces that touch a path on its right, at all its vertices but the last.

    Parameters
    ----------
    path : (k,) int64
        Vertices; the first on the boundary, the others inside.
    edges : (k - 1,) int64
        Between them.
    F, FE, EF
        Of the topology of a disk.

    Examples
    --------
    >>> fan = Topology(np.array([[4, 0, 1], [4, 1, 2], [4, 2, 3], [4, 3, 0]]))
    >>> right_of(np.array([0, 4]), fan.edge_ids(np.array([[0, 4]])), fan.F, fan.FE, fan.EF).tolist()
    [0]
    """
    taken = np.zeros(F.shape[0], dtype=np.bool_)
    on_path = np.zeros(EF.shape[0], dtype=np.bool_)
    on_path[edges] = True
    for k in range(edges.shape[0]):
        v, w, face = path[k], path[k + 1], EF[edges[k], 0]
        # The face that runs w -> v has that edge on its left: it lies on the right of v -> w.
        for j in range(3):
            if F[face, j] == v and F[face, (j + 1) % 3] == w:
                face = EF[edges[k], 1]
                break
        while face >= 0:
            taken[face] = True
            j = 0
            while F[face, j] != v:
                j += 1
            here = FE[face, j]
            if on_path[here]:
                break
            face = EF[here, 0] + EF[here, 1] - face  # past the boundary: -1
    return np.flatnonzero(taken)


@numba.njit(cache=True)
def _other_side(
    path: IntArray, faces: IntArray, UV: FloatArray, F: IntArray, gradients: FloatArray, weight: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Of the faces on the right of a path: the unknowns they meet (those of the split vertices first), their part of the
    Hessian's columns of the split vertices, and of the gradient."""
    number = np.full(UV.shape[0], -1)
    met = np.empty(path.shape[0] + 3 * faces.shape[0], dtype=np.int64)
    count = 0
    for v in path[:-1]:
        number[v], met[count] = count, v
        count += 1
    k = 2 * count
    local = np.empty((faces.shape[0], 3), dtype=np.int64)
    for f in range(faces.shape[0]):
        for j in range(3):
            v = F[faces[f], j]
            if number[v] < 0:
                number[v], met[count] = count, v
                count += 1
            local[f, j] = number[v]
    u = UV[met[:count]]
    indptr, indices, place = vertex_pattern(local, count)
    data, gradient = assemble(u, local, gradients[faces], weight[faces], place, indptr)
    columns = np.zeros((2 * count, k))
    for c in range(2 * count):
        for slot in range(indptr[c], indptr[c + 1]):
            r = indices[slot]
            if c < k:
                columns[r, c] = data[slot]
            if r < k:
                columns[c, r] = data[slot]
    rows = np.empty(2 * count, dtype=np.int64)
    rows[::2] = 2 * met[:count]
    rows[1::2] = 2 * met[:count] + 1
    return rows, columns, gradient[:k]
