"""Join pieces again along whole borders wherever the joined piece is still good."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.laplacian import intrinsic
from skinfab.mesh.joined import joined
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import open_pieces
from skinfab.seams.judge import Limits, Parted, Verdict, judge
from skinfab.seams.refine import Judged
from skinfab.tolerances import NEWTON_DECREASE

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

#: An object of hundreds of pieces is not made whole by gluing.
_MOST_TRIALS = 1200

#: A border is not glued past a vertex whose angle defect is larger (rad): the cone there could not lie flat.
_CONE = 0.3


def glue_pieces(
    mesh: Mesh,
    cut: BoolArray,
    pieces: list[Judged],
    limits: Limits,
    *,
    neck: float,
    excess: float,
    smaller_than: float = np.inf,
    tolerance: float = NEWTON_DECREASE,
    locked: BoolArray | None = None,
    whole: bool = False,
    cost: NDArray[np.float64] | None = None,
) -> tuple[BoolArray, list[Judged]]:
    """Glue neighbours, the longest (or dearest) border first, as long as the result keeps to `limits`.

    Parameters
    ----------
    mesh : Mesh
    cut : (e,) bool
    pieces : list of (OpenPiece, Verdict)
        All of them.
    limits : Limits
    neck : float, mm
        A border shorter than this is not glued: what hangs on it would tear off.
    excess : float
        By how much a glued piece's mean d may be above the area-weighted mean of its two parts.
    smaller_than : float, mm^2
        Only pairs of which one has less area than this.
    tolerance : float
        How far each flattening is driven, see `IsometricSolver.refine`.
    locked : (e,) bool, optional
        Edges that stay cut.
    whole : bool
        Two pieces are joined along all they have in common or not at all, so that no seam is left inside the joined piece.
    cost : (e,) float, optional
        Of a seam along each edge: the dearest border is glued first; default its length.

    Returns
    -------
    cut, pieces
    """
    cut = cut.copy()
    owner = np.empty(len(mesh.F), dtype=np.int64)
    judged = dict(enumerate(pieces))
    for k, (piece, _) in judged.items():
        owner[piece.faces] = k
    refused: set[tuple[int, int, int]] = set()
    lengths: dict[tuple[int, int], Verdict] = {}
    blunt = ~_is_cone(mesh)
    fresh = len(judged)
    for _ in range(_MOST_TRIALS):
        chain = _longest_chain(mesh, cut if locked is None else cut & ~locked, owner, blunt, refused, neck, cost)
        if chain is None:
            break
        (a, b), edges = chain
        first = int(edges.min())
        if whole:
            edges = _common(mesh, cut, owner, a, b)
        trial = cut.copy()
        trial[edges] = False
        faces = np.concatenate([judged[a][0].faces, judged[b][0].faces])
        if min(_area(mesh, judged[a]), _area(mesh, judged[b])) >= smaller_than:
            refused.add((a, b, first))
            continue
        (piece,) = open_pieces(mesh, trial, faces=faces)
        may = piece.is_disk and not (whole and locked is not None and locked[edges].any())
        verdict = judge(mesh, piece, limits, tolerance=tolerance, untangle=False) if may else None
        stretched = verdict is not None and verdict.distortion.mean > _mean(mesh, judged[a], judged[b]) + excess
        if verdict is None or stretched or not verdict.accepted:
            refused.add((a, b, first))
            if verdict is not None and not (stretched or verdict.too_distorted or verdict.overlaps):
                lengths[a, b] = verdict
            continue
        cut = trial
        one, other = judged[a][1].parted, judged[b][1].parted
        judged[fresh] = (piece, replace(verdict, parted=one) if one == other else verdict)
        owner[faces] = fresh
        del judged[a], judged[b]
        fresh += 1
    return cut, sorted(_marked(judged, lengths).values(), key=lambda item: int(item[0].faces[0]))


def _marked(judged: dict[int, Judged], refused: dict[tuple[int, int], Verdict]) -> dict[int, Judged]:
    """The pieces; those that nothing but the bed or a neck keeps from being joined, and that nothing is known of yet, say so."""
    pairs = [pair for pair in refused if all(k in judged and judged[k][1].parted is None for k in pair)]
    marked = dict(judged)
    while pairs:
        group, why = set(pairs[0]), []
        while touching := [pair for pair in pairs if group & set(pair)]:
            pairs = [pair for pair in pairs if pair not in touching]
            why += [refused[pair] for pair in touching]
            group.update(*touching)
        first = min(int(judged[k][0].faces[0]) for k in group)
        neck = min((verdict.neck.width for verdict in why if verdict.neck is not None), default=0.0)
        # Of three and more only pairs are known to be flat.
        parted = Parted(first, any(verdict.too_large for verdict in why), neck, flat=len(group) == 2)
        marked |= {k: (judged[k][0], replace(judged[k][1], parted=parted)) for k in group}
    return marked


def _common(mesh: Mesh, cut: BoolArray, owner: IntArray, a: int, b: int) -> IntArray:
    """All edges between two pieces."""
    EF = mesh.topology.EF
    inner = np.flatnonzero(cut & (EF[:, 1] >= 0))
    pair = np.sort(owner[EF[inner]], axis=1)
    chosen: IntArray = inner[(pair == sorted((a, b))).all(axis=1)]
    return chosen


def _mean(mesh: Mesh, *parts: Judged) -> float:
    return float(np.average([verdict.distortion.mean for _, verdict in parts], weights=[_area(mesh, part) for part in parts]))


def _area(mesh: Mesh, part: Judged) -> float:
    return float(mesh.face_areas[part[0].faces].sum())


def _is_cone(mesh: Mesh) -> BoolArray:
    """(n,) vertices so sharp that gluing past one would close a cone."""
    defect = 2 * np.pi - intrinsic(mesh.V, mesh.F).angle_sum
    return np.abs(defect) > _CONE


def _longest_chain(
    mesh: Mesh,
    cut: BoolArray,
    owner: IntArray,
    blunt: BoolArray,
    refused: set[tuple[int, int, int]],
    neck: float,
    cost: NDArray[np.float64] | None,
) -> tuple[tuple[int, int], IntArray] | None:
    """The pair of pieces with the longest unbroken common border, and its edges."""
    topology = mesh.topology
    border = np.flatnonzero(cut & (topology.EF[:, 1] >= 0))
    pair = np.sort(owner[topology.EF[border]], axis=1)
    apart = pair[:, 0] != pair[:, 1]
    border, pair = border[apart], pair[apart]
    if not len(border):
        return None
    run = _runs(topology.E[border], pair, blunt)
    length = np.bincount(run, mesh.edge_lengths[border])
    worth = length if cost is None else np.bincount(run, cost[border])
    for k in np.argsort(-worth.round(9), kind="stable"):
        if length[k] < neck:
            continue
        edges = border[run == k]
        a, b = pair[np.argmax(run == k)].tolist()
        if (a, b, int(edges.min())) not in refused:
            return (a, b), edges
    return None


def _runs(E: IntArray, pair: IntArray, blunt: BoolArray) -> IntArray:
    """Group border edges: two belong together when they meet at a blunt vertex and part the same two pieces."""
    # A vertex counts once for every pair of pieces, so that runs of different pairs do not join.
    pair_id = np.unique(pair, axis=0, return_inverse=True)[1].reshape(-1)
    keys = pair_id[:, None] * (int(E.max()) + 1) + E
    nodes, node = np.unique(keys, return_inverse=True)
    node = node.reshape(-1, 2)
    open_end = ~blunt[E]
    edge = np.arange(len(E))
    # Bipartite: edges on one side, blunt vertices on the other.
    rows = np.concatenate([edge[~open_end[:, s]] for s in (0, 1)])
    columns = np.concatenate([len(E) + node[~open_end[:, s], s] for s in (0, 1)])
    size = len(E) + len(nodes)
    _, label = joined(rows, columns, size)
    return np.unique(label[: len(E)], return_inverse=True)[1]
