"""One picture file as a grey image."""

from __future__ import annotations

import io
import os
import struct
import threading
import warnings
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from skinfab.errors import InputError
from skinfab.fingertip.optical.pins import Image

#: What is taken for a picture in a folder.
SUFFIXES = (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".pgm")
#: What a simulator writes into its pictures, near their beginning.
_SIMULATED, _HEAD = b"simulated: true", 4096
#: More is no picture of a sensor's camera: a few hundred bytes can claim a thousand million pixels. Three bytes of colour each.
MOST_PIXELS = 50_000_000
MAX_BYTES = 4 * MOST_PIXELS
_PNG = b"\x89PNG\r\n\x1a\n"


@dataclass
class _Hush:
    """OpenCV has one level of its log for all threads: who comes first sets it, and who goes last gives it back."""

    lock: threading.Lock
    users: int = 0
    before: int = 0


_HUSH = _Hush(threading.Lock())


@contextmanager
def opencv_silent() -> Iterator[None]:
    """OpenCV's own warnings, and those of the video reader in it, say nothing that the error does not; in several threads at once, too."""
    log = cv2.utils.logging
    with _HUSH.lock:
        if _HUSH.users == 0:
            _HUSH.before = log.getLogLevel()
            log.setLogLevel(log.LOG_LEVEL_SILENT)
            os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
        _HUSH.users += 1
    try:
        yield
    finally:
        with _HUSH.lock:
            _HUSH.users -= 1
            if _HUSH.users == 0:
                log.setLogLevel(_HUSH.before)


def read_picture(path: str | Path) -> tuple[Image, bool]:
    """A picture in grey, (h, w) uint8, and whether it says that it is simulated.

    Raises
    ------
    InputError
        There is no such file, or it is no picture, or larger than any camera's.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "one.png"
    >>> _ = cv2.imwrite(str(path), np.full((20, 30), 7, np.uint8))
    >>> image, simulated = read_picture(path)
    >>> image.shape, int(image[0, 0]), simulated
    ((20, 30), 7, False)
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as fault:  # ValueError: a null byte in its name
        raise InputError(f"{path}: {getattr(fault, 'strerror', None) or fault}; give a picture that can be read") from fault
    if len(data) > MAX_BYTES or _pixels(data) > MOST_PIXELS:
        raise InputError(f"{path} is a picture of more than {MOST_PIXELS // 10**6} million pixels; give those of the sensor's camera")
    try:
        with opencv_silent():
            image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_GRAYSCALE) if data and not _damaged(data) else None
    except cv2.error:
        image = None
    if image is None:
        raise InputError(f"{path} is no picture that can be read; give PNG, JPEG, BMP, TIFF or PGM, whole")
    return image.astype(np.uint8, copy=False), _SIMULATED in data[:_HEAD]


def _damaged(data: bytes) -> bool:
    """Is it a PNG whose chunks are not whole?

    libpng would print a line of its own on that, past everything that is set here, and OpenCV take 4 GB because a
    chunk's length says so.
    """
    if not data.startswith(_PNG):
        return False
    at = len(_PNG)
    while at + 12 <= len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        end = at + 8 + length
        if end + 4 > len(data) or zlib.crc32(data[at + 4 : end]) != int.from_bytes(data[end : end + 4], "big"):
            return True
        if kind == b"IEND":
            return False
        at = end + 4
    return True


def _pixels(data: bytes) -> int:
    """How many pixels a picture claims to have; 0 where its heading is not understood here: OpenCV itself stops at 2^30."""
    from PIL import Image as Headings

    with _HUSH.lock, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        warnings.simplefilter("error", Headings.DecompressionBombWarning)
        try:
            with Headings.open(io.BytesIO(data)) as heading:
                return int(heading.width * heading.height)
        except (Headings.DecompressionBombWarning, Headings.DecompressionBombError):
            return MOST_PIXELS + 1
        except (OSError, ValueError, OverflowError):
            return 0
