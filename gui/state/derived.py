"""What follows from the document, computed once for as long as the part it follows from stays the same."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from skinfab.drawings.sheet import sheet_offsets
from skinfab.flatten.distortion import Distortion, measure
from skinfab.flatten.mapping import FlatMap
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin
from skinfab.tolerances import PREVIEW_CHORD_MM

T = TypeVar("T")

#: What so many documents ago was kept is let go.
_KEPT = 4096


class Derived:
    """Distortion, maps and lines of pieces and sensors, kept by identity: documents share what did not change.

    Examples
    --------
    >>> from skinfab.pieces import Piece
    >>> mesh = Mesh(np.array([[0.0, 0, 0], [9, 0, 0], [0, 9, 0]]), np.array([[0, 1, 2]]))
    >>> piece = Piece("P1", np.arange(1), np.arange(3), mesh.F, mesh.V[:, :2])
    >>> derived = Derived()
    >>> round(derived.distortion(mesh, piece).mean, 6), derived.distortion(mesh, piece) is derived.distortion(mesh, piece)
    (4.0, True)
    """

    def __init__(self) -> None:
        # Values hold their keys' objects, so that an id is not used again while it is a key.
        self._kept: dict[Hashable, tuple[tuple[object, ...], Any]] = {}

    def distortion(self, mesh: Mesh, piece: Piece) -> Distortion:
        """Of a piece, per triangle and in sum."""
        return self._once("d", (mesh, piece), lambda: measure(piece.V(mesh), piece.F, piece.UV, topology=piece.topology))

    def flat_map(self, mesh: Mesh, piece: Piece) -> FlatMap:
        """Between the object and a piece, both ways; `mesh` may be the one flattened or the object itself."""
        return self._once("map", (mesh, piece), lambda: FlatMap(mesh, piece))

    def offsets(self, pieces: tuple[Piece, ...]) -> dict[str, NDArray[np.float64]]:
        """Where each piece lies on the sheet, (2,) mm to add to its coordinates, by id."""
        return self._once("sheet", pieces, lambda: dict(zip([p.id for p in pieces], sheet_offsets(pieces), strict=True)) if pieces else {})

    def piece_of_face(self, skin: Skin) -> NDArray[np.int64]:
        """(m,) index into ``skin.pieces`` of each mesh face; -1 where it has none."""
        return self._once("owner", (skin.mesh, *skin.pieces), lambda: _owners(skin))

    def flat_line(self, sensor: Sensor) -> NDArray[np.float64]:
        """(k, 2) mm in the piece frame: pad, conductor, pad."""
        return self._once("flat", (sensor,), lambda: sensor.printed_path.to_polyline(tolerance=PREVIEW_CHORD_MM))

    def object_line(self, skin: Skin, sensor: Sensor) -> NDArray[np.float64]:
        """(k, 3) mm on the object; NaN where the flat line lies beside its piece."""
        piece = skin.piece(sensor.piece)
        return self._once("line", (skin.object, piece, sensor), lambda: self._on_object(skin, piece, sensor))

    def _on_object(self, skin: Skin, piece: Piece, sensor: Sensor) -> NDArray[np.float64]:
        path = sensor.printed_path
        # Straight in the plane is not straight on the object: a point every millimetre.
        count = max(int(path.length), 2)
        return self.flat_map(skin.object, piece).to_object(path.point_at(np.linspace(0, 1, count + 1))).xyz

    def _once(self, what: str, of: tuple[object, ...], make: Callable[[], T]) -> T:
        key = (what, *map(id, of))
        if key not in self._kept:
            while len(self._kept) >= _KEPT:
                del self._kept[next(iter(self._kept))]
            self._kept[key] = of, make()
        value: T = self._kept[key][1]
        return value


def _owners(skin: Skin) -> NDArray[np.int64]:
    owner = np.full(len(skin.mesh.F), -1)
    for k, piece in enumerate(skin.pieces):
        owner[piece.faces] = k
    return owner
