"""The skin document: everything a result is made from, in one value."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece
from skinfab.placement.lifted import Lifted
from skinfab.placement.sensor import Sensor


@dataclass(frozen=True)
class Source:
    """Where the mesh came from.

    Parameters
    ----------
    file : str
        File name without its folder.
    sha256 : str
        Of the file's bytes.
    units : str
        The unit the file was read in: "mm", "cm", "m" or "in".
    scale : float
        File units were multiplied by this to give mm (unit and ``--scale`` together).
    """

    file: str
    sha256: str
    units: str
    scale: float


@dataclass(frozen=True, eq=False)
class SeamMarks:
    """What a person decided about where seams may run.

    Parameters
    ----------
    locked : (k, 2) int64
        Mesh vertex pairs: seam edges that stay seams when the object is cut automatically.
    forbidden : (k, 2) int64
        Mesh vertex pairs: edges that are never cut.
    preference : (m,) int8
        Per mesh face: +1 attracts seams, -1 repels them, 0 leaves them alone.

    Examples
    --------
    >>> marks = SeamMarks.none(3)
    >>> marks.empty, marks.preference.tolist()
    (True, [0, 0, 0])
    """

    locked: NDArray[np.int64]
    forbidden: NDArray[np.int64]
    preference: NDArray[np.int8]

    @staticmethod
    def none(n_faces: int) -> SeamMarks:
        """Marks of a mesh with that many faces which say nothing."""
        no_edges = np.zeros((0, 2), dtype=np.int64)
        return SeamMarks(no_edges, no_edges, np.zeros(n_faces, dtype=np.int8))

    @property
    def empty(self) -> bool:
        """Whether they say nothing."""
        return not (len(self.locked) or len(self.forbidden) or self.preference.any())


@dataclass(frozen=True, eq=False)
class Skin:
    """A mesh with its seams, flat pieces and sensors.

    Parameters
    ----------
    mesh : Mesh
        The surface that was flattened: the object's own, or, with a thickness, the one its skin's middle lies on.
    source : Source
    seams : (k, 2) int64
        Mesh vertex pairs: the edges that are cut.
    pieces : tuple of Piece
    sensors : tuple of Sensor
    printer, material : str
        Profile names, or paths to profiles of one's own.
    max_distortion : float
        The bound on each piece's mean d that the pieces were cut for.
    seed : int
    thickness : float, mm
        Of the skin when it was flattened; 0 where the object's own surface was.
    neutral : float
        How far through the skin, from its inner side (0 to 1), the surface lies that bending does not stretch.
    object_V : (n, 3) float64, mm, optional
        The object's own vertices, where `mesh` has others.
    marks : SeamMarks, optional
        Where seams may run; None where nothing was decided.
    lifted : tuple of Lifted
        Sensors that a cut took off; they are part of nothing that is made until they are back.
    """

    mesh: Mesh
    source: Source
    seams: NDArray[np.int64]
    pieces: tuple[Piece, ...]
    sensors: tuple[Sensor, ...] = ()
    printer: str = "ender5plus-vipro"
    material: str = "carbon-grease-ecoflex"
    max_distortion: float = 4.05
    seed: int = 0
    thickness: float = 0.0
    neutral: float = 0.5
    object_V: NDArray[np.float64] | None = None
    marks: SeamMarks | None = None
    lifted: tuple[Lifted, ...] = ()

    @cached_property
    def object(self) -> Mesh:
        """The object itself, with the faces of `mesh`."""
        return self.mesh if self.object_V is None else Mesh(self.object_V, self.mesh.F, self.mesh.name)

    @property
    def flattened_at(self) -> float:
        """How far outside the object the surface lies that was flattened, mm."""
        return 0.0 if self.object_V is None else self.thickness * self.neutral

    def piece(self, id: str) -> Piece:
        """The piece of that id."""
        for piece in self.pieces:
            if piece.id == id:
                return piece
        raise InputError(f"no piece {id!r}; this skin has {', '.join(p.id for p in self.pieces)}")

    def sensors_on(self, id: str) -> tuple[Sensor, ...]:
        """The sensors that lie on the piece of that id."""
        return tuple(s for s in self.sensors if s.piece == id)
