"""What the worker process made anew may be the same as before: then what was there is kept, and what follows from it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece
from skinfab.placement.lifted import Lifted
from skinfab.skin import Skin


def adopt(before: Skin, after: Skin) -> Skin:
    """`after` with the mesh, pieces and sensors of `before` wherever they are equal, so that what was derived of them still holds.

    Examples
    --------
    >>> import copy
    >>> from skinfab.skin import Source
    >>> mesh = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    >>> before = Skin(mesh, Source("a.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), dtype=np.int64), ())
    >>> adopt(before, copy.deepcopy(before)).mesh is mesh
    True
    """
    pieces = {p.id: p for p in before.pieces}
    sensors = {s.id: s for s in before.sensors}
    object_V = after.object_V
    if object_V is not None and before.object_V is not None and np.array_equal(object_V, before.object_V):
        object_V = before.object_V
    adopted = replace(
        after,
        mesh=before.mesh if _same_mesh(before.mesh, after.mesh) else after.mesh,
        object_V=object_V,
        pieces=tuple(pieces[p.id] if p.id in pieces and _same_piece(pieces[p.id], p) else p for p in after.pieces),
        sensors=tuple(sensors[s.id] if sensors.get(s.id) == s else s for s in after.sensors),
        seams=before.seams if np.array_equal(before.seams, after.seams) else after.seams,
        marks=before.marks if _same_marks(before, after) else after.marks,
        lifted=before.lifted if _same_lifted(before.lifted, after.lifted) else after.lifted,
    )
    return adopted


def _same_mesh(a: Mesh, b: Mesh) -> bool:
    return a is b or (a.name == b.name and np.array_equal(a.V, b.V) and np.array_equal(a.F, b.F))


def _same_piece(a: Piece, b: Piece) -> bool:
    return a is b or all(np.array_equal(getattr(a, name), getattr(b, name)) for name in ("faces", "vertices", "F", "UV"))


def _same_lifted(before: tuple[Lifted, ...], after: tuple[Lifted, ...]) -> bool:
    return len(before) == len(after) and all(
        (a.sensor, a.why, a.place) == (b.sensor, b.why, b.place) and _same_piece(a.piece, b.piece)
        for a, b in zip(before, after, strict=True)
    )


def _same_marks(a: Skin, b: Skin) -> bool:
    if a.marks is None or b.marks is None:
        return a.marks is b.marks
    return all(np.array_equal(getattr(a.marks, name), getattr(b.marks, name)) for name in ("locked", "forbidden", "preference"))
