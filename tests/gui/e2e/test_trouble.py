"""What may go wrong on an ordinary day, in a window that is driven from outside: it answers, says a sentence, and loses nothing."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from outside import OBJECT, Window
from screen import Screen, until

from skinfab.document import load_skin

MESHES = Path(__file__).parents[3] / "meshes"

CANCEL = ".statusbar.work.cancel"


def cut_cube(window: Window) -> None:
    """Have the cube cut by itself: the shortest work there is, to see that the window still works."""
    window.key("F5")
    window.settled()
    assert window.wait_kept(lambda s: len(s.pieces) > 0, "there is a piece").pieces[0].id == "P1"


def is_running(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def test_answers_while_it_works_and_stops_at_once(start: Callable[..., Window], screen: Screen) -> None:
    window = start(MESHES / "grip.obj")
    window.open_mesh("84982 triangles")
    window.settled()
    window.key("F5")
    until(lambda: window.busy, "the work to begin")
    times = []
    x, y = window.place(OBJECT)
    for k in range(60):
        before = time.perf_counter()
        screen.xdo("mousemove", x + k % 20 - 10, y + k % 12)
        window.tcl("update idletasks")  # answered after the motion, with what it changed on the screen
        times.append(time.perf_counter() - before)
    # A window that waits for its work would answer once, when that has ended. How the slowest fare is the benchmark's to say
    # (gui_responsive.py): on a machine with other work they wait for a processor.
    assert window.busy, "all were answered while it worked"
    assert np.median(times) < 0.1
    window.click(CANCEL)
    until(lambda: not window.busy, "the work to end", patience=0.5)
    window.close()
    assert window.process.wait(timeout=20) == 0, "a mesh that was only opened is not asked about"


def test_a_file_that_is_no_mesh_and_work_that_dies_leave_a_sentence(start: Callable[..., Window], tmp_path: Path) -> None:
    bad = tmp_path / "bad.obj"
    bad.write_text("v 0 0 0\nv 1 0 nonsense\nf 1 2 9\n", encoding="utf-8")
    window = start(bad)
    until(lambda: any("bad.obj" in line for line in window.problems), "a sentence")
    assert not any("Traceback" in line for line in window.problems)
    window.key("ctrl+o")
    window.file_named(MESHES / "cup.obj")
    window.open_mesh()
    window.settled()
    window.key("F5")
    until(lambda: window.busy and window.text(".statusbar.work.label") != "cutting and flattening", "the work to be on its way")
    window.stop_work()
    until(lambda: any("was ended by the system" in line for line in window.problems), "a sentence")
    assert not window.busy
    window.key("ctrl+o")
    window.file_named(MESHES / "cube.obj")
    window.open_mesh("12 triangles")
    window.settled()
    cut_cube(window)


def test_what_a_crash_left_is_offered_and_comes_back(start: Callable[..., Window]) -> None:
    """With sensors that were off when it came."""
    window = start(MESHES / "cube.obj")
    window.open_mesh()
    window.settled()
    cut_cube(window)
    window.key("F7")
    placed = window.wait_kept(lambda s: len(s.sensors) > 0, "there are sensors")
    window.settled()
    window.key("alt+a", *["Down"] * int(window.tcl(".menu.seams index {Glue all seams that are not locked}")), "Return")
    lost = window.wait_kept(lambda s: len(s.lifted) > 0, "sensors are off")
    assert lost.pieces == lost.sensors == () and [each.sensor for each in lost.lifted] == list(placed.sensors)
    workers = window.workers()
    assert workers
    window.kill()
    until(lambda: not any(map(is_running, workers)), "the worker to end with its window")
    again = start()
    until(lambda: again.exists(".question.body.text"), "the question about what was kept")
    assert "a copy of it" in again.text(".question.body.text")
    again.answer("Open the copy")
    until(lambda: again.title.startswith("*cube.obj"), "the document, with its changes unsaved")
    back = again.wait_kept(lambda s: True, "is kept anew")
    assert np.array_equal(back.seams, lost.seams) and [each.sensor for each in back.lifted] == list(placed.sensors)
    assert all(np.array_equal(a.piece.UV, b.piece.UV) for a, b in zip(back.lifted, lost.lifted, strict=True))
    again.settled()
    again.key("F5")
    open_again = again.wait_kept(lambda s: not s.lifted, "no sensor is off")
    assert [s.id for s in open_again.sensors] == [s.id for s in placed.sensors]
    assert all(np.array_equal(a.UV, b.UV) for a, b in zip(open_again.pieces, placed.pieces, strict=True))


def test_unsaved_work_is_asked_about_and_the_worker_ends_too(start: Callable[..., Window], tmp_path: Path) -> None:
    document = tmp_path / "cube.skin"
    window = start(MESHES / "cube.obj")
    window.open_mesh()
    window.settled()
    cut_cube(window)
    workers = window.workers()
    window.close()
    window.answer("Cancel")
    assert window.process.poll() is None
    window.close()
    window.answer("Save")
    window.file_named(document)
    assert window.process.wait(timeout=20) == 0
    assert load_skin(document).pieces
    assert not any(map(is_running, workers))
    assert not list((tmp_path / "state" / "autosave").glob("*.skin")), "nothing is left to ask about"


def test_a_terminated_window_takes_its_worker_along(start: Callable[..., Window]) -> None:
    window = start(MESHES / "cup.obj")
    window.open_mesh()
    window.settled()
    window.key("F5")
    until(lambda: window.busy, "the work to begin")
    workers = window.workers()
    os.kill(window.process.pid, 15)
    window.process.wait(timeout=20)
    until(lambda: not any(map(is_running, workers)), "the worker to end in the middle of its work", patience=10)
