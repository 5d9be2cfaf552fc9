"""A triangle mesh in millimetres: plain arrays under a name."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.topology import Topology


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles in space.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        Corner indices into `V`, counter-clockwise from outside.
    name : str
        What to call it in messages and file names.

    Examples
    --------
    >>> m = Mesh(np.eye(3), np.array([[0, 1, 2]]), "corner")
    >>> m, round(float(m.face_areas[0]), 4)
    (Mesh('corner', 3 vertices, 1 faces), 0.866)
    """

    V: NDArray[np.float64]
    F: NDArray[np.int64]
    name: str = "mesh"

    def __post_init__(self) -> None:
        object.__setattr__(self, "V", np.ascontiguousarray(self.V, dtype=np.float64))
        object.__setattr__(self, "F", np.ascontiguousarray(self.F, dtype=np.int64))

    def __repr__(self) -> str:
        return f"Mesh({self.name!r}, {len(self.V)} vertices, {len(self.F)} faces)"

    @cached_property
    def topology(self) -> Topology:
        return Topology(self.F)

    @cached_property
    def face_cross(self) -> NDArray[np.float64]:
        """(m, 3) mm^2: twice the area times the unit normal of each face."""
        p = self.V[self.F]
        return np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])

    @cached_property
    def face_areas(self) -> NDArray[np.float64]:
        """(m,) mm^2."""
        return np.linalg.norm(self.face_cross, axis=1) / 2

    @cached_property
    def face_normals(self) -> NDArray[np.float64]:
        """(m, 3) unit normals; zero for a degenerate face."""
        length = np.linalg.norm(self.face_cross, axis=1, keepdims=True)
        return np.divide(self.face_cross, length, out=np.zeros_like(self.face_cross), where=length > 0)

    @cached_property
    def edge_lengths(self) -> NDArray[np.float64]:
        """(e,) mm, in the order of ``topology.E``."""
        ends = self.V[self.topology.E]
        return np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)

    @property
    def area(self) -> float:
        """Surface area, mm^2."""
        return float(self.face_areas.sum())

    @property
    def bbox(self) -> NDArray[np.float64]:
        """((xmin, ymin, zmin), (xmax, ymax, zmax)), mm."""
        return np.array([self.V.min(axis=0), self.V.max(axis=0)])
