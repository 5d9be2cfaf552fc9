"""What a skin document is put together of, each read with all that can be wrong with it: fields, pieces, sensors."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.archive import Archive
from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern, parameters
from skinfab.pieces import Piece
from skinfab.placement.lifted import Lifted
from skinfab.placement.sensor import ID, ID_WORDS, Sensor

Arrays = dict[str, NDArray[Any]]


def describe_piece(piece: Piece) -> dict[str, Any]:
    """What `skin.json` holds of a piece."""
    return {"id": piece.id, "n_faces": len(piece.faces), "n_vertices": len(piece.vertices)}


def arrays_of(piece: Piece, folder: str) -> Arrays:
    """The arrays of a piece, by name."""
    return {f"{folder}/{field}": getattr(piece, field) for field in ("faces", "vertices", "F", "UV")}


def read_piece(entry: dict[str, Any], where: str, folder: str, mesh: Mesh, archive: Archive) -> Piece:
    """The piece that `entry` says, its arrays in `folder` of the document."""
    id = get_id(entry, "id", where)
    n_faces, n_vertices = get(entry, "n_faces", int, where), get(entry, "n_vertices", int, where)
    faces = archive.array(f"{folder}/faces", "<i8", (n_faces,))
    vertices = archive.array(f"{folder}/vertices", "<i8", (n_vertices,))
    F = archive.array(f"{folder}/F", "<i8", (n_faces, 3))
    UV = archive.array(f"{folder}/UV", "<f8", (n_vertices, 2))
    check_indices(faces, len(mesh.F), f"{folder}/faces")
    check_indices(vertices, len(mesh.V), f"{folder}/vertices")
    check_indices(F, n_vertices, f"{folder}/F")
    if n_faces == 0 or not np.array_equal(vertices[F], mesh.F[faces]):
        raise InputError(f"piece {id} does not match the mesh; its arrays come from another skin")
    return Piece(id, faces, vertices, F, UV)


def describe_sensor(sensor: Sensor) -> dict[str, Any]:
    """What `skin.json` holds of a sensor."""
    return {
        "id": sensor.id,
        "kind": sensor.pattern.kind,
        "piece": sensor.piece,
        "params": {name: np.asarray(value).item() for name, value in parameters(sensor.pattern).items()},
        "x_mm": float(sensor.x),
        "y_mm": float(sensor.y),
        "angle_rad": float(sensor.angle),
        "channel": int(sensor.channel),
    }


def read_sensor(entry: dict[str, Any], where: str, pieces: Collection[str]) -> Sensor:
    """The sensor that `entry` says, on one of the pieces."""
    piece = get_id(entry, "piece", where)
    if piece not in pieces:
        raise InputError(f"{where} lies on piece {piece!r}; there is no such piece")
    channel = get(entry, "channel", int, where)
    if not 0 <= channel < 2**31:
        raise InputError(f"{where}: channel is {channel}; it must be zero or more")
    kind, params = get(entry, "kind", str, where), get(entry, "params", dict, where)
    x, y, angle = (get(entry, key, float, where) for key in ("x_mm", "y_mm", "angle_rad"))
    try:
        pattern = make_pattern(kind, params)
    except InputError as fault:
        raise InputError(f"{where}: {fault}") from fault
    return Sensor(id=get_id(entry, "id", where), piece=piece, pattern=pattern, x=x, y=y, angle=angle, channel=channel)


def describe_lifted(lifted: Sequence[Lifted]) -> tuple[dict[str, Any], Arrays]:
    """What `skin.json` holds of sensors that are off, and the pieces they lay on; what keeps them off is found anew."""
    pieces = list({id(each.piece): each.piece for each in lifted}.values())
    number = {id(piece): k for k, piece in enumerate(pieces)}
    sensors = [describe_sensor(each.sensor) | {"lay_on": number[id(each.piece)], "place": int(each.place)} for each in lifted]
    arrays = {name: array for k, piece in enumerate(pieces) for name, array in arrays_of(piece, f"lifted/{k}").items()}
    return {"pieces": [describe_piece(piece) for piece in pieces], "sensors": sensors}, arrays


def read_lifted(entry: dict[str, Any], mesh: Mesh, archive: Archive) -> tuple[Lifted, ...]:
    """Sensors that are off; their pieces are of the same mesh, but from before it was cut as it is now."""
    where = "skin.json, lifted"
    pieces = [
        read_piece(each, f"{where}, pieces[{k}]", f"lifted/{k}", mesh, archive)
        for k, each in enumerate(get_entries(entry, "pieces", where))
    ]
    if any(np.bincount(piece.faces).max() > 1 for piece in pieces):
        raise InputError(f"{where}: a piece has a face of the mesh twice; each may be in it once")
    lifted = []
    for k, each in enumerate(get_entries(entry, "sensors", where)):
        here = f"{where}, sensors[{k}]"
        number, place = get(each, "lay_on", int, here), get(each, "place", int, here)
        if not 0 <= number < len(pieces):
            raise InputError(f"{here}: lay_on is {number}; there are {len(pieces)} pieces, counted from 0")
        if not 0 <= place < 2**31:
            raise InputError(f"{here}: place is {place}; it must be zero or more")
        lifted.append(Lifted(read_sensor(each, here, {pieces[number].id}), pieces[number], place=place))
    return tuple(lifted)


def get(entry: dict[str, Any], key: str, kind: type, where: str) -> Any:
    """`entry[key]`, which must be of that kind; a float may be written as a whole number, never as NaN."""
    if key not in entry:
        raise InputError(f"{where}: {key} is missing")
    value = entry[key]
    if kind is float and type(value) is int and abs(value) < 2**53:
        return float(value)
    if type(value) is not kind:
        raise InputError(f"{where}: {key} is {str(value)[:40]!r}; it must be a {kind.__name__}")
    if isinstance(value, float) and not math.isfinite(value):
        raise InputError(f"{where}: {key} is {value}; it must be finite")
    return value


def get_id(entry: dict[str, Any], key: str, where: str) -> str:
    """`entry[key]`, which must be an id."""
    id: str = get(entry, key, str, where)
    if not ID.fullmatch(id):
        raise InputError(f"{where}: {key} is {id[:40]!r}; an id has {ID_WORDS}")
    return id


def get_entries(data: dict[str, Any], key: str, where: str) -> list[dict[str, Any]]:
    """`data[key]`, which must be a list of objects."""
    entries: list[dict[str, Any]] = get(data, key, list, where)
    for k, entry in enumerate(entries):
        if not isinstance(entry, dict):
            raise InputError(f"{where}: {key}[{k}] is {str(entry)[:40]!r}; it must be an object")
    return entries


def check_unique(ids: list[str], what: str) -> None:
    """Refuse two of the same id."""
    # File systems of other machines do not tell "p1" from "P1".
    if len({id.lower() for id in ids}) < len(ids):
        raise InputError(f"two {what}s have the same id; each needs its own")


def check_indices(array: NDArray[Any], count: int, name: str) -> None:
    """Refuse numbers that point at nothing."""
    if array.size and (array.min() < 0 or array.max() >= count):
        raise InputError(f"{name}.npy points at number {array.max() if array.max() >= count else array.min()}; there are {count}")
