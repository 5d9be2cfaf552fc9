"""The skin document, `*.skin`: a zip of one `skin.json` and plain arrays, the same bytes for the same skin.

Arrays are stored, not deflated: other releases of zlib would make other bytes, and saving stays quick enough
for a GUI to do it after every change.
"""

from __future__ import annotations

import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab import __version__
from skinfab.archive import Archive, write_archive
from skinfab.document_parts import (
    arrays_of,
    check_indices,
    check_unique,
    describe_lifted,
    describe_piece,
    describe_sensor,
    get,
    get_entries,
    read_lifted,
    read_piece,
    read_sensor,
)
from skinfab.errors import InputError
from skinfab.files import atomic_path
from skinfab.mesh.model import Mesh
from skinfab.skin import SeamMarks, Skin, Source

#: Version of `skin.json`. A reader takes its own and older ones.
SCHEMA = 1


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
        arrays |= arrays_of(piece, f"pieces/{k}")
    if skin.marks is not None and not skin.marks.empty:
        for field in ("locked", "forbidden"):
            arrays[f"marks/{field}"] = np.asarray(getattr(skin.marks, field)).reshape(-1, 2)
        arrays["marks/preference"] = skin.marks.preference
    described = _describe(skin)
    if skin.lifted:
        described["lifted"], theirs = describe_lifted(skin.lifted)
        arrays |= theirs
    with atomic_path(path) as partial:
        write_archive(partial, text={"skin.json": json.dumps(described, indent=1, allow_nan=False) + "\n"}, arrays=arrays)


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
        "pieces": [describe_piece(piece) for piece in skin.pieces],
        "sensors": [describe_sensor(sensor) for sensor in skin.sensors],
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
    schema = get(data, "schema", int, "skin.json")
    if schema > SCHEMA:
        raise InputError(f"is of schema {schema}, this skinfab reads up to {SCHEMA}; install a newer skinfab")
    if schema < 1:
        raise InputError(f"skin.json: schema is {schema}; the first one is 1")
    units = get(data, "units", dict, "skin.json")
    if units != {"length": "mm", "angle": "rad"}:
        raise InputError(f"skin.json: units are {units}; they must be mm and rad")
    mesh = _mesh(get(data, "mesh", dict, "skin.json"), archive)
    seams = archive.array("seams", "<i8", (get(get(data, "seams", dict, "skin.json"), "n_edges", int, "skin.json, seams"), 2))
    check_indices(seams, len(mesh.V), "seams")
    pieces = tuple(
        read_piece(entry, f"skin.json, pieces[{k}]", f"pieces/{k}", mesh, archive)
        for k, entry in enumerate(get_entries(data, "pieces", "skin.json"))
    )
    check_unique([p.id for p in pieces], "piece")
    if pieces and np.bincount(np.concatenate([p.faces for p in pieces]), minlength=1).max() > 1:
        raise InputError("two pieces share a face of the mesh; each face may be in one piece only")
    ids = {p.id for p in pieces}
    sensors = tuple(
        read_sensor(entry, f"skin.json, sensors[{k}]", ids) for k, entry in enumerate(get_entries(data, "sensors", "skin.json"))
    )
    check_unique([s.id for s in sensors], "sensor")
    thickness, neutral = _thickness(data)
    return Skin(
        mesh=mesh,
        source=_source(get(data, "provenance", dict, "skin.json")),
        seams=seams,
        pieces=pieces,
        sensors=sensors,
        printer=get(data, "printer", str, "skin.json"),
        material=get(data, "material", str, "skin.json"),
        max_distortion=get(data, "max_distortion", float, "skin.json"),
        seed=get(data, "seed", int, "skin.json"),
        thickness=thickness,
        neutral=neutral,
        object_V=archive.array("object/V", "<f8", mesh.V.shape) if thickness * neutral > 0 else None,
        marks=_marks(get(data, "marks", dict, "skin.json"), mesh, archive) if "marks" in data else None,
        lifted=read_lifted(get(data, "lifted", dict, "skin.json"), mesh, archive) if "lifted" in data else (),
    )


def _marks(entry: dict[str, Any], mesh: Mesh, archive: Archive) -> SeamMarks:
    pairs = {}
    for field in ("locked", "forbidden"):
        pairs[field] = archive.array(f"marks/{field}", "<i8", (get(entry, f"n_{field}", int, "skin.json, marks"), 2))
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
    entry, where = get(data, "thickness", dict, "skin.json"), "skin.json, thickness"
    thickness, neutral = (get(entry, key, float, where) for key in ("thickness_mm", "neutral"))
    if thickness < 0 or not 0 <= neutral <= 1:
        raise InputError(f"{where}: {thickness:g} mm with neutral {neutral:g}; they must be 0 or more, and from 0 to 1")
    return thickness, neutral


def _source(entry: dict[str, Any]) -> Source:
    where = "skin.json, provenance"
    return Source(
        file=get(entry, "file", str, where),
        sha256=get(entry, "sha256", str, where),
        units=get(entry, "units", str, where),
        scale=get(entry, "scale", float, where),
    )


def _mesh(entry: dict[str, Any], archive: Archive) -> Mesh:
    name = get(entry, "name", str, "skin.json, mesh")
    if not name.isprintable() or "/" in name or "\\" in name or name in ("", ".", ".."):
        raise InputError(f"skin.json: mesh name {name!r} cannot be part of a file name")
    V = archive.array("mesh/V", "<f8", (get(entry, "n_vertices", int, "skin.json, mesh"), 3))
    F = archive.array("mesh/F", "<i8", (get(entry, "n_faces", int, "skin.json, mesh"), 3))
    check_indices(F, len(V), "mesh/F")
    return Mesh(V, F, name)
