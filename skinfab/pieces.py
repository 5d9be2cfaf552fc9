"""A flat piece: faces of the object, opened along the seams and laid out in the plane."""

from __future__ import annotations

from dataclasses import InitVar, dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.model import Mesh
from skinfab.mesh.topology import Topology


@dataclass(frozen=True, eq=False)
class Piece:
    """One disk of the object's surface and its flat shape.

    The piece frame has the lower left corner of the flat shape's bounding box at (0, 0).

    Parameters
    ----------
    id : str
        "P1", "P2", ...; also the stem of its G-code and mould files.
    faces : (k,) int64
        Which faces of the mesh, in mesh order.
    vertices : (p,) int64
        The mesh vertex each piece vertex was opened from; a vertex on a dart appears twice.
    F : (k, 3) int64
        The same faces by piece vertices.
    UV : (p, 2) float64, mm
    known : Topology, optional
        Of `F`, where it is at hand.
    """

    id: str
    faces: NDArray[np.int64]
    vertices: NDArray[np.int64]
    F: NDArray[np.int64]
    UV: NDArray[np.float64]
    known: InitVar[Topology | None] = None

    def __post_init__(self, known: Topology | None) -> None:
        if known is not None:
            vars(self)["topology"] = known  # as `topology` itself would keep it

    def __repr__(self) -> str:
        w, h = self.size
        return f"Piece({self.id!r}, {len(self.F)} faces, {w:.1f} x {h:.1f} mm)"

    @cached_property
    def topology(self) -> Topology:
        return Topology(self.F)

    @cached_property
    def outline(self) -> NDArray[np.float64]:
        """(b, 2) mm: the flat boundary, counter-clockwise, not repeated at the end.

        Both sides of a dart are on it; where the dart closes they may lie on each other.
        """
        return self.UV[self.topology.boundary_loops[0]]

    @cached_property
    def size(self) -> tuple[float, float]:
        """Width and height of the flat bounding box, mm."""
        w, h = np.ptp(self.UV, axis=0)
        return float(w), float(h)

    @cached_property
    def area(self) -> float:
        """Area of the flat shape without its holes, mm^2."""
        total = 0.0
        for loop in self.topology.boundary_loops:
            x, y = self.UV[loop].T
            total += float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2
        return total

    def V(self, mesh: Mesh) -> NDArray[np.float64]:
        """Where the piece's vertices lie on the object, (p, 3) mm."""
        return mesh.V[self.vertices]
