"""Logs that are cut off, damaged or hostile: what is whole is given and the rest is said, in one line, within bounded memory."""

import bz2
import io
import sqlite3
import struct
import tracemalloc
from pathlib import Path

import lz4.frame
import numpy as np
import pytest
import zstandard

from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Recording, Stream
from skinfab.readout.logs.log import read_log, write_log

NAMES = ("a.csv", "a.mcap", "a.bag", "a.frames")


def recording(n: int = 3000) -> Recording:
    rng = np.random.default_rng(1)
    channels = tuple(Channel(f"S{k}", "V") for k in range(4))
    return Recording.of_values(Stream("skin", channels, 100.0), rng.standard_normal((n, 4)), device_time=np.arange(n) / 100)


def whole_part(part: Recording, of: Recording) -> bool:
    """Is it the beginning of the other one, bit for bit?"""
    n = len(part)
    return part.stream == of.stream and all(
        getattr(part, name).tobytes() == getattr(of, name)[:n].tobytes()
        for name in ("device_time", "host_time", "sequence", "values", "valid", "saturated")
    )


@pytest.mark.parametrize("name", NAMES)
def test_cut_off_anywhere(tmp_path: Path, name: str) -> None:
    made = recording()
    write_log(made, tmp_path / name)
    data = (tmp_path / name).read_bytes()
    got: list[int] = []
    lines: list[str] = []
    for end in np.random.default_rng(2).integers(1, len(data) - 1, 60).tolist():
        (tmp_path / name).write_bytes(data[:end])
        try:
            log = read_log(tmp_path / name)
        except InputError as fault:
            lines.append(str(fault))
            got.append(0)
            continue
        assert whole_part(log.recording, made)
        # A cut between two frames of a table or of packets cannot be seen; in a block format every one can.
        assert len(log.recording) == len(made) or name in ("a.csv", "a.frames") or log.notes, end
        assert all("\n" not in note for note in log.notes)
        got.append(len(log.recording))
        lost = 1 - end / len(data) - (1 - got[-1] / len(made))
        assert abs(lost) < (0.5 if name in ("a.mcap", "a.bag") else 0.02)
    assert not any("\n" in line for line in lines)
    assert max(got) > len(made) * 0.8 and min(got) < len(made) * 0.2


def test_cut_off_frames_are_said(tmp_path: Path) -> None:
    for name in NAMES:
        write_log(recording(), tmp_path / name)
        data = (tmp_path / name).read_bytes()
        cut = data.index(b"\n", len(data) * 2 // 3) + 10 if name == "a.csv" else len(data) * 2 // 3
        (tmp_path / name).write_bytes(data[:cut])
        log = read_log(tmp_path / name)
        assert any("cut off" in note for note in log.notes), name
        assert 0.3 * 3000 < len(log.recording) < 0.7 * 3000


def test_a_cut_off_ros2_bag(tmp_path: Path) -> None:
    made = recording()
    write_log(made, tmp_path / "bag")
    (tmp_path / "bag" / "metadata.yaml").unlink()  # as after a kill of the recorder
    assert len(read_log(tmp_path / "bag").recording) == 3000
    file = next((tmp_path / "bag").glob("*.db3"))
    data = file.read_bytes()
    file.write_bytes(data[: len(data) // 2])
    log = read_log(tmp_path / "bag")
    assert whole_part(log.recording, made)
    assert 1000 < len(log.recording) < 2000 and any("cut off or damaged" in note for note in log.notes)


@pytest.mark.parametrize("name", [*NAMES, "bag"])
def test_garbage_within_gives_the_truth_or_one_line(tmp_path: Path, name: str) -> None:
    made = recording(400)
    write_log(made, tmp_path / name)
    path = next((tmp_path / name).glob("*.db3")) if name == "bag" else tmp_path / name
    data, rng = path.read_bytes(), np.random.default_rng(3)
    lines: list[str] = []
    for _ in range(60):
        broken = bytearray(data)
        at = int(rng.integers(0, len(data)))
        broken[at : at + 8] = rng.bytes(len(broken[at : at + 8]))
        path.write_bytes(broken)
        try:
            log = read_log(tmp_path / name)
        except InputError as fault:
            lines.append(str(fault))
            continue
        assert len(log.recording) <= 400
        if name in ("a.mcap", "a.frames"):  # with checksums: never a wrong number
            assert np.isin(log.recording.values, made.values).all()
    assert not any("\n" in line for line in lines)


@pytest.mark.parametrize(
    "head", [b"", b"\0" * 100, b"PK\x03\x04", b"\x89MCAP0\r\n", b"#ROSBAG V2.0\n", b"SQLite format 3\0", b"# skinfab recording: 1\n"]
)
@pytest.mark.parametrize("tail", [b"", b"\0" * 1000, b"\xff" * 1000, bytes(range(256)) * 8, b"1,2,3\n" * 50])
def test_what_is_no_log(tmp_path: Path, head: bytes, tail: bytes) -> None:
    (tmp_path / "x").write_bytes(head + tail)
    with pytest.raises(InputError) as fault:
        read_log(tmp_path / "x")
    assert "\n" not in str(fault.value) and str(tmp_path / "x") in str(fault.value)


def test_what_is_no_file(tmp_path: Path) -> None:
    for path, says in ((tmp_path / "none", "No such file"), (tmp_path, "no .mcap or .db3 file"), (Path("/dev/zero"), "device or a pipe")):
        with pytest.raises(InputError, match=says):
            read_log(path)


def record(code: int, body: bytes) -> bytes:
    return struct.pack("<BQ", code, len(body)) + body


def block(packing: bytes, packed: bytes, claimed: int) -> bytes:
    return struct.pack("<QQQII", 0, 0, claimed, 0, len(packing)) + packing + struct.pack("<Q", len(packed)) + packed


BOMB_BYTES = 100_000_000
PACKERS = {b"zstd": zstandard.ZstdCompressor(level=19).compress, b"lz4": lz4.frame.compress, b"bz2": bz2.compress}


@pytest.fixture(scope="module", params=PACKERS)
def packed(request: pytest.FixtureRequest) -> tuple[bytes, bytes]:
    """A packing, and zeros without end in it."""
    return request.param, PACKERS[request.param](bytes(BOMB_BYTES))


@pytest.mark.parametrize("claimed", [1000, BOMB_BYTES, 2**62])
def test_a_bomb_is_not_unpacked(tmp_path: Path, packed: tuple[bytes, bytes], claimed: int) -> None:
    packing, data = packed
    path = tmp_path / "bomb"
    path.write_bytes(b"\x89MCAP0\r\n" + record(1, struct.pack("<II", 0, 0)) + record(6, block(packing, data, claimed)))
    tracemalloc.start()
    try:
        with pytest.raises(InputError, match=r"zip bomb|nothing in it is whole"):
            read_log(path)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 20_000_000 + 3 * len(data)


def test_the_one_call_function_believes_the_bomb() -> None:
    """Why blocks are unpacked by a reader that stops: this asks the packed data itself how long it is, whatever it is told."""
    packed = zstandard.ZstdCompressor().compress(bytes(5_000_000))
    assert len(zstandard.ZstdDecompressor().decompress(packed, max_output_size=1000)) == 5_000_000
    assert len(zstandard.ZstdDecompressor().stream_reader(io.BytesIO(packed)).read(1000)) == 1000


def test_a_record_that_claims_the_world(tmp_path: Path) -> None:
    path = tmp_path / "x"
    for data in (
        b"\x89MCAP0\r\n" + struct.pack("<BQ", 5, 2**63),
        b"#ROSBAG V2.0\n" + struct.pack("<I", 2**32 - 1),
        b"#ROSBAG V2.0\n" + struct.pack("<I", 0) + struct.pack("<I", 2**32 - 1),
    ):
        path.write_bytes(data)
        with pytest.raises(InputError, match="nothing in it is whole"):
            read_log(path)


def test_a_database_of_endless_views(tmp_path: Path) -> None:
    path = tmp_path / "a.db3"
    with sqlite3.connect(path) as base:
        base.executescript(
            "CREATE TABLE topics(id INTEGER, name TEXT, type TEXT, serialization_format TEXT);"
            "CREATE VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id + 1 FROM n) "
            "SELECT id, 1 AS topic_id, id AS timestamp, zeroblob(1000000) AS data FROM n;"
        )
    base.close()
    with pytest.raises(InputError, match="without the table 'messages'"):
        read_log(path)
    with sqlite3.connect(path) as base:
        base.executescript(
            "DROP VIEW messages;"
            "CREATE TABLE messages(id INTEGER, topic_id INTEGER, timestamp INTEGER, data BLOB AS (zeroblob(900000000)) VIRTUAL);"
            "INSERT INTO messages(id, topic_id, timestamp) VALUES (1, 1, 1);"
        )
    base.close()
    with pytest.raises(InputError, match="nothing in it is whole"):
        read_log(path)
