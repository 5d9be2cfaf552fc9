"""MCAP files: read record by record, so that one that was cut off gives what is whole; written so that Foxglove shows them."""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path

from skinfab.files import atomic_path
from skinfab.readout.frame import Recording
from skinfab.readout.logs.message import FRAME_TOPIC, TOPICS, Message, log_messages, typestore
from skinfab.readout.logs.unpack import Budget, Cursor, DamagedError, unpack

MAGIC = b"\x89MCAP0\r\n"

#: A block is packed as one; what is lost of a file that was cut off is less than one.
BLOCK_BYTES = 65_536

_SCHEMA, _CHANNEL, _MESSAGE, _CHUNK, _DATA_END = 3, 4, 5, 6, 15


def write_mcap(recording: Recording, path: str | Path) -> None:
    """Write a recording.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    from mcap.writer import Writer

    with atomic_path(path) as partial, partial.open("wb") as file:
        writer = Writer(file, chunk_size=BLOCK_BYTES)
        writer.start(profile="ros2", library="skinfab")
        channels = {}
        for topic, kind in TOPICS.items():
            definition, _ = typestore("cdr").generate_msgdef(kind, ros_version=2)
            schema = writer.register_schema(kind, "ros2msg", definition.encode())
            channels[topic] = writer.register_channel(topic, "cdr", schema)
        for k, (topic, time, data) in enumerate(log_messages(recording, "cdr")):
            writer.add_message(channels[topic], time, data, time, k - 1 if topic == FRAME_TOPIC else 0)
        writer.finish()


class _Records:
    """What the records said so far: types by schema, topics by channel."""

    def __init__(self, budget: Budget) -> None:
        self.budget = budget
        self._schemas: dict[int, str] = {}
        self._channels: dict[int, tuple[str, str, str]] = {}

    def message(self, code: int, body: bytes) -> Message | None:
        """Take in a record; a message is given back."""
        cursor = Cursor(body)
        if code == _SCHEMA:
            schema = cursor.number("<H")
            self._schemas[schema] = cursor.sized("<I").decode()
        elif code == _CHANNEL:
            channel, schema = cursor.number("<H"), cursor.number("<H")
            topic, coding = cursor.sized("<I").decode(), cursor.sized("<I").decode()
            self._channels[channel] = topic, coding, modern(self._schemas.get(schema, "unknown"))
        elif code == _MESSAGE:
            channel = cursor.number("<H")
            cursor.number("<I")
            time = cursor.number("<Q")
            cursor.number("<Q")
            if channel not in self._channels:
                raise DamagedError(f"a message belongs to channel {channel}, which was never described")
            topic, coding, kind = self._channels[channel]
            return Message(topic, kind, coding, time, cursor.take(cursor.left))
        return None


def modern(kind: str) -> str:
    """A type's name as ROS 2 writes it.

    Examples
    --------
    >>> modern("std_msgs/String"), modern("std_msgs/msg/String")
    ('std_msgs/msg/String', 'std_msgs/msg/String')
    """
    package, slash, name = kind.partition("/")
    return f"{package}/msg/{name}" if slash and "/" not in name else kind


def mcap_messages(path: Path, budget: Budget) -> Iterator[Message]:
    """Every message in the order of the file.

    Raises
    ------
    DamagedError
        From here on the file is cut off or damaged.
    InputError
        It is a bomb, or packed in an unknown way.
    """
    size = path.stat().st_size
    records = _Records(budget)
    with path.open("rb") as file:
        file.read(len(MAGIC))
        while True:
            head = file.read(9)
            at = file.tell()
            if len(head) < 9:
                raise DamagedError(f"it ends at byte {size:,} without its end mark")
            code, length = struct.unpack("<BQ", head)
            if length > size - at:
                raise DamagedError(f"it ends at byte {size:,}, within a record")
            try:
                if code == _DATA_END:
                    return
                if code == _CHUNK:
                    yield from _block(file.read(length), records)
                elif code in (_SCHEMA, _CHANNEL, _MESSAGE):
                    if (message := records.message(code, file.read(length))) is not None:
                        yield message
                else:
                    file.seek(length, io.SEEK_CUR)
            except (DamagedError, UnicodeDecodeError) as fault:
                raise DamagedError(f"at byte {at:,} it is damaged ({fault})") from fault


def _block(body: bytes, records: _Records) -> Iterator[Message]:
    cursor = Cursor(body)
    cursor.take(16)
    size, check = cursor.number("<Q"), cursor.number("<I")
    packing = cursor.sized("<I").decode()
    data = unpack(packing, cursor.sized("<Q"), size, records.budget)
    if check and zlib.crc32(data) != check:
        raise DamagedError("a block's checksum is wrong")
    inside = Cursor(data)
    while inside.left:
        code = inside.number("<B")
        if (message := records.message(code, inside.sized("<Q"))) is not None:
            yield message
