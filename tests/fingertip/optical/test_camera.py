"""A camera that ends, falls silent or shows the same picture for ever is told, and none of these holds up who reads it."""

import atexit
import itertools
import re
import threading
import time
from collections.abc import Callable, Iterator

import cv2
import numpy as np
import pytest

from skinfab.fingertip.optical import camera
from skinfab.fingertip.optical.camera import CameraImages
from skinfab.fingertip.optical.picture import opencv_silent


class Capture:
    """In OpenCV's place: pictures, then its end or nothing until it is let go."""

    def __init__(self, pictures: Iterator[np.ndarray], *, freezes: bool = False) -> None:
        self.pictures, self.freezes = pictures, freezes
        self.go, self.released = threading.Event(), threading.Event()

    def isOpened(self) -> bool:
        return True

    def get(self, setting: int) -> float:
        return 30.0

    def read(self) -> tuple[bool, np.ndarray | None]:
        if (one := next(self.pictures, None)) is None and self.freezes:
            self.go.wait(20)
        return one is not None, one

    def release(self) -> None:
        self.released.set()


def numbered(count: int) -> Iterator[np.ndarray]:
    return (np.full((8, 8), k, np.uint8) for k in range(count))


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> Callable[[Capture], CameraImages]:
    def open_it(capture: Capture) -> CameraImages:
        monkeypatch.setattr(cv2, "VideoCapture", lambda what, backend, settings: capture)
        return CameraImages(3)

    monkeypatch.setattr(camera, "_LAST_S", 0.01)
    return open_it


def test_a_camera_that_ends_is_told(opened: Callable[[Capture], CameraImages]) -> None:
    capture = Capture(numbered(3))
    with opened(capture) as source:
        assert len(list(source)) == 3 and source.ended
    assert len(source.notes) == 1 and source.notes[0].startswith("camera 3 gave no more after 0.") and capture.released.is_set()


def test_a_silent_camera_is_gone_and_close_does_not_wait_for_it(
    opened: Callable[[Capture], CameraImages], monkeypatch: pytest.MonkeyPatch
) -> None:
    at_exit: list[object] = []
    monkeypatch.setattr(atexit, "register", lambda *words: at_exit.append(words))
    monkeypatch.setattr(camera, "GONE_S", 0.1)
    capture = Capture(numbered(2), freezes=True)
    source = opened(capture).open()
    assert len(list(source)) == 2 and source.ended and not capture.released.is_set()
    source.close()
    held = source._thread
    assert held.is_alive() and at_exit == [(camera._wait_for, held)] and source.notes[0].startswith("camera 3 gave no more")
    capture.go.set()
    held.join(20)
    assert capture.released.is_set() and not held.is_alive()  # by the thread itself


def test_a_silence_at_the_end_or_meanwhile_is_told(opened: Callable[[Capture], CameraImages], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(camera, "STILL_S", 0.05)
    capture = Capture(numbered(2), freezes=True)
    with opened(capture) as source:
        assert source.read(20) is not None and source.read(20) is not None
        assert source.read(0.1) is None and not source.ended
    assert len(source.notes) == 1 and re.search(r"gave no picture for \d+\.\d s after \d+\.\d s", source.notes[0])
    capture.go.set()

    def late() -> Iterator[np.ndarray]:
        for one in numbered(3):
            time.sleep(0.1 if one[0, 0] == 1 else 0)
            yield one

    with opened(Capture(late())) as source:
        assert len(list(source)) == 3
    assert "gave no more" in source.notes[0] and "gave no picture for" in source.notes[1]


def test_the_same_picture_for_ever_is_told(opened: Callable[[Capture], CameraImages], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(camera, "STILL_S", 0.05)

    def slowly(pictures: Iterator[np.ndarray]) -> Iterator[np.ndarray]:
        for one in pictures:
            time.sleep(0.01)
            yield one

    with opened(Capture(slowly(itertools.islice(itertools.cycle(numbered(1)), 12)))) as source:
        assert len(list(source)) == 12
    assert "alike in every pixel" in source.notes[-1]
    with opened(Capture(slowly(numbered(12)))) as source:
        list(source)
    assert "alike" not in " ".join(source.notes)


def test_none_at_all_is_told(opened: Callable[[Capture], CameraImages]) -> None:
    with opened(Capture(iter(()))) as source:
        assert source.read() is None
    assert source.notes[0].startswith("it gave none in ")


def test_only_addresses_have_limits(monkeypatch: pytest.MonkeyPatch) -> None:
    """Other readers of OpenCV refuse to open with a setting that they do not know."""
    asked: list[tuple[int | str, list[int]]] = []

    def capture(what: int | str, backend: int, settings: list[int]) -> Capture:
        asked.append((what, settings))
        return Capture(iter(()))

    monkeypatch.setattr(cv2, "VideoCapture", capture)
    for what in (0, "/dev/video0", "http://127.0.0.1/a"):
        CameraImages(what).open().close()
    limit = [cv2.CAP_PROP_OPEN_TIMEOUT_MSEC, 5000, cv2.CAP_PROP_READ_TIMEOUT_MSEC, 5000]
    assert asked == [(0, []), ("/dev/video0", []), ("http://127.0.0.1/a", limit)]


def test_opencv_is_hushed_until_the_last_has_gone() -> None:
    log = cv2.utils.logging
    before = log.getLogLevel()
    first, second = opencv_silent(), opencv_silent()
    first.__enter__()
    second.__enter__()
    first.__exit__(None, None, None)
    assert log.getLogLevel() == log.LOG_LEVEL_SILENT != before
    second.__exit__(None, None, None)
    assert log.getLogLevel() == before
