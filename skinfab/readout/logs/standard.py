"""Standard ROS messages as a recording: what numbers a message holds, what they are called, and several topics as one stream."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Recording, Stream
from skinfab.readout.logs.message import Message, typestore
from skinfab.readout.logs.unpack import DamagedError

FloatArray = NDArray[np.float64]

#: Numbers of a topic that were not sent for this long are not valid, s (or for one and a half of its usual steps).
MAX_GAP_S = 0.1
#: A message with more numbers is a picture or a cloud of points, and no log of sensors.
MAX_CHANNELS = 4096

#: A message's numbers: (name within the message, unit, kind, value).
Number = tuple[str, str, str, float]

_INTEGERS = ("Int8", "Int16", "Int32", "Int64", "UInt8", "UInt16", "UInt32", "UInt64")


def _scalar(message: Any) -> list[Number]:
    return [("", "", "", float(message.data))]


def _list(message: Any) -> list[Number]:
    if len(message.data) > MAX_CHANNELS:
        raise InputError(f"a message holds {len(message.data):,} numbers; a log of sensors has at most {MAX_CHANNELS:,}")
    return [(f"[{k}]", "", "", float(value)) for k, value in enumerate(message.data)]


def _joints(message: Any) -> list[Number]:
    if len(message.name) > MAX_CHANNELS:
        raise InputError(f"a message holds {len(message.name):,} joints; a log has at most {MAX_CHANNELS:,}")
    parts = (("position", "rad", "angle"), ("velocity", "rad/s", ""), ("effort", "N m", ""))
    return [
        (f"{name}.{part}", unit, kind, float(value))
        for part, unit, kind in parts
        for name, value in zip(message.name, getattr(message, part), strict=False)  # a part that is not measured is empty
    ]


def _vectors(*fields: tuple[str, str, str]) -> Callable[[Any], list[Number]]:
    """Fields (path, unit, kind) that have x, y and z, or are numbers."""

    def numbers(message: Any) -> list[Number]:
        out: list[Number] = []
        for path, unit, kind in fields:
            value = message
            for name in path.split("."):
                value = getattr(value, name)
            last = path.split(".")[-1]
            if hasattr(value, "x"):
                out += [(f".{last}.{axis}", unit, kind, float(getattr(value, axis))) for axis in "xyz"]
            else:
                out.append((f".{last}", unit, kind, float(value)))
        return out

    return numbers


#: How each known type is read.
STANDARD: Mapping[str, Callable[[Any], list[Number]]] = {
    **{f"std_msgs/msg/{name}": _scalar for name in ("Bool", "Float32", "Float64", *_INTEGERS)},
    **{f"std_msgs/msg/{name}MultiArray": _list for name in ("Float32", "Float64", *_INTEGERS)},
    "sensor_msgs/msg/JointState": _joints,
    "sensor_msgs/msg/Imu": _vectors(("linear_acceleration", "m/s^2", "acceleration"), ("angular_velocity", "rad/s", "rate")),
    "sensor_msgs/msg/MagneticField": _vectors(("magnetic_field", "T", "")),
    "sensor_msgs/msg/Temperature": _vectors(("temperature", "degC", "")),
    "sensor_msgs/msg/FluidPressure": _vectors(("fluid_pressure", "Pa", "")),
    "geometry_msgs/msg/Wrench": _vectors(("force", "N", "force"), ("torque", "N m", "torque")),
    "geometry_msgs/msg/WrenchStamped": _vectors(("wrench.force", "N", "force"), ("wrench.torque", "N m", "torque")),
    "geometry_msgs/msg/Vector3Stamped": _vectors(("vector", "", "")),
}


def readable(message: Message) -> bool:
    """Is the message of a known type, and coded as ROS does?"""
    return message.type in STANDARD and message.coding in ("cdr", "ros1")


@dataclass
class _Topic:
    """What was read of a topic."""

    name: str
    log: list[int] = field(default_factory=list)
    stamps: list[float] = field(default_factory=list)
    channels: dict[str, Channel] = field(default_factory=dict)
    rows: list[tuple[tuple[str, ...], list[float]]] = field(default_factory=list)

    def add(self, message: Message) -> None:
        """Take in a message."""
        store = typestore(message.coding)
        try:
            deserialize = store.deserialize_ros1 if message.coding == "ros1" else store.deserialize_cdr
            content: Any = deserialize(message.data, message.type)
            numbers = STANDARD[message.type](content)
        except InputError as fault:
            raise InputError(f"topic {self.name}: {fault}") from fault
        except Exception as fault:  # generated code on damaged bytes: whatever it raises, the bytes are no such message
            raise DamagedError(f"a message of {self.name} is no {message.type} ({type(fault).__name__})") from fault
        own = message.type != "sensor_msgs/msg/JointState"
        names = tuple((self.name.strip("/") + name) if own else name for name, _, _, _ in numbers)
        if not self.rows or self.rows[-1][0] != names:
            for name, (_, unit, kind, _) in zip(names, numbers, strict=True):
                self.channels.setdefault(name, Channel(name or "value", unit, kind))
        self.rows.append((names, [number[3] for number in numbers]))
        self.log.append(message.time)
        header = getattr(content, "header", None)
        self.stamps.append(np.nan if header is None else header.stamp.sec + header.stamp.nanosec * 1e-9)

    def table(self) -> FloatArray:
        """The numbers, (n, c), NaN where a message has not all."""
        at = {name: k for k, name in enumerate(self.channels)}
        out = np.full((len(self.rows), len(at)), np.nan)
        places: dict[tuple[str, ...], list[int]] = {}
        for k, (names, values) in enumerate(self.rows):
            out[k, places.setdefault(names, [at[name] for name in names])] = values
        return out


class Gathered:
    """Standard messages, as they come."""

    def __init__(self) -> None:
        self._topics: dict[str, _Topic] = {}

    def add(self, message: Message) -> None:
        """Take in a message that is `readable`.

        Raises
        ------
        DamagedError
            It is not what it says.
        InputError
            It holds more numbers than a log of sensors does.
        """
        self._topics.setdefault(message.topic, _Topic(message.topic)).add(message)

    @property
    def topics(self) -> dict[str, str]:
        """What was gathered, by topic, as it is named to a user."""
        return {name: name for name in self._topics}

    def __len__(self) -> int:
        return sum(len(topic.rows) for topic in self._topics.values())

    def recording(self, name: str) -> tuple[Recording, list[str]]:
        """All topics as one stream, and what is to be said of it.

        The topic with the most messages sets the times; the others are interpolated there, where they were being sent.
        """
        topics = sorted((t for t in self._topics.values() if t.channels), key=lambda t: -len(t.rows))
        if not topics:
            raise InputError("its messages hold no numbers; record some that do")
        stamped = all(np.all(np.array(topic.stamps) > 0) for topic in topics)
        times = [np.array(topic.stamps) if stamped else np.array(topic.log) * 1e-9 for topic in topics]
        order = np.argsort(times[0], kind="stable")
        time, host = times[0][order], np.array(topics[0].log)[order] * 1e-9
        tables = [topics[0].table()[order]]
        tables += [_at(time, own, topic.table()) for topic, own in zip(topics[1:], times[1:], strict=True)]
        step = float(np.median(np.diff(time))) if len(time) > 1 else 0.0
        stream = Stream(name, tuple(_named(topics)), round(1 / step, 3) if step > 0 else 0.0)
        recording = Recording.of_values(stream, np.hstack(tables), device_time=time - time[0], host_time=host)
        notes = []
        if len(topics) > 1:
            others = ", ".join(topic.name for topic in topics[1:])
            notes.append(f"{others}: interpolated at the times of {topics[0].name}, the topic with the most messages")
        return recording, notes


def _named(topics: Sequence[_Topic]) -> Iterable[Channel]:
    """The channels; a name that comes twice gets its topic in front."""
    names = [name for topic in topics for name in topic.channels]
    twice = {name for name in names if names.count(name) > 1}
    for topic in topics:
        for name, channel in topic.channels.items():
            own = f"{topic.name.strip('/')}/{channel.name}" if name in twice else channel.name
            yield Channel(own, channel.unit, channel.kind)


def _at(time: FloatArray, own: FloatArray, values: FloatArray) -> FloatArray:
    """Values (n, c) at times (n,) interpolated at other times; NaN before, after, and where none came for too long."""
    own, first = np.unique(own, return_index=True)
    out = np.full((len(time), values.shape[1]), np.nan)
    for k in range(values.shape[1]):
        column = values[first, k]
        there = np.isfinite(column)
        if np.count_nonzero(there) < 2:
            continue
        t, v = own[there], column[there]
        gap = max(MAX_GAP_S, 1.5 * float(np.median(np.diff(t))))
        after = np.clip(np.searchsorted(t, time), 1, len(t) - 1)
        bridged = (t[after] - t[after - 1] <= gap) & (time >= t[0]) & (time <= t[-1])
        bridged |= (time == t[after]) | (time == t[after - 1])
        out[bridged, k] = np.interp(time[bridged], t, v)
    return out
