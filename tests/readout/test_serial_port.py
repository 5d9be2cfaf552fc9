"""A real serial port's path, over a pseudo-terminal: rates, garbage, lost bytes, a cable that is pulled, clocks that step."""

import errno
import itertools
import os
import pty
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import serial

from skinfab.errors import InputError
from skinfab.readout import serial_port
from skinfab.readout.faults import Faults
from skinfab.readout.frame import Frame, Stream
from skinfab.readout.packets import FRAME_64
from skinfab.readout.pty_server import PtyServer
from skinfab.readout.serial_port import WAITING, SerialPort
from skinfab.readout.source import StaleError
from skinfab.readout.strain_simulator import strain_frames, strain_stream

STREAM = strain_stream(channels=4, rate_hz=500.0)
PATIENCE_S = 3.0  # so long without a frame, and there are no more


def sent(count: int, *, stream: Stream = STREAM) -> list[Frame]:
    return list(itertools.islice(strain_frames(stream), count))


def until(port: SerialPort, last: int) -> list[Frame]:
    """All frames up to the one of this number, or until none comes any more."""
    found = []
    while (frame := port.read(PATIENCE_S)) is not None:
        found.append(frame)
        if frame.sequence >= last:
            break
    return found


def assert_none_is_wrong(found: list[Frame], made: list[Frame]) -> None:
    for frame in found:
        np.testing.assert_array_equal(frame.values, made[frame.sequence].values)


@pytest.mark.parametrize(("rate_hz", "channels"), [(100.0, 32), (1400.0, 6)])
def test_no_frame_is_lost_at_the_rates_of_the_seed_device_and_of_a_nail(rate_hz: float, channels: int) -> None:
    stream = strain_stream(channels=channels, rate_hz=rate_hz)
    made = sent(int(3 * rate_hz), stream=stream)
    with PtyServer(stream, made) as device, SerialPort(device.path) as port:
        assert port.stream == stream
        found = until(port, len(made) - 1)
        assert device.wait(PATIENCE_S)
        counts = port.counts
    assert device.unsent == 0 and len(found) == counts.frames == device.sent == len(made)
    assert (counts.lost, counts.bad, counts.late, counts.unchecked, counts.reopened) == (0, 0, 0, 0, 0)
    assert [f.sequence for f in found] == list(range(len(made)))
    host = np.array([f.host_time for f in found])
    assert np.all(np.diff(host) >= 0) and host[-1] - host[0] == pytest.approx(3.0, abs=1.0)
    for frame, original in zip(found, made, strict=True):
        np.testing.assert_array_equal(frame.values, original.values.astype(np.float32).astype(float))


@pytest.mark.parametrize(
    "faults",
    [Faults(garbage=0.2), Faults(lost=1e-3), Faults(flipped=1e-3), Faults(lost=1e-3, flipped=1e-3, garbage=0.1, twice=0.1, swapped=0.1)],
    ids=["garbage", "bytes lost", "bits flipped", "all at once"],
)
def test_what_goes_wrong_on_the_wire_is_counted_and_no_wrong_frame_comes_through(faults: Faults) -> None:
    made = sent(1500)
    last = len(made) - 20  # the very last may be among those that are lost
    with PtyServer(STREAM, made, rate_hz=0, kind=FRAME_64, faults=faults) as device, SerialPort(device.path) as port:
        found = until(port, last)
        counts = port.counts
    assert_none_is_wrong(found, made)
    numbers = [f.sequence for f in found]
    assert numbers == sorted(set(numbers))
    assert counts.bad > 0
    assert counts.lost >= numbers[-1] - numbers[0] + 1 - len(found)
    assert len(found) > 0.5 * last


def test_packets_twice_or_late_are_dropped_and_counted() -> None:
    made = sent(400)
    with PtyServer(STREAM, made, rate_hz=0, faults=Faults(twice=0.2, seed=1)) as device, SerialPort(device.path) as port:
        found = until(port, len(made) - 1)
        device.wait(PATIENCE_S)
        twice = port.counts
    assert [f.sequence for f in found] == list(range(400)) and (twice.lost, twice.bad) == (0, 0) and 40 < twice.late < 130
    with PtyServer(STREAM, made, rate_hz=0, faults=Faults(swapped=0.2, seed=1)) as device, SerialPort(device.path) as port:
        found = until(port, len(made) - 2)
        swapped = port.counts
    numbers = [f.sequence for f in found]
    assert numbers == sorted(set(numbers)) and 30 < swapped.late <= swapped.lost <= swapped.late + 1


def test_a_cable_pulled_and_plugged_in_again_is_survived() -> None:
    whole = sent(1000)
    made = whole[:300] + whole[305:]  # five are never sent: of those on their way as the cable goes a quick reader may lose none
    faults = Faults(unplugged={300: 0.3, 700: 0.1})
    with PtyServer(STREAM, made, faults=faults) as device, SerialPort(device.path) as port:
        found = until(port, 999)
        counts = port.counts
        assert device.wait(PATIENCE_S)
    numbers = [f.sequence for f in found]
    assert counts.reopened == 2 and numbers[0] == 0 and numbers[-1] == 999
    assert counts.lost == 1000 - len(found) > 0 and counts.frames == len(found)
    assert set(range(290)) <= set(numbers)  # what came before is whole, but for what was on its way
    assert all(b > a for a, b in itertools.pairwise(numbers))


def test_a_device_that_starts_anew_goes_on_where_it_was() -> None:
    made = sent(300)
    again = [*made, *made[:200]]
    with PtyServer(STREAM, again, rate_hz=0) as device, SerialPort(device.path) as port:
        found = until(port, 499)
        assert port.counts.reopened == 1 and port.counts.lost == port.counts.late == 0
    assert [f.sequence for f in found] == list(range(500)) and found[300].device_time == 0.0


def test_steps_of_the_wall_clock_do_not_reach_the_frames(monkeypatch: pytest.MonkeyPatch) -> None:
    real = time.time
    with PtyServer(STREAM, strain_frames(STREAM)) as device, SerialPort(device.path) as port:
        before = [port.read(PATIENCE_S) for _ in range(20)]
        for step in (-3600.0, 3600.0, 1e9):
            monkeypatch.setattr(time, "time", lambda step=step: real() + step)
            before += [port.read(PATIENCE_S) for _ in range(20)]
            assert port.read_latest(PATIENCE_S).host_time >= before[-1].host_time  # type: ignore[union-attr]
    host = np.array([f.host_time for f in before if f is not None])
    assert len(host) == 80 and np.all(np.diff(host) >= 0) and host[-1] - host[0] < 5 and abs(host[0] - real()) < 10


def test_what_is_stale_is_an_error_and_the_newest_frame_is_given_as_often_as_it_is_asked_for() -> None:
    told = threading.Event()

    def ten() -> Iterator[Frame]:
        yield from sent(10)
        told.wait(PATIENCE_S)
        yield sent(11)[10]

    with PtyServer(STREAM, ten()) as device, SerialPort(device.path) as port:
        assert until(port, 9)[-1].sequence == 9
        assert port.read_latest(5.0).sequence == port.read_latest(5.0).sequence == 9
        time.sleep(0.1)
        with pytest.raises(StaleError, match=r"s old, and 0\.05 s are allowed"):
            port.read_latest(0.05)
        told.set()
        assert port.read(PATIENCE_S) is not None and port.read_latest(5.0).sequence == 10


def test_older_frames_are_passed_over_and_a_reader_that_sleeps_is_told_what_it_missed() -> None:
    stream = strain_stream(channels=1, rate_hz=100.0)
    made = sent(WAITING + 500, stream=stream)
    with PtyServer(stream, made, rate_hz=0) as device, SerialPort(device.path) as port:
        assert device.wait(60.0)
        while port.counts.frames + port.counts.lost < len(made):
            time.sleep(0.01)
        counts = port.counts
        assert counts.lost == 500 and counts.frames == WAITING
        first = port.read(0)
        assert first is not None and first.sequence == 500
        assert port.read_latest(60.0).sequence == len(made) - 1 and port.read(0) is None


def test_lines_of_numbers_are_read_and_flagged() -> None:
    made = sent(200)
    with PtyServer(STREAM, made, rate_hz=0, ascii_lines=True) as device, SerialPort(device.path) as port:
        assert port.stream.names == STREAM.names
        found = until(port, 199)
        counts = port.counts
    # Of the first line it cannot be known that it came whole.
    assert counts.unchecked == counts.frames == len(found) >= 198 and counts.lost == counts.bad == 0
    for frame in found:
        np.testing.assert_allclose(frame.values, made[frame.sequence].values, rtol=1e-8)


def test_another_device_on_the_same_port_is_refused_not_mixed_in() -> None:
    other = strain_stream(channels=3, rate_hz=500.0)
    with PtyServer(STREAM, sent(20), rate_hz=0) as device:
        port = SerialPort(device.path).open()
        assert len(until(port, 19)) == 20
        path = device.path
        device.wait(PATIENCE_S)
        with PtyServer(other, strain_frames(other)) as second:
            path.symlink_to(second.path)
            with pytest.raises(InputError, match="another stream than when it was opened, simulated strain channels with 3 channels"):
                port.read(PATIENCE_S)
            with pytest.raises(InputError, match="another stream"):
                port.read_latest(1.0)
            port.close()
            path.unlink()


def test_a_port_may_be_opened_again_and_iterated_until_it_is_closed() -> None:
    with PtyServer(STREAM, strain_frames(STREAM)) as device:
        port = SerialPort(device.path)
        with pytest.raises(InputError, match="is not open"):
            _ = port.stream
        for _ in range(2):
            with port:
                for k, _frame in enumerate(port):
                    if k == 5:
                        break
                with pytest.raises(InputError, match="open already"):
                    port.open()
            assert port.read(0.0) is None and list(port) == []
        port.close()


def test_nobody_else_may_read_the_port() -> None:
    with PtyServer(STREAM, strain_frames(STREAM)) as device, SerialPort(device.path), pytest.raises(InputError, match="another program"):
        SerialPort(device.path).open()


def test_a_port_that_cannot_be_used_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no port"):
        SerialPort(tmp_path / "none").open()
    (tmp_path / "file").write_text("no port")
    with pytest.raises(InputError, match="no serial port"):
        SerialPort(tmp_path / "file").open()
    silent = PtyServer(STREAM, iter(()))
    with silent, pytest.raises(InputError, match=r"sent nothing for 0\.2 s"):
        SerialPort(silent.path, described_s=0.2).open()


def test_a_port_without_permission_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(port: str, baud: int) -> None:
        raise serial.SerialException(errno.EACCES, "could not open port")

    monkeypatch.setattr(serial_port, "_opened", refused)
    with pytest.raises(InputError, match="sudo adduser"):
        SerialPort("/dev/ttyACM0").open()


def test_a_fault_in_the_reading_thread_reaches_who_reads(monkeypatch: pytest.MonkeyPatch) -> None:
    with PtyServer(STREAM, strain_frames(STREAM)) as device, SerialPort(device.path) as port:
        assert port.read(PATIENCE_S) is not None

        def broken(counter: int) -> int:
            raise MemoryError

        monkeypatch.setattr(port._order, "place", broken)
        with pytest.raises(MemoryError):
            for _ in port:
                pass
        with pytest.raises(MemoryError):
            port.read_latest(1.0)


def test_a_board_that_prints_for_people_is_told_what_was_seen() -> None:
    ours, theirs = pty.openpty()
    stop = threading.Event()

    def talk() -> None:
        while not stop.wait(0.02):
            os.write(ours, b"S1 = 1.5 V\n")

    thread = threading.Thread(target=talk)
    thread.start()
    try:
        says = r"\(the line 'S1 = 1.5 V' is no line of numbers parted by commas, semicolons or tabs, and none of headings\); is it"
        with pytest.raises(InputError, match=says):
            SerialPort(os.ttyname(theirs), described_s=0.5).open()
    finally:
        stop.set()
        thread.join()
        os.close(ours)
        os.close(theirs)


def test_what_cannot_be_understood_is_one_line() -> None:
    says = r"bytes in 0\.5 s and no description of a stream.*; is it 115200 baud"
    with PtyServer(STREAM, strain_frames(STREAM), faults=Faults(flipped=0.3)) as device, pytest.raises(InputError, match=says):
        SerialPort(device.path, baud=115_200, described_s=0.5).open()


def test_what_makes_the_frames_fail_is_told_by_the_server() -> None:
    bad = Frame(-1.0, 0.0, 0, np.zeros(4), np.ones(4, bool), np.zeros(4, bool))
    with pytest.raises(InputError, match="cannot be sent"), PtyServer(STREAM, [*sent(5), bad]) as device, SerialPort(device.path) as port:
        assert len(until(port, 4)) == 5 and device.wait(PATIENCE_S)
