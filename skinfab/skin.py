"""The skin document: everything a result is made from, in one value."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece
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
class Skin:
    """A mesh with its seams, flat pieces and sensors.

    Parameters
    ----------
    mesh : Mesh
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

    def piece(self, id: str) -> Piece:
        """The piece of that id."""
        for piece in self.pieces:
            if piece.id == id:
                return piece
        raise InputError(f"no piece {id!r}; this skin has {', '.join(p.id for p in self.pieces)}")

    def sensors_on(self, id: str) -> tuple[Sensor, ...]:
        """The sensors that lie on the piece of that id."""
        return tuple(s for s in self.sensors if s.piece == id)
