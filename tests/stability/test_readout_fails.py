"""Where the usual ways to read a sensor fail, and what is done here instead."""

import itertools
import time
import tracemalloc
from datetime import datetime

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.readout.decode import AnyDecoder, PacketDecoder
from skinfab.readout.faults import Faults, Wire
from skinfab.readout.frame import Frame, Stream
from skinfab.readout.framing import LONGEST
from skinfab.readout.packets import FRAME_64, Layout
from skinfab.readout.pty_server import PtyServer
from skinfab.readout.sequence import InOrder
from skinfab.readout.serial_port import SerialPort
from skinfab.readout.source import HostClock, StaleError
from skinfab.readout.strain_simulator import strain_frames, strain_stream

STREAM = strain_stream(channels=16, rate_hz=100.0)
FRAMES = list(itertools.islice(strain_frames(STREAM), 6000))


def naive_lines(data: bytes) -> list[list[float]]:
    """What is found in many a script: whatever is a line of enough numbers is believed."""
    found = []
    for line in data.split(b"\n"):
        try:
            numbers = [float(cell) for cell in line.split(b",")]
        except ValueError:
            continue
        if len(numbers) == len(STREAM.channels) + 1:
            found.append(numbers)
    return found


@pytest.mark.parametrize("faults", [Faults(lost=1e-3), Faults(flipped=1e-3)], ids=["bytes lost", "bits flipped"])
def test_lines_of_numbers_are_wrong_in_silence_and_packets_are_not(faults: Faults) -> None:
    lines = b"".join(f"{f.sequence},{','.join(f'{v:.4f}' for v in f.values)}\n".encode() for f in FRAMES)
    believed = naive_lines(Wire(faults).hurt(lines))
    wrong = sum(not (0 <= n[0] < len(FRAMES) and np.allclose(n[1:], FRAMES[int(n[0])].values, rtol=0, atol=6e-5)) for n in believed)
    assert wrong > 0.02 * len(believed)

    layout, decoder = Layout(STREAM), PacketDecoder()
    decoder.feed(layout.description, host_time=0.0)
    read = decoder.feed(Wire(faults).hurt(b"".join(layout.frame_packet(f, kind=FRAME_64) for f in FRAMES)), host_time=0.0)
    assert len(read) > 0.8 * len(FRAMES) and decoder.bad > 0
    for frame in read:
        np.testing.assert_array_equal(frame.values, FRAMES[frame.sequence].values)


def test_fixed_frames_without_an_end_mark_never_find_their_place_again() -> None:
    size = 16 * 4
    raw = bytearray(b"".join(f.values.astype("<f4").tobytes() for f in FRAMES[:200]))
    del raw[1000]  # one byte
    whole = np.frombuffer(bytes(raw[: len(raw) // size * size]), "<f4").reshape(-1, 16)
    right = [np.array_equal(a, f.values.astype(np.float32)) for a, f in zip(whole, FRAMES, strict=False)]
    assert all(right[:15]) and not any(right[15:])

    layout, decoder = Layout(STREAM), PacketDecoder()
    decoder.feed(layout.description, host_time=0.0)
    sent = bytearray(b"".join(layout.frame_packet(f) for f in FRAMES[:200]))
    del sent[1000]
    assert len(decoder.feed(bytes(sent), host_time=0.0)) >= 198


def test_a_wall_clock_that_is_set_makes_frames_run_backwards_and_ours_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    real, shift = time.time, [0.0]
    monkeypatch.setattr(time, "time", lambda: real() + shift[0])
    clock = HostClock()
    naive, ours = [], []
    for shift[0] in (0.0, -3600.0, 0.0, 5.0, 1.0):  # an hour back, and a time server at work
        naive.append(time.time())
        ours.append(clock.now())
    assert np.diff(naive).min() < -3000
    assert 0 <= np.diff(ours).min() <= np.diff(ours).max() < 1 and abs(datetime.fromtimestamp(ours[0]).timestamp() - real()) < 60


def test_a_counter_of_sixteen_bits_taken_as_it_is_loses_65535_frames_at_its_end() -> None:
    counters = [(65_530 + k) % 65_536 for k in range(12)]
    naive_lost = sum(abs(b - a) - 1 for a, b in itertools.pairwise(counters))
    assert naive_lost > 65_000
    order = InOrder()
    placed = [order.place((2**32 - 6 + k) % 2**32) for k in range(12)]
    assert placed == list(range(2**32 - 6, 2**32 + 6)) and order.lost == 0


def test_the_last_value_of_a_dead_device_looks_alive_and_here_it_is_an_error() -> None:
    with PtyServer(STREAM, FRAMES[:5]) as device, SerialPort(device.path) as port:
        newest: Frame | None = None
        while (frame := port.read(0.5)) is not None:
            newest = frame
        assert newest is not None and newest.valid.all()  # nothing in it says that the device is dead
        with pytest.raises(StaleError, match="look at the device"):
            port.read_latest(0.1)


def test_endless_garbage_fills_no_memory_and_what_follows_is_read() -> None:
    rng = np.random.default_rng(0)
    naive = bytearray()
    decoder = AnyDecoder()
    pieces = [bytes(rng.integers(1, 256, 200_000, dtype=np.uint8)) for _ in range(5)]
    tracemalloc.start()
    try:
        for _ in range(10):
            for piece in pieces:
                decoder.feed(piece.replace(b"\n", b"\r"), host_time=0.0)  # no end of any kind, ten megabytes long
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    for piece in pieces:
        naive += piece.replace(b"\n", b"\r")  # a script that collects until the end comes
    assert len(naive) == 1_000_000 and peak < 1_000_000 + 4 * LONGEST
    layout = Layout(STREAM)
    assert len(decoder.feed(b"\0" + layout.description + layout.frame_packet(FRAMES[0]), host_time=0.0)) == 1


def test_frames_read_with_another_devices_channels_are_plausible_and_refused() -> None:
    other = Stream(STREAM.name, tuple(reversed(STREAM.channels)), STREAM.rate_hz)
    layout = Layout(other)
    # As many bytes, as many numbers, a right checksum: only the layout's number tells.
    assert len(layout.frame_packet(FRAMES[0])) == len(Layout(STREAM).frame_packet(FRAMES[0]))
    decoder = PacketDecoder()
    decoder.feed(Layout(STREAM).description, host_time=0.0)
    assert decoder.feed(b"\0" + layout.frame_packet(FRAMES[0]), host_time=0.0) == [] and decoder.bad == 1


def test_a_port_that_sends_nonsense_ends_in_one_line_not_in_a_hang() -> None:
    wire = Faults(flipped=0.5)
    with PtyServer(STREAM, FRAMES[:1000], rate_hz=0, faults=wire) as device, pytest.raises(InputError) as fault:
        SerialPort(device.path, described_s=2.0).open()
    assert "\n" not in str(fault.value) and "docs/readout.md" in str(fault.value)
