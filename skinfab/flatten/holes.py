"""Surfaces with holes, laid flat as disks: the holes are filled for the solve, and empty again after it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.flatten.distortion import best_scale, shaped_areas, singular_values
from skinfab.flatten.robust import flatten_robust
from skinfab.mesh.inspect import inspect
from skinfab.mesh.polygons import triangulate
from skinfab.mesh.topology import Topology
from skinfab.tolerances import FLAT_START, OVERLAP_FRACTION

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: The triangulation of a bent-in hole takes time with the square of its edges, half a second for so many.
_MOST_EDGES = 10_000


def border_of(V: FloatArray, topology: Topology) -> int:
    """Which boundary loop is the border of a disk with or without holes: the widest.

    The one whose points lie farthest from their middle (root mean square, mm); a jagged hole may well be longer than the border.

    Raises
    ------
    InputError
        Several components, unused or missing vertices, a closed surface, handles, or a coordinate that is not finite.

    Examples
    --------
    >>> square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> border_of(square, Topology(np.array([[0, 1, 2], [0, 2, 3]])))
    0
    """
    if len(topology.F) and (topology.F.min() < 0 or topology.F.max() >= len(V)):
        face = int(np.flatnonzero(((topology.F < 0) | (topology.F >= len(V))).any(axis=1))[0])
        raise InputError(f"face {face} uses vertices {topology.F[face].tolist()}; there are 0 to {len(V) - 1}, so mend the mesh")
    F = topology.F
    if not topology.is_oriented_manifold:
        for fault in inspect(V, F).faults:
            # Vertices of two fans and unused ones are told below in the words of holes and borders.
            if fault.mended_by != "nothing" and not fault.first.startswith("vertex"):
                raise InputError(f"the surface has a {fault.kind} (first: {fault.first}); mend the mesh first (skinfab.mesh.repair)")
    loops = topology.boundary_loops
    components, _ = topology.face_components()
    unused = len(V) - len(topology.used_vertices)
    handles = (2 - len(loops) - topology.euler) // 2
    why = ""
    if components != 1:
        why = f"this has {components} components; take them one by one"
    elif unused:
        why = f"this has {unused} unused vertices; remove them"
    elif not loops:
        why = "this is closed; cut it first (skinfab segment, or --method auto)"
    elif handles:
        why = f"this has {'a handle' if handles == 1 else f'{handles} handles'}; cut it first (skinfab segment, or --method auto)"
    if why:
        raise InputError(f"only a disk can be flattened, with holes or without: {why}")
    if not np.isfinite(V).all():
        wrong = int(np.flatnonzero(~np.isfinite(V).all(axis=1))[0])
        raise InputError(f"vertex {wrong} has a coordinate that is not a finite number; mend it in the mesh")
    if not shaped_areas(V, F)[1].any():
        raise InputError(f"none of the {len(F)} triangles has an area, so that there is nothing to lay flat; check the mesh")
    return int(np.argmax([_width(V[loop]) for loop in loops]))


def _width(line: FloatArray) -> float:
    weight = _weights(line)
    from_middle = ((line - _middle(line)) ** 2).sum(axis=1)
    return float(weight @ from_middle / weight.sum()) if weight.sum() > 0 else 0.0


def fill_holes(V: FloatArray, F: IntArray, *, topology: Topology | None = None) -> tuple[FloatArray, IntArray]:
    """The mesh with every hole filled: each boundary loop but the widest, which stays the border.

    A hole is filled by a fan about a new vertex in its middle, or, where that would fold over itself, by triangles
    between its own vertices.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        One component of genus 0 with a boundary; every vertex in use.
    topology : Topology, optional
        Of `F`, where it is at hand.

    Returns
    -------
    V : (n + h, 3) float64, mm
        The given vertices, then the middle of each hole that has a fan.
    F : (m + k, 3) int64
        The given faces, then the fillings.

    Raises
    ------
    InputError
        Even with its holes filled it is no disk: closed, with a handle, or in several components; or a hole is
        pinched to a vertex.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [3, 0, 0], [0, 3, 0], [0.9, 0.9, 0], [1.2, 0.9, 0], [0.9, 1.2, 0]])
    >>> ring = np.array([[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]])
    >>> W, G = fill_holes(V, ring)
    >>> W[6:].round(6).tolist(), len(G), Topology(G).euler
    ([[1.006066, 1.006066, 0.0]], 9, 1)
    """
    topology = topology or Topology(F)
    border = border_of(V, topology)
    middles: list[FloatArray] = []
    fillings: list[IntArray] = []
    for k, loop in enumerate(topology.boundary_loops):
        if k == border:
            continue
        if len(np.unique(loop)) < len(loop):
            twice = int(np.flatnonzero(np.bincount(loop) > 1)[0])
            raise InputError(
                f"a hole meets itself at vertex {twice}; give each side a vertex of its own there, as reading from a file does"
            )
        middle = _middle(V[loop])
        if _folds(V[loop], middle) and (inside := _between(V, loop, topology)) is not None:
            fillings.append(inside)
            continue
        fillings.append(np.column_stack([np.roll(loop, -1), loop, np.full(len(loop), len(V) + len(middles))]))
        middles.append(middle)
    return (np.vstack([V, *middles]) if middles else V), (np.vstack([F, *fillings]) if fillings else F)


def _middle(line: FloatArray) -> FloatArray:
    """The middle of a closed line, not of its vertices, whose spacing says nothing about the hole."""
    weight = _weights(line)
    middle: FloatArray = weight @ line / weight.sum() if weight.sum() > 0 else line.mean(axis=0)
    return middle


def _weights(line: FloatArray) -> FloatArray:
    """How much of a closed line belongs to each of its points, mm: the two edges beside it."""
    step: FloatArray = np.linalg.norm(np.roll(line, -1, axis=0) - line, axis=1)
    return step + np.roll(step, 1)


def _folds(line: FloatArray, middle: FloatArray) -> bool:
    """A fan about the middle has triangles that face against the rest."""
    spoke = line - middle
    normal = np.cross(spoke, np.roll(spoke, -1, axis=0))
    return bool((normal @ normal.sum(axis=0) < 0).any())


def _between(V: FloatArray, loop: IntArray, topology: Topology) -> IntArray | None:
    """Triangles between the vertices of a hole; None where one would run along an edge that the mesh has already."""
    if len(loop) > _MOST_EDGES:
        return None
    inside = triangulate(V, loop[::-1], np.array([len(loop)]))
    filled = Topology(inside)
    across = filled.E[~filled.is_boundary]
    return inside if filled.edge_count.max() <= 2 and (topology.edge_ids(across) < 0).all() else None


def flatten_filled(V: FloatArray, F: IntArray, *, topology: Topology | None = None) -> FloatArray:
    """Free-boundary BFF of a surface with or without holes, with the fewest flips, at the scale of the least d.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        One component of genus 0 with a boundary; every vertex in use.
    topology : Topology, optional
        Of `F`, where it is at hand.

    Returns
    -------
    (n, 2) float64, mm

    Raises
    ------
    InputError
        Even with its holes filled it is no disk: closed, with a handle, or in several components.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [3, 0, 0], [0, 3, 0], [0.9, 0.9, 0], [1.2, 0.9, 0], [0.9, 1.2, 0]])
    >>> ring = np.array([[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]])
    >>> uv = flatten_filled(V, ring)
    >>> float(np.linalg.norm(uv[5] - uv[4]).round(6))
    0.424264
    """
    topology = topology or Topology(F)
    W, G = fill_holes(V, F, topology=topology)
    uv = flatten_robust(W, G, topology=topology if G is F else None, counted=len(F))[: len(V)]
    return uv * best_scale(V, F, uv)


def flatten_least(
    V: FloatArray, F: IntArray, *, topology: Topology | None = None, say: Callable[[str], object] | None = None
) -> FloatArray:
    """The least mean d of a surface with or without holes: `flatten_isometric`, then the holes left to themselves.

    Where a hole's rim would come to lie on itself or on another, the layout with filled holes is kept.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        One component of genus 0 with a boundary; every vertex in use.
    topology : Topology, optional
        Of `F`, where it is at hand.
    say : function, optional
        Is told in one sentence where BFF's layout had to be untangled.

    Returns
    -------
    (n, 2) float64, mm
        No triangle is flipped.

    Raises
    ------
    InputError
        Even with its holes filled it is no disk: closed, with a handle, or in several components.
    """
    from skinfab.flatten.disk import flatten_isometric, lower
    from skinfab.flatten.isometric import IsometricSolver
    from skinfab.flatten.overlap import overlap_area

    topology = topology or Topology(F)
    W, G = fill_holes(V, F, topology=topology)
    if G is F:
        return flatten_isometric(V, F, topology=topology, say=say)
    start = flatten_robust(W, G, counted=len(F))[: len(V)]
    s = singular_values(V, F, start)
    if np.isfinite(s).all() and s[:, 1].min() >= FLAT_START * s[:, 0].max():
        freed = lower(V, F, start, topology=topology).UV
        if overlap_area(F, freed, topology=topology) <= _nothing(freed):
            return freed
    filled = flatten_isometric(W, G, say=say)[: len(V)]
    filled = filled * best_scale(V, F, filled)
    freed = IsometricSolver(V, F).refine(filled).UV
    if overlap_area(F, freed, topology=topology) <= overlap_area(F, filled, topology=topology) + _nothing(freed):
        return freed
    return filled


def flatten_apart(V: FloatArray, F: IntArray, *, topology: Topology | None = None) -> FloatArray:
    """The least mean d without overlap of a surface with or without holes: `flatten_bijective` with its holes filled.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        One component of genus 0 with a boundary; every vertex in use.
    topology : Topology, optional
        Of `F`, where it is at hand.

    Returns
    -------
    (n, 2) float64, mm
        No triangle is flipped, and nothing is covered twice.

    Raises
    ------
    InputError
        Even with its holes filled it is no disk: closed, with a handle, or in several components.
    """
    from skinfab.flatten.bijective import flatten_bijective

    topology = topology or Topology(F)
    W, G = fill_holes(V, F, topology=topology)
    uv = flatten_bijective(W, G, topology=topology if G is F else None)
    return uv if G is F else uv[: len(V)] * best_scale(V, F, uv[: len(V)])


def _nothing(UV: FloatArray) -> float:
    """An area that is none, mm^2."""
    return OVERLAP_FRACTION * float(np.prod(np.ptp(UV, axis=0)))
