"""What MCAP files and ROS bags have in common: messages with a topic and a type; and how a recording is put into them.

A recording is two topics: its stream's description (``std_msgs/String`` of JSON), and its frames, one message each, of a
type whose definition every such file carries, so that Foxglove, PlotJuggler or ROS itself can show them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.readout.description import stream_of_json, stream_to_json
from skinfab.readout.frame import Recording, Stream

if TYPE_CHECKING:
    from rosbags import rosbag1, rosbag2
    from rosbags.typesys.store import Typestore

STREAM_TOPIC, FRAME_TOPIC = "/skinfab/stream", "/skinfab/frames"
STREAM_TYPE, FRAME_TYPE = "std_msgs/msg/String", "skinfab_msgs/msg/Frame"
#: In the order in which they are written: the stream is described first.
TOPICS = {STREAM_TOPIC: STREAM_TYPE, FRAME_TOPIC: FRAME_TYPE}

#: The type's definition: `skinfab.readout.frame.Frame`, with one byte, 0 or 1, for what is true or not.
FRAME_DEFINITION = """\
float64 device_time
float64 host_time
int64 sequence
float64[] values
uint8[] valid
uint8[] saturated
"""


@dataclass(frozen=True)
class Message:
    """One message as it lies in the file.

    Parameters
    ----------
    topic : str
    type : str
        As ROS 2 writes it: ``std_msgs/msg/String``.
    coding : str
        ``cdr`` (ROS 2), ``ros1``, or whatever else the file says.
    time : int, ns
        When it was recorded.
    data : bytes
    """

    topic: str
    type: str
    coding: str
    time: int
    data: bytes


@cache
def typestore(coding: str) -> Typestore:
    """The known types of ROS 1 or 2. A file's own definitions are never used: they would be turned into code."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC if coding == "ros1" else Stores.ROS2_HUMBLE)
    store.register(get_types_from_msg(FRAME_DEFINITION, FRAME_TYPE))
    return store


def frame_layout(channels: int, coding: str) -> np.dtype[np.void]:
    """How a frame's message lies in bytes: the counts of its lists are fields like others. All messages of a stream are of one length.

    CDR, of ROS 2, begins with four bytes of its own and aligns every number to its size; ROS 1 packs them.

    Examples
    --------
    >>> frame_layout(2, "cdr").itemsize, frame_layout(2, "ros1").itemsize
    (66, 56)
    """
    names = ["device_time", "host_time", "sequence", "count", "values", "valid_count", "valid", "saturated_count", "saturated"]
    kinds: list[object] = ["<f8", "<f8", "<i8", "<u4", ("<f8", (channels,)), "<u4", ("u1", (channels,)), "<u4", ("u1", (channels,))]
    aligned = coding == "cdr"
    at, places = 4 if aligned else 0, []
    for kind in kinds:
        item = np.dtype(kind)  # type: ignore[call-overload]
        size = (item.subdtype[0] if item.subdtype else item).itemsize
        if aligned and item.itemsize:  # an empty list has no first number to align
            at += -(at - 4) % size
        places.append(at)
        at += item.itemsize
    return np.dtype({"names": names, "formats": kinds, "offsets": places, "itemsize": at})


def frame_messages(recording: Recording, coding: str) -> list[bytes]:
    """Each frame as a message's bytes."""
    channels = len(recording.stream.channels)
    layout = frame_layout(channels, coding)
    table = np.zeros(len(recording), dtype=layout)
    for name in ("device_time", "host_time", "sequence", "values", "valid", "saturated"):
        table[name] = getattr(recording, name)
    for name in ("count", "valid_count", "saturated_count"):
        table[name] = channels
    data = bytearray(table.tobytes())
    if coding == "cdr":  # little-endian, the plain form
        data[1 :: layout.itemsize] = b"\1" * len(recording)
    return [bytes(data[k : k + layout.itemsize]) for k in range(0, len(data), layout.itemsize)]


def log_times(recording: Recording) -> NDArray[np.int64]:
    """When each frame reached the computer, in whole ns from 1970 on, as bags want it; the frames hold the exact time."""
    seconds = np.nan_to_num(recording.host_time, nan=0.0, posinf=0.0, neginf=0.0)
    return np.round(np.clip(seconds, 0, 2**32 - 1) * 1e9).astype(np.int64)


def log_messages(recording: Recording, coding: str) -> Iterator[tuple[str, int, bytes]]:
    """All of a recording's messages: topic, time (ns) and bytes."""
    at = log_times(recording).tolist()
    yield STREAM_TOPIC, min(at, default=0), stream_message(recording.stream, coding)
    for time, data in zip(at, frame_messages(recording, coding), strict=True):
        yield FRAME_TOPIC, time, data


def write_bag(writer: rosbag1.Writer | rosbag2.Writer, recording: Recording, coding: str) -> None:
    """Write a recording into a bag that is open."""
    store = typestore(coding)
    connections = {topic: writer.add_connection(topic, kind, typestore=store) for topic, kind in TOPICS.items()}
    for topic, time, data in log_messages(recording, coding):
        writer.write(connections[topic], time, data)


def stream_message(stream: Stream, coding: str) -> bytes:
    """The description as a message's bytes."""
    text = stream_to_json(stream).encode()
    return (
        (b"\0\1\0\0" if coding == "cdr" else b"") + (len(text) + (coding == "cdr")).to_bytes(4, "little") + text + b"\0" * (coding == "cdr")
    )


def recording_of(messages: Sequence[Message]) -> Recording:
    """The recording that messages hold.

    Raises
    ------
    InputError
        The description is damaged, or a frame is not of its length.
    """
    said = {m.data for m in messages if m.topic == STREAM_TOPIC}
    frames = [m for m in messages if m.topic == FRAME_TOPIC and m.type == FRAME_TYPE]
    if len(said) > 1:
        raise InputError(f"it describes {len(said)} different streams; a log holds one: cut it apart")
    coding = next(m.coding for m in messages if m.topic == STREAM_TOPIC)
    start, tail = (8, 1) if coding == "cdr" else (4, 0)
    data = next(iter(said))
    stream = stream_of_json(data[start : len(data) - tail])
    layout = frame_layout(len(stream.channels), coding)
    for k, m in enumerate(frames):
        if len(m.data) != layout.itemsize or m.coding != coding:
            raise InputError(
                f"frame {k + 1} has {len(m.data)} bytes where {len(stream.channels)} channels need {layout.itemsize}; mend the file"
            )
    table = np.frombuffer(b"".join(m.data for m in frames), dtype=layout)
    for name in ("count", "valid_count", "saturated_count"):
        if np.any(table[name] != len(stream.channels)):
            raise InputError(f"frame {int(np.argmax(table[name] != len(stream.channels))) + 1} has not one value a channel; mend the file")
    return Recording(
        stream,
        table["device_time"].copy(),
        table["host_time"].copy(),
        table["sequence"].copy(),
        table["values"].copy(),
        table["valid"] != 0,
        table["saturated"] != 0,
    )
