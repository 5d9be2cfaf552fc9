"""Flatten with cones: cut through them by short seams, then lay out with the scale factors they imply.

Meant for near-polyhedra, whose corners the cones are, for plain round bodies, and for comparison with other tools. The
net of an object with limbs or noise often covers itself or turns triangles over (9 of 13 scans), which nothing here
mends: `seams.auto` is for those.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.flatten.cones import cone_scale, place_cones
from skinfab.flatten.distortion import best_scale, shaped_areas
from skinfab.flatten.robust import flatten_robust, turned_over
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import OpenPiece, open_pieces
from skinfab.seams.disk import cut_to_disk
from skinfab.seams.graph import edge_graph, shortest_tree, trace
from skinfab.seams.weights import seam_weights

BoolArray = NDArray[np.bool_]
FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def cut_through(mesh: Mesh, points: IntArray) -> BoolArray:
    """Seams that open `mesh` to a disk with every one of `points` on its boundary, (e,) bool.

    Each point is joined to what is cut already by a shortest path, the nearest first (Prim's order).

    Parameters
    ----------
    mesh : Mesh
        One component.
    points : (c,) int64
        Vertices.

    Raises
    ------
    InputError
        A point cannot be reached from the others.
    """
    topology, weight = mesh.topology, seam_weights(mesh)
    cut = np.zeros(len(topology.E), dtype=bool)
    start = int(points[0]) if len(points) else None
    if topology.euler != 2 or topology.is_boundary.any():
        cut[cut_to_disk(topology, weight, len(mesh.V), start=start)] = True
    seam = np.zeros(len(mesh.V), dtype=bool)
    seam[topology.E[cut | topology.is_boundary].ravel()] = True
    if not seam.any() and start is not None:
        seam[start] = True
    graph = edge_graph(topology, weight, len(mesh.V))
    left = [int(p) for p in points if not seam[p]]
    while left:
        distance, before = shortest_tree(graph, np.flatnonzero(seam))
        nearest = min(left, key=lambda p: (distance[p], p))
        if not np.isfinite(distance[left]).all():
            lost = next(p for p in left if not np.isfinite(distance[p]))
            raise InputError(f"no seam leads to vertex {lost} along edges of finite length; mend the mesh, or give points of one component")
        path = trace(before, nearest)
        cut[topology.edge_ids(path)] = True
        seam[path.ravel()] = True
        left = [p for p in left if not seam[p]]
    return cut


def flatten_with_cones(
    mesh: Mesh, *, cones: IntArray | None = None, angles: FloatArray | None = None, count: int | None = None
) -> tuple[BoolArray, OpenPiece, FloatArray, IntArray]:
    """Boundary first flattening with cone singularities.

    Parameters
    ----------
    mesh : Mesh
        One component, manifold; closed or open.
    cones : (c,) int64, optional
        Inner vertices, each once. Default: placed automatically.
    angles : (c,) float, rad, optional
        Cone angles of the given cones (2 pi minus their curvature); see `cone_scale`. Default: those of least area distortion.
    count : int, optional
        How many to place; default as many as pay (`place_cones`).

    Returns
    -------
    cut : (e,) bool
    piece : OpenPiece
    UV : (p, 2) float64, mm
        At the scale of the least d.
    cones : (c,) int64

    Raises
    ------
    InputError
        Several components, angles without cones, or what `cone_scale` does not take.
    RefusedError
        Triangles come out upside down or without area, over the intrinsic Delaunay triangulation too.
    """
    topology = mesh.topology
    if topology.face_components()[0] != 1:
        raise InputError("cones need one connected surface; use --method auto for several components")
    if cones is None:
        if angles is not None:
            raise InputError("cone angles are of given cones; say which vertices they belong to")
        cones = place_cones(mesh.V, mesh.F, count=count, topology=topology)
    u, _ = cone_scale(mesh.V, mesh.F, cones, angles, topology=topology)
    cut = cut_through(mesh, cones)
    (piece,) = open_pieces(mesh, cut)
    if not piece.is_disk:
        raise InputError("a closed surface needs at least two cones to open it; use --cones 8 or --cones auto")
    V = mesh.V[piece.vertices]
    uv = flatten_robust(V, piece.F, scale=u[piece.vertices], topology=piece.topology)
    _, shaped = shaped_areas(V, piece.F)
    if over := turned_over(uv, piece.F[shaped]):
        raise RefusedError(
            f"{over} of {len(mesh.F)} triangles come out upside down or without area with {len(cones)} cones; "
            f"cones suit near-polyhedra and plain round bodies, so use --method auto, or other cones"
        )
    return cut, piece, uv * best_scale(V, piece.F, uv), cones
