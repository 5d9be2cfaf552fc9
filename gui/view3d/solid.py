"""A mesh as the z-buffer takes it: single precision, with the directions in which its corners reflect light."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.model import Mesh
from skinfab.tolerances import CREASE_RAD

Float32 = NDArray[np.float32]
Int32 = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Solid:
    """What is drawn.

    Parameters
    ----------
    V : (n, 3) float32, mm
    F : (m, 3) int32
    normals : (q, 3) float32
    normal : (m, 3) int32
        Which of `normals` each corner has: one for all of a vertex where the surface is smooth there, the face's own at creases.
    name : (m,) int32
        Number of the face in the mesh the document has.
    closed : bool
        Without border and wound outward: what is seen from behind is hidden.
    slack : float, mm
        How far below its surface lines on the object may run.
    corners : (8, 3) float, mm
        Of the box around it.
    """

    V: Float32
    F: Int32
    normals: Float32
    normal: Int32
    name: Int32
    closed: bool
    slack: float
    corners: NDArray[np.float64]

    @staticmethod
    def of(mesh: Mesh, name: NDArray[np.int64] | None = None, *, slack: float = 0.0) -> Solid:
        """From a mesh; `name` where its faces are some of another's, `slack` mm added where it lies off that.

        Examples
        --------
        >>> fold = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), np.array([[0, 1, 2], [0, 3, 1]]))
        >>> solid = Solid.of(fold)
        >>> solid.closed, solid.normal.tolist()  # on the crease, the normals of the faces come after those of the vertices
        (False, [[4, 4, 2], [5, 3, 5]])
        """
        n, m = len(mesh.V), len(mesh.F)
        face, cross = mesh.face_normals, mesh.face_cross
        corners = mesh.F.T.ravel()
        sums = (np.bincount(corners, weights=np.tile(cross[:, k], 3), minlength=n) for k in range(3))
        vertex = np.stack(list(sums), axis=1).astype(np.float64)  # sums of nothing are whole numbers
        length = np.linalg.norm(vertex, axis=1, keepdims=True)
        np.divide(vertex, length, out=vertex, where=length > 0)
        smooth = np.stack([np.einsum("mx,mx->m", vertex[mesh.F[:, k]], face) for k in range(3)], axis=1) >= np.cos(CREASE_RAD)
        volume = float(np.einsum("mx,mx->", mesh.V[mesh.F[:, 0]] - mesh.V.mean(axis=0), cross)) if m else 0.0
        top = mesh.topology
        box = np.array([mesh.V.min(axis=0), mesh.V.max(axis=0)]) if n else np.zeros((2, 3))
        return Solid(
            mesh.V.astype(np.float32),
            mesh.F.astype(np.int32),
            np.concatenate([vertex, face]).astype(np.float32),
            np.where(smooth, mesh.F, n + np.arange(m)[:, None]).astype(np.int32),
            (np.arange(m) if name is None else name).astype(np.int32),
            bool(top.is_oriented_manifold and not top.is_boundary.any() and volume > 0),
            _SLACK * float(np.linalg.norm(box[1] - box[0])) + slack,
            np.stack(np.meshgrid(*box.T), axis=-1).reshape(8, 3),
        )


#: How far behind the surface a line on it may lie, as a fraction of the object's diagonal: chords of a millimetre do.
_SLACK = 0.003
