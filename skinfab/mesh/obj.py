"""Wavefront OBJ: positions and faces, read in bulk, or line by line where the file is unusual."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.decimals import read_floats, read_ints, words
from skinfab.errors import InputError
from skinfab.mesh.polygons import triangulate

Bytes = NDArray[np.uint8]
IntArray = NDArray[np.int64]

_SPACE, _SLASH, _NEWLINE, _V, _F = 32, 47, 10, 118, 102
_NUMBER = re.compile(rb"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$|[+-]?(nan|inf|infinity)$", re.IGNORECASE)


@dataclass(frozen=True, eq=False)
class _Polygons:
    """What an OBJ file holds, before checks: 1-based or negative corners, face after face."""

    V: NDArray[np.float64]  # (n, 3)
    vertex_line: IntArray  # (n,) line number of each vertex
    corners: IntArray  # (c,)
    sizes: IntArray  # (p,) corners of each face
    face_line: IntArray  # (p,)
    vertices_before: IntArray  # (p,) vertices read when the face was: what -1 counts back from


def parse_obj(data: bytes, name: str) -> tuple[NDArray[np.float64], IntArray]:
    """Vertices and triangles of an OBJ text.

    Slash forms, negative indices, comments, CRLF and vertex colours are understood; quads and
    polygons are triangulated; texture, normals, groups and materials are skipped.

    Parameters
    ----------
    data : bytes
    name : str
        The file's name, for messages.

    Returns
    -------
    V : (n, 3) float64, file units
    F : (m, 3) int64

    Raises
    ------
    InputError
        Not an OBJ text, a number that is none, or an index out of range: names the line.

    Examples
    --------
    >>> V, F = parse_obj(b"v 0 0 0\\nv 1 0 0\\nv 1 1 0\\nv 0 1 0\\nf 1/1 2/2 3/3 -1/4\\n", "quad.obj")
    >>> V.shape, F.tolist()
    ((4, 3), [[0, 1, 2], [0, 2, 3]])
    """
    if b"\0" in data:
        raise InputError(f"{name} is not an OBJ text (byte {data.index(0) + 1} is zero); check the file or its extension")
    data = data.removeprefix(b"\xef\xbb\xbf")
    if b"\n" not in data:
        data = data.replace(b"\r", b"\n")
    found = _read_bulk(data)
    if found is None:
        found = _read_lines(data, name)
    return _check(found, name)


def _check(found: _Polygons, name: str) -> tuple[NDArray[np.float64], IntArray]:
    if not len(found.V):
        raise InputError(f"{name} has no vertices (no line 'v x y z'); check that it is an OBJ file")
    if not len(found.sizes):
        raise InputError(f"{name} has {len(found.V)} vertices but no faces; export it as a surface mesh, not as points")
    if not np.isfinite(found.V).all():
        bad = ~np.isfinite(found.V).all(axis=1)
        line = found.vertex_line[np.argmax(bad)]
        raise InputError(f"{name} line {line}: vertex {int(np.argmax(bad)) + 1} is not finite (NaN or infinity); export the mesh again")
    bad = found.sizes > max(len(found.V), 3)
    if bad.any():
        k = int(np.argmax(bad))
        raise InputError(
            f"{name} line {found.face_line[k]}: face {k + 1} has {found.sizes[k]} corners, more than there are vertices "
            f"({len(found.V)}); export the mesh again"
        )
    face = np.repeat(np.arange(len(found.sizes)), found.sizes)
    corners = np.where(found.corners < 0, found.corners + found.vertices_before[face], found.corners - 1)
    bad = (corners < 0) | (corners >= len(found.V)) | (found.corners == 0)
    if bad.any():
        k = int(np.argmax(bad))
        raise InputError(
            f"{name} line {found.face_line[face[k]]}: face {face[k] + 1} uses vertex {found.corners[k]}, "
            f"but there are {len(found.V)} (numbered from 1); export the mesh again"
        )
    return found.V, triangulate(found.V, corners, found.sizes)


def _read_bulk(data: bytes) -> _Polygons | None:
    """All numbers at once; None where the file has anything out of the ordinary."""
    text = np.frombuffer(data + b"\n", np.uint8)
    ends = np.flatnonzero(text == _NEWLINE)
    starts = np.concatenate([[0], ends[:-1] + 1])
    first, second = text[starts], text[np.minimum(starts + 1, len(text) - 1)]
    if b"\\" in data or ((first <= _SPACE) & (ends - starts > 1)).any():
        return None  # continued or indented lines
    is_v = (first == _V) & (second <= _SPACE)
    is_f = (first == _F) & (second <= _SPACE)
    v_numbers = _numbers(text, starts[is_v], ends[is_v], np.float64)
    f_numbers = _numbers(text, starts[is_f], ends[is_f], np.int64)
    if v_numbers is None or f_numbers is None:
        return None
    values, counts = v_numbers
    corners, sizes = f_numbers
    if len(counts) and ((counts != counts[0]).any() or counts[0] not in (3, 4, 6, 7)):
        return None
    V = values.reshape(len(counts), -1)[:, :3] if len(counts) else np.zeros((0, 3))
    if (sizes < 3).any():
        return None
    lines = np.arange(1, len(starts) + 1)
    return _Polygons(V, lines[is_v], corners, sizes, lines[is_f], np.cumsum(is_v)[is_f])


def _numbers(text: Bytes, starts: IntArray, ends: IntArray, kind: type) -> tuple[NDArray[Any], IntArray] | None:
    """The numbers on the given lines (up to a slash) and how many each has; None if some are no numbers."""
    if not len(starts):
        return np.zeros(0, kind), np.zeros(0, np.int64)
    low, high = int(starts[0]), int(ends[-1]) + 1
    part = text[low:high].copy()
    starts, ends = starts - low, ends - low
    if len(starts) > 1 and (starts[1:] != ends[:-1] + 1).any():
        # Other lines between: keep only ours.
        step = np.zeros(len(part) + 1, np.int8)
        step[starts] += 1
        step[ends + 1] -= 1
        keep = np.cumsum(step[:-1], dtype=np.int8).astype(bool)
        part = part[keep]
        lengths = ends + 1 - starts
        starts = np.concatenate([[0], np.cumsum(lengths)[:-1]])
        ends = starts + lengths - 1
    part[starts] = _SPACE
    if (part == _SLASH).any() and not _blank_after_slash(part):
        return None
    first, last = words(part)
    values = (read_ints if kind is np.int64 else read_floats)(part, first, last)
    return None if values is None else (values, _words_on_lines(first, last, starts, ends))


def _blank_after_slash(part: Bytes) -> bool:
    """``7/3/5`` becomes ``7``; False where nothing stands before a slash."""
    slash = np.flatnonzero(part == _SLASH)
    first, last = words(part)
    word = np.searchsorted(first, slash, side="right") - 1
    leading = np.ones(len(slash), dtype=bool)
    leading[1:] = word[1:] != word[:-1]
    if (slash == first[word]).any():
        return False
    step = np.zeros(len(part), np.int8)
    step[slash[leading]] = 1
    step[last[word[leading]]] = -1
    part[np.cumsum(step, dtype=np.int8).astype(bool)] = _SPACE
    return True


def _words_on_lines(first: IntArray, last: IntArray, starts: IntArray, ends: IntArray) -> IntArray:
    """How many of the words each line has."""
    each = len(first) // len(starts)
    if each * len(starts) == len(first) and each and (first[::each] >= starts).all() and (last[each - 1 :: each] <= ends).all():
        return np.full(len(starts), each)
    return np.diff(np.searchsorted(first, starts), append=len(first))


def _read_lines(data: bytes, name: str) -> _Polygons:
    """The careful reader: one line at a time, every error with its line."""
    V: list[list[float]] = []
    vertex_line: list[int] = []
    faces: list[IntArray] = []
    face_line: list[int] = []
    before: list[int] = []
    for number, line in _logical_lines(data):
        tokens = line.split(b"#", 1)[0].split()
        if not tokens:
            continue
        if tokens[0] == b"v":
            if len(tokens) < 4:
                raise InputError(
                    f"{name} line {number}: a vertex needs three numbers, this one has {len(tokens) - 1}; export the mesh again"
                )
            V.append([_float(word, name, number) for word in tokens[1:4]])
            vertex_line.append(number)
        elif tokens[0] == b"f":
            if len(tokens) < 4:
                raise InputError(f"{name} line {number}: a face needs three corners, this one has {len(tokens) - 1}; remove the line")
            faces.append(np.array([_index(word, name, number) for word in tokens[1:]], dtype=np.int64))
            face_line.append(number)
            before.append(len(V))
    corners = np.concatenate(faces) if faces else np.zeros(0, np.int64)
    sizes = np.array([len(f) for f in faces], dtype=np.int64)
    return _Polygons(np.array(V, dtype=float).reshape(-1, 3), np.array(vertex_line), corners, sizes, np.array(face_line), np.array(before))


def _logical_lines(data: bytes) -> list[tuple[int, bytes]]:
    """Lines with their numbers, a trailing backslash joining the next one on."""
    out: list[tuple[int, bytes]] = []
    held: list[bytes] = []
    begun = 1
    for number, line in enumerate(data.split(b"\n"), start=1):
        stripped = line.rstrip()
        if not held:
            begun = number
        if stripped.endswith(b"\\"):
            held.append(stripped[:-1])
            continue
        out.append((begun, b" ".join([*held, line])))
        held = []
    if held:
        out.append((begun, b" ".join(held)))
    return out


def _show(word: bytes) -> str:
    return repr(word[:24].decode("ascii", "replace"))


def _float(word: bytes, name: str, number: int) -> float:
    if not _NUMBER.match(word):
        raise InputError(f"{name} line {number}: {_show(word)} is no number; export the mesh again")
    return float(word)


def _index(word: bytes, name: str, number: int) -> int:
    head = word.split(b"/", 1)[0]
    # More than 18 digits would not fit an int64, and no file has as many vertices.
    if not re.fullmatch(rb"[+-]?\d{1,18}", head):
        raise InputError(f"{name} line {number}: {_show(word)} is no vertex number; export the mesh again")
    return int(head)
