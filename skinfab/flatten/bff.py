"""Boundary first flattening of a disk (Sawhney and Crane 2017), from one Cholesky factorisation or two.

The factor of the interior block of the cotangent Laplacian serves every step: the scale factors (Dirichlet
solve), the boundary's new curvature (Dirichlet-to-Neumann map) and the extension of the boundary curve into the
interior (two harmonic functions). The way back from curvature to scale, which only prescribed angles, curves and
the disk need, has a factor of its own. Numbers in comments are the paper's sections.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.flatten.bff_checks import require_closed, require_lengths, require_upright
from skinfab.flatten.bff_curve import close_curve, scaled_lengths, vertex_scale
from skinfab.flatten.bff_target import fit_circle, fit_curve
from skinfab.flatten.distortion import best_scale
from skinfab.flatten.ears import Halved, halve_chords
from skinfab.flatten.laplacian import Intrinsic, intrinsic
from skinfab.flatten.steklov import NeumannToDirichlet
from skinfab.linalg import Cholesky
from skinfab.mesh.topology import Topology
from skinfab.tolerances import TURNING_SUM_RAD

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Shaped:
    """A disk laid in a target shape.

    On a straight side a triangle whose corners all lie on the border (an ear, say) has no room, and on a round one hardly
    any. So chords, the inner edges from border to border, are halved first (`ears.halve_chords`): the surface is the same,
    its triangles are a few more.

    Parameters
    ----------
    V : (n + k, 3) float64, mm
        The given vertices, then the middles of the chords.
    F : (l, 3) int64
        The given triangles, those at chords in parts.
    UV : (n + k, 2) float64
    chords : (k, 2) int64
        Ends of the edges that were halved; none where every triangle has an inner vertex.
    """

    V: FloatArray
    F: NDArray[np.int64]
    UV: FloatArray
    chords: NDArray[np.int64]

    def __repr__(self) -> str:
        return f"Shaped({len(self.F)} triangles, {len(self.chords)} chords halved)"


class BffSolver:
    """Conformal flattenings of one disk: factored once, laid out for one boundary after the other.

    What is said of the boundary is given in the order of `boundary`, counter-clockwise; edge k runs from its
    vertex k to k + 1.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        A disk: one component, one boundary loop, Euler number 1; every vertex in use.
    topology : Topology, optional
        Of `F`, where it is at hand.
    robust : bool
        Over the intrinsic Delaunay triangulation: fewer flips where triangles are obtuse; `flatten_robust` knows where.

    Attributes
    ----------
    boundary : (b,) int64
    lengths_mm : (b,) float
        Of the boundary edges on the object.

    Raises
    ------
    InputError
        The mesh is not a disk, or a coordinate is not finite. From `angles`, `curve` and `disk`: a boundary vertex
        has triangles without area only.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 0]])
    >>> F = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    >>> solver = BffSolver(V, F)
    >>> uv = solver.free()
    >>> float(np.linalg.norm(uv[2] - uv[0]).round(9)), solver.factorisations, solver.solves
    (1.414213562, 1, 2)
    >>> np.linalg.norm(solver.disk().UV, axis=1).round(9).tolist()
    [1.0, 1.0, 1.0, 1.0, 0.0]
    """

    def __init__(self, V: FloatArray, F: NDArray[np.int64], *, topology: Topology | None = None, robust: bool = False) -> None:
        topology = topology or Topology(F)
        self.boundary = loop = require_disk(topology, len(V))
        require_finite(V)
        corners = _delaunay(V, F, topology) if robust else intrinsic(V, F)
        self._V, self._F, self._topology, self._robust = V, F, topology, robust
        self.lengths_mm = np.linalg.norm(V[np.roll(loop, -1)] - V[loop], axis=1)
        inner = np.ones(len(V), dtype=bool)
        inner[loop] = False
        self._free = np.flatnonzero(inner)
        self._L = corners.laplacian() if robust else corners.laplacian(topology=topology)
        self._L_about_boundary = self._L.about(loop)
        self._cholesky = Cholesky(self._L.block(inner)) if len(self._free) else None
        self._curvature = np.where(inner, 2 * np.pi, np.pi) - corners.angle_sum

    @property
    def factorisations(self) -> int:
        """How many sparse factorisations were done.

        1, or 0 without inner vertices; one more from the first `disk`, `angles`, `curve` or `scale_of` on. Where there are
        chords to halve, `disk` and `curve` have two of their own.
        """
        return sum(factor.factorisations for factor in self._factors)

    @property
    def solves(self) -> int:
        """How many times a factor was used so far; several right-hand sides at once count as one."""
        return sum(factor.solves for factor in self._factors)

    @property
    def _factors(self) -> list[Cholesky | NeumannToDirichlet]:
        own = [factor for factor in (self._cholesky, self.__dict__.get("_to_dirichlet")) if factor is not None]
        room = self.__dict__.get("_roomy", self)
        return own if room is self else own + room._factors

    def free(self) -> FloatArray:
        """Scale factor 1 along the boundary: of all conformal flattenings the one with the least area distortion (4.2); (n, 2) mm."""
        return self.scale(np.zeros(len(self.boundary)))

    def scale(self, u: FloatArray) -> FloatArray:
        """Log scale factors u (b,) along the boundary; (n, 2) mm. Two solves."""
        u = self._checked(u, "scale factors")
        return self._extended(close_curve(scaled_lengths(self.lengths_mm, u), self._turning(u)))

    def lengths(self, target_lengths: FloatArray) -> FloatArray:
        """Boundary edges of these lengths (b,) mm, up to what closing the curve takes; (n, 2) mm. Two solves.

        Raises
        ------
        InputError
            Not one length for each boundary edge, one that is not positive (the object's own such edge included), or one
            longer than all the others together.
        RefusedError
            The curve closes only with an edge more than a quarter off its length, or a triangle would be turned over.
        """
        target = self._checked(target_lengths, "lengths")
        for length, whose in ((target, "the target lengths"), (self.lengths_mm, "the mesh")):
            require_lengths(length, whose)
        turning = self._turning(vertex_scale(self.lengths_mm, target))
        return self._asked(close_curve(target, turning), turning, "with these lengths", length=target)

    def angles(self, turning: FloatArray) -> FloatArray:
        """Turning angles (b,) rad at the boundary vertices, 2 pi together: 0 straight on, pi / 2 a square's corner; (n, 2) mm.

        The size is the one that keeps the boundary's scale factors 1 in the mean.

        Raises
        ------
        InputError
            Not one angle for each boundary vertex, or their sum is not 2 pi.
        RefusedError
            The curve closes only with edges that run backwards, or a triangle would be turned over.
        """
        wanted = self._checked(turning, "turning angles")
        if not abs(wanted.sum() - 2 * np.pi) <= TURNING_SUM_RAD:
            raise InputError(f"the turning angles sum to {wanted.sum():.9g} rad; a closed curve turns by 2 pi, so scale or shift them")
        u = self.scale_of(wanted)
        return self._asked(close_curve(scaled_lengths(self.lengths_mm, u), wanted), wanted, "with these turning angles")

    def curve(self, target_points: FloatArray) -> Shaped:
        """The boundary laid on a closed curve (6.3): `boundary[0]` on its first point, the others where the map is most nearly conformal.

        Parameters
        ----------
        target_points : (k, 2) float, mm
            A simple polygon, counter-clockwise, not repeated at the end.

        Returns
        -------
        Shaped
            At the target's own size and place, the boundary on it, every triangle the right way up. Smooth borders and
            targets settle to rounding; where one has corners the boundary is the one of the least conformal energy.

        Raises
        ------
        InputError
            Fewer than three points, one that is not finite, or a curve that does not run counter-clockwise.
        RefusedError
            A triangle would be turned over (at a corner that turns inwards, most often), or shrink to nothing.
        """
        target = np.asarray(target_points, dtype=np.float64)
        if target.ndim != 2 or target.shape[1] != 2 or len(target) < 3 or not np.isfinite(target).all():
            raise InputError(f"a target curve is an array of three or more finite points (k, 2); this has the shape {target.shape}")
        area = (target[:, 0] * np.roll(target[:, 1], -1) - np.roll(target[:, 0], -1) * target[:, 1]).sum() / 2
        if not area > 0:
            raise InputError(f"the target curve encloses {area:g} mm^2; give its points counter-clockwise, without crossing itself")
        on = self._roomy
        inverse = on._to_dirichlet.pinned
        return self._shaped(
            fit_curve(on.lengths_mm, target, scale_of=on.scale_of, slope_of=on._slope, values_of=inverse), "inside the target curve"
        )

    def disk(self) -> Shaped:
        """The unit disk (6.2), without unit: every boundary vertex on the circle about (0, 0).

        Of the conformal maps onto the disk, which differ by a Moebius transformation, the one whose boundary scale
        factors are balanced: u has no first harmonic around the circle. `boundary[0]` lies at (1, 0).

        Raises
        ------
        RefusedError
            A triangle would be turned over, or shrink to nothing.
        """
        return self._shaped(fit_circle(self._roomy.lengths_mm, self._roomy.scale_of), "inside the disk")

    def _asked(self, closed: FloatArray, turning: FloatArray, where: str, *, length: FloatArray | None = None) -> FloatArray:
        require_closed(closed, turning, length=length)
        uv = self._extended(closed)
        require_upright(self._V, self._F, uv, where)
        return uv

    def _shaped(self, places: FloatArray, where: str) -> Shaped:
        on = self._roomy
        uv = on._extended(places)
        require_upright(on._V, on._F, uv, where, face_of=self._halved.face_of)
        return Shaped(on._V, on._F, uv, self._halved.chords)

    @cached_property
    def _halved(self) -> Halved:
        return halve_chords(self._V, self._F, topology=self._topology)

    @cached_property
    def _roomy(self) -> BffSolver:
        """This, or a solver for the same surface with its chords halved."""
        if not len(self._halved.chords):
            return self
        solver = BffSolver(self._halved.V, self._halved.F, robust=self._robust)
        # A new loop may begin elsewhere; halving inner edges leaves its vertices and their order.
        solver.boundary, solver.lengths_mm = self.boundary, self.lengths_mm
        return solver

    def scale_of(self, turning: FloatArray) -> FloatArray:
        """(b,) log scale factors, of mean zero, that make the boundary turn by (b,) rad (Neumann to Dirichlet, 4.1)."""
        return self._to_dirichlet(turning - self._free_turning)

    @cached_property
    def _to_dirichlet(self) -> NeumannToDirichlet:
        return NeumannToDirichlet(self._L, self.boundary)

    @cached_property
    def _free_turning(self) -> FloatArray:
        return self._turning(np.zeros(len(self.boundary)))

    def _turning(self, u: FloatArray) -> FloatArray:
        """New boundary curvature: the old one with the normal derivative of u (4.1)."""
        turning: FloatArray = self._curvature[self.boundary] + self._slope(u, self._curvature[self._free])
        return turning

    def _slope(self, values: FloatArray, source: FloatArray | float = 0.0) -> FloatArray:
        """Normal derivative, integrated at each boundary vertex, of the function with L f = -source inside and these boundary values."""
        f = self._harmonic(values, source)
        return (self._L_about_boundary @ f)[self.boundary]

    def _extended(self, curve: FloatArray) -> FloatArray:
        """Boundary curve and the harmonic functions inside (4.4)."""
        return self._harmonic(curve)

    def _harmonic(self, values: FloatArray, source: FloatArray | float = 0.0) -> FloatArray:
        """The function (n,) or (n, k) with L f = -source inside and these values on the boundary. One solve."""
        f = np.zeros((len(self._curvature), *values.shape[1:]))
        f[self.boundary] = values
        if self._cholesky is not None:
            f[self._free] = self._cholesky.solve(-source - (self._L_about_boundary @ f)[self._free])
        return f

    def _checked(self, values: FloatArray, what: str) -> FloatArray:
        values = np.asarray(values, dtype=np.float64)
        b = len(self.boundary)
        if values.shape != (b,) or not np.isfinite(values).all():
            raise InputError(
                f"{what} are {b} finite numbers, one for each vertex or edge of the boundary; this has the shape {values.shape}"
            )
        return values


def _delaunay(V: FloatArray, F: NDArray[np.int64], topology: Topology) -> Intrinsic:
    from skinfab.flatten.delaunay import delaunay_corners  # a compiler loads with it, for the few meshes that need it

    return delaunay_corners(V, F, topology=topology)


def flatten_disk(V: FloatArray, F: NDArray[np.int64], *, scale: FloatArray | None = None, topology: Topology | None = None) -> FloatArray:
    """Conformal flattening of a disk whose boundary scale factors are given: `BffSolver` for one use.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        A disk: one component, one boundary loop, Euler number 1; every vertex in use.
    scale : (n,) float, optional
        Log scale factors u; only the boundary's are read. Zero, the default, is the free boundary.
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
    solver = BffSolver(V, F, topology=topology)
    return solver.free() if scale is None else solver.scale(scale[solver.boundary])


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


def require_finite(V: FloatArray) -> None:
    """InputError names the first vertex (n, 3) with a coordinate that is no finite number."""
    finite = np.isfinite(V).all(axis=1)
    if not finite.all():
        raise InputError(f"vertex {int(np.argmin(finite))} has a coordinate that is not a finite number; mend it in the mesh")
