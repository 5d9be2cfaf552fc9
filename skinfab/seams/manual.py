"""Seams by hand: a text file of vertex paths.

One path a line: vertex numbers (counted from 0, in the order of the mesh file) parted by blanks or commas;
`#` starts a comment. Neighbours on a line that share no edge are joined by the cheapest path over edges,
creases preferred. A path may close by ending where it began, and may touch or cross others::

    # round the wrist, then up the back
    12 87 140 12
    140 522
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from skinfab.errors import InputError, RefusedError
from skinfab.mesh.model import Mesh
from skinfab.seams.auto import Seams
from skinfab.seams.cut import OpenPiece, open_pieces
from skinfab.seams.graph import edge_graph, trace
from skinfab.seams.judge import Limits, Verdict, excess, judge
from skinfab.seams.weights import seam_weights

IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

#: A cuts file longer than this is not one.
_MOST_BYTES = 50_000_000


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


def cut_along(mesh: Mesh, paths: list[NDArray[np.float64]]) -> BoolArray:
    """Seam edges of paths given by their points on the mesh.

    Parameters
    ----------
    mesh : Mesh
    paths : list of (k, 3) float64, mm
        Vertex positions; each is taken to the nearest vertex of `mesh`, so that numbers given for a file hold
        on the cleaned mesh too.

    Returns
    -------
    (e,) bool

    Raises
    ------
    InputError
        Two neighbours of a path lie on different components.
    """
    topology = mesh.topology
    cut = np.zeros(len(topology.E), dtype=bool)
    used = topology.used_vertices
    tree = cKDTree(mesh.V[used])
    graph = edge_graph(topology, seam_weights(mesh), len(mesh.V))
    for number, points in enumerate(paths, start=1):
        vertices = used[tree.query(points)[1]]
        for a, b in zip(vertices[:-1].tolist(), vertices[1:].tolist(), strict=True):
            edge = topology.edge_ids(np.array([[a, b]]))
            if edge[0] < 0 and a != b:
                distance, before = dijkstra(graph, indices=a, return_predecessors=True)
                if not np.isfinite(distance[b]):
                    raise InputError(f"cut {number}: vertices {a} and {b} lie on different components; no seam can join them")
                edge = topology.edge_ids(trace(before.astype(np.int64), b))
            if a != b:
                cut[edge] = True
    return cut


def seams_by_hand(mesh: Mesh, cut: BoolArray, limits: Limits) -> Seams:
    """Just these seams, each piece checked.

    Raises
    ------
    InputError
        A piece is not a disk.
    RefusedError
        A piece breaks `limits`.
    """
    pieces = []
    for number, piece in enumerate(open_pieces(mesh, cut), start=1):
        if not piece.is_disk:
            raise InputError(f"the cuts leave piece {number} ({len(piece.faces)} faces) {_shape(piece)}; {_more(piece)}, or add --complete")
        verdict = judge(mesh, piece, limits)
        if not verdict.accepted:
            raise RefusedError(
                f"piece {number} ({len(piece.faces)} faces) {_fault(verdict, limits)}; cut it further by hand, or add --complete"
            )
        pieces.append((piece, verdict))
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
