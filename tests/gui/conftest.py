"""A real window for every test that needs one: on the screen there is, or on a virtual one."""

from __future__ import annotations

import gc
import multiprocessing
import os
import shutil
import subprocess
from collections.abc import Iterator
from types import SimpleNamespace

import numpy as np
import pytest

from gui.jobs import runner, worker
from gui.state.session import Session
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source

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
    # What a window leaves in cycles of its own must not be found by a thread of the next test: Tk would not answer it.
    gc.collect()
    if faults:
        raise faults[0]


@pytest.fixture
def skin() -> Skin:
    """Two square pieces of 100 mm that lie side by side, with two sensors on the first; whatever is drawn on it is easily told."""
    V = np.array([[0.0, 0, 0], [100, 0, 0], [100, 100, 0], [0, 100, 0], [200, 0, 0], [200, 100, 0]])
    F = np.array([[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]])
    square = np.array([[0.0, 0], [100, 0], [100, 100], [0, 100]])
    local = np.array([[0, 1, 2], [0, 2, 3]])
    pieces = (
        Piece("P1", np.array([0, 1]), np.array([0, 1, 2, 3]), local, square),
        Piece("P2", np.array([2, 3]), np.array([1, 4, 5, 2]), local, square),
    )
    spiral = make_pattern("contact-spiral", {"s": 20})
    sensors = (Sensor("C1", "P1", spiral, 50.0, 30.0, 0.0, 0), Sensor("C2", "P1", spiral, 50.0, 70.0, 0.0, 1))
    return Skin(Mesh(V, F, "plate"), Source("plate.obj", "0" * 64, "mm", 1.0), np.array([[1, 2]]), pieces, sensors)


@pytest.fixture
def session(skin: Skin) -> Session:
    """That skin, open and saved."""
    made = Session()
    made.open(skin, None)
    return made


@pytest.fixture(scope="module")
def quick_workers() -> Iterator[None]:
    """Worker processes that branch off one that has imported all they need, instead of 1.3 s of imports for each window and its spare.

    How a window really starts them is seen in tests/gui/jobs, tests/gui/e2e and tests/cli/test_gui.py.
    """
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["gui.jobs.tasks", *worker.NEEDS])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runner, "multiprocessing", SimpleNamespace(get_context=lambda method: context))
        yield


@pytest.fixture(scope="module")
def one_window(display: str, quick_workers: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[object]:
    """One real window for all tests of a file, with its worker process, and with someone who answers its questions."""
    import tkinter as tk

    from person import Answers, Person

    from gui.app import App

    state = tmp_path_factory.mktemp("state")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SKINFAB_STATE", str(state))
        answers = Answers()
        app = App(tk.Tk(), dialogs=answers)
    app.root.geometry("1280x760+0+0")
    app.root.update()
    person = Person(app, answers)
    person.wait(lambda: app.view2d.winfo_width() > 1)
    yield person
    answers.give["Unsaved work"] = "Do not save"
    app.close()
    gc.collect()


@pytest.fixture
def person(one_window) -> Iterator[object]:
    """That window with nothing wrong, nothing answered and the first tool in hand; a fault of its own fails the test."""
    app, answers = one_window.app, one_window.answers
    fresh = type(answers)()
    answers.asked, answers.give, answers.path, answers.choice = fresh.asked, {"Unsaved work": "Do not save"}, None, fresh.choice
    app.runner.cancel()
    app.session.take_up("select")
    app.session.shade("pieces")
    for source in {p.source for p in app.session.problems}:
        app.session.report(source, [])
    log = app.desk.state / "gui.log"
    log.unlink(missing_ok=True)
    yield one_window
    assert not log.exists(), log.read_text(encoding="utf-8")
