"""Regions between sharp edges: the faces a designer drew."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.model import Mesh
from skinfab.seams.weights import dihedral_angles

#: Bent by more than this, an edge is sharp.
_SHARP = np.radians(35)

#: A region smaller than this part of the surface joins its neighbour.
_LEAST_REGION = 0.01

#: A transferred scrap under this part of the surface joins its neighbour.
_SCRAP = 0.002


def crease_seams(mesh: Mesh, *, forbidden: NDArray[np.bool_] | None = None) -> NDArray[np.bool_]:
    """Sharp edges that part the surface into regions worth a piece, (e,) bool.

    A sharp edge with the same region on both sides parts nothing and is left out; regions under one hundredth
    of the area join the neighbour they share the longest border with. `forbidden` edges (e,) are not sharp.
    """
    topology = mesh.topology
    sharp = dihedral_angles(mesh) > _SHARP
    if forbidden is not None:
        sharp &= ~forbidden
    _, label = topology.face_components(sharp)
    return borders(mesh, merge_small(mesh, label, _LEAST_REGION * mesh.area))


def merge_small(mesh: Mesh, label: NDArray[np.int64], least_area: float) -> NDArray[np.int64]:
    """Face labels (m,) with every region under `least_area` joined to the neighbour of the longest border.

    A region without neighbours (a small component) stays.
    """
    label = np.unique(label, return_inverse=True)[1].astype(np.int64)
    count = int(label.max()) + 1
    inner = np.flatnonzero(mesh.topology.EF[:, 1] >= 0)
    EF, length = mesh.topology.EF[inner], mesh.edge_lengths[inner]
    area = np.bincount(label, mesh.face_areas, count)
    finished = area >= least_area
    while not finished.all():
        small = int(np.argmin(np.where(finished, np.inf, area)))
        a, b = label[EF].T
        touching = (a == small) != (b == small)
        if not touching.any():
            finished[small] = True
            continue
        other = np.where(a[touching] == small, b[touching], a[touching])
        border = np.bincount(other, length[touching], count)
        into = int(np.argmax(border))
        label[label == small] = into
        area[into] += area[small]
        area[small], finished[small] = 0.0, True
        finished[into] = area[into] >= least_area
    return label


def without_scraps(mesh: Mesh, cut: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """`cut` (e,) without the borders of tiny parts, as they are left between seams taken from another mesh."""
    _, label = mesh.topology.face_components(cut)
    merged = merge_small(mesh, label, _SCRAP * mesh.area)
    # Within a piece the seams that part nothing (darts) stay; between pieces only the borders do.
    EF = mesh.topology.EF
    inside = (EF[:, 1] >= 0) & (label[EF[:, 0]] == label[EF[:, 1]])
    return (cut & inside) | borders(mesh, merged)


def borders(mesh: Mesh, label: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Interior edges with two different labels, (e,) bool."""
    EF = mesh.topology.EF
    return (EF[:, 1] >= 0) & (label[EF[:, 0]] != label[EF[:, 1]])
