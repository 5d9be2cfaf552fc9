"""Ways to send frames over a wire, each with the reader that is usually written for it: what the readout is measured beside."""

from __future__ import annotations

import binascii
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import reduce
from operator import xor

import numpy as np
from numpy.typing import NDArray

from skinfab.readout.ascii_lines import LineDecoder
from skinfab.readout.decode import PacketDecoder
from skinfab.readout.frame import Channel, Frame, Stream
from skinfab.readout.packets import Layout

#: What the project's own firmware is told to send.
DEFAULT = "COBS + CRC-16"

#: A frame as it was read: its number and its values.
Read = tuple[int, tuple[float, ...]]

_SYNC = b"\xaa\x55"
_LONGEST = 256


@dataclass(frozen=True)
class Framing:
    """One way to send.

    Parameters
    ----------
    encode : callable
        Frames, (n, c) whole numbers, to one string of bytes.
    decode : callable
        Bytes to the frames that are read from it.
    """

    encode: Callable[[NDArray[np.int64]], bytes]
    decode: Callable[[bytes], Sequence[Read]]


def _stream(channels: int) -> Stream:
    return Stream("bench", tuple(Channel(f"S{k + 1}") for k in range(channels)), 100.0)


def _lines(values: NDArray[np.int64]) -> list[bytes]:
    return [f"{k},{','.join(map(str, row))}".encode() for k, row in enumerate(values.tolist())]


def encode_ascii(values: NDArray[np.int64]) -> bytes:
    """Lines of numbers."""
    return b"".join(line + b"\n" for line in _lines(values))


def ascii_decoder(channels: int) -> Callable[[bytes], list[Read]]:
    """The project's own reader of lines, which takes plain numbers alone and the right number of them."""

    def decode(data: bytes) -> list[Read]:
        decoder = LineDecoder()
        decoder.feed(("\nsequence," + ",".join(_stream(channels).names) + "\n").encode(), host_time=0.0)
        return [(frame.sequence, tuple(frame.values.tolist())) for frame in decoder.feed(b"\n" + data, host_time=0.0)]

    return decode


def encode_summed(values: NDArray[np.int64]) -> bytes:
    """Lines of numbers with the exclusive or of their bytes behind them, as NMEA 0183 has it."""
    return b"".join(line + b"*%02X\n" % reduce(xor, line) for line in _lines(values))


def summed_decoder(channels: int) -> Callable[[bytes], list[Read]]:
    """Lines whose checksum fits, with the right number of numbers."""

    def decode(data: bytes) -> list[Read]:
        out = []
        for line in data.split(b"\n"):
            body, star, told = line.rpartition(b"*")
            if not star or told != b"%02X" % reduce(xor, body, 0):
                continue
            cells = body.split(b",")
            if len(cells) == channels + 1 and all(cell.lstrip(b"-").isdigit() for cell in cells):
                out.append((int(cells[0]), tuple(float(cell) for cell in cells[1:])))
        return out

    return decode


def _body(k: int, row: NDArray[np.int64]) -> bytes:
    return struct.pack("<I", k) + row.astype("<f4").tobytes()


def encode_sync(values: NDArray[np.int64]) -> bytes:
    """Two bytes to begin with, a length, and the same checksum as ours."""
    bodies = (_body(k, row) for k, row in enumerate(values))
    return b"".join(_SYNC + struct.pack("<H", len(b)) + b + struct.pack("<H", binascii.crc_hqx(b, 0xFFFF)) for b in bodies)


def sync_decoder(channels: int) -> Callable[[bytes], list[Read]]:
    """Looks for the two bytes, believes the length that follows, and tries the checksum."""

    def decode(data: bytes) -> list[Read]:
        out, at = [], data.find(_SYNC)
        while 0 <= at <= len(data) - 6:
            (size,) = struct.unpack_from("<H", data, at + 2)
            body = data[at + 4 : at + 4 + size]
            if size == 4 + 4 * channels <= _LONGEST and data[at + 4 + size : at + 6 + size] == struct.pack(
                "<H", binascii.crc_hqx(body, 0xFFFF)
            ):
                out.append((struct.unpack_from("<I", body)[0], tuple(np.frombuffer(body, "<f4", offset=4).tolist())))
                at += 6 + size
            else:
                at += 1
            at = data.find(_SYNC, at)
        return out

    return decode


def encode_cobs(values: NDArray[np.int64]) -> bytes:
    """The project's packets."""
    c = values.shape[1]
    layout, fine, free = Layout(_stream(c)), np.ones(c, dtype=bool), np.zeros(c, dtype=bool)
    return b"".join(layout.frame_packet(Frame(k / 100, 0.0, k, row.astype(float), fine, free)) for k, row in enumerate(values))


def cobs_decoder(channels: int) -> Callable[[bytes], list[Read]]:
    """The project's reader, once it has had the description."""

    def decode(data: bytes) -> list[Read]:
        decoder = PacketDecoder()
        decoder.feed(Layout(_stream(channels)).description, host_time=0.0)
        return [(frame.sequence, tuple(frame.values.tolist())) for frame in decoder.feed(data, host_time=0.0)]

    return decode


def framings(channels: int) -> dict[str, Framing]:
    """All of them, for so many channels.

    Examples
    --------
    >>> values = np.arange(6).reshape(3, 2)
    >>> {name: len(way.decode(way.encode(values))) for name, way in framings(2).items()}
    {'ASCII': 3, 'ASCII + sum': 3, 'sync + length + CRC-16': 3, 'COBS + CRC-16': 3}
    """
    return {
        "ASCII": Framing(encode_ascii, ascii_decoder(channels)),
        "ASCII + sum": Framing(encode_summed, summed_decoder(channels)),
        "sync + length + CRC-16": Framing(encode_sync, sync_decoder(channels)),
        DEFAULT: Framing(encode_cobs, cobs_decoder(channels)),
    }
