"""From a stream of bytes to whole packets: COBS marks where each one ends, a CRC-16 tells whether it is what was sent.

Cutting bytes into pieces knows nothing of what is in them, so that garbage, a lost byte or a packet half sent costs the
pieces it touches and nothing after the next end mark.

Consistent Overhead Byte Stuffing: Cheshire and Baker, IEEE/ACM Transactions on Networking 7 (1999) 159. The checksum is
CRC-16/IBM-3740 (polynomial 0x1021, start 0xFFFF, not mirrored, not inverted; of ``123456789`` it is 0x29B1).
"""

from __future__ import annotations

import binascii

from cobs import cobs

#: What ends a packet: the one byte that COBS leaves out of it.
END = b"\0"

#: Bytes between two end marks that are still taken for a packet. A description of 100 channels has about 9000.
LONGEST = 16_384

_CRC_START = 0xFFFF
_CRC_BYTES = 2


class Splitter:
    """Cuts bytes at an end mark, as they come, and never keeps more than `longest` of them.

    Parameters
    ----------
    end : bytes
        One byte.
    longest : int
        A longer piece is thrown away up to its end mark.

    Examples
    --------
    >>> splitter = Splitter()
    >>> splitter.feed(b"ab\\0c"), splitter.feed(b"d\\0\\0e")
    ([b'ab'], [b'cd'])
    >>> splitter.feed(b"x" * 20_000 + b"\\0f\\0"), splitter.overlong
    ([b'f'], 1)
    """

    def __init__(self, *, end: bytes = END, longest: int = LONGEST) -> None:
        self._end, self._longest = end, longest
        self._kept = bytearray()
        self._skipping = False
        #: Pieces that were too long so far.
        self.overlong = 0

    @property
    def kept(self) -> int:
        """Bytes that wait for their end mark."""
        return len(self._kept)

    def feed(self, data: bytes) -> list[bytes]:
        """The pieces that these bytes complete, without their end marks; empty ones are left out."""
        *whole, rest = data.split(self._end)
        out: list[bytes] = []
        for piece in whole:
            self._keep(piece)
            if self._kept and not self._skipping:
                out.append(bytes(self._kept))
            self.reset()
        self._keep(rest)
        return out

    def reset(self) -> None:
        """Forget the piece that has begun: what comes next is the beginning of another one."""
        self._kept.clear()
        self._skipping = False

    def _keep(self, part: bytes) -> None:
        if self._skipping:
            return
        if len(self._kept) + len(part) > self._longest:
            self._kept.clear()
            self._skipping = True
            self.overlong += 1
        else:
            self._kept += part


def crc16(data: bytes) -> int:
    """CRC-16/IBM-3740.

    Examples
    --------
    >>> hex(crc16(b"123456789"))
    '0x29b1'
    """
    return binascii.crc_hqx(data, _CRC_START)


def packed(body: bytes) -> bytes:
    """What goes over the wire for a packet's body: checksum appended, stuffed, end mark behind.

    Examples
    --------
    >>> packed(b"\\x01\\x00").hex(" ")
    '02 01 03 3e 2e 00'
    """
    return bytes(cobs.encode(body + crc16(body).to_bytes(_CRC_BYTES, "little"))) + END


def unpacked(piece: bytes) -> bytes | None:
    """The body of a packet that came whole (without its end mark); None for anything else.

    Examples
    --------
    >>> unpacked(packed(b"strain")[:-1]), unpacked(b"garbage")
    (b'strain', None)
    """
    try:
        whole = bytes(cobs.decode(piece))
    except cobs.DecodeError:
        return None
    body, sent = whole[:-_CRC_BYTES], whole[-_CRC_BYTES:]
    if not body or crc16(body) != int.from_bytes(sent, "little"):
        return None
    return body
