"""A recording that is ended anyhow: killed, cut off, out of room, without a device. What was recorded is there."""

import errno
import itertools
import os
import random
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.readout.frame import Frame, Recording
from skinfab.readout.logs.csv_log import write_csv
from skinfab.readout.logs.log import read_log
from skinfab.readout.paced import PacedFrames
from skinfab.readout.pty_server import PtyServer
from skinfab.readout.record import Recorder, State, record
from skinfab.readout.recording_file import read_recording
from skinfab.readout.serial_port import SerialPort
from skinfab.readout.strain_simulator import simulated_strain, strain_frames, strain_stream

STREAM = strain_stream(channels=5, rate_hz=200.0)
KINDS = (".frames", ".csv")


def made(n: int) -> list[Frame]:
    each = list(itertools.islice(strain_frames(STREAM), n))
    each[1].valid[2], each[1].saturated[3], each[1].values[2] = False, True, np.nan
    return each


def assert_same(found: Recording, each: list[Frame]) -> None:
    wanted = Recording.of_frames(STREAM, each)
    assert found.stream == STREAM
    for name in ("device_time", "host_time", "sequence", "values", "valid", "saturated"):
        np.testing.assert_array_equal(getattr(found, name), getattr(wanted, name))


@pytest.mark.parametrize("suffix", KINDS)
def test_what_comes_over_the_port_is_in_the_file(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    told: list[State] = []
    with PtyServer(STREAM, made(500)) as device, SerialPort(device.path) as port:
        with Recorder(path, port.stream) as recorder:
            record(port, recorder, seconds=3.2, told=told.append)
        counts = port.counts
    found = read_log(path).recording
    assert len(found) == counts.frames == 500 and counts.lost == 0
    assert [s.frames for s in told] == sorted(s.frames for s in told) and told[-1].frames == 500
    assert len(told) >= 3 and told[0].rate_hz == pytest.approx(200, rel=0.2)
    assert told[-1].bytes == path.stat().st_size and told[-1].free_bytes > 0 and told[-1].room_s > 0


@pytest.mark.parametrize("suffix", KINDS)
def test_cut_off_at_any_byte_the_last_frame_at_most_is_lost(tmp_path: Path, suffix: str) -> None:
    path, each, ends = tmp_path / f"a{suffix}", made(4), []
    with Recorder(path, STREAM) as recorder:
        ends.append(recorder.bytes)
        for frame in each:
            recorder.add(frame)
            ends.append(path.stat().st_size)  # in the file at once, not in some buffer
    data = path.read_bytes()
    for size in range(ends[0], len(data) + 1):
        path.write_bytes(data[:size])
        found = read_log(path).recording
        whole = sum(end <= size for end in ends[1:])
        # The line of a CSV file is whole without its end too.
        assert whole <= len(found) <= whole + (suffix == ".csv")
        assert_same(found, each[: len(found)])


def test_csv_is_the_same_as_of_a_whole_recording(tmp_path: Path) -> None:
    with Recorder(tmp_path / "a.csv", STREAM) as recorder:
        for frame in made(30):
            recorder.add(frame)
    write_csv(Recording.of_frames(STREAM, made(30)), tmp_path / "b.csv")
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()


def add_all(recorder: Recorder, each: list[Frame]) -> None:
    for frame in each:
        recorder.add(frame)


KILLED = """
import sys
from skinfab.readout.record import Recorder
from skinfab.readout.strain_simulator import simulated_strain
with simulated_strain(channels=5, rate_hz=200.0, in_time=False) as source, Recorder(sys.argv[1], source.stream) as recorder:
    for frame in source:
        recorder.add(frame)
        print(recorder.frames, flush=True)
"""


@pytest.mark.parametrize("suffix", KINDS)
def test_killed_at_a_random_moment_it_has_every_frame_it_was_given(tmp_path: Path, suffix: str) -> None:
    path, rng = tmp_path / f"a{suffix}", random.Random(suffix)
    for _ in range(4):
        process = subprocess.Popen([sys.executable, "-c", KILLED, str(path)], stdout=subprocess.PIPE, text=True)
        assert process.stdout is not None and process.stdout.readline() == "1\n"
        time.sleep(rng.uniform(0.0, 0.05))
        process.send_signal(signal.SIGKILL)
        given = int((["1", *process.stdout.read().split("\n")[:-1]])[-1])
        process.wait()
        process.stdout.close()
        found = read_log(path).recording
        assert given <= len(found) <= given + 1  # killed between writing a frame and saying so
        with simulated_strain(channels=5, rate_hz=200.0, in_time=False) as again:
            for k in range(len(found)):
                frame = again.read()
                assert frame is not None
                np.testing.assert_array_equal(found.values[k], frame.values)
        path.unlink()


@pytest.mark.parametrize("suffix", KINDS)
def test_a_full_disk_is_one_line_and_what_was_recorded_stays(tmp_path: Path, suffix: str, monkeypatch: pytest.MonkeyPatch) -> None:
    path, each, room = tmp_path / f"a{suffix}", made(50), [3000]
    write = os.write

    def full(file: int, data: bytes) -> int:
        if room[0] <= 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        went = write(file, data[: room[0]])  # as the system does: what fits goes in, the rest is an error the next time
        room[0] -= went
        return went

    with Recorder(path, STREAM) as recorder:
        monkeypatch.setattr(os, "write", full)
        with pytest.raises(InputError, match=r"the disk is full; .*; the \d+ frames recorded before are in it") as fault:
            add_all(recorder, each)
        monkeypatch.undo()
    assert "\n" not in str(fault.value) and 5 < recorder.frames < 50
    assert_same(read_log(path).recording, each[: recorder.frames])
    assert path.stat().st_size == recorder.bytes  # nothing half-written was left


def test_no_room_for_the_head_leaves_no_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(file: int, data: bytes) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "write", full)
    with pytest.raises(InputError, match="disk is full"):
        Recorder(tmp_path / "a.frames", STREAM)
    assert list(tmp_path.iterdir()) == []


def test_a_file_is_never_overwritten(tmp_path: Path) -> None:
    path = tmp_path / "a.frames"
    path.write_text("mine")
    with pytest.raises(InputError, match="never overwritten"):
        Recorder(path, STREAM)
    assert path.read_text() == "mine"
    (tmp_path / "b.frames").symlink_to(tmp_path / "nowhere")
    with pytest.raises(InputError, match="never overwritten"):
        Recorder(tmp_path / "b.frames", STREAM)


@pytest.mark.parametrize(
    ("name", "says"), [("a.txt", "call a recording"), ("none/a.csv", "folder does not exist"), ("a", "call a recording")]
)
def test_a_name_that_will_not_do_is_one_line(tmp_path: Path, name: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        Recorder(tmp_path / name, STREAM)


def test_a_recording_without_a_frame_is_removed(tmp_path: Path) -> None:
    with Recorder(tmp_path / "a.frames", STREAM):
        pass
    assert list(tmp_path.iterdir()) == []


def test_a_source_that_ends_ends_the_recording(tmp_path: Path) -> None:
    each = made(20)
    with PacedFrames(STREAM, lambda: each, in_time=False) as source, Recorder(tmp_path / "a.frames", STREAM) as recorder:
        record(source, recorder)
    assert len(read_recording(tmp_path / "a.frames")) == 20


def test_it_can_be_told_to_stop_and_does_so_between_two_frames(tmp_path: Path) -> None:
    stop = threading.Event()
    timer = threading.Timer(0.3, stop.set)
    with simulated_strain(channels=2, rate_hz=500.0) as source, Recorder(tmp_path / "a.frames", source.stream) as recorder:
        timer.start()
        record(source, recorder, stop=stop)
    assert len(read_recording(tmp_path / "a.frames")) == recorder.frames == source.counts.frames > 50


def test_a_device_that_is_silent_does_not_hold_the_recording_beyond_its_time(tmp_path: Path) -> None:
    with PtyServer(STREAM, made(20)) as device, SerialPort(device.path) as port:
        began = time.monotonic()
        with Recorder(tmp_path / "a.frames", STREAM) as recorder:
            record(port, recorder, seconds=1.0)
        assert 0.9 < time.monotonic() - began < 3.0 and recorder.frames == 20
