"""Cone singularities: take the curvature in at a few points and cut through them (BFF, section 5).

With u = 0 at the cones and on the boundary, u is the scale that lays everything else flat; the cone angles
follow from it. A cone put where |u| is largest takes most area distortion away. Where the cone angles are given
instead, u is free at the cones and follows from the angles.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from skinfab.errors import InputError
from skinfab.flatten.bff import require_finite
from skinfab.flatten.laplacian import intrinsic
from skinfab.linalg import Cholesky
from skinfab.mesh.topology import Topology
from skinfab.tolerances import FLAT_SCALE, TURNING_SUM_RAD

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: What a cone and the seam to it must be worth in mean d. At half of it a fine sphere gets 24 instead of 14; at 0.006 a
#: dodecahedron keeps only 14 of its 20 corners.
_PRICE = 0.004

#: No more than this many are placed automatically, worth it or not.
_MOST_CONES = 64


class ConeField:
    """The scale factors that flatten everything but the cones, while cones are added: one factorisation, one solve a cone.

    A cone is a constraint u = 0 at one vertex. Its column of the inverse, made orthogonal in energy to those of the
    cones before it, says how u gives way to it.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        One component, every vertex in use.
    topology : Topology

    Raises
    ------
    InputError
        A coordinate is not finite.

    Attributes
    ----------
    u : (n,) float
        Log scale factors; zero at cones and on the boundary.
    cones : list of int
        On a closed mesh there is one from the start, the sharpest vertex.
    """

    def __init__(self, V: FloatArray, F: IntArray, topology: Topology) -> None:
        require_finite(V)
        corners = intrinsic(V, F)
        defect = 2 * np.pi - corners.angle_sum
        fixed = _on_boundary(topology, len(V))
        self.cones: list[int] = []
        if not fixed.any():
            self.cones.append(int(np.argmax(np.abs(defect))))
            fixed[self.cones] = True
        self.sharpness = np.where(fixed, 0.0, np.abs(defect))
        self._share = _area_share(V, F)
        self._free = free = np.flatnonzero(~fixed)
        self._row = np.cumsum(~fixed) - 1
        L = corners.stiffness()
        self._cholesky = Cholesky(csc_array(L[free][:, free])) if len(free) else None
        self.u = self._solved(-defect[free])
        self._columns: list[tuple[int, FloatArray]] = []

    @property
    def factorisations(self) -> int:
        """1, or 0 where every vertex is on the boundary."""
        return self._cholesky.factorisations if self._cholesky else 0

    @property
    def solves(self) -> int:
        """One, and one for each cone added."""
        return self._cholesky.solves if self._cholesky else 0

    @property
    def worst(self) -> int:
        """The vertex whose scale factor is farthest from zero."""
        return int(np.argmax(np.abs(self.u)))

    @property
    def mean_d(self) -> float:
        """Mean d of the conformal map with these factors at its best scale: 4 sqrt(<e^2u> <e^-2u>), areas as weights."""
        high, low = self.u.max(), self.u.min()
        spread = np.log(self._share @ np.exp(2 * (self.u - high))) + np.log(self._share @ np.exp(2 * (low - self.u)))
        # Past e^300 all are alike: worthless.
        return 4 * float(np.exp(min(spread / 2 + high - low, 300.0)))

    def add(self, vertex: int) -> None:
        """One more cone, at an inner vertex that is none yet."""
        unit = np.zeros(len(self._free))
        unit[self._row[vertex]] = 1.0
        column = self._solved(unit)
        for cone, earlier in self._columns:
            column = column - earlier * (column[cone] / earlier[cone])
        self._columns.append((vertex, column))
        self.u = self.u - column * (self.u[vertex] / column[vertex])
        self.cones.append(vertex)
        self.u[self.cones] = 0.0

    def _solved(self, right: FloatArray) -> FloatArray:
        x = np.zeros(len(self._share))
        if self._cholesky is not None:
            x[self._free] = self._cholesky.solve(right)
        return x


def cone_scale(
    V: FloatArray, F: IntArray, cones: IntArray, angles: FloatArray | None = None, *, topology: Topology | None = None
) -> tuple[FloatArray, FloatArray]:
    """Log scale factors that flatten everything but the cones, and the cones' curvature.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        One component, every vertex in use.
    cones : (c,) int64
        Inner vertices, each once; at least one when the mesh is closed.
    angles : (c,) float, rad, optional
        Cone angles: the corners about the cone, added up in the flat layout; 2 pi minus its curvature. 3/2 pi is a
        cube's corner, 2 pi no cone at all. On a closed mesh they sum to 2 pi times the number of cones less the Euler
        number (Gauss-Bonnet); on an open one the boundary turns by what they leave over. Default: u = 0 at the cones.

    Returns
    -------
    u : (n,) float
        Zero on the boundary; zero at cones without given angles. On a closed mesh with angles of area-weighted mean zero.
    curvature : (c,) float, rad
        2 pi minus the cone's angle. With the boundary's turning they sum to 2 pi times the Euler number.

    Raises
    ------
    InputError
        A coordinate is not finite; a cone is no vertex, on the boundary or given twice; a closed mesh without cones
        (there is nowhere for its curvature to go); not one angle for each cone, one that is not positive, or angles
        that a closed surface cannot have.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 1, 0], [1, 0, 1], [0, 1, 1]])
    >>> F = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    >>> u, curvature = cone_scale(V, F, np.arange(4), np.full(4, np.pi))
    >>> bool(np.abs(u).max() < 1e-9), np.degrees(curvature).round(6).tolist()
    (True, [180.0, 180.0, 180.0, 180.0])
    """
    require_finite(V)
    topology = topology or Topology(F)
    pinned = _on_boundary(topology, len(V))
    closed = not pinned.any()
    cones = _checked_cones(cones, pinned)
    corners = intrinsic(V, F)
    L = corners.stiffness()
    defect = 2 * np.pi - corners.angle_sum
    left = np.zeros(len(V))
    if angles is None:
        pinned[cones] = True
    else:
        left[cones] = 2 * np.pi - _checked_angles(angles, len(cones), topology.euler if closed else None)
        # Curvature fixes u up to a constant only.
        pinned[cones[:1]] |= closed
    free = np.flatnonzero(~pinned)
    u = np.zeros(len(V))
    if len(free):
        u[free] = Cholesky(csc_array(L[free][:, free])).solve((left - defect)[free])
    if closed and angles is not None:
        u -= _area_share(V, F) @ u
    return u, defect[cones] + (L @ u)[cones]


def _checked_cones(cones: IntArray, boundary: NDArray[np.bool_]) -> IntArray:
    cones = np.asarray(cones)
    if not cones.size:
        if not boundary.any():
            raise InputError("a closed mesh needs at least one cone; use --cones 8, --cones auto or a list of vertices")
        return np.zeros(0, dtype=np.int64)
    if cones.ndim != 1 or not np.issubdtype(cones.dtype, np.integer):
        raise InputError(f"cones are vertices, an array (c,) of whole numbers; this is {cones.dtype} of the shape {cones.shape}")
    if missing := [int(c) for c in cones if not 0 <= c < len(boundary)]:
        raise InputError(f"cone vertex {missing[0]} does not exist; the mesh has vertices 0 to {len(boundary) - 1}")
    vertex, times = np.unique(cones, return_counts=True)
    if (times > 1).any():
        raise InputError(f"cone vertex {vertex[times > 1][0]} is given {times[times > 1][0]} times; give every cone once")
    if boundary[cones].any():
        raise InputError(f"cone vertex {cones[boundary[cones]][0]} lies on the boundary, which is no place for a cone; give inner vertices")
    return cones.astype(np.int64, copy=False)


def _checked_angles(angles: FloatArray, n_cones: int, euler: int | None) -> FloatArray:
    """The angles, if a surface can have them; `euler` is the Euler number of a closed one."""
    angles = np.asarray(angles, dtype=np.float64)
    if angles.shape != (n_cones,):
        raise InputError(f"cone angles are one number for each of the {n_cones} cones; this has the shape {angles.shape}")
    wrong = np.flatnonzero(~(np.isfinite(angles) & (angles > 0)))
    if len(wrong):
        raise InputError(f"cone angle {wrong[0]} is {np.degrees(angles[wrong[0]]):.9g} degrees; give more than 0, 360 being flat")
    if euler is None:
        return angles
    due, got = 360 * (n_cones - euler), float(np.degrees(angles.sum()))
    if due <= 0:
        raise InputError(
            f"{n_cones} cones cannot take the curvature of a closed surface of Euler number {euler} at positive angles; "
            f"give {euler + 1} or more"
        )
    if not abs(got - due) <= np.degrees(TURNING_SUM_RAD):
        raise InputError(
            f"the cone angles sum to {got:.9g} degrees; {n_cones} cones on a closed surface of Euler number {euler} "
            f"must sum to {due} (Gauss-Bonnet), so change them by {due - got:+.9g} together"
        )
    return angles


def _on_boundary(topology: Topology, n_vertices: int) -> NDArray[np.bool_]:
    on = np.zeros(n_vertices, dtype=bool)
    on[topology.E[topology.is_boundary].ravel()] = True
    return on


def _area_share(V: FloatArray, F: IntArray) -> FloatArray:
    """(n,) each vertex's part of the area, 1 together."""
    twice = np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1)
    area = np.bincount(F.ravel(), np.repeat(twice, 3), len(V))
    share: FloatArray = area / area.sum()
    return share


def place_cones(V: FloatArray, F: IntArray, *, count: int | None = None, topology: Topology | None = None) -> IntArray:
    """Vertices for `count` cones, or for as many as pay.

    Each cone goes where the log scale factor is farthest from zero under the cones so far. On a closed mesh the
    first goes to the sharpest vertex. Of the numbers of cones from none to 64, that one is taken at which mean d and
    a price of 0.004 for each cone are least together: all the corners of a polyhedron, 14 points of a fine sphere.

    Parameters
    ----------
    V, F
        As for `cone_scale`.
    count : int, optional
        How many; fewer where there are no more curved vertices.

    Returns
    -------
    (c,) int64
        None twice, in the order in which they were placed.

    Raises
    ------
    InputError
        `count` is not positive, or a coordinate is not finite.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> F = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> sorted(place_cones(V, F, count=4).tolist())
    [0, 1, 2, 3]
    """
    if count is not None and count < 1:
        raise InputError(f"{count} cones cannot be placed; give at least 1")
    field = ConeField(V, F, topology or Topology(F))
    most = _MOST_CONES if count is None else count
    best, least = len(field.cones), np.inf
    while True:
        cost = field.mean_d - 4 + _PRICE * len(field.cones)
        if cost < least:
            best, least = len(field.cones), cost
        exhausted = abs(field.u[field.worst]) < FLAT_SCALE
        too_dear = count is None and _PRICE * len(field.cones) >= least
        if exhausted or too_dear or len(field.cones) >= most:
            break
        field.add(field.worst)
    cones = field.cones[:best] if count is None else field.cones + _sharpest_left(field, count - len(field.cones))
    return np.array(cones, dtype=np.int64)


def _sharpest_left(field: ConeField, missing: int) -> list[int]:
    """When u is already zero everywhere, the rest are the sharpest inner vertices left."""
    score = field.sharpness.copy()
    score[field.cones] = 0.0
    order = np.argsort(-score, kind="stable")[: max(missing, 0)]
    return [int(v) for v in order if score[v] > FLAT_SCALE]
