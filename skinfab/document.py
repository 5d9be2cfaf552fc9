"""The skin document, `*.skin`: a zip of one `skin.json` and plain arrays, the same bytes for the same skin.

Arrays are stored, not deflated: other releases of zlib would make other bytes, and saving stays quick enough
for a GUI to do it after every change.
"""

from __future__ import annotations

import json
import math
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab import __version__
from skinfab.archive import Archive, write_archive
from skinfab.errors import InputError
from skinfab.files import atomic_path
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern, parameters
from skinfab.pieces import Piece
from skinfab.placement.sensor import ID, ID_WORDS, Sensor
from skinfab.skin import SeamMarks, Skin, Source

#: Version of `skin.json`. A reader takes its own and older ones.
SCHEMA = 1

#: Ids become file names: no separators, no dots.


def save_skin(skin: Skin, path: str | Path) -> None:
    """Write `skin` to `path`, whole or not at all; the same skin gives the same bytes.

    Parameters
    ----------
    skin : Skin
    path : path
        Ends in ``.skin`` by custom. Its folder must exist.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    arrays: dict[str, NDArray[Any]] = {"mesh/V": skin.mesh.V, "mesh/F": skin.mesh.F, "seams": np.asarray(skin.seams).reshape(-1, 2)}
    if skin.object_V is not None:
        arrays["object/V"] = skin.object_V
    for k, piece in enumerate(skin.pieces):
        for field in ("faces", "vertices", "F", "UV"):
            arrays[f"pieces/{k}/{field}"] = getattr(piece, field)
    if skin.marks is not None and not skin.marks.empty:
        for field in ("locked", "forbidden"):
            arrays[f"marks/{field}"] = np.asarray(getattr(skin.marks, field)).reshape(-1, 2)
        arrays["marks/preference"] = skin.marks.preference
    with atomic_path(path) as partial:
        write_archive(partial, text={"skin.json": json.dumps(_describe(skin), indent=1, allow_nan=False) + "\n"}, arrays=arrays)


def load_skin(path: str | Path) -> Skin:
    """Read a skin document; everything in it is checked, nothing in it is run.

    Parameters
    ----------
    path : path

    Returns
    -------
    Skin

    Raises
    ------
    InputError
        Not a skin document, of a newer schema, damaged, out of proportion, or contradicting itself.
    """
    path = Path(path)
    try:
        with Archive(path) as archive:
            data = archive.json("skin.json")
            return _build(data, archive)
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except IsADirectoryError:
        raise InputError(f"{path}: is a folder; give a .skin file") from None
    except zipfile.BadZipFile as fault:
        if path.suffix.lower() != ".skin":
            raise InputError(f"{path}: not a skin document; make one from a mesh with skinfab make or skinfab segment") from None
        raise InputError(f"{path}: not a whole skin document ({fault}); save it again or take a copy") from None
    except InputError as fault:
        raise InputError(f"{path}: {fault}") from fault


def _describe(skin: Skin) -> dict[str, Any]:
    """What `skin.json` holds."""
    source = skin.source
    return {
        "schema": SCHEMA,
        "units": {"length": "mm", "angle": "rad"},
        "provenance": {
            "made_by": f"skinfab {__version__}",
            "file": source.file,
            "sha256": source.sha256,
            "units": source.units,
            "scale": float(source.scale),
        },
        "mesh": {"name": skin.mesh.name, "n_vertices": len(skin.mesh.V), "n_faces": len(skin.mesh.F)},
        "seams": {"n_edges": len(skin.seams)},
        "pieces": [{"id": p.id, "n_faces": len(p.faces), "n_vertices": len(p.vertices)} for p in skin.pieces],
        "sensors": [
            {
                "id": s.id,
                "kind": s.pattern.kind,
                "piece": s.piece,
                "params": {name: np.asarray(value).item() for name, value in parameters(s.pattern).items()},
                "x_mm": float(s.x),
                "y_mm": float(s.y),
                "angle_rad": float(s.angle),
                "channel": int(s.channel),
            }
            for s in skin.sensors
        ],
        "printer": skin.printer,
        "material": skin.material,
        "max_distortion": float(skin.max_distortion),
        "seed": int(skin.seed),
        # Left out where it says nothing: such a document is the same as those of releases that knew no thickness.
        **({"thickness": {"thickness_mm": float(skin.thickness), "neutral": float(skin.neutral)}} if _is_thick(skin) else {}),
        **({} if skin.marks is None or skin.marks.empty else {"marks": _describe_marks(skin.marks)}),
    }


def _describe_marks(marks: SeamMarks) -> dict[str, int]:
    return {"n_locked": len(marks.locked), "n_forbidden": len(marks.forbidden)}


def _is_thick(skin: Skin) -> bool:
    return skin.thickness > 0 or skin.neutral != Skin.neutral


def _build(data: dict[str, Any], archive: Archive) -> Skin:
    schema = _get(data, "schema", int, "skin.json")
    if schema > SCHEMA:
        raise InputError(f"is of schema {schema}, this skinfab reads up to {SCHEMA}; install a newer skinfab")
    if schema < 1:
        raise InputError(f"skin.json: schema is {schema}; the first one is 1")
    units = _get(data, "units", dict, "skin.json")
    if units != {"length": "mm", "angle": "rad"}:
        raise InputError(f"skin.json: units are {units}; they must be mm and rad")
    mesh = _mesh(_get(data, "mesh", dict, "skin.json"), archive)
    seams = archive.array("seams", "<i8", (_get(_get(data, "seams", dict, "skin.json"), "n_edges", int, "skin.json, seams"), 2))
    _check_indices(seams, len(mesh.V), "seams")
    pieces = tuple(_piece(entry, k, mesh, archive) for k, entry in enumerate(_entries(data, "pieces")))
    _check_unique([p.id for p in pieces], "piece")
    if pieces and np.bincount(np.concatenate([p.faces for p in pieces]), minlength=1).max() > 1:
        raise InputError("two pieces share a face of the mesh; each face may be in one piece only")
    sensors = tuple(_sensor(entry, k, {p.id for p in pieces}) for k, entry in enumerate(_entries(data, "sensors")))
    _check_unique([s.id for s in sensors], "sensor")
    thickness, neutral = _thickness(data)
    return Skin(
        mesh=mesh,
        source=_source(_get(data, "provenance", dict, "skin.json")),
        seams=seams,
        pieces=pieces,
        sensors=sensors,
        printer=_get(data, "printer", str, "skin.json"),
        material=_get(data, "material", str, "skin.json"),
        max_distortion=_get(data, "max_distortion", float, "skin.json"),
        seed=_get(data, "seed", int, "skin.json"),
        thickness=thickness,
        neutral=neutral,
        object_V=archive.array("object/V", "<f8", mesh.V.shape) if thickness * neutral > 0 else None,
        marks=_marks(_get(data, "marks", dict, "skin.json"), mesh, archive) if "marks" in data else None,
    )


def _marks(entry: dict[str, Any], mesh: Mesh, archive: Archive) -> SeamMarks:
    pairs = {}
    for field in ("locked", "forbidden"):
        pairs[field] = archive.array(f"marks/{field}", "<i8", (_get(entry, f"n_{field}", int, "skin.json, marks"), 2))
        if (mesh.topology.edge_ids(pairs[field]) < 0).any():
            raise InputError(f"marks/{field}.npy names two vertices that no edge of the mesh joins; it comes from another skin")
    preference = archive.array("marks/preference", "<i8", (len(mesh.F),))
    if (np.abs(preference.clip(-2, 2)) > 1).any():  # clipped: the least int64 has no absolute value
        raise InputError("marks/preference.npy holds a number other than -1 (avoid), 0 and 1 (attract)")
    return SeamMarks(pairs["locked"], pairs["forbidden"], preference.astype(np.int8))


def _thickness(data: dict[str, Any]) -> tuple[float, float]:
    """Thickness and neutral surface; documents without them were flattened on the object itself."""
    if "thickness" not in data:
        return Skin.thickness, Skin.neutral
    entry, where = _get(data, "thickness", dict, "skin.json"), "skin.json, thickness"
    thickness, neutral = (_get(entry, key, float, where) for key in ("thickness_mm", "neutral"))
    if thickness < 0 or not 0 <= neutral <= 1:
        raise InputError(f"{where}: {thickness:g} mm with neutral {neutral:g}; they must be 0 or more, and from 0 to 1")
    return thickness, neutral


def _source(entry: dict[str, Any]) -> Source:
    where = "skin.json, provenance"
    return Source(
        file=_get(entry, "file", str, where),
        sha256=_get(entry, "sha256", str, where),
        units=_get(entry, "units", str, where),
        scale=_get(entry, "scale", float, where),
    )


def _mesh(entry: dict[str, Any], archive: Archive) -> Mesh:
    name = _get(entry, "name", str, "skin.json, mesh")
    if not name.isprintable() or "/" in name or "\\" in name or name in ("", ".", ".."):
        raise InputError(f"skin.json: mesh name {name!r} cannot be part of a file name")
    V = archive.array("mesh/V", "<f8", (_get(entry, "n_vertices", int, "skin.json, mesh"), 3))
    F = archive.array("mesh/F", "<i8", (_get(entry, "n_faces", int, "skin.json, mesh"), 3))
    _check_indices(F, len(V), "mesh/F")
    return Mesh(V, F, name)


def _piece(entry: dict[str, Any], k: int, mesh: Mesh, archive: Archive) -> Piece:
    where = f"skin.json, pieces[{k}]"
    id = _get_id(entry, "id", where)
    n_faces, n_vertices = _get(entry, "n_faces", int, where), _get(entry, "n_vertices", int, where)
    faces = archive.array(f"pieces/{k}/faces", "<i8", (n_faces,))
    vertices = archive.array(f"pieces/{k}/vertices", "<i8", (n_vertices,))
    F = archive.array(f"pieces/{k}/F", "<i8", (n_faces, 3))
    UV = archive.array(f"pieces/{k}/UV", "<f8", (n_vertices, 2))
    _check_indices(faces, len(mesh.F), f"pieces/{k}/faces")
    _check_indices(vertices, len(mesh.V), f"pieces/{k}/vertices")
    _check_indices(F, n_vertices, f"pieces/{k}/F")
    if n_faces == 0 or not np.array_equal(vertices[F], mesh.F[faces]):
        raise InputError(f"piece {id} does not match the mesh; its arrays come from another skin")
    return Piece(id, faces, vertices, F, UV)


def _sensor(entry: dict[str, Any], k: int, pieces: set[str]) -> Sensor:
    where = f"skin.json, sensors[{k}]"
    piece = _get_id(entry, "piece", where)
    if piece not in pieces:
        raise InputError(f"{where} lies on piece {piece!r}; there is no such piece")
    channel = _get(entry, "channel", int, where)
    if not 0 <= channel < 2**31:
        raise InputError(f"{where}: channel is {channel}; it must be zero or more")
    kind, params = _get(entry, "kind", str, where), _get(entry, "params", dict, where)
    x, y, angle = (_get(entry, key, float, where) for key in ("x_mm", "y_mm", "angle_rad"))
    try:
        pattern = make_pattern(kind, params)
    except InputError as fault:
        raise InputError(f"{where}: {fault}") from fault
    return Sensor(id=_get_id(entry, "id", where), piece=piece, pattern=pattern, x=x, y=y, angle=angle, channel=channel)


def _get(entry: dict[str, Any], key: str, kind: type, where: str) -> Any:
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


def _get_id(entry: dict[str, Any], key: str, where: str) -> str:
    id: str = _get(entry, key, str, where)
    if not ID.fullmatch(id):
        raise InputError(f"{where}: {key} is {id[:40]!r}; an id has {ID_WORDS}")
    return id


def _entries(data: dict[str, Any], key: str) -> list[dict[str, Any]]:
    entries: list[dict[str, Any]] = _get(data, key, list, "skin.json")
    for k, entry in enumerate(entries):
        if not isinstance(entry, dict):
            raise InputError(f"skin.json: {key}[{k}] is {str(entry)[:40]!r}; it must be an object")
    return entries


def _check_unique(ids: list[str], what: str) -> None:
    # File systems of other machines do not tell "p1" from "P1".
    if len({id.lower() for id in ids}) < len(ids):
        raise InputError(f"two {what}s have the same id; each needs its own")


def _check_indices(array: NDArray[Any], count: int, name: str) -> None:
    if array.size and (array.min() < 0 or array.max() >= count):
        raise InputError(f"{name}.npy points at number {array.max() if array.max() >= count else array.min()}; there are {count}")
