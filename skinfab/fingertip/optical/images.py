"""Images as they come from a folder or a video, with the times and counts that a readout source has."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import TracebackType
from typing import Any, Protocol, Self

import cv2
import numpy as np

from skinfab.errors import InputError
from skinfab.fingertip.optical.picture import SUFFIXES, opencv_silent, read_picture
from skinfab.fingertip.optical.pins import Image
from skinfab.readout.source import Counts, HostClock

#: A folder's pictures say no time: so many count as a second, which is a plain camera's rate.
RATE_HZ = 30.0
#: A step of a video's time beyond so many of its usual ones is pictures lost.
_STEP = 1.5


@dataclass(frozen=True, eq=False)
class Picture:
    """One image and when it was taken.

    Parameters
    ----------
    image : (h, w) uint8
    name : str
        The file's, or what number it is.
    device_time : float, s
        Since the first one.
    host_time : float, s
        When it reached this computer, since 1970.
    sequence : int
        A step of more than one is pictures lost.
    """

    image: Image
    name: str
    device_time: float
    host_time: float
    sequence: int


class ImageSource(Protocol):
    """Pictures, one at a time: ``with source: for picture in source: ...``."""

    name: str
    rate_hz: float
    simulated: bool
    notes: list[str]

    @property
    def counts(self) -> Counts: ...

    def open(self) -> Self: ...

    def close(self) -> None: ...

    def read(self, timeout: float | None = None) -> Picture | None:
        """The next one; None after `timeout` seconds without one, or at the end."""
        ...

    @property
    def ended(self) -> bool:
        """There will be no more."""
        ...


class Pictures(ABC):
    """What every image source is alike in."""

    def __init__(self, name: str, rate_hz: float) -> None:
        self.name, self.rate_hz, self.simulated = name, rate_hz, False
        self.notes: list[str] = []
        self.counts = Counts()
        self.ended = False

    def __iter__(self) -> Iterator[Picture]:
        while (one := self.read()) is not None:
            yield one

    def __enter__(self) -> Self:
        return self.open()

    def __exit__(self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    @abstractmethod
    def open(self) -> Self: ...

    @abstractmethod
    def close(self) -> None: ...

    @abstractmethod
    def read(self, timeout: float | None = None) -> Picture | None: ...


class FolderImages(Pictures):
    """The pictures of a folder, in the order of the numbers in their names.

    Files that are no whole picture are counted as bad; the first of them is named in `notes`, with their number.

    Parameters
    ----------
    folder : path
    rate_hz : float
        At which they count as taken.

    Raises
    ------
    InputError
        There is no such folder, or no picture in it.
    """

    def __init__(self, folder: str | Path, *, rate_hz: float = RATE_HZ) -> None:
        self._folder = Path(folder)
        super().__init__(self._folder.name or str(folder), rate_hz)
        try:
            files = [path for path in self._folder.iterdir() if path.suffix.lower() in SUFFIXES]
        except OSError as fault:
            raise InputError(f"{folder}: {fault.strerror or fault}; give a folder of pictures") from fault
        if not files:
            raise InputError(f"{folder} holds no picture ({', '.join(SUFFIXES)}); give a folder of pictures")
        self._files = sorted(files, key=_natural)
        self.simulated = read_any_simulated(self._files)

    def open(self) -> Self:
        """Begin from the first one."""
        self._next, self._clock = 0, HostClock()
        self._passed: dict[str, tuple[str, int]] = {}
        self.counts, self.ended = Counts(), False
        self.notes.clear()
        return self

    def close(self) -> None:
        """Give no more."""
        self.ended = True

    def read(self, timeout: float | None = None) -> Picture | None:
        """The next whole picture; None at the end."""
        while not self.ended and self._next < len(self._files):
            k, path = self._next, self._files[self._next]
            self._next += 1
            try:
                image, _ = read_picture(path)
            except InputError as fault:
                self.counts = replace(self.counts, bad=self.counts.bad + 1)
                self._note("unreadable", str(fault))
                continue
            self.counts = replace(self.counts, frames=self.counts.frames + 1)
            return Picture(image, path.name, k / self.rate_hz, self._clock.now(), k)
        self.ended = True
        return None

    def pass_over(self, picture: Picture, why: str) -> None:
        """Count the last picture among the bad ones after all, and say why."""
        self.counts = replace(self.counts, frames=self.counts.frames - 1, bad=self.counts.bad + 1)
        height, width = picture.image.shape
        self._note("size", f"{picture.name} is of {width} x {height} pixels, {why}")

    def _note(self, kind: str, what: str) -> None:
        """Name the first of a kind and count the others: of a folder for another model there may be ten thousand."""
        first, count = self._passed.get(kind, (what, 0))
        self._passed[kind] = first, count + 1
        self.notes[:] = [f"{said}; it was passed over{_more(count - 1)}" for said, count in self._passed.values()]


def _more(count: int) -> str:
    """
    Examples
    --------
    >>> _more(0), _more(1), _more(2)
    ('', ', as was one more', ', as were 2 others')
    """
    return "" if count == 0 else ", as was one more" if count == 1 else f", as were {count} others"


def read_any_simulated(files: list[Path]) -> bool:
    """Does the first or the last of the pictures say that it is simulated? Broken ones say nothing."""
    for path in (files[0], files[-1]):
        try:
            if read_picture(path)[1]:
                return True
        except InputError:
            continue  # named when it is its turn
    return False


def _natural(path: Path) -> list[tuple[int, int | str]]:
    """
    Examples
    --------
    >>> [p.name for p in sorted(map(Path, ["a10.png", "a9.png", "a.png"]), key=_natural)]
    ['a.png', 'a9.png', 'a10.png']
    """
    return [(0, int(part)) if part.isdecimal() else (1, part) for part in re.split(r"(\d+)", path.stem) if part]


class VideoImages(Pictures):
    """The pictures of a video file; what is missing by its own times, or cut off, is counted as lost.

    Parameters
    ----------
    path : path

    Raises
    ------
    InputError
        On opening: there is no such file, or it is no video that can be read.
    """

    def __init__(self, path: str | Path) -> None:
        self._path = Path(path)
        if not self._path.is_file():
            raise InputError(f"{path}: no such file; give a video, a folder of pictures or a camera's number")
        super().__init__(self._path.name, 0.0)
        capture = _open_file(self._path, f"{path} is no video that can be read; give AVI, MP4 or MKV in a usual coding")
        self.rate_hz = float(capture.get(cv2.CAP_PROP_FPS)) or RATE_HZ
        capture.release()

    def open(self) -> Self:
        """Begin from the first one."""
        self._capture = _open_file(self._path, f"{self._path} cannot be read any more; look whether it is still there")
        self._all = int(self._capture.get(cv2.CAP_PROP_FRAME_COUNT))
        self._clock, self._sequence, self._time = HostClock(), -1, -1 / self.rate_hz
        self.counts, self.ended = Counts(), False
        self.notes.clear()
        return self

    def close(self) -> None:
        """Give no more."""
        self._capture.release()
        self.ended = True

    def read(self, timeout: float | None = None) -> Picture | None:
        """The next one; None at the end."""
        if self.ended:
            return None
        whole, raw = self._capture.read()
        if not whole:
            self.ended = True
            if (left := self._all - 1 - self._sequence) > 0:
                self.counts = replace(self.counts, lost=self.counts.lost + left)
                self.notes.append(f"{self._path} says that it has {self._all} pictures, and the last {left} cannot be read: it is cut off")
            return None
        at = max(float(self._capture.get(cv2.CAP_PROP_POS_MSEC)) / 1000, self._time)
        gone = max(round((at - self._time) * self.rate_hz) - 1, 0) if (at - self._time) * self.rate_hz > _STEP else 0
        self._sequence += 1 + gone
        self._time = at
        self.counts = replace(self.counts, frames=self.counts.frames + 1, lost=self.counts.lost + gone)
        return Picture(grey(raw), f"{self._sequence + 1}", at, self._clock.now(), self._sequence)


def _open_file(path: Path, wrong: str) -> Any:
    """A video; where there is FFmpeg no other reader is asked, as OpenCV's own one prints a line on an AVI that is cut off."""
    known = cv2.CAP_FFMPEG in cv2.videoio_registry.getStreamBackends()
    return open_capture(str(path), wrong, backend=cv2.CAP_FFMPEG if known else cv2.CAP_ANY)


def open_capture(what: int | str, wrong: str, *, backend: int = cv2.CAP_ANY, settings: Sequence[int] = ()) -> Any:
    """A capture of OpenCV; `settings` are its properties and values in turn.

    Raises
    ------
    InputError
        It cannot be opened; in the words of `wrong`.
    """
    with opencv_silent():
        capture = cv2.VideoCapture(what, backend, list(settings))
    if not capture.isOpened():
        capture.release()
        raise InputError(wrong)
    return capture


def grey(raw: Any) -> Image:
    """A picture of OpenCV, (h, w) or (h, w, 3), as (h, w) uint8."""
    image = raw if raw.ndim == 2 else cv2.cvtColor(raw, cv2.COLOR_BGR2GRAY)
    return np.ascontiguousarray(image, dtype=np.uint8)
