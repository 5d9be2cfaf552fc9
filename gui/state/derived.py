"""What follows from the document, computed once for as long as the part it follows from stays the same."""

from __future__ import annotations

import threading
from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

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

#: Parts that follow from fewer triangles than this, all together, are made when they are asked for: that takes less than 50 ms.
AT_ONCE = 12_000

#: What so many documents ago was kept is let go.
_KEPT = 4096


@dataclass(frozen=True, eq=False)
class Part:
    """Something to be made once from parts of a document.

    Parameters
    ----------
    what : str
    of : tuple
        It follows from these objects alone.
    size : int
        Triangles it is made from: how long that takes.
    make : callable
        Touches no widget: it may be called in another thread.
    """

    what: str
    of: tuple[object, ...]
    size: int
    make: Callable[[], Any]


class Asker(Protocol):
    """What answers questions beside the window's loop: `gui.jobs.background.Background`."""

    def ask(self, key: str, question: Callable[[], Any], answered: Callable[[Any], None]) -> None:
        """Call `question` elsewhere, and `answered` here."""


class Derived:
    """Distortion, maps and lines of pieces and sensors, kept by identity: documents share what did not change.

    Parameters
    ----------
    background : Asker, optional
        Makes what a large document is shown by; without it, all is made when it is asked for.

    Examples
    --------
    >>> from skinfab.pieces import Piece
    >>> mesh = Mesh(np.array([[0.0, 0, 0], [9, 0, 0], [0, 9, 0]]), np.array([[0, 1, 2]]))
    >>> piece = Piece("P1", np.arange(1), np.arange(3), mesh.F, mesh.V[:, :2])
    >>> derived = Derived()
    >>> round(derived.distortion(mesh, piece).mean, 6), derived.distortion(mesh, piece) is derived.distortion(mesh, piece)
    (4.0, True)
    """

    def __init__(self, background: Asker | None = None) -> None:
        # Values hold their keys' objects, so that an id is not used again while it is a key.
        self._kept: dict[Hashable, tuple[tuple[object, ...], Any]] = {}
        self._lock = threading.Lock()
        self._background = background
        self._needs: list[Callable[[Skin], Iterable[Part]]] = [self._own_parts]
        self._waiting: tuple[Skin | None, list[Callable[[], None]]] = (None, [])
        self._given_up: Skin | None = None

    def needs(self, parts: Callable[[Skin], Iterable[Part]]) -> None:
        """A view says by which parts it shows a document; `parts` itself has to be quick."""
        self._needs.append(parts)

    def ready(self, skin: Skin, then: Callable[[], None]) -> bool:
        """Whether a document can be shown at once; where not, its parts are being made, and `then` is called when they are there.

        Until then the caller goes on showing what it has shown. Only the newest document that was asked for is waited for.
        """
        missing = [part for parts in self._needs for part in parts(skin) if (part.what, *map(id, part.of)) not in self._kept]
        if self._background is None or sum(part.size for part in missing) < AT_ONCE or skin is self._given_up:
            return True
        waits_for, waiting = self._waiting
        if waits_for is skin:
            if then not in waiting:
                waiting.append(then)
            return False
        waiting = [then]
        self._waiting = skin, waiting

        def make() -> None:
            for part in missing:
                self.once(part.what, part.of, part.make)

        def made(outcome: Any) -> None:
            self._waiting = None, []
            if outcome.sentence:
                self._given_up = skin  # who asks for the part that failed says so, where it is seen
            for call in waiting:
                call()

        self._background.ask("derived", make, made)
        return False

    def distortion(self, mesh: Mesh, piece: Piece) -> Distortion:
        """Of a piece, per triangle and in sum."""
        return self.once("d", (mesh, piece), lambda: _distortion(mesh, piece))

    def flat_map(self, mesh: Mesh, piece: Piece) -> FlatMap:
        """Between the object and a piece, both ways; `mesh` may be the one flattened or the object itself."""
        return self.once("map", (mesh, piece), lambda: FlatMap(mesh, piece))

    def offsets(self, pieces: tuple[Piece, ...]) -> dict[str, NDArray[np.float64]]:
        """Where each piece lies on the sheet, (2,) mm to add to its coordinates, by id."""
        return self.once("sheet", pieces, lambda: dict(zip([p.id for p in pieces], sheet_offsets(pieces), strict=True)) if pieces else {})

    def piece_of_face(self, skin: Skin) -> NDArray[np.int64]:
        """(m,) index into ``skin.pieces`` of each mesh face; -1 where it has none."""
        return self.once("owner", (skin.mesh, *skin.pieces), lambda: _owners(skin))

    def flat_line(self, sensor: Sensor) -> NDArray[np.float64]:
        """(k, 2) mm in the piece frame: pad, conductor, pad."""
        return self.once("flat", (sensor,), lambda: sensor.printed_path.to_polyline(tolerance=PREVIEW_CHORD_MM))

    def object_line(self, skin: Skin, sensor: Sensor) -> NDArray[np.float64]:
        """(k, 3) mm on the object; NaN where the flat line lies beside its piece."""
        piece = skin.piece(sensor.piece)
        return self.once("line", (skin.object, piece, sensor), lambda: self._on_object(skin, piece, sensor))

    def _on_object(self, skin: Skin, piece: Piece, sensor: Sensor) -> NDArray[np.float64]:
        path = sensor.printed_path
        # Straight in the plane is not straight on the object: a point every millimetre.
        count = max(int(path.length), 2)
        return self.flat_map(skin.object, piece).to_object(path.point_at(np.linspace(0, 1, count + 1))).xyz

    def once(self, what: str, of: tuple[object, ...], make: Callable[[], T]) -> T:
        """What `make` gives, made once for as long as the objects in `of` are the same ones."""
        key = (what, *map(id, of))
        kept = self._kept.get(key)
        if kept is None:
            kept = of, make()
            with self._lock:
                while len(self._kept) >= _KEPT:
                    del self._kept[next(iter(self._kept))]
                self._kept[key] = kept
        value: T = kept[1]
        return value

    def _own_parts(self, skin: Skin) -> Iterable[Part]:
        """What every view needs: how edges meet, and where conductors lie on the object."""
        mesh, m = skin.mesh, len(skin.mesh.F)
        yield Part("topology", (mesh,), m, lambda: (mesh.topology, mesh.topology.used_vertices))
        for piece in skin.pieces:
            yield Part("outline", (piece,), len(piece.F), lambda piece=piece: piece.topology.boundary_loops)  # type: ignore[misc]
            yield Part("d", (mesh, piece), len(piece.F), lambda piece=piece: _distortion(mesh, piece))  # type: ignore[misc]
        for piece in {s.piece: skin.piece(s.piece) for s in skin.sensors if any(p.id == s.piece for p in skin.pieces)}.values():
            yield Part("map", (skin.object, piece), 2 * len(piece.F), lambda piece=piece: FlatMap(skin.object, piece))  # type: ignore[misc]


def _distortion(mesh: Mesh, piece: Piece) -> Distortion:
    return measure(piece.V(mesh), piece.F, piece.UV, topology=piece.topology)


def _owners(skin: Skin) -> NDArray[np.int64]:
    owner = np.full(len(skin.mesh.F), -1)
    for k, piece in enumerate(skin.pieces):
        owner[piece.faces] = k
    return owner
