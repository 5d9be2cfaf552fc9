"""One picture file as a grey image."""

from __future__ import annotations

import os
import threading
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
        There is no such file, or it is no picture.

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
        data = path.read_bytes()
    except OSError as fault:
        raise InputError(f"{path}: {fault.strerror or fault}; give a picture that can be read") from fault
    try:
        with opencv_silent():
            image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_GRAYSCALE) if data and not _cut_off(data) else None
    except cv2.error:
        image = None
    if image is None:
        raise InputError(f"{path} is no picture that can be read; give PNG, JPEG, BMP, TIFF or PGM, whole")
    return image.astype(np.uint8, copy=False), _SIMULATED in data[:_HEAD]


def _cut_off(data: bytes) -> bool:
    """Is it a PNG without its end? libpng would print a line of its own on that, past everything that is set here."""
    return data.startswith(b"\x89PNG") and b"IEND" not in data[-1024:]
