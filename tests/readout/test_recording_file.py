"""A recording comes back bit for bit, and cut off at any byte it loses no more than its last frame."""

import io
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Frame, Recording, Stream
from skinfab.readout.recording_file import MAGIC, append, read_recording, read_recording_counted, write_header, write_recording

STREAM = Stream(
    "finger",
    (Channel("S1", "V", "strain", 0.0, 3.3, "s1", 1, 4), Channel("S2"), *(Channel(f"äö{k}", "kohm") for k in range(9))),
    100.0,
    simulated=True,
)


def frames(n: int) -> list[Frame]:
    rng = np.random.default_rng(1)
    c = len(STREAM.channels)
    values = rng.normal(size=(n, c)) * 10.0 ** rng.integers(-300, 300, (n, c))
    values[rng.random((n, c)) < 0.1] = np.nan
    times = 1.7e9 + np.cumsum(rng.random(n))
    return [Frame(times[k] - 1.7e9, times[k], 2**40 + k, values[k], rng.random(c) < 0.8, rng.random(c) < 0.2) for k in range(n)]


def raw(each: list[Frame]) -> tuple[bytes, list[int]]:
    """The file's bytes, and how long it is after each frame."""
    file, ends = io.BytesIO(), []
    layout = write_header(file, STREAM)
    ends.append(file.tell())
    for frame in each:
        append(file, layout, frame)
        ends.append(file.tell())
    return file.getvalue(), ends


def assert_same(found: Recording, each: list[Frame]) -> None:
    wanted = Recording.of_frames(STREAM, each)
    assert found.stream == STREAM and len(found) == len(each)
    for name in ("device_time", "host_time", "sequence", "values", "valid", "saturated"):
        np.testing.assert_array_equal(getattr(found, name), getattr(wanted, name), strict=True)


def test_what_was_written_comes_back_bit_for_bit(tmp_path: Path) -> None:
    path, each = tmp_path / "a.frames", frames(200)
    write_recording(path, STREAM, each)
    assert_same(read_recording(path), each)


def test_cut_off_at_every_byte_it_loses_the_last_frame_at_most(tmp_path: Path) -> None:
    path, each = tmp_path / "a.frames", frames(5)
    data, ends = raw(each)
    for size in range(len(data) + 1):
        path.write_bytes(data[:size])
        if size < ends[0]:
            with pytest.raises(InputError, match="cut off before"):
                read_recording(path)
        else:
            whole = sum(end <= size for end in ends[1:])
            found, counts = read_recording_counted(path)
            assert_same(found, each[:whole])
            assert counts.bad == 0


def test_a_damaged_frame_is_left_out_counted_and_costs_no_other(tmp_path: Path) -> None:
    path, each = tmp_path / "a.frames", frames(20)
    data, ends = raw(each)
    for at in range(ends[7], ends[8] - 1):
        hurt = bytearray(data)
        hurt[at] ^= 0x10
        path.write_bytes(hurt)
        found, counts = read_recording_counted(path)
        # Where the damage makes an end mark of a byte, one packet becomes two bad pieces.
        assert counts.lost == 1 and 1 <= counts.bad <= 2
        assert_same(found, each[:7] + each[8:])


@given(st.binary(max_size=3000))
def test_no_bytes_crash_the_reader(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "garbage.frames"
    head, _ = raw([])
    path.write_bytes(head + data)
    assert len(read_recording(path)) == 0
    path.write_bytes(MAGIC + data)
    with pytest.raises(InputError, match="cut off"):
        read_recording(path)


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"time,S1\n0,1\n", "no recording"),
        (MAGIC.replace(b"1", b"2"), "another version"),
        (b"", "cut off before"),
        (b"\xff" * 40, "no recording"),
    ],
)
def test_other_files_are_refused_in_one_line(tmp_path: Path, data: bytes, says: str) -> None:
    path = tmp_path / "a.frames"
    path.write_bytes(data)
    with pytest.raises(InputError, match=says) as fault:
        read_recording(path)
    assert "\n" not in str(fault.value)


def test_a_missing_file_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        read_recording(tmp_path / "none.frames")
