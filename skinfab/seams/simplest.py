"""Simple pieces: compact regions that are nearly flat, joined while the joined piece is a disk that needs no dart.

The regions are those of variational shape approximation (Cohen-Steiner, Alliez and Desbrun 2004): each has a plane, and each
face belongs to the region whose normal is most like its own; planes and regions are found in turns.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import RefusedError
from skinfab.mesh.model import Mesh
from skinfab.seams.coarse import coarsen, transfer
from skinfab.seams.creases import borders, without_scraps
from skinfab.seams.glue import glue_pieces
from skinfab.seams.judge import Limits
from skinfab.seams.refine import Judged, refine_seams
from skinfab.seams.rules import EdgeRules, coarse_rules
from skinfab.seams.weights import seam_weights
from skinfab.tolerances import SEARCH_DECREASE

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

#: Regions to begin with; more only give more to join.
_REGIONS = 40

#: Regions are found on about this many triangles.
_COARSE_FACES = 4000

#: Planes and regions in turns: after so many hardly a face changes hands.
_TURNS = 12

#: A fine mesh shows more d than the one on which regions were joined.
_AIM = 0.7


def simplest_seams(
    mesh: Mesh,
    limits: Limits,
    *,
    neck: float = 4.0,
    rules: EdgeRules | None = None,
    progress: Callable[[float], None] | None = None,
) -> tuple[BoolArray, list[Judged]]:
    """Seams between compact pieces without darts.

    Parameters
    ----------
    mesh : Mesh
    limits : Limits
    neck : float, mm
        Pieces are not joined across less than this.
    rules : EdgeRules, optional
    progress : callable, optional
        Called with the part that is done, 0 to 1.

    Returns
    -------
    cut : (e,) bool
    pieces : list of (OpenPiece, Verdict)

    Raises
    ------
    InputError, RefusedError
        As `refine_seams`, which cuts what is not good yet.
    """
    report = progress or (lambda done: None)
    small = coarsen(mesh, _COARSE_FACES)
    none = np.zeros(len(mesh.topology.E), dtype=bool)
    locked = none if rules is None else rules.locked
    forbidden = none if rules is None else rules.forbidden
    there = locked if small is mesh else transfer(mesh, locked, small)
    marked = None if rules is None else rules if small is mesh else coarse_rules(mesh, rules, small, there)
    inner = replace(limits, mean=4 + _AIM * (limits.mean - 4))
    weight = seam_weights(small) if marked is None else marked.weights(small)
    cut = borders(small, regions(small, _REGIONS, there)) | there
    never = None if marked is None else marked.forbidden
    if never is not None:
        cut &= ~never
    search = partial(refine_seams, small, cut, weight=weight, tolerance=SEARCH_DECREASE, forbidden=never)
    try:
        cut, pieces = search(inner, progress=lambda done: report(0.4 * done))
    except RefusedError:
        if never is None or small is not mesh:
            raise
        # What is forbidden may leave no seam for less than the bound, and one for the bound.
        report(0.4)
        cut, pieces = search(limits)
    cost = None if marked is None else small.edge_lengths * marked.factor
    cut, pieces = glue_pieces(
        small, cut, pieces, inner, neck=neck, excess=np.inf, tolerance=SEARCH_DECREASE, locked=there, whole=True, cost=cost
    )
    report(0.7)
    if small is not mesh:
        ends = np.unique(small.topology.E[there]), np.unique(mesh.topology.E[locked])
        costs = seam_weights(mesh) if rules is None else rules.weights(mesh)
        cut = without_scraps(mesh, (transfer(small, cut & ~there, mesh, weight=costs, pinned=ends) & ~forbidden) | locked) | locked
        cut, pieces = refine_seams(
            mesh, cut, limits, costs, tolerance=SEARCH_DECREASE, forbidden=forbidden, progress=lambda done: report(0.7 + 0.3 * done)
        )
    return cut, pieces


def regions(mesh: Mesh, count: int, locked: BoolArray) -> IntArray:
    """(m,) region of each face: connected, none across `locked` edges (e,), about `count` of them.

    Examples
    --------
    >>> from skinfab.mesh.model import Mesh
    >>> roof = Mesh(np.array([[0.0, 0, 0], [0, 9, 0], [5, 0, 5], [5, 9, 5], [10, 0, 0], [10, 9, 0]]),
    ...             np.array([[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5]]))
    >>> regions(roof, 2, np.zeros(9, dtype=bool)).tolist()
    [0, 0, 1, 1]
    """
    areas, normals = mesh.face_areas, mesh.face_normals
    about = _neighbours(mesh, locked)
    seeds = _seeds(mesh, locked, count)
    planes = normals[seeds]
    label = _flooded(about, areas, normals, seeds, planes)
    for _ in range(_TURNS):
        sums = np.zeros((len(seeds), 3))
        np.add.at(sums, label, areas[:, None] * normals)
        planes = sums / np.maximum(np.linalg.norm(sums, axis=1), np.finfo(float).tiny)[:, None]
        off = areas * ((normals - planes[label]) ** 2).sum(axis=1)
        order = np.lexsort((off, label))
        seeds = order[np.r_[True, np.diff(label[order]) > 0]]
        before, label = label, _flooded(about, areas, normals, seeds, planes)
        if np.array_equal(before, label):
            break
    return label


def _neighbours(mesh: Mesh, locked: BoolArray) -> list[list[int]]:
    EF = mesh.topology.EF[(mesh.topology.EF[:, 1] >= 0) & ~locked]
    about: list[list[int]] = [[] for _ in range(len(mesh.F))]
    for f, g in EF.tolist():
        about[f].append(g)
        about[g].append(f)
    return about


def _seeds(mesh: Mesh, locked: BoolArray, count: int) -> IntArray:
    """Faces far from each other, at least one in each part between locked seams."""
    centre = mesh.V[mesh.F].mean(axis=1)
    part = mesh.topology.face_components(locked)[1]
    seeds = np.unique(part, return_index=True)[1].tolist()
    far = np.min([np.linalg.norm(centre - centre[s], axis=1) for s in seeds[:count]], axis=0)
    while len(seeds) < min(count, len(mesh.F)):
        seeds.append(int(np.argmax(far)))
        far = np.minimum(far, np.linalg.norm(centre - centre[seeds[-1]], axis=1))
    return np.array(sorted(set(seeds)), dtype=np.int64)


def _flooded(about: list[list[int]], areas: FloatArray, normals: FloatArray, seeds: IntArray, planes: FloatArray) -> IntArray:
    """Regions grown from their seeds, always by the face that fits its region's plane best (Lloyd's flooding)."""
    label = np.full(len(areas), -1, dtype=np.int64)
    cost = areas[:, None] * ((normals[:, None] - planes[None]) ** 2).sum(axis=2)
    queue = [(-1.0, int(face), k) for k, face in enumerate(seeds)]
    heapq.heapify(queue)
    while queue:
        _, face, k = heapq.heappop(queue)
        if label[face] >= 0:
            continue
        label[face] = k
        for other in about[face]:
            if label[other] < 0:
                heapq.heappush(queue, (float(cost[other, k]), other, k))
    return label
