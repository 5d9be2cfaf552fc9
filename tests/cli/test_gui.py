"""`skinfab gui` as a person starts it: a real process, ended in every way there is."""

import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from gui.state.autosave import left_over
from skinfab.cli.main import main

ROOT = Path(__file__).parents[2]


def ended(process, timeout=30):
    out, err = process.communicate(timeout=timeout)
    return process.returncode, out, err


@pytest.fixture(scope="module")
def display():
    if shutil.which("Xvfb") is None:
        if os.environ.get("CI"):
            pytest.fail("Xvfb is not installed")
        pytest.skip("Xvfb is not installed; tools/setup.sh installs it as root")
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp"]
    server = subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as pipe:
        number = pipe.readline().strip()
    yield f":{number}"
    server.terminate()
    server.wait(timeout=10)


@pytest.fixture
def said(tmp_path, monkeypatch, capfd):
    """What `skinfab gui` with these words says that opens no window, in this process: its exit status, standard output and error."""
    monkeypatch.setenv("SKINFAB_STATE", str(tmp_path / "state"))
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)

    def run(*words):
        status = main(["gui", *map(str, words)])
        return status, *capfd.readouterr()

    return run


def test_without_a_screen_it_is_one_sentence(said):
    status, out, err = said()
    assert status == 1 and out == "" and err.startswith("skinfab: there is no screen") and err.count("\n") == 1 and "DISPLAY" in err


@pytest.mark.parametrize(("name", "why"), [("gone.obj", "no such file"), ("", "is a folder")])
def test_a_file_that_is_not_there_is_said_before_a_window_opens(said, tmp_path, name, why):
    status, _, err = said(tmp_path / name)
    assert status == 1 and why in err and err.count("\n") == 1


def test_a_state_folder_that_cannot_be_made_is_one_sentence(said, tmp_path, display, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("DISPLAY", display)
    monkeypatch.setenv("SKINFAB_STATE", str(tmp_path / "file" / "state"))
    status, _, err = said()
    assert status == 1 and err.count("\n") == 1 and "file" in err


#: Opens a window on a document with unsaved work, and says when its copy is written.
WORK = """
import sys, tkinter as tk
from dataclasses import replace
from pathlib import Path
import gui.app
made = []
class Watched(gui.app.App):
    def __init__(self, root, path=None, **options):
        super().__init__(root, path, **options)
        root.after(100, self.work, root)
    def work(self, root):
        if self.session.skin is None:
            return root.after(50, self.work, root)
        self.session.do("another seed", replace(self.session.skin, seed=42))
        self.autosave.settle()
        if "asking" in sys.argv:
            root.after(0, self.close)
        self.wait(root)
    def wait(self, root):
        if "asking" in sys.argv and "question" not in root.children:
            return root.after(20, self.wait, root)
        print("kept", flush=True)
gui.app.App = Watched
from gui.dialogs.open_mesh import MeshChoice
gui.app.Dialogs.how_to_open = lambda self, facts: MeshChoice(facts.units, False)
from skinfab.cli.main import main
if __name__ == "__main__":
    sys.exit(main(["gui", sys.argv[1]]))
"""


# What SIGKILL leaves is seen in tests/gui/e2e/test_trouble.py.
@pytest.mark.parametrize(("number", "asking"), [(signal.SIGTERM, "asking"), (signal.SIGINT, "")])
def test_whatever_ends_it_the_work_is_there_at_the_next_start(tmp_path, display, number, asking):
    (tmp_path / "work.py").write_text(WORK)
    environment = os.environ | {"SKINFAB_STATE": str(tmp_path / "state"), "PYTHONPATH": str(ROOT), "DISPLAY": display}
    command = [sys.executable, str(tmp_path / "work.py"), str(ROOT / "meshes" / "cube.obj"), asking]
    process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    impatience = threading.Timer(120, process.kill)  # a window that never says so ends as a failure
    impatience.start()
    said = process.stdout.readline()
    impatience.cancel()
    assert said == "kept\n", ended(process)
    began = time.monotonic()
    process.send_signal(number)
    status, _, err = ended(process)
    assert time.monotonic() - began < 10
    assert status == 130 and err == "skinfab: interrupted; nothing half-written was left\n"
    (left,) = left_over(tmp_path / "state" / "autosave")
    assert left.load().seed == 42 and left.path is None
