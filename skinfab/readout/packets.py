"""What is in a packet: the description of a stream, or one frame of it. Byte by byte it is told in docs/readout.md.

All numbers are little-endian and lie where a C struct without packing has them::

    description   u8 version = 1   u8 kind = 1   u16 0        JSON in UTF-8
    frame         u8 version = 1   u8 kind       u16 layout   u32 sequence   u64 device time, us   values   valid   saturated
    recorded      u8 version = 1   u8 kind = 4   u16 layout   u32 0          i64 sequence
                  f64 device time, s   f64 host time, s                      values   valid   saturated

Values are float32 (kind 2) or float64 (kinds 3 and 4); valid and saturated are one bit a channel, the first channel the
lowest bit of the first byte. `layout` is the checksum of the description that the frame belongs to: a frame is never read
with another device's channels.
"""

from __future__ import annotations

import json
import struct

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.readout.description import stream_of_json, stream_to_json
from skinfab.readout.frame import BoolArray, Frame, Stream
from skinfab.readout.framing import LONGEST, crc16, packed

VERSION = 1
DESCRIPTION, FRAME_32, FRAME_64, RECORDED = 1, 2, 3, 4

#: Bits of the sequence number in a frame.
SEQUENCE_BITS = 32

_HEAD = struct.Struct("<BBH")
_FRAME = struct.Struct("<BBHIQ")
_RECORDED = struct.Struct("<BBHIqdd")
_VALUE: dict[int, np.dtype[np.float32] | np.dtype[np.float64]] = {
    FRAME_32: np.dtype("<f4"),
    FRAME_64: np.dtype("<f8"),
    RECORDED: np.dtype("<f8"),
}
_US = 1e6


class Layout:
    """How the frames of one stream lie in their packets.

    Parameters
    ----------
    stream : Stream

    Raises
    ------
    InputError
        Its description does not fit into a packet.

    Examples
    --------
    >>> from skinfab.readout.frame import Channel
    >>> from skinfab.readout.framing import unpacked
    >>> layout = Layout(Stream("one", (Channel("U", "V"),), 100.0))
    >>> frame = Frame(1.5, 0.0, 7, np.array([0.25]), np.array([True]), np.array([False]))
    >>> back = layout.frame(unpacked(layout.frame_packet(frame)[:-1]), host_time=9.0)
    >>> back.device_time, back.sequence, back.values
    (1.5, 7, array([0.25]))
    """

    def __init__(self, stream: Stream) -> None:
        self.stream = stream
        body = _HEAD.pack(VERSION, DESCRIPTION, 0) + _in_few_words(stream).encode()
        #: The packet that says what the channels are.
        self.description = packed(body)
        if len(self.description) > LONGEST:
            raise InputError(
                f"stream {stream.name}: its description takes {len(self.description)} bytes, and a packet has {LONGEST} at most; "
                "give the channels shorter names, or cut the stream in two"
            )
        self._take_number(crc16(body))

    @classmethod
    def of_description(cls, body: bytes) -> Layout:
        """Of a description's body as it came: its number is that of the sender's own words.

        Raises
        ------
        InputError
            It is none, or of a version that is not known here.
        """
        version, kind, _ = _HEAD.unpack_from(body)
        if version != VERSION or kind != DESCRIPTION:
            raise InputError(f"a packet of version {version}, kind {kind} is no description of version {VERSION}; update skinfab")
        stream = stream_of_json(body[_HEAD.size :])
        if not stream.channels:
            raise InputError(f"stream {stream.name} has no channel; nothing can be read from it")
        layout = cls(stream)
        layout._take_number(crc16(body))
        return layout

    def _take_number(self, number: int) -> None:
        self.number = number
        channels = self.stream.channels
        self._masks = (len(channels) + 7) // 8
        # Compared with what the ends are in four bytes: 3.3 V sent as float32 is 3.29999995.
        self._low = np.array([channel.low for channel in channels], dtype=np.float32).astype(float)
        self._high = np.array([channel.high for channel in channels], dtype=np.float32).astype(float)

    def size(self, kind: int) -> int:
        """Bytes in a body of this kind."""
        head = _RECORDED.size if kind == RECORDED else _FRAME.size
        return head + len(self.stream.channels) * _VALUE[kind].itemsize + 2 * self._masks

    def frame_packet(self, frame: Frame, *, kind: int = FRAME_32) -> bytes:
        """A frame as a device sends it (the host time stays here).

        Raises
        ------
        InputError
            It has another number of channels, or a time that no device has.
        """
        us = round(frame.device_time * _US)
        if not 0 <= us < 1 << 64:
            raise InputError(
                f"frame {frame.sequence}: a device time of {frame.device_time:g} s cannot be sent; count from the device's start"
            )
        head = _FRAME.pack(VERSION, kind, self.number, frame.sequence % (1 << SEQUENCE_BITS), us)
        return packed(head + self._tail(frame, kind))

    def recorded_packet(self, frame: Frame) -> bytes:
        """A frame with all that is known of it, exactly."""
        head = _RECORDED.pack(VERSION, RECORDED, self.number, 0, frame.sequence, frame.device_time, frame.host_time)
        return packed(head + self._tail(frame, RECORDED))

    def _tail(self, frame: Frame, kind: int) -> bytes:
        if len(frame.values) != len(self.stream.channels):
            raise InputError(f"frame {frame.sequence} has {len(frame.values)} values; its stream has {len(self.stream.channels)} channels")
        with np.errstate(over="ignore"):  # what is too large for four bytes is sent as infinite: not valid
            values = frame.values.astype(_VALUE[kind]).tobytes()
        return values + _bits(frame.valid) + _bits(frame.saturated)

    def frame(self, body: bytes, *, host_time: float) -> Frame | None:
        """The frame in a body of kind 2 or 3; None where it is not one of this stream.

        Its sequence number is the counter as it was sent. A value that is not finite is not valid; one at an end of its
        channel's range is saturated, whether or not the device said so.
        """
        if len(body) < _FRAME.size:
            return None
        version, kind, number, counter, us = _FRAME.unpack_from(body)
        if version != VERSION or kind not in (FRAME_32, FRAME_64) or number != self.number or len(body) != self.size(kind):
            return None
        n = len(self.stream.channels)
        masks = np.frombuffer(body, np.uint8, offset=len(body) - 2 * self._masks).reshape(2, -1)
        bits = np.unpackbits(masks, axis=1, bitorder="little").astype(bool)
        if bits[:, n:].any():
            return None
        values = np.frombuffer(body, _VALUE[kind], n, _FRAME.size).astype(float)
        with np.errstate(invalid="ignore"):
            saturated = bits[1, :n] | (values <= self._low) & np.isfinite(self._low) | (values >= self._high) & np.isfinite(self._high)
        return Frame(us / _US, host_time, counter, values, bits[0, :n] & np.isfinite(values), saturated)

    def recorded_type(self) -> np.dtype[np.void]:
        """The body of a recorded frame as a row of a table."""
        n = len(self.stream.channels)
        return np.dtype(
            [
                ("version", "u1"),
                ("kind", "u1"),
                ("layout", "<u2"),
                ("zero", "<u4"),
                ("sequence", "<i8"),
                ("device_time", "<f8"),
                ("host_time", "<f8"),
                ("values", "<f8", (n,)),
                ("valid", "u1", (self._masks,)),
                ("saturated", "u1", (self._masks,)),
            ]
        )


def kind_of(body: bytes) -> int | None:
    """What kind of packet a body is; None where it is none of this version."""
    if len(body) < _HEAD.size or body[0] != VERSION or body[1] not in (DESCRIPTION, FRAME_32, FRAME_64, RECORDED):
        return None
    return body[1]


def _in_few_words(stream: Stream) -> str:
    """The description without what says nothing: each byte less is one less that can be hurt."""
    said = json.loads(stream_to_json(stream))
    said["channels"] = [
        {key: value for key, value in each.items() if value not in ("", None) and not (key in ("board", "input") and not each["board"])}
        for each in said["channels"]
    ]
    return json.dumps(said, separators=(",", ":"), ensure_ascii=False, allow_nan=False)


def _bits(flags: BoolArray) -> bytes:
    packed_flags: NDArray[np.uint8] = np.packbits(flags, bitorder="little")
    return packed_flags.tobytes()
