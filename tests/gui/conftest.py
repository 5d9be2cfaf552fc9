"""A real window for every test that needs one: on the screen there is, or on a virtual one."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator

import pytest

SCREEN = "1280x800x24"


@pytest.fixture(scope="session")
def display() -> Iterator[str]:
    """The name of a screen; always a virtual one, so that tests do not depend on the size of the user's."""
    if shutil.which("Xvfb") is None:
        reason = "Xvfb is not installed; tools/setup.sh installs it as root"
        if os.environ.get("CI"):
            pytest.fail(reason)
        pytest.skip(reason)
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", SCREEN, "-nolisten", "tcp"],
        pass_fds=[write],
        stderr=subprocess.DEVNULL,
    )
    os.close(write)
    with os.fdopen(read) as pipe:
        number = pipe.readline().strip()  # the server writes it once it takes connections
    before = os.environ.get("DISPLAY")
    os.environ["DISPLAY"] = f":{number}"
    yield f":{number}"
    if before is None:
        del os.environ["DISPLAY"]
    else:
        os.environ["DISPLAY"] = before
    server.terminate()
    server.wait(timeout=10)


@pytest.fixture
def root(display: str) -> Iterator[object]:
    """A window of its own; what a callback raises fails the test."""
    import tkinter as tk

    window = tk.Tk()
    window.geometry("1280x800+0+0")
    faults: list[BaseException] = []
    window.report_callback_exception = lambda kind, fault, trace: faults.append(fault)
    yield window
    window.destroy()
    if faults:
        raise faults[0]
