"""A fingertip of any shape, as a closed triangle mesh, on which contact points are looked for."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: The face that a fingertip is mounted with looks down (-z) within this angle, rad, lies as low as anything does, within this part of
#: the fingertip's size, and has at least this part of its area: what is round below has no such face.
MOUNT_RAD, MOUNT_PART, MOUNT_AREA = 0.1, 0.002, 0.05


class TipMesh:
    """A closed mesh with a tree over its triangles: built once, asked often.

    Parameters
    ----------
    mesh : Mesh
        Closed, its triangles counter-clockwise from outside, in the sensor's frame, mm; its flat bottom (-z), where it has one, is
        what it is mounted with.

    Raises
    ------
    InputError
        It has open or non-manifold edges, is inside out, has no triangles, or has coordinates that are no numbers.

    Examples
    --------
    >>> from skinfab.fingertip.force.contact import locate
    >>> V = np.array([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0], [0, 0, 15.0]])
    >>> F = np.array([[0, 2, 1], [0, 3, 2], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    >>> pyramid = TipMesh(Mesh(V, F, "pyramid"))
    >>> found = locate([[-1.0, 0, 0]], [[0, -5.0, 0]], pyramid)  # pushed in -x, 5 mm up
    >>> found.point.round(6).tolist(), found.flags.tolist()
    ([[6.0, -0.0, 5.0]], [0])
    """

    def __init__(self, mesh: Mesh) -> None:
        _require_closed(mesh)
        from skinfab.fingertip.force import _entry_mesh

        self.mesh = mesh
        self.size = float(np.linalg.norm(mesh.bbox[1] - mesh.bbox[0]))
        self._mount_z = _mount(mesh, MOUNT_PART * self.size)
        order, self._lo, self._hi, self._child, self._first = _entry_mesh.build_tree(mesh.V[mesh.F])
        self._corners = np.ascontiguousarray(mesh.V[mesh.F][order])
        self._normals = np.ascontiguousarray(mesh.face_normals[order])

    def __repr__(self) -> str:
        return f"TipMesh({self.mesh!r})"

    def enter(
        self,
        F: FloatArray,
        M: FloatArray,
        least_force: float,
        force_sd: float,
        moment_sd: float,
        torsion_sd: float,
        out: FloatArray,
        flags: NDArray[np.uint8],
    ) -> None:
        """Fill in the entries of the forces' lines, for `skinfab.fingertip.force.contact.locate`."""
        from skinfab.fingertip.force import _entry_mesh

        limits = (least_force, force_sd, moment_sd, torsion_sd)
        tree = (self._corners, self._normals, self._lo, self._hi, self._child, self._first)
        _entry_mesh.enter_mesh(F, M, *tree, self.size, *limits, out, flags)

    def at_the_mount(self, point: FloatArray, normal: FloatArray) -> BoolArray:
        """Which points (n, 3), with normals into the fingertip, lie on the face that it is mounted with."""
        mount: BoolArray = (normal[:, 2] > np.cos(MOUNT_RAD)) & (point[:, 2] < self._mount_z)
        return mount


def _mount(mesh: Mesh, thickness: float) -> float:
    """Below which height there is nothing but the face that the fingertip is mounted with; -inf where there is none."""
    p = mesh.V[mesh.F]
    top = float(mesh.V[:, 2].min()) + thickness
    across = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    area = np.linalg.norm(across, axis=1)
    flat = (p[:, :, 2].max(axis=1) < top) & (-across[:, 2] > np.cos(MOUNT_RAD) * area)
    return top if area[flat].sum() > MOUNT_AREA * area.sum() else -np.inf


def _require_closed(mesh: Mesh) -> None:
    if not len(mesh.F):
        raise InputError(f"{mesh.name} has no triangles; give the fingertip as a closed mesh")
    if not np.isfinite(mesh.V).all():
        raise InputError(f"{mesh.name} has coordinates that are no numbers; mend the mesh")
    wrong = int((mesh.topology.edge_count != 2).sum())
    if wrong:
        raise InputError(f"{mesh.name} has {wrong} edges at which not exactly two triangles meet; a fingertip is a closed mesh: repair it")
    p = mesh.V[mesh.F]
    volume = float(np.einsum("ij,ij->", p[:, 0], np.cross(p[:, 1], p[:, 2]))) / 6
    if not volume > 0:
        raise InputError(f"{mesh.name} is inside out (its volume is {volume:g} mm^3); turn its triangles round")
