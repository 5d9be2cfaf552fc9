"""Packets come back as they went, damage is seen, and no amount of garbage is kept."""

import binascii

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from skinfab.readout.framing import END, LONGEST, Splitter, crc16, packed, unpacked


def slow_crc(data: bytes) -> int:
    """The polynomial division as a firmware writes it."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc


@given(st.binary(max_size=600))
def test_checksum_is_the_one_that_the_document_names(data: bytes) -> None:
    assert crc16(data) == slow_crc(data) == binascii.crc_hqx(data, 0xFFFF)


@given(st.binary(min_size=1, max_size=2000))
def test_a_packet_comes_back_and_has_one_end_mark(body: bytes) -> None:
    sent = packed(body)
    assert sent.count(END) == 1 and sent.endswith(END)
    assert unpacked(sent[:-1]) == body


@given(st.binary(min_size=1, max_size=300), st.data())
def test_damage_never_passes_for_what_was_sent(body: bytes, data: st.DataObject) -> None:
    sent = packed(body)[:-1]
    at = data.draw(st.integers(0, len(sent) - 1))
    assert unpacked(sent[:at] + sent[at + 1 :]) != body
    assert unpacked(sent[:at] + bytes([sent[at] ^ data.draw(st.integers(1, 255))]) + sent[at + 1 :]) != body


def test_damage_is_seen_all_but_once_in_65536() -> None:
    rng = np.random.default_rng(0)
    passed = 0
    for _ in range(20_000):
        sent = bytearray(packed(rng.bytes(40))[:-1])
        if rng.random() < 0.5:
            del sent[int(rng.integers(len(sent)))]
        else:
            sent[int(rng.integers(len(sent)))] ^= 1 << int(rng.integers(8))
        passed += unpacked(bytes(sent)) is not None
    assert passed <= 3


@given(st.lists(st.binary(min_size=1, max_size=80), max_size=20), st.lists(st.integers(1, 90), min_size=1, max_size=50))
def test_however_the_bytes_arrive_the_pieces_are_the_same(bodies: list[bytes], steps: list[int]) -> None:
    data = b"".join(packed(body) for body in bodies)
    splitter, found, at, k = Splitter(), [], 0, 0
    while at < len(data):
        found += splitter.feed(data[at : at + steps[k % len(steps)]])
        at, k = at + steps[k % len(steps)], k + 1
    assert [unpacked(piece) for piece in found] == bodies


def test_endless_garbage_is_not_kept() -> None:
    splitter = Splitter()
    garbage = bytes(np.random.default_rng(0).integers(1, 256, 100_000, dtype=np.uint8))
    for _ in range(100):
        assert splitter.feed(garbage) == []
        assert splitter.kept <= LONGEST
    assert splitter.overlong == 1
    assert splitter.feed(END + packed(b"after")) == [packed(b"after")[:-1]]
