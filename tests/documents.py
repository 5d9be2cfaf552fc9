"""A small skin, its document taken apart and put together otherwise, and what must be true of one that is read."""

import io
import json
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from skinfab.document import load_skin
from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source


def grid_skin(*, columns: int = 4, rows: int = 3, sensors: tuple[Sensor, ...] = (), **changes: object) -> Skin:
    """A sheet of squares, cut into its left and its right half, each already flat."""
    x, y = np.meshgrid(np.arange(columns + 1) * 0.1, np.arange(rows + 1) / 3)
    V = np.c_[x.ravel(), y.ravel(), np.sin(x.ravel())]
    corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    F = np.vstack([np.c_[corner, corner + 1, corner + columns + 2], np.c_[corner, corner + columns + 2, corner + columns + 1]])
    left = np.tile(np.arange(columns) < columns // 2, rows * 2)
    pieces = []
    for k, mine in enumerate((left, ~left)):
        faces = np.flatnonzero(mine)
        vertices, inverse = np.unique(F[faces], return_inverse=True)
        pieces.append(Piece(f"P{k + 1}", faces, vertices, inverse.reshape(-1, 3), V[vertices, :2] + 1 / 7))
    seam = np.arange(rows + 1) * (columns + 1) + columns // 2
    source = Source("grid.obj", "ab" * 32, "in", 25.4)
    values = {"sensors": sensors, "seed": 7, "max_distortion": 4.1, **changes}
    return Skin(mesh=Mesh(V, F, "grid"), source=source, seams=np.c_[seam[:-1], seam[1:]], pieces=tuple(pieces), **values)  # type: ignore[arg-type]


def assert_same(one: Skin, two: Skin) -> None:
    np.testing.assert_array_equal(one.mesh.V, two.mesh.V)
    np.testing.assert_array_equal(one.mesh.F, two.mesh.F)
    np.testing.assert_array_equal(one.seams, two.seams)
    assert one.mesh.V.dtype == two.mesh.V.dtype and one.seams.dtype == two.seams.dtype
    for p, q in zip(one.pieces, two.pieces, strict=True):
        assert p.id == q.id
        for field in ("faces", "vertices", "F", "UV"):
            np.testing.assert_array_equal(getattr(p, field), getattr(q, field))
            assert getattr(p, field).dtype == getattr(q, field).dtype
    for field in ("source", "sensors", "printer", "material", "max_distortion", "seed"):
        assert getattr(one, field) == getattr(two, field)
    assert one.mesh.name == two.mesh.name
    np.testing.assert_array_equal(one.object.V, two.object.V)
    assert (one.thickness, one.neutral, one.flattened_at) == (two.thickness, two.neutral, two.flattened_at)


def rewrite(path: Path, change: Callable[[str, bytes], bytes | None], *, method: int = zipfile.ZIP_STORED) -> None:
    """The same zip with members changed (None: left out)."""
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile(path, "w", method) as archive:
        for name, content in members.items():
            if (new := change(name, content)) is not None:
                archive.writestr(name, new)


def edit_json(path: Path, change: Callable[[dict], object]) -> None:  # type: ignore[type-arg]
    def edited(name: str, content: bytes) -> bytes:
        if name != "skin.json":
            return content
        data = json.loads(content)
        change(data)
        return json.dumps(data).encode()

    rewrite(path, edited)


def assert_refused(path: Path, says: str) -> None:
    with pytest.raises(InputError, match=says) as caught:
        load_skin(path)
    message = str(caught.value)
    assert message.startswith(str(path)) and "\n" not in message and len(message) < 400


def npy(array: np.ndarray, **options: object) -> bytes:
    stream = io.BytesIO()
    np.save(stream, array, **options)  # type: ignore[arg-type]
    return stream.getvalue()
