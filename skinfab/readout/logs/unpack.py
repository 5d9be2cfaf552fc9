"""Packed blocks are unpacked within bounds, whatever their headers claim, and what is damaged is told from what is whole."""

from __future__ import annotations

import bz2
import io
import struct

from skinfab.errors import InputError

#: All of a log, unpacked. More is read as several logs.
MAX_BYTES = 2_000_000_000
#: A log that unpacks to more than `FREE_BYTES` and more than this many times its own size is a bomb: times alone, which
#: differ from frame to frame, keep a real one of constant readings below 40.
MAX_RATIO = 200
FREE_BYTES = 64_000_000


class DamagedError(Exception):
    """The file is cut off or damaged from here on; what was read before is whole."""


class Budget:
    """How many bytes a log may still unpack to.

    Parameters
    ----------
    size : int
        Of the file.

    Examples
    --------
    >>> budget = Budget(1_000_000)
    >>> budget.take(150_000_000)
    >>> budget.left
    50000000
    """

    def __init__(self, size: int) -> None:
        self._size = size
        self.left = min(MAX_BYTES, max(FREE_BYTES, MAX_RATIO * size))

    def take(self, count: int) -> None:
        """Count bytes that were unpacked.

        Raises
        ------
        InputError
            They are too many for a log of this size.
        """
        if count > self.left:
            raise InputError(
                f"it unpacks to more than {min(MAX_BYTES, max(FREE_BYTES, MAX_RATIO * self._size)):,} bytes from {self._size:,}, "
                "which no log does; refused as a zip bomb (a log that is merely long must be cut into parts)"
            )
        self.left -= count


def unpack(packing: str, data: bytes, size: int, budget: Budget) -> bytes:
    """The `size` bytes that are packed in `data`.

    Parameters
    ----------
    packing : str
        ``zstd``, ``lz4``, ``bz2``; ``none`` or empty for none at all.
    data : bytes
    size : int
        As the file states it.
    budget : Budget

    Raises
    ------
    DamagedError
        They cannot be unpacked, or are not as many as stated.
    InputError
        An unknown packing, or a bomb.

    Examples
    --------
    >>> unpack("bz2", bz2.compress(b"abc"), 3, Budget(100))
    b'abc'
    """
    budget.take(size)
    if packing in ("", "none"):
        out = data
    elif packing == "zstd":
        out = _zstd(data, size)
    elif packing == "lz4":
        out = _lz4(data, size)
    elif packing == "bz2":
        out = _bz2(data, size)
    else:
        raise InputError(f"its blocks are packed by {packing!r}, and only zstd, lz4 and bz2 are read; store it in one of these")
    if len(out) != size:
        raise DamagedError(f"a block that should unpack to {size:,} bytes unpacks to {'more' if len(out) > size else f'{len(out):,}'}")
    return out


def _zstd(data: bytes, size: int) -> bytes:
    import zstandard

    try:
        # The one-call function believes the size in the packed data's own header; the reader stops where it is told.
        return zstandard.ZstdDecompressor().stream_reader(io.BytesIO(data)).read(size + 1)
    except zstandard.ZstdError as fault:
        raise DamagedError(str(fault)) from fault


def _lz4(data: bytes, size: int) -> bytes:
    import lz4.frame

    try:
        return bytes(lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=size + 1))
    except (RuntimeError, EOFError) as fault:
        raise DamagedError(str(fault)) from fault


def _bz2(data: bytes, size: int) -> bytes:
    try:
        return bz2.BZ2Decompressor().decompress(data, max_length=size + 1)
    except (OSError, EOFError, ValueError) as fault:
        raise DamagedError(str(fault)) from fault


class Cursor:
    """Reads fields from bytes, and never beyond their end.

    Examples
    --------
    >>> cursor = Cursor(bytes([2, 0, 0, 0]) + b"ab!")
    >>> cursor.sized("<I"), cursor.left
    (b'ab', 1)
    """

    def __init__(self, data: bytes) -> None:
        self._data = data
        self.at = 0

    @property
    def left(self) -> int:
        """How many bytes there still are."""
        return len(self._data) - self.at

    def take(self, count: int) -> bytes:
        """The next bytes.

        Raises
        ------
        DamagedError
            There are not so many.
        """
        if count > self.left:
            raise DamagedError(f"{count:,} bytes should follow and {self.left:,} do")
        self.at += count
        return self._data[self.at - count : self.at]

    def number(self, form: str) -> int:
        """A number in the form of `struct`."""
        return int(struct.unpack(form, self.take(struct.calcsize(form)))[0])

    def sized(self, form: str) -> bytes:
        """Bytes behind their count."""
        return self.take(self.number(form))
