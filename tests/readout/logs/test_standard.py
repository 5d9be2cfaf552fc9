"""Standard ROS messages of others: sensible names and units, several topics as one stream, and unknown ones named."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import Writer as McapWriter
from rosbags.rosbag1 import Writer as Bag1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Bag2
from rosbags.typesys import Stores, get_typestore

from skinfab.errors import InputError
from skinfab.readout.logs.log import read_log, read_log_table

ROS1, ROS2 = get_typestore(Stores.ROS1_NOETIC), get_typestore(Stores.ROS2_HUMBLE)
Told = list[tuple[str, str, int, Any]]  # topic, type, ns, message
START = 1_700_000_000 * 10**9


def header(store: Any, ns: int) -> Any:
    stamp = store.types["builtin_interfaces/msg/Time"](ns // 10**9, ns % 10**9)
    more = {"seq": 0} if store is ROS1 else {}
    return store.types["std_msgs/msg/Header"](**more, stamp=stamp, frame_id="")


def numbers(store: Any, values: list[float]) -> Any:
    layout = store.types["std_msgs/msg/MultiArrayLayout"]([], 0)
    return store.types["std_msgs/msg/Float64MultiArray"](layout, np.array(values))


def joints(store: Any, ns: int, names: list[str], position: list[float]) -> Any:
    none = np.zeros(0)
    return store.types["sensor_msgs/msg/JointState"](header(store, ns), names, np.array(position), none, none)


def bag1(path: Path, told: Callable[[Any], Told], **_: Any) -> None:
    with Bag1(path) as writer:
        known: dict[str, Any] = {}
        for topic, kind, ns, message in told(ROS1):
            if topic not in known:
                known[topic] = writer.add_connection(topic, kind, typestore=ROS1)
            writer.write(known[topic], ns, ROS1.serialize_ros1(message, kind))


def bag2(path: Path, told: Callable[[Any], Told], plugin: StoragePlugin = StoragePlugin.SQLITE3) -> None:
    with Bag2(path, version=9, storage_plugin=plugin) as writer:
        known: dict[str, Any] = {}
        for topic, kind, ns, message in told(ROS2):
            if topic not in known:
                known[topic] = writer.add_connection(topic, kind, typestore=ROS2)
            writer.write(known[topic], ns, ROS2.serialize_cdr(message, kind))


def bag2_mcap(path: Path, told: Callable[[Any], Told]) -> None:
    bag2(path, told, StoragePlugin.MCAP)


def mcap(path: Path, told: Callable[[Any], Told]) -> None:
    with path.open("wb") as file:
        writer = McapWriter(file)
        writer.start(profile="ros2")
        known: dict[str, int] = {}
        for topic, kind, ns, message in told(ROS2):
            if topic not in known:
                known[topic] = writer.register_channel(topic, "cdr", writer.register_schema(kind, "ros2msg", b""))
            writer.add_message(known[topic], ns, bytes(ROS2.serialize_cdr(message, kind)), ns)
        writer.finish()


MAKERS = [bag1, bag2, bag2_mcap, mcap]
Maker = Callable[[Path, Callable[[Any], Told]], None]


@pytest.mark.parametrize("make", MAKERS)
def test_joints_and_readings_become_one_stream(tmp_path: Path, make: Maker) -> None:
    def told(store: Any) -> Told:
        out: Told = []
        for k in range(100):
            ns = START + k * 10**7
            out.append(("/strain", "std_msgs/msg/Float64MultiArray", ns, numbers(store, [1 + k / 1000, 2.0])))
            if k % 2 == 0:
                out.append(("/joint_states", "sensor_msgs/msg/JointState", ns, joints(store, ns, ["pip", "dip"], [k / 100, -k / 100])))
        return out

    path = tmp_path / "log"
    make(path, told)
    log = read_log(path)
    made = log.recording
    assert made.stream.names == ("strain[0]", "strain[1]", "pip.position", "dip.position")
    assert [c.unit for c in made.stream.channels] == ["", "", "rad", "rad"]
    assert made.stream.rate_hz == 100 and len(made) == 100
    assert np.allclose(made.device_time, np.arange(100) / 100, atol=1e-6)
    assert np.allclose(made.host_time, 1.7e9 + np.arange(100) / 100, atol=1e-6)
    assert np.allclose(made.column("strain[0]"), 1 + np.arange(100) / 1000)
    assert np.allclose(made.column("pip.position")[:99], np.arange(99) / 100, atol=1e-6)
    assert np.isnan(made.column("pip.position")[99])  # after the joint's last message
    assert any("interpolated at the times of /strain" in note for note in log.notes)
    table, _ = read_log_table(path)
    assert np.allclose(table.column("pip.position")[:99], np.degrees(np.arange(99) / 100), atol=1e-4)


@pytest.mark.parametrize("make", MAKERS)
def test_unknown_topics_are_named(tmp_path: Path, make: Maker) -> None:
    def words(store: Any) -> Told:
        return [("/chatter", "std_msgs/msg/String", START + k, store.types["std_msgs/msg/String"]("hello")) for k in range(3)]

    def both(store: Any) -> Told:
        return [*words(store), ("/u", "std_msgs/msg/Float64", START, store.types["std_msgs/msg/Float64"](2.5))]

    make(tmp_path / "words", words)
    with pytest.raises(InputError, match=r"/chatter \(std_msgs/msg/String\).*JointState"):
        read_log(tmp_path / "words")
    make(tmp_path / "both", both)
    log = read_log(tmp_path / "both")
    assert (log.recording.stream.names, log.recording.values.tolist()) == (("u",), [[2.5]])
    assert any("passed over /chatter" in note for note in log.notes)


@pytest.mark.parametrize("make", MAKERS)
def test_stamps_are_the_devices_time_and_vectors_have_names(tmp_path: Path, make: Maker) -> None:
    def told(store: Any) -> Told:
        def vector(x: float, y: float, z: float) -> Any:
            return store.types["geometry_msgs/msg/Vector3"](x, y, z)

        wrench, kind = store.types["geometry_msgs/msg/Wrench"], "geometry_msgs/msg/WrenchStamped"
        return [
            ("/ft", kind, START + 10**9 + k, store.types[kind](header(store, START + k * 10**7), wrench(vector(1, 2, k), vector(4, 5, 6))))
            for k in range(4)
        ]

    make(tmp_path / "log", told)
    made = read_log(tmp_path / "log").recording
    assert made.stream.names == ("ft.force.x", "ft.force.y", "ft.force.z", "ft.torque.x", "ft.torque.y", "ft.torque.z")
    assert [c.unit for c in made.stream.channels] == ["N"] * 3 + ["N m"] * 3
    assert made.values[:, 2].tolist() == [0, 1, 2, 3]
    assert np.allclose(np.diff(made.device_time), 0.01, atol=1e-6)  # by the stamps, not when they were recorded
    assert np.allclose(made.host_time, 1.7e9 + 1, atol=1e-6)


def test_a_gap_is_not_bridged(tmp_path: Path) -> None:
    def told(store: Any) -> Told:
        scalar = store.types["std_msgs/msg/Float64"]
        out: Told = [("/fast", "std_msgs/msg/Float64", START + k * 10**7, scalar(float(k))) for k in range(200)]
        slow = [k for k in range(0, 200, 2) if not 50 <= k < 100]
        return out + [("/slow", "std_msgs/msg/Float64", START + k * 10**7, scalar(float(k))) for k in slow]

    mcap(tmp_path / "log", told)
    made = read_log(tmp_path / "log").recording
    there = np.isfinite(made.column("slow"))
    assert there[:49].all() and not there[49:100].any() and there[100:199].all()


def test_the_same_joint_twice_is_told_apart_and_a_changing_list_is_kept(tmp_path: Path) -> None:
    def told(store: Any) -> Told:
        kind = "sensor_msgs/msg/JointState"
        left = [("/left", kind, START + k, joints(store, START + k, ["pip"], [1.0])) for k in (1, 2, 3)]
        right = [("/right", kind, START + k, joints(store, START + k, ["pip", "mcp"][:k], [2.0, 3.0][:k])) for k in (1, 2)]
        return left + right

    mcap(tmp_path / "log", told)
    made = read_log(tmp_path / "log").recording
    assert made.stream.names == ("left/pip.position", "right/pip.position", "mcp.position")


def test_a_picture_is_no_log(tmp_path: Path) -> None:
    mcap(tmp_path / "log", lambda store: [("/big", "std_msgs/msg/Float64MultiArray", START, numbers(store, [0.0] * 5000))])
    with pytest.raises(InputError, match=r"/big: a message holds 5,000 numbers"):
        read_log(tmp_path / "log")
