"""What a seam costs: its length, less on a crease, where it is neither seen nor felt."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.model import Mesh

#: An edge bent by this much or more is a full crease.
_FULL_CREASE = np.pi / 4

#: A full crease costs this part of its length.
_CREASE_COST = 0.4


def dihedral_angles(mesh: Mesh) -> NDArray[np.float64]:
    """(e,) rad: angle between the normals of the two faces at each edge; 0 at a boundary."""
    EF = mesh.topology.EF
    inner = EF[:, 1] >= 0
    N = mesh.face_normals
    angle = np.zeros(len(EF))
    a, b = N[EF[inner, 0]], N[EF[inner, 1]]
    # atan2 keeps its digits near flat, where arccos loses half of them.
    angle[inner] = np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), np.einsum("ij,ij->i", a, b))
    return angle


def seam_weights(mesh: Mesh) -> NDArray[np.float64]:
    """(e,) cost of cutting each edge, > 0."""
    crease = np.clip(dihedral_angles(mesh) / _FULL_CREASE, 0, 1)
    length = mesh.edge_lengths
    return length * (1 - (1 - _CREASE_COST) * crease) + 1e-9 * length.mean()
