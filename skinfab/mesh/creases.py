"""The sides of a sharp edge taken apart, so that neither's direction colours the other's."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.joined import joined
from skinfab.mesh.model import Mesh
from skinfab.tolerances import OFFSET_CREASE_RAD

#: Edges that turn by less join one curved surface, as where a surface is moved outward.
SHARP_RAD = OFFSET_CREASE_RAD[0]


def turns(mesh: Mesh) -> NDArray[np.float64]:
    """How far the normal turns at each edge, (e,) rad: positive where it sticks out, negative in a groove, 0 at a border.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, 0, -1]])
    >>> turns(Mesh(V, np.array([[0, 1, 2], [1, 0, 3]]))).round(3).tolist()
    [1.571, 0.0, 0.0, 0.0, 0.0]
    """
    topology = mesh.topology
    out = np.zeros(len(topology.E))
    inner = np.flatnonzero(topology.edge_count == 2)
    first, second = topology.EF[inner].T
    at = topology.EC[inner, 0]
    along = mesh.V[mesh.F[first, (at + 1) % 3]] - mesh.V[mesh.F[first, at]]
    length = np.linalg.norm(along, axis=1)
    a, b = mesh.face_normals[first], mesh.face_normals[second]
    # The first face has the edge on its left, so the normal of one that falls away beyond it turns to the right.
    sine = np.einsum("ij,ij->i", np.cross(a, b), along) / np.maximum(length, np.finfo(float).tiny)
    out[inner] = np.arctan2(sine, np.einsum("ij,ij->i", a, b))
    return out


def split_at_creases(mesh: Mesh) -> Mesh:
    """The same triangles, with vertices doubled along edges that turn by more than `SHARP_RAD`.

    Parameters
    ----------
    mesh : Mesh
        Wound alike throughout.

    Returns
    -------
    Mesh
        Face k is face k. A crease that ends amid a surface leaves its last vertex whole.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, 0, -1]])
    >>> len(split_at_creases(Mesh(V, np.array([[0, 1, 2], [1, 0, 3]]))).V)
    6
    """
    topology, F = mesh.topology, mesh.F
    smooth = np.flatnonzero((topology.edge_count == 2) & (np.abs(turns(mesh)) <= SHARP_RAD))
    (f, g), (i, j) = topology.EF[smooth].T, topology.EC[smooth].T
    # Corners are counted through; an edge that starts at a corner of one face ends at that of the other.
    ones = np.concatenate([3 * f + i, 3 * f + (i + 1) % 3])
    others = np.concatenate([3 * g + (j + 1) % 3, 3 * g + j])
    count, vertex = joined(ones, others, F.size)
    V = np.empty((count, 3))
    V[vertex] = mesh.V[F.ravel()]
    return Mesh(V, vertex.reshape(-1, 3), mesh.name)
