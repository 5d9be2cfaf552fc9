"""What goes between the window and its worker process: large arrays beside the rest, and nothing back that was sent there."""

from __future__ import annotations

import io
import os
import pickle
from collections.abc import Sequence
from multiprocessing.connection import Connection
from typing import Any

import numpy as np

from skinfab.skin import Skin


def shared(arguments: dict[str, Any]) -> list[object]:
    """Parts of documents that work may give back as they are, in an order that is the same on both sides.

    Examples
    --------
    >>> from skinfab.mesh.model import Mesh
    >>> from skinfab.skin import Source
    >>> mesh = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    >>> skin = Skin(mesh, Source("a.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), dtype=np.int64), ())
    >>> shared({"method": "auto", "skin": skin})[1] is mesh
    True
    """
    found: list[object] = []
    for skin in (value for value in arguments.values() if isinstance(value, Skin)):
        found += [skin, skin.mesh, skin.source, skin.seams, *skin.pieces, *skin.sensors]
        found += [part for part in (skin.object_V, skin.marks) if part is not None]
        found += [part for each in skin.lifted for part in (each, each.sensor, each.piece)]
    return found


def send(channel: Connection, message: object, known: Sequence[object] = ()) -> None:
    """Send it; what is among `known` is only named, for one who has the same.

    Raises
    ------
    BrokenPipeError, ConnectionResetError
        Nobody listens.
    """
    file, buffers = io.BytesIO(), list[pickle.PickleBuffer]()
    _Pickler(file, buffers, known).dump(message)
    raw = [buffer.raw() for buffer in buffers]
    channel.send([len(each) for each in raw])
    channel.send_bytes(file.getvalue())
    for each in raw:
        while len(each):
            each = each[os.write(channel.fileno(), each) :]


def receive(channel: Connection, known: Sequence[object] = ()) -> Any:
    """What was sent; in place of what was only named, that of `known`.

    Raises
    ------
    EOFError, ConnectionResetError
        The other side is gone.
    """
    sizes, head = channel.recv(), channel.recv_bytes()
    buffers = [np.empty(size, dtype=np.uint8) for size in sizes]
    for buffer in buffers:
        left = buffer.data
        while len(left):
            count = os.readv(channel.fileno(), [left])
            if not count:
                raise EOFError
            left = left[count:]
    return _Unpickler(head, buffers, known).load()


class _Pickler(pickle.Pickler):
    def __init__(self, file: io.BytesIO, buffers: list[pickle.PickleBuffer], known: Sequence[object]) -> None:
        super().__init__(file, protocol=5, buffer_callback=buffers.append)
        self._place = {id(each): k for k, each in enumerate(known)}

    def persistent_id(self, obj: object) -> int | None:
        return self._place.get(id(obj))


class _Unpickler(pickle.Unpickler):
    def __init__(self, head: bytes, buffers: Sequence[Any], known: Sequence[object]) -> None:
        super().__init__(io.BytesIO(head), buffers=buffers)
        self._known = known

    def persistent_load(self, pid: int) -> object:
        return self._known[pid]
