"""Images of a live camera: a thread takes them as they come, and a camera that stops is told."""

from __future__ import annotations

import atexit
import contextlib
import math
import os
import threading
import time
from collections import deque
from dataclasses import dataclass, field, replace
from typing import Any, Self

import cv2
import numpy as np

from skinfab.fingertip.optical.images import RATE_HZ, Picture, Pictures, grey, open_capture
from skinfab.fingertip.optical.picture import opencv_silent
from skinfab.readout.source import Counts, HostClock

#: Pictures that wait to be read; older ones give way and are counted as lost.
WAITING = 4
#: A camera that gives no picture for so long is gone, s; so long OpenCV is let wait for one (of itself 10, or 30 for an address).
GONE_S = 5
#: One that gives none for so long, or always the same one, stands still, s: a camera's own noise would change some pixel.
STILL_S = 2.0
#: How long to wait for the last picture when no more are wanted, s.
_LAST_S = 1.0


@dataclass
class _Spell:
    """The longest time of one kind, and when it began, s since the first picture."""

    lasted_s: float = 0.0
    began_s: float = 0.0

    def take(self, lasted_s: float, began_s: float) -> None:
        if lasted_s > self.lasted_s:
            self.lasted_s, self.began_s = lasted_s, began_s


@dataclass
class _Taking:
    """What the thread of one opening shares with who reads; of another opening it knows nothing."""

    capture: Any
    clock: HostClock
    begun: float = math.nan
    newest: float = field(default_factory=time.monotonic)
    come: threading.Condition = field(default_factory=threading.Condition)
    waiting: deque[Picture] = field(default_factory=deque)
    stop: bool = False
    done: bool = False
    silent: _Spell = field(default_factory=_Spell)
    alike: _Spell = field(default_factory=_Spell)


class CameraImages(Pictures):
    """A live camera. A thread takes its pictures as they come; those that nobody reads in time give way and are counted as lost.

    A camera that gives no more, or stood still meanwhile, is told in `notes` when it is closed.

    Parameters
    ----------
    camera : int or str
        Its number from 0, or an address that OpenCV opens.

    Raises
    ------
    InputError
        On opening: there is no such camera.
    """

    def __init__(self, camera: int | str) -> None:
        super().__init__(f"camera {camera}", RATE_HZ)
        self._camera = camera

    def open(self) -> Self:
        """Begin to take pictures."""
        wrong = f"there is no {self.name}, or another program has it; cameras are numbered from 0"
        os.environ.setdefault("OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT", str(GONE_S))
        capture = open_capture(self._camera, wrong, settings=_limits(self._camera))
        self.rate_hz = float(capture.get(cv2.CAP_PROP_FPS)) or RATE_HZ
        self.counts, self.ended, self._closed = Counts(), False, False
        self.notes.clear()
        self._now = _Taking(capture, HostClock())
        self._thread = threading.Thread(target=self._take, args=(self._now,), name=self.name, daemon=True)
        self._thread.start()
        return self

    def close(self) -> None:
        """Take no more. A thread that OpenCV holds in a picture that does not come is let go: it gives the camera back when that ends."""
        now = self._now
        with now.come:
            now.stop = True
            if not self._closed:
                self.notes += self._told(now)
        self._thread.join(_LAST_S)
        if self._thread.is_alive():
            atexit.register(_wait_for, self._thread)
        self.ended = self._closed = True

    def _take(self, now: _Taking) -> None:
        sequence, alike_since, last = 0, math.nan, None
        try:
            with opencv_silent():
                while not now.stop:
                    whole, raw = now.capture.read()
                    at = time.monotonic()
                    if not whole:
                        break
                    image = grey(raw)
                    same = last is not None and np.array_equal(image, last)
                    with now.come:
                        if now.stop:
                            break
                        if sequence == 0:
                            now.begun = at
                        else:
                            now.silent.take(at - now.newest, now.newest - now.begun)
                        alike_since = alike_since if same else at
                        now.alike.take(at - alike_since, alike_since - now.begun)
                        now.newest = at
                        if len(now.waiting) == WAITING:
                            now.waiting.popleft()
                            self.counts = replace(self.counts, lost=self.counts.lost + 1)
                        now.waiting.append(Picture(image, f"{sequence + 1}", at - now.begun, now.clock.at(at), sequence))
                        now.come.notify()
                    last, sequence = image, sequence + 1
        finally:
            now.capture.release()
            with now.come:
                now.done = True
                now.come.notify()

    def read(self, timeout: float | None = None) -> Picture | None:
        """The next one that has not given way; None after `timeout` seconds without one, or when the camera is gone."""
        now, end = self._now, math.inf if timeout is None else time.monotonic() + timeout
        with now.come:
            while not now.waiting and not now.done:
                left = min(end, now.newest + GONE_S) - time.monotonic()
                if left <= 0:
                    break
                now.come.wait(left)
            if not now.waiting:
                self.ended = now.done or time.monotonic() >= now.newest + GONE_S
                return None
            self.counts = replace(self.counts, frames=self.counts.frames + 1)
            return now.waiting.popleft()

    def _told(self, now: _Taking) -> list[str]:
        """What went wrong with the camera itself."""
        if math.isnan(now.begun):
            return [f"it gave none in {time.monotonic() - now.newest:.1f} s"]
        notes = []
        lasted = now.newest - now.begun
        if self.ended or now.done:
            notes.append(f"{self.name} gave no more after {lasted:.1f} s: it ended by itself, or was taken off")
        elif (silence := time.monotonic() - now.newest) > STILL_S:
            now.silent.take(silence, lasted)
        for spell, words in ((now.silent, "gave no picture"), (now.alike, "gave pictures that are alike in every pixel")):
            if spell.lasted_s > STILL_S:
                notes.append(f"{self.name} {words} for {spell.lasted_s:.1f} s after {spell.began_s:.1f} s")
        return notes


def _wait_for(thread: threading.Thread) -> None:
    """Python ends hard (SIGABRT) where OpenCV comes back from a picture while it is shutting down; what was found is written by then."""
    with contextlib.suppress(KeyboardInterrupt):
        thread.join(GONE_S)


def _limits(camera: int | str) -> list[int]:
    """How long OpenCV waits for an address, ms; others have no such setting, and would not open with it."""
    if isinstance(camera, int) or "://" not in camera:
        return []
    limit = 1000 * GONE_S
    return [cv2.CAP_PROP_OPEN_TIMEOUT_MSEC, limit, cv2.CAP_PROP_READ_TIMEOUT_MSEC, limit]
