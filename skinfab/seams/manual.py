"""Seams by hand: a text file of vertex paths.

One path a line: vertex numbers (counted from 0, in the order of the mesh file) parted by blanks or commas;
`#` starts a comment. Neighbours on a line that share no edge are joined by the cheapest path over edges,
creases preferred. A path may close by ending where it began, and may touch or cross others::

    # round the wrist, then up the back
    12 87 140 12
    140 522
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from skinfab.errors import InputError, RefusedError
from skinfab.mesh.model import Mesh
from skinfab.mesh.topology import Topology
from skinfab.seams.auto import Aim, Seams, find_seams
from skinfab.seams.cut import OpenPiece, open_pieces
from skinfab.seams.even import brought_within
from skinfab.seams.graph import edge_graph, trace
from skinfab.seams.judge import Limits, Verdict, excess, judge
from skinfab.seams.naming import as_paths, bounds_of, idle, named_edges
from skinfab.seams.refine import next_cut, refine_seams
from skinfab.seams.rules import EdgeRules
from skinfab.seams.weights import seam_weights

IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

#: A cuts file longer than this is not one.
_MOST_BYTES = 50_000_000

#: So many of the paths that would help are told; the next attempt tells the rest.
_SAID = 3


def read_cuts(path: str | Path, n_vertices: int) -> list[IntArray]:
    """Vertex paths of a cuts file.

    Parameters
    ----------
    path : path
    n_vertices : int
        Of the mesh file, for the range check.

    Raises
    ------
    InputError
        Unreadable, not numbers, a vertex that does not exist, or no path at all; the line is named.
    """
    path = Path(path)
    try:
        if path.stat().st_size > _MOST_BYTES:
            raise InputError(f"{path} is too large for a file of vertex paths")
        lines = path.read_text(encoding="utf-8").splitlines()
    except OSError as fault:
        raise InputError(f"cannot read the cuts file {path}: {fault.strerror}") from fault
    except UnicodeDecodeError as fault:
        raise InputError(f"{path} is not a text file of vertex paths") from fault
    paths = []
    for number, line in enumerate(lines, start=1):
        words = line.split("#")[0].replace(",", " ").split()
        if not words:
            continue
        try:
            vertices = np.array([int(word) for word in words], dtype=np.int64)
        except (ValueError, OverflowError):
            raise InputError(f"{path}, line {number}: {line.strip()[:60]!r} is not a list of vertex numbers") from None
        if ((vertices < 0) | (vertices >= n_vertices)).any():
            wrong = int(vertices[(vertices < 0) | (vertices >= n_vertices)][0])
            raise InputError(f"{path}, line {number}: vertex {wrong} does not exist; the mesh has vertices 0 to {n_vertices - 1}")
        if len(vertices) < 2:
            raise InputError(f"{path}, line {number}: a path needs at least two vertices")
        paths.append(vertices)
    if not paths:
        raise InputError(f"{path} holds no vertex path; write one a line, such as: 12 87 140")
    return paths


def cut_along(mesh: Mesh, paths: list[NDArray[np.float64]], *, numbers: IntArray | None = None) -> BoolArray:
    """Seam edges of paths given by their points on the mesh.

    Parameters
    ----------
    mesh : Mesh
    paths : list of (k, 3) float64, mm
        Vertex positions; each is taken to the nearest vertex of `mesh`, so that numbers given for a file hold
        on the cleaned mesh too.
    numbers : (n,) int64, optional
        What the user calls each vertex; default its own number.

    Returns
    -------
    (e,) bool

    Raises
    ------
    InputError
        Two neighbours of a path lie on different components, or all points of a path are one vertex.
    """
    topology = mesh.topology
    cut = np.zeros(len(topology.E), dtype=bool)
    used = topology.used_vertices
    tree = cKDTree(mesh.V[used])
    graph = edge_graph(topology, seam_weights(mesh), len(mesh.V))
    for number, points in enumerate(paths, start=1):
        vertices = used[tree.query(points)[1]]
        called = vertices if numbers is None else numbers[vertices]
        if (vertices == vertices[0]).all():
            raise InputError(
                f"cut {number}: all its points are vertex {called[0]}, so it has no length; give a path of two vertices or more"
            )
        # Where sheets touch in a point, cleaning gave each its own vertex there: the path goes by the one that leads on.
        at = [used[tree.query_ball_point(mesh.V[v], 0.0)] for v in vertices]
        for k, (starts, ends) in enumerate(pairwise(at)):
            if np.array_equal(starts, ends):
                continue
            way = _way(topology, graph, starts, ends)
            if not len(way):
                raise InputError(
                    f"cut {number}: vertices {called[k]} and {called[k + 1]} lie on different components; no seam can join them"
                )
            cut[way] = True
    return cut


def _way(topology: Topology, graph: csr_array, starts: IntArray, ends: IntArray) -> IntArray:
    """The edge from one of `starts` to one of `ends`, else the cheapest way over edges; none where they are not connected."""
    edges = topology.edge_ids(np.stack(np.meshgrid(starts, ends), axis=-1).reshape(-1, 2))
    if (edges >= 0).any():
        return edges[edges >= 0][:1]
    distance, before, _ = dijkstra(graph, indices=starts, return_predecessors=True, min_only=True)
    end = int(ends[np.argmin(distance[ends])])
    return topology.edge_ids(trace(before.astype(np.int64), end)) if np.isfinite(distance[end]) else np.zeros(0, dtype=np.int64)


def numbers_in(file: Mesh, mesh: Mesh) -> IntArray:
    """(n,) what each vertex of `mesh` is called in the mesh as its `file` has it, before it was cleaned: by place."""
    numbers: IntArray = cKDTree(file.V).query(mesh.V)[1].astype(np.int64)
    return numbers


def completed(
    mesh: Mesh,
    cut: BoolArray,
    limits: Limits,
    *,
    neck: float = 4.0,
    aim: Aim = "usual",
    progress: Callable[[float], None] | None = None,
) -> Seams:
    """These seams, and automatic ones where they do not give pieces within `limits`.

    Parameters
    ----------
    mesh : Mesh
    cut : (e,) bool
        All of it stays cut.
    limits : Limits
    neck : float, mm
    aim : "fewest", "usual" or "simplest"
        See `find_seams`; the usual ones only cut further what is not good yet.
    progress : callable, optional
        Called with the part that is done, 0 to 1.
    """
    if aim == "usual":
        return Seams(*refine_seams(mesh, cut, limits, seam_weights(mesh), progress=progress))
    nothing = np.zeros(len(cut), dtype=bool)
    rules = EdgeRules(np.ones(len(cut)), cut & ~mesh.topology.is_boundary, nothing)
    return find_seams(mesh, limits, neck=neck, rules=rules, aim=aim, progress=progress)


def seams_by_hand(mesh: Mesh, cut: BoolArray, limits: Limits, *, numbers: IntArray | None = None) -> Seams:
    """Just these seams, each piece checked.

    Parameters
    ----------
    mesh : Mesh
    cut : (e,) bool
    limits : Limits
    numbers : (n,) int64, optional
        What the user calls each vertex; default its own number.

    Raises
    ------
    InputError
        A piece is not a disk.
    RefusedError
        A piece breaks `limits`. Either error names the cuts that bound the piece and a path that would help.
    """
    pieces = []
    weight = seam_weights(mesh)
    for number, piece in enumerate(open_pieces(mesh, cut), start=1):
        verdict = brought_within(mesh, (piece, judge(mesh, piece, limits)), limits)[1] if piece.is_disk else None
        if verdict is not None and verdict.accepted:
            pieces.append((piece, verdict))
            continue
        bounds = bounds_of(mesh, piece, cut)
        within = f" within the cuts {named_edges(mesh, bounds, numbers=numbers)}" if len(bounds) else ""
        who = f"piece {number} ({len(piece.faces)} faces{within})"
        paths = as_paths(mesh, next_cut(mesh, piece, verdict, weight)[0], numbers=numbers)
        further = f", such as along {' and '.join(paths[:_SAID])}" if paths else ""
        if verdict is None:
            alone = idle(mesh, piece, cut)
            nothing = f" (a cut of one edge alone, {named_edges(mesh, alone, numbers=numbers)}, opens nothing)" if len(alone) else ""
            raise InputError(f"the cuts leave {who} {_shape(piece)}{nothing}; {_more(piece)}{further}, or add --complete")
        raise RefusedError(f"{who} {_fault(verdict, limits)}; cut it further by hand{further}, or add --complete")
    return Seams(cut, pieces)


def _shape(piece: OpenPiece) -> str:
    loops = len(piece.topology.boundary_loops)
    if not loops:
        return "closed"
    if loops > 1:
        return f"with {loops} boundary loops"
    return f"with a handle (Euler number {piece.topology.euler})"


def _more(piece: OpenPiece) -> str:
    loops = len(piece.topology.boundary_loops)
    return "cut from one loop to the other" if loops > 1 else "cut it open" if not loops else "cut through the handle"


def _fault(verdict: Verdict, limits: Limits) -> str:
    if verdict.too_distorted:
        option = "--max-p99" if verdict.distortion.mean <= limits.mean else "--max-distortion"
        return f"has {excess(verdict.distortion, limits)} (raise {option} to allow it)"
    if verdict.overlaps:
        return f"overlaps itself by {verdict.distortion.overlap_mm2:.3g} mm^2 when laid flat"
    if verdict.neck is not None:
        return f"has a neck {verdict.neck.width:.1f} mm wide when laid flat, and {limits.neck:g} mm of silicone survive handling"
    w, h = verdict.UV.max(axis=0)
    (W, H) = sorted(limits.size, reverse=True)
    lips = "" if w > W or h > H else " with the lips of its mould"
    return f"is {w:.0f} x {h:.0f} mm flat and does not fit the bed ({limits.size[0]:.0f} x {limits.size[1]:.0f} mm){lips}"
