"""Frames through packets: what a device sends is what is read, and what is not its own is not read at all."""

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.readout.decode import AnyDecoder, PacketDecoder
from skinfab.readout.frame import Channel, Frame, Stream
from skinfab.readout.framing import crc16, packed, unpacked
from skinfab.readout.packets import FRAME_32, FRAME_64, Layout

numbers = st.floats(width=32, allow_infinity=False, allow_nan=False) | st.just(float("nan"))


@given(st.data(), st.integers(1, 40), st.integers(0, 2**32 - 1), st.integers(0, 2**50), st.sampled_from([FRAME_32, FRAME_64]))
def test_a_frame_comes_back(data: st.DataObject, n: int, counter: int, us: int, kind: int) -> None:
    layout = Layout(Stream("s", tuple(Channel(f"c{k}") for k in range(n)), 100.0))
    values = np.array(data.draw(st.lists(numbers, min_size=n, max_size=n)))
    valid, saturated = (np.array(data.draw(st.lists(st.booleans(), min_size=n, max_size=n))) for _ in range(2))
    body = unpacked(layout.frame_packet(Frame(us / 1e6, 0.0, counter, values, valid, saturated), kind=kind)[:-1])
    assert body is not None
    back = layout.frame(body, host_time=5.0)
    assert back is not None and (back.device_time, back.host_time, back.sequence) == (us / 1e6, 5.0, counter)
    np.testing.assert_array_equal(back.values, values)
    np.testing.assert_array_equal(back.valid, valid & np.isfinite(values))
    np.testing.assert_array_equal(back.saturated, saturated)


def test_the_bytes_are_those_of_the_document() -> None:
    layout = Layout(Stream("s", (Channel("a"), Channel("b")), 100.0))
    frame = Frame(1.0, 0.0, 7, np.array([1.0, -2.0]), np.array([True, True]), np.array([False, True]))
    body = struct.pack("<BBHIQ2fBB", 1, 2, layout.number, 7, 1_000_000, 1.0, -2.0, 0b11, 0b10)
    assert layout.frame_packet(frame) == packed(body)
    described = unpacked(layout.description[:-1])
    assert described is not None and described[:4] == b"\x01\x01\0\0" and layout.number == crc16(described)


def test_an_end_of_the_range_is_saturated_though_four_bytes_hold_it_inexactly() -> None:
    layout = Layout(Stream("s", (Channel("U", "V", low=0.1, high=3.3), Channel("free")), 100.0))
    for volt, at_end in ((3.3, True), (3.29, False), (0.1, True), (0.11, False)):
        frame = Frame(0.0, 0.0, 0, np.array([volt, 1e9]), np.array([True, True]), np.array([False, False]))
        body = unpacked(layout.frame_packet(frame)[:-1])
        assert body is not None
        back = layout.frame(body, host_time=0.0)
        assert back is not None and back.saturated.tolist() == [at_end, False]


@pytest.mark.parametrize("size", [0, 3, 4, 15, 24, 26, 40])
def test_a_packet_of_another_size_is_no_frame(size: int) -> None:
    layout = Layout(Stream("s", (Channel("a"), Channel("b")), 100.0))
    whole = struct.pack("<BBHIQ2fBB", 1, 2, layout.number, 7, 1, 1.0, 2.0, 3, 0)
    assert layout.frame(whole, host_time=0.0) is not None
    assert layout.frame((whole + bytes(40))[:size] if size != len(whole) else b"", host_time=0.0) is None
    for at, other in ((0, 2), (1, 9), (2, whole[2] ^ 1), (24, 7), (25, 4)):  # version, kind, layout, and bits of no channel
        assert layout.frame(whole[:at] + bytes([other]) + whole[at + 1 :], host_time=0.0) is None


def test_another_stream_on_the_same_port_is_named_and_none_of_its_frames_given_out() -> None:
    one, two = (Layout(Stream(name, (Channel("a"),), 100.0)) for name in ("one", "two"))
    frame = Frame(0.0, 0.0, 1, np.array([1.0]), np.array([True]), np.array([False]))
    decoder = PacketDecoder()
    assert len(decoder.feed(one.description + one.frame_packet(frame), host_time=0.0)) == 1 and decoder.changed is None
    assert decoder.feed(two.description + two.frame_packet(frame), host_time=0.0) == []
    assert decoder.changed is not None and decoder.changed.name == "two" and decoder.stream == one.stream


def test_a_device_may_describe_itself_in_fewer_words() -> None:
    text = b'{"schema":1,"name":"skin","rate_hz":100,"channels":[{"name":"S1","unit":"V"}]}'
    body = b"\x01\x01\0\0" + text
    decoder = PacketDecoder()
    decoder.feed(packed(body), host_time=0.0)
    frame = struct.pack("<BBHIQfBB", 1, 2, crc16(body), 1, 10, 0.5, 1, 0)
    assert [f.values.tolist() for f in decoder.feed(packed(frame), host_time=0.0)] == [[0.5]]


@pytest.mark.parametrize("text", [b"", b"{}", b'{"schema":1,"name":"x","channels":[]}', b"\xff", b"[" * 5000])
def test_a_description_that_is_none_is_bad_and_changes_nothing(text: bytes) -> None:
    decoder = PacketDecoder()
    decoder.feed(b"\0" + packed(b"\x01\x01\0\0" + text), host_time=0.0)
    assert decoder.stream is None and decoder.bad == 1


def test_a_stream_with_too_long_a_description_is_refused() -> None:
    with pytest.raises(InputError, match="shorter names"):
        Layout(Stream("s", tuple(Channel("x" * 100 + str(k)) for k in range(300)), 100.0))


@given(st.lists(st.binary(max_size=200), max_size=20))
def test_no_bytes_crash_a_decoder(pieces: list[bytes]) -> None:
    decoder = AnyDecoder()
    for piece in pieces:
        decoder.feed(piece, host_time=0.0)
    layout = Layout(Stream("s", (Channel("a"),), 100.0))
    before = PacketDecoder()
    before.feed(layout.description, host_time=0.0)
    for piece in pieces:
        before.feed(piece, host_time=0.0)
    # What can be made with a right checksum by chance is no frame either: it would have to name the layout.
    frame = Frame(0.0, 0.0, 1, np.array([1.0]), np.array([True]), np.array([False]))
    assert len(before.feed(b"\0" + layout.frame_packet(frame), host_time=0.0)) == 1


@given(st.binary(max_size=100))
def test_no_body_with_a_right_checksum_crashes_a_decoder(body: bytes) -> None:
    layout = Layout(Stream("s", (Channel("a"),), 100.0))
    decoder = PacketDecoder()
    decoder.feed(layout.description, host_time=0.0)
    for head in (b"", b"\x01\x01", b"\x01\x02" + layout.number.to_bytes(2, "little"), b"\x01\x03"):
        decoder.feed(packed(head + body or b"\0"), host_time=0.0)
    assert decoder.stream == layout.stream
