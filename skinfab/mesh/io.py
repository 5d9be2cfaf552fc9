"""Read a mesh file into millimetres: OBJ, STL, PLY, OFF, GLB."""

from __future__ import annotations

import hashlib
import io
import logging
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.mesh.obj import parse_obj
from skinfab.mesh.stl import parse_stl
from skinfab.mesh.units import guess_units, mm_per, odd_size
from skinfab.tolerances import LARGEST_OBJECT_MM, SMALLEST_OBJECT_MM

#: No count has more, and Python converts no more than 4300.
_DIGITS = 18

FORMATS = (".obj", ".stl", ".ply", ".off", ".glb")


@dataclass(frozen=True, eq=False)
class Loaded:
    """A mesh and where it came from.

    Parameters
    ----------
    mesh : Mesh
        In mm; as the file has it otherwise, faults and all.
    file : str
        File name without its folder.
    sha256 : str
        Of the file's bytes.
    units : str
        The unit the file was read in.
    scale : float
        File units were multiplied by this to give mm.
    notes : tuple of str
        What the user should be told: one sentence each.
    """

    mesh: Mesh
    file: str
    sha256: str
    units: str
    scale: float
    notes: tuple[str, ...] = ()


def load_mesh(path: str | Path, *, units: str | None = None, scale: float = 1.0) -> Loaded:
    """Read a mesh file.

    Parameters
    ----------
    path : path
        .obj, .stl, .ply, .off or .glb.
    units : str, optional
        "mm", "cm", "m" or "in"; by default guessed from the size.
    scale : float
        A further factor on all coordinates.

    Returns
    -------
    Loaded
        The mesh in mm, with quads and polygons triangulated and all components kept.

    Raises
    ------
    InputError
        No such file, not a mesh, no faces, a coordinate that is not finite, an index out of range.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "corner.obj"
    >>> _ = path.write_text("v 0 0 0\\nv .2 0 0\\nv 0 .2 0\\nf 1 2 3\\n")
    >>> loaded = load_mesh(path)
    >>> loaded.mesh, loaded.units, loaded.mesh.bbox[1].tolist()
    (Mesh('corner', 3 vertices, 1 faces), 'm', [200.0, 200.0, 0.0])
    """
    path = Path(path)
    if not (np.isfinite(scale) and scale > 0):
        raise InputError(f"scale is {scale:g}; it must be a positive number")
    if units is not None:
        mm_per(units)
    data = _read_bytes(path)
    V, F = _parse(path, data)
    _check(V, F, path.name)
    notes = []
    if units is None:
        guess = guess_units(float(np.ptp(V, axis=0).max()))
        units = guess.units
        if units != "mm" or not guess.sure:
            notes.append(guess.reason)
    factor = mm_per(units) * scale
    size = float(np.ptp(V, axis=0).max()) * factor
    if not SMALLEST_OBJECT_MM <= size <= LARGEST_OBJECT_MM:
        raise InputError(f"{path.name} is {size:.3g} mm long, which nothing can be computed with; check --units and --scale")
    if odd := odd_size(size):
        notes.append(odd)
    mesh = Mesh(V * factor, F, name_of(path.stem))
    file = path.name.encode(errors="backslashreplace").decode()  # bytes that are no UTF-8 go into no report
    return Loaded(mesh, file, hashlib.sha256(data).hexdigest(), units, factor, tuple(notes))


def name_of(stem: str) -> str:
    """What a mesh is called after its file: what is no part of a file's name on every system, or of a drawing's text, is an underscore.

    Examples
    --------
    >>> name_of("grip\\u3000v2"), name_of("left\\\\right"), name_of("..")
    ('grip_v2', 'left_right', '_')
    """
    name = "".join(each if each.isprintable() and each not in "/\\" else "_" for each in stem)
    return name if name.strip(".") else "_"


def _read_bytes(path: Path) -> bytes:
    if path.suffix.lower() == ".skin":
        raise InputError(f"{path} is a skin document, which is cut and flat already; skinfab make, place, mould and gcode take it")
    if path.suffix.lower() not in FORMATS:
        raise InputError(f"{path} is not a mesh file skinfab reads; give one of {', '.join(FORMATS)}")
    if path.is_dir():
        raise InputError(f"{path} is a folder; give the mesh file inside it")
    if not path.exists():
        raise InputError(f"{path} does not exist; check the path")
    if not path.is_file():
        raise InputError(f"{path} is no regular file; give a mesh file")
    try:
        data = path.read_bytes()
    except OSError as fault:
        raise InputError(f"cannot read {path}: {fault.strerror or fault}; check the file") from fault
    if not data.strip():
        raise InputError(f"{path} is empty; export the mesh again")
    return data


def _parse(path: Path, data: bytes) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    suffix = path.suffix.lower()
    if suffix == ".obj":
        with np.errstate(over="ignore", invalid="ignore"):  # of coordinates that are refused below
            return parse_obj(data, path.name)
    if suffix == ".stl":
        return parse_stl(data, path.name)
    if suffix == ".ply":
        _check_ply_header(data, path.name)
    elif suffix == ".off":
        _check_off_header(data, path.name)
    else:
        _check_glb_header(data, path.name)
    return _parse_with_trimesh(data, path.name, suffix[1:])


def _check_ply_header(data: bytes, name: str) -> None:
    """The counts a header claims must fit the file, before anything is allocated for them."""
    end = data.find(b"end_header", 0, 1 << 16)
    if data[:3] != b"ply" or end < 0:
        raise InputError(f"{name} is no PLY (no 'ply ... end_header' at its start); check the file or its extension")
    for element, count in re.findall(rb"element\s+(\w+)\s+(\d+)", data[:end]):
        if len(count) > _DIGITS or int(count) > len(data) - end:
            raise InputError(
                f"{name} is cut off: its header claims {count[:_DIGITS].decode()} of {element.decode()!r}, "
                "but the file is shorter; export the mesh again"
            )


def _check_off_header(data: bytes, name: str) -> None:
    words = re.sub(rb"#[^\n]*", b"", data[:4096]).split()[:4]
    if not words or not words[0].upper().endswith(b"OFF"):
        raise InputError(f"{name} is no OFF (it does not begin with 'OFF'); check the file or its extension")
    if any(word.isdigit() and (len(word) > _DIGITS or int(word) > len(data)) for word in words[1:3]):
        raise InputError(f"{name} is cut off: its header claims more elements than the file holds; export the mesh again")


def _check_glb_header(data: bytes, name: str) -> None:
    if data[:4] != b"glTF":
        raise InputError(f"{name} is no GLB (it does not begin with 'glTF'); check the file or its extension")
    claimed = int.from_bytes(data[8:12], "little")
    if claimed > len(data):
        raise InputError(f"{name} is cut off: its header claims {claimed} bytes, it has {len(data)}; export the mesh again")


def _parse_with_trimesh(data: bytes, name: str, kind: str) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    import trimesh

    with _hushed():
        try:
            scene = trimesh.load_scene(io.BytesIO(data), file_type=kind, process=False)
            geometry = scene.to_mesh()
            V = np.asarray(geometry.vertices, dtype=np.float64).reshape(-1, 3)
            F = np.asarray(geometry.faces, dtype=np.int64).reshape(-1, 3)
        # A damaged file makes the parser fail in any way at all: KeyError, struct.error, MemoryError ...
        except Exception as fault:
            said = " ".join(str(fault).split())[:80]
            raise InputError(f"{name} cannot be read as {kind.upper()} ({type(fault).__name__}: {said}); export the mesh again") from None
    if len(V) and not len(F):
        raise InputError(f"{name} has {len(V)} vertices but no faces; export it as a surface mesh, not as points")
    return V, F


@contextmanager
def _hushed() -> Iterator[None]:
    """Keep a parser's warnings off stderr: what matters is found by our own checks."""
    quiet, logger = logging.NullHandler(), logging.getLogger("trimesh")
    held = logger.propagate
    logger.addHandler(quiet)
    logger.propagate = False
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            yield
    finally:
        logger.removeHandler(quiet)
        logger.propagate = held


def _check(V: NDArray[np.float64], F: NDArray[np.int64], name: str) -> None:
    if not len(V) or not len(F):
        raise InputError(f"{name} has no faces; export the mesh again")
    if not np.isfinite(V).all():
        bad = ~np.isfinite(V).all(axis=1)
        raise InputError(f"{name}: vertex {int(np.argmax(bad))} (counted from 0) is not finite (NaN or infinity); export the mesh again")
    if F.min() < 0 or F.max() >= len(V):
        k = int(np.argmax(((F < 0) | (F >= len(V))).any(axis=1)))
        raise InputError(f"{name}: face {k} (counted from 0) uses vertex {F[k].max()}, but there are {len(V)}; export the mesh again")
    # Squares and products of coordinates must stay finite too.
    if np.abs(V).max() > 1e100:
        raise InputError(
            f"{name}: vertex {int(np.abs(V).max(axis=1).argmax())} lies {np.abs(V).max():.3g} units away; export the mesh again"
        )
