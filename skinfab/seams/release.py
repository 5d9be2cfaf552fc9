"""What a dart would gain, at every length of it, told without cutting.

Along a dart the two sides hold each other with forces that vanish once they are apart. With the Hessian of the uncut
layout factored already, letting one side move by itself is a bordered system whose Schur complement is as small as the
dart; the pivots of its Cholesky factor, taken from the boundary inwards, give the decrease for every shorter dart as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import NamedTuple, Protocol

import numba
import numpy as np
from numpy.typing import NDArray

from skinfab.flatten._dirichlet import assemble, vertex_pattern
from skinfab.flatten.flexibility import Flexibility
from skinfab.flatten.isometric import IsometricSolver
from skinfab.seams.leading import leading_energies

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: A dart may end at so many places along its way: enough for the opening's shape between them, and as many columns to solve for.
_ENDS = 6


class Sides(Protocol):
    """What a topology tells of faces and edges; edges may be those of the surface that a piece was opened from."""

    @property
    def FE(self) -> IntArray: ...

    @property
    def EF(self) -> IntArray: ...


@dataclass(frozen=True, eq=False)
class Way:
    """A way for darts, from the boundary of a piece inwards.

    Parameters
    ----------
    vertices : (k,) int64
        Of the piece; the first on its boundary, the others inside.
    edges : (k - 1,) int64
        Between them; of the piece, or of the surface that it was opened from.
    """

    vertices: IntArray
    edges: IntArray

    @cached_property
    def ends(self) -> IntArray:
        """Places along `vertices` where a dart may end: all, or of many so many, evenly."""
        return _ends(len(self.edges))


@cache
def _ends(most: int) -> IntArray:
    return np.unique(np.round(np.linspace(0, most, min(most, _ENDS) + 1)).astype(np.int64))[1:]


class Side(NamedTuple):
    """One side of a way, moving by itself.

    Parameters
    ----------
    rows : (r,) int64
        Unknowns of the layout that meet it.
    forces : (r, k) float64
        On these, for each of its own unknowns.
    stiffness : (k, k) float64
        Against its moving, all else held.
    gradient : (k,) float64
        Of the mean d.
    """

    rows: IntArray
    forces: FloatArray
    stiffness: FloatArray
    gradient: FloatArray


def sides_of(solver: IsometricSolver, UV: FloatArray, topology: Sides, ways: Sequence[Way]) -> list[Side]:
    """The right side of each way.

    Parameters
    ----------
    solver : IsometricSolver
    UV : (n, 2) float64, mm
        At its least d, or near it.
    topology : Sides
        Of the piece.
    ways : sequence of Way
    """
    UV = np.ascontiguousarray(UV)
    sides = []
    for way in ways:
        faces = right_of(way.vertices, way.edges, solver.F, topology.FE, topology.EF)
        sides.append(Side(*_other_side(way.vertices, way.ends, faces, UV, solver.F, solver.gradients, solver.weight)))
    return sides


def releases(flexibility: Flexibility, sides: Sequence[Side]) -> list[FloatArray]:
    """By how much darts along each way lower the mean d, to second order.

    Parameters
    ----------
    flexibility : Flexibility
        Of the layout; what keeps it from covering itself is held as it is.
    sides : sequence of Side
        Of `sides_of`.

    Returns
    -------
    list of (k,) float64
        For the dart to each of the way's `ends`; not falling.
    """
    return [_decreases(side.stiffness - flexibility.energy(side.rows, side.forces), side.gradient) for side in sides]


def held_releases(sides: Sequence[Side]) -> list[FloatArray]:
    """As `releases`, if nothing moved but one side of the dart: less than is gained in truth, and told with no factorisation."""
    return [_decreases(side.stiffness, side.gradient) for side in sides]


def _decreases(stiffness: FloatArray, force: FloatArray) -> FloatArray:
    """What the sides give up with the first two unknowns, the first four, and so on."""
    energy = leading_energies(stiffness, force)
    return np.zeros(len(energy)) if np.isnan(energy).any() else energy  # nothing holds that side: such a seam is no dart


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
    >>> from skinfab.mesh.topology import Topology
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
        while True:
            taken[face] = True
            j = 0
            while F[face, j] != v:
                j += 1
            here = FE[face, j]
            if on_path[here] or EF[here, 1] < 0:
                break
            face = EF[here, 0] + EF[here, 1] - face
    return np.flatnonzero(taken)


@numba.njit(cache=True)
def _other_side(
    path: IntArray, ends: IntArray, faces: IntArray, UV: FloatArray, F: IntArray, gradients: FloatArray, weight: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
    """Of the faces on the right of a path, for one side of it moving by itself, by so much at its first vertex and at each end
    but the last, and in between in proportion: the unknowns met, the forces there, the stiffness against it, the gradient."""
    number = np.full(UV.shape[0], -1)
    met = np.empty(path.shape[0] + 3 * faces.shape[0], dtype=np.int64)
    split = path.shape[0] - 1
    count = split
    met[:count] = path[:-1]
    for j in range(count):
        number[path[j]] = j
    local = np.empty((faces.shape[0], 3), dtype=np.int64)
    for f in range(faces.shape[0]):
        for j in range(3):
            v = F[faces[f], j]
            if number[v] < 0:
                number[v], met[count] = count, v
                count += 1
            local[f, j] = number[v]
    indptr, indices, place = vertex_pattern(local, count)
    data, gradient = assemble(UV[met[:count]], local, gradients[faces], weight[faces], place, indptr)
    nodes = ends.shape[0]
    share = np.zeros((split, nodes))
    for j in range(nodes):
        low, high = (0 if j == 0 else ends[j - 1]), ends[j]
        for i in range(low, min(high, split)):
            part = (i - low) / (high - low)
            share[i, j] = 1 - part
            if j + 1 < nodes:
                share[i, j + 1] = part
    side = np.zeros((2 * count, 2 * nodes))
    for c in range(2 * count):
        for slot in range(indptr[c], indptr[c + 1]):
            r = indices[slot]
            for j in range(nodes):
                if c < 2 * split:
                    side[r, 2 * j + c % 2] += data[slot] * share[c // 2, j]
                if r < 2 * split and r != c:
                    side[c, 2 * j + r % 2] += data[slot] * share[r // 2, j]
    stiff, force = np.zeros((2 * nodes, 2 * nodes)), np.zeros(2 * nodes)
    for i in range(split):
        for j in range(nodes):
            for x in range(2):
                force[2 * j + x] += share[i, j] * gradient[2 * i + x]
                for b in range(2 * nodes):
                    stiff[2 * j + x, b] += share[i, j] * side[2 * i + x, b]
    rows = np.empty(2 * count, dtype=np.int64)
    rows[::2] = 2 * met[:count]
    rows[1::2] = 2 * met[:count] + 1
    return rows, side, stiff, force
