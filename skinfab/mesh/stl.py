"""STL, binary and text: a soup of triangles, its equal corners joined."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_HEADER = 84
_VERTEX = re.compile(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)")


def parse_stl(data: bytes, name: str) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and triangles of an STL file.

    Parameters
    ----------
    data : bytes
    name : str
        The file's name, for messages.

    Returns
    -------
    V : (n, 3) float64, file units
        Corners with equal coordinates are one vertex.
    F : (m, 3) int64

    Raises
    ------
    InputError
        The file is cut off, or is no STL.
    """
    is_text = data[:5].lower() == b"solid" and b"vertex" in data[:4096]
    V, F = weld((_parse_text if is_text else _parse_binary)(data, name))
    return V, F.reshape(-1, 3)


def _parse_binary(data: bytes, name: str) -> NDArray[np.float64]:
    if len(data) < _HEADER:
        raise InputError(f"{name} is no STL: it has {len(data)} bytes, less than a header; export the mesh again")
    claimed = int.from_bytes(data[80:84], "little")
    held = (len(data) - _HEADER) // _RECORD.itemsize
    if claimed > held:
        raise InputError(f"{name} is cut off or no STL: its header claims {claimed} triangles, it holds {held}; export the mesh again")
    if not claimed:
        raise InputError(f"{name} has no triangles; export the mesh again")
    records = np.frombuffer(data, _RECORD, count=claimed, offset=_HEADER)
    with np.errstate(invalid="ignore"):
        return records["corners"].reshape(-1, 3).astype(np.float64)


def _parse_text(data: bytes, name: str) -> NDArray[np.float64]:
    words = np.array(_VERTEX.findall(data))
    if not len(words) or len(words) % 3 or data.count(b"endsolid") == 0:
        raise InputError(f"{name} is cut off: a text STL needs three 'vertex' lines a facet and an 'endsolid'; export the mesh again")
    try:
        return words.astype(np.float64)
    except ValueError:
        raise InputError(f"{name} has a 'vertex' line whose coordinates are no numbers; export the mesh again") from None


def weld(corners: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Join equal points: the distinct ones in order of first appearance, and each point's index.

    Examples
    --------
    >>> V, index = weld(np.array([[1.0, 0, 0], [0, 0, 0], [1, 0, 0]]))
    >>> V.tolist(), index.tolist()
    ([[1.0, 0.0, 0.0], [0.0, 0.0, 0.0]], [0, 1, 0])
    """
    corners = corners + 0.0  # -0.0 and 0.0 are one number
    order = np.lexsort(corners.T)
    ordered = corners[order]
    new = np.ones(len(corners), dtype=bool)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    first = order[new]  # lexsort is stable, so the first of each group comes first
    group = np.cumsum(new) - 1
    rank = np.empty(len(first), dtype=np.int64)
    appearance = np.argsort(first)
    rank[appearance] = np.arange(len(first))
    index = np.empty(len(corners), dtype=np.int64)
    index[order] = rank[group]
    return corners[first[appearance]], index
