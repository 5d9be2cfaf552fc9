"""Disks cut from real objects: what lies on one side of a plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.flatten.bff import require_disk
from skinfab.mesh.model import Mesh
from skinfab.mesh.repair import clean
from skinfab.mesh.topology import Topology


def cut_disk(mesh: Mesh, towards: tuple[float, float, float], share: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The largest connected part of the triangles that lie farthest in a direction: V (n, 3) mm and F (m, 3).

    Parameters
    ----------
    mesh : Mesh
    towards : (x, y, z)
        Of any length.
    share : float
        Of the triangles, over 0 and under 1.

    Raises
    ------
    InputError
        That part is no disk.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> cut_disk(Mesh(V, np.array([[0, 1, 2], [0, 2, 3]])), (1, 0, 0), 0.5)[1].tolist()
    [[0, 1, 2]]
    """
    height = mesh.V[mesh.F].mean(axis=1) @ np.asarray(towards, dtype=np.float64)
    F = mesh.F[height > np.quantile(height, 1 - share)]
    if not len(F):
        raise InputError(f"a share of {share:g} of {len(mesh.F)} triangles is none; give more")
    part, _ = clean(Mesh(mesh.V, F))
    labels = Topology(part.F).face_components()[1]
    used, F = np.unique(part.F[labels == np.bincount(labels).argmax()], return_inverse=True)
    F = F.reshape(-1, 3)
    require_disk(Topology(F), len(used))
    return part.V[used], F
