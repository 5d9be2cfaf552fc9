"""ROS 1 bags: read record by record without their index, so that one that was cut off needs no reindexing."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from pathlib import Path

from skinfab.files import atomic_path
from skinfab.readout.frame import Recording
from skinfab.readout.logs.mcap_log import BLOCK_BYTES, modern
from skinfab.readout.logs.message import Message, write_bag
from skinfab.readout.logs.unpack import Budget, Cursor, DamagedError, unpack

MAGIC = b"#ROSBAG V2.0\n"

_MESSAGE, _BAG_HEADER, _CHUNK, _CONNECTION = 2, 3, 5, 7
#: A record's header is a few fields; one connection's holds the definition of its type.
_MAX_HEADER = 1_000_000


def write_bag1(recording: Recording, path: str | Path) -> None:
    """Write a recording.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    from rosbags.rosbag1 import Writer

    with atomic_path(path) as partial:
        writer = Writer(partial)
        writer.chunk_threshold = BLOCK_BYTES
        writer.open()
        try:
            write_bag(writer, recording, "ros1")
        finally:
            writer.close()


def bag1_messages(path: Path, budget: Budget) -> Iterator[Message]:
    """Every message in the order of the file.

    Raises
    ------
    DamagedError
        From here on the file is cut off or damaged.
    InputError
        It is a bomb, or packed in an unknown way.
    """
    size = path.stat().st_size
    known: dict[int, tuple[str, str]] = {}
    finished = False
    with path.open("rb") as file:
        file.read(len(MAGIC))
        while (at := file.tell()) < size:
            try:
                header = _fields(_sized(file, size, _MAX_HEADER))
                code = _number(header, "op")
                length = int.from_bytes(_sized_length(file, size), "little")
                if code == _BAG_HEADER:  # all of it is set when the bag is closed, and zero before
                    finished = _number(header, "index_pos") > 0
                if code in (_CHUNK, _CONNECTION, _MESSAGE):
                    body = file.read(length)
                    if code == _CHUNK:
                        packing = header.get("compression", b"none").decode()
                        yield from _block(unpack(packing, body, _number(header, "size"), budget), known)
                    elif (message := _record(code, header, body, known)) is not None:
                        yield message
                else:
                    file.seek(length, io.SEEK_CUR)
            except (DamagedError, UnicodeDecodeError) as fault:
                raise DamagedError(f"at byte {at:,} it is damaged ({fault})") from fault
    if not finished:
        raise DamagedError("it was never closed, so that its end may be missing")


def _sized_length(file: io.BufferedReader, size: int) -> bytes:
    head = file.read(4)
    if len(head) < 4 or int.from_bytes(head, "little") > size - file.tell():
        raise DamagedError(f"it ends at byte {size:,}, within a record")
    return head


def _sized(file: io.BufferedReader, size: int, at_most: int) -> bytes:
    length = int.from_bytes(_sized_length(file, size), "little")
    if length > at_most:
        raise DamagedError(f"a record's header claims {length:,} bytes")
    return file.read(length)


def _fields(data: bytes) -> dict[str, bytes]:
    cursor, out = Cursor(data), {}
    while cursor.left:
        name, equals, value = cursor.sized("<I").partition(b"=")
        if not equals:
            raise DamagedError("a field has no name")
        out[name.decode()] = value
    return out


def _number(header: Mapping[str, bytes], name: str) -> int:
    if name not in header or len(header[name]) > 8:
        raise DamagedError(f"a record has no {name}")
    return int.from_bytes(header[name], "little")


def _block(data: bytes, known: dict[int, tuple[str, str]]) -> Iterator[Message]:
    cursor = Cursor(data)
    while cursor.left:
        header = _fields(cursor.sized("<I"))
        if (message := _record(_number(header, "op"), header, cursor.sized("<I"), known)) is not None:
            yield message


def _record(code: int, header: Mapping[str, bytes], body: bytes, known: dict[int, tuple[str, str]]) -> Message | None:
    """Take in a record; a message is given back."""
    if code == _CONNECTION:
        details = _fields(body)
        topic, kind = header.get("topic", b"").decode(), details.get("type", b"unknown").decode()
        known[_number(header, "conn")] = topic, modern(kind)
    elif code == _MESSAGE:
        connection = _number(header, "conn")
        if connection not in known:
            raise DamagedError(f"a message belongs to connection {connection}, which was never described")
        stamp = header.get("time", b"")
        time = int.from_bytes(stamp[:4], "little") * 10**9 + int.from_bytes(stamp[4:8], "little")
        return Message(*known[connection], "ros1", time, body)
    return None
