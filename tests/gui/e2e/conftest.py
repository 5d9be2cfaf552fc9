"""A desk with the window on it, for tests that do what a person does."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from outside import Window
from screen import Screen, missing


@pytest.fixture(scope="module")
def screen(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Screen]:
    """A screen with a window manager, for all tests of a file."""
    if gone := missing():
        reason = f"{', '.join(gone)} not installed; tests/setup_gui.sh installs them as root"
        if os.environ.get("CI"):
            pytest.fail(reason)
        pytest.skip(reason)
    made = Screen(tmp_path_factory.mktemp("screen"))
    yield made
    made.close()


@pytest.fixture
def start(screen: Screen, tmp_path: Path) -> Iterator[Callable[..., Window]]:
    """Starts ``skinfab gui WORDS``; all windows of a test keep their state in one folder, and are gone when it ends."""
    windows: list[Window] = []

    def started(*words: object) -> Window:
        windows.append(Window(screen, tmp_path / "state", *words))
        return windows[-1]

    (tmp_path / "state").mkdir()
    yield started
    for window in windows:
        window.kill()
    log = tmp_path / "state" / "gui.log"
    assert not log.exists(), log.read_text(encoding="utf-8")
