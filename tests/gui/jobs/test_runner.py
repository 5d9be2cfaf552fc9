"""Long work never stops the window, can be stopped, and says what went wrong."""

import importlib
import sys
import time
import tkinter as tk
from pathlib import Path

import pytest

import gui.jobs.runner as module
from gui.jobs.runner import Runner

HERE = Path(__file__).parent


@pytest.fixture(scope="module")
def work():
    """The module `work` beside this file, under a name that the worker process, which is given this path, can import too."""
    sys.path.insert(0, str(HERE))
    yield importlib.import_module("work")
    sys.path.remove(str(HERE))


@pytest.fixture
def runner(root, work):
    made = made_in(root)
    yield made
    made.close()


@pytest.fixture(scope="module")
def kept(display, work):
    """One process for all tests that leave it alive, and a window for it."""
    window = tk.Tk()
    made = made_in(window)
    yield made
    made.close()
    window.destroy()


@pytest.fixture
def alive(kept):
    """That process, and nothing heard from it yet."""
    for heard in kept.seen.values():
        heard.clear()
    return kept


def made_in(window):
    seen = {"steps": [], "log": []}
    made = Runner(window, changed=seen["steps"].append, log=seen["log"].append)
    made.seen, made.window = seen, window
    return made


def outcome(root, runner, function, *, seconds=30.0, **arguments):
    """Run the window until the work has ended; what came of it."""
    heard = []
    runner.start("working", function, done=lambda r: heard.append(("done", r)), failed=lambda s: heard.append(("failed", s)), **arguments)
    wait(root, lambda: heard, seconds=seconds)
    return heard[0]


def wait(root, condition, *, seconds=30.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "nothing happened"
        root.update()
        time.sleep(0.002)


def test_a_result_comes_back_and_progress_before_it(alive, work):
    assert outcome(alive.window, alive, work.double, number=21) == ("done", 42)
    assert [s and s.label for s in alive.seen["steps"]] == ["working", "doubling", None]
    assert alive.job is None


def test_a_refusal_is_its_sentence(alive, work):
    assert outcome(alive.window, alive, work.refuse) == ("failed", "piece P1 overlaps itself; cut it further")
    assert alive.seen["log"] == []


def test_a_fault_of_ours_is_a_sentence_and_a_line_in_the_log(alive, work):
    what, sentence = outcome(alive.window, alive, work.stumble)
    assert what == "failed" and "ZeroDivisionError" in sentence and "\n" not in sentence
    assert "in stumble" in alive.seen["log"][0]


def test_a_dead_process_is_told_and_replaced(root, runner, work):
    assert "ended by the system" in outcome(root, runner, work.die)[1]
    assert outcome(root, runner, work.double, number=4) == ("done", 8)


def test_what_is_cancelled_is_never_heard_of_again(root, runner, work):
    heard = []
    runner.start("busy", work.busy, done=heard.append, failed=heard.append, seconds=20.0)
    wait(root, lambda: any(s and s.fraction > 0 for s in runner.seen["steps"]))
    began = time.monotonic()
    assert runner.cancel()
    assert time.monotonic() - began < 0.5
    assert runner.job is None and runner.seen["steps"][-1] is None
    assert outcome(root, runner, work.double, number=1) == ("done", 2)
    assert heard == [] and not runner.cancel()


def test_new_work_takes_the_place_of_old(root, runner, work):
    heard = []
    runner.start("busy", work.busy, done=heard.append, failed=heard.append, seconds=20.0)
    assert outcome(root, runner, work.double, number=3) == ("done", 6)
    assert heard == []


def test_what_is_cancelled_leaves_no_half_written_file(root, runner, work, tmp_path):
    runner.start("writing", work.write_slowly, done=lambda r: None, failed=lambda s: None, folder=tmp_path / "out")
    wait(root, lambda: any(s and s.label == "writing" and s.fraction > 0 for s in runner.seen["steps"]))
    runner.cancel()
    wait(root, lambda: not (tmp_path / "out").exists())


def test_the_window_answers_while_work_goes_on(root, runner, work):
    finished = []
    runner.start("busy", work.busy, done=finished.append, failed=finished.append, seconds=1.5)
    late = []
    while not finished:
        asked = time.monotonic()
        root.after(0, lambda asked=asked: late.append(time.monotonic() - asked))
        root.update()
        time.sleep(0.005)
    assert finished == ["finished"]
    assert sorted(late)[int(0.99 * len(late))] < 0.1


def test_work_that_takes_the_place_of_other_work_waits_for_no_start(root, runner, work, monkeypatch):
    """A spare process is ready when the one at work is ended."""
    monkeypatch.setattr(module, "SPARE_AFTER_S", 0.0)
    assert outcome(root, runner, work.double, number=1) == ("done", 2)
    wait(root, lambda: runner._spare is not None and runner._spare.ready)
    spare = runner._spare.process
    runner.start("busy", work.busy, done=lambda r: None, failed=lambda s: None, seconds=20.0)
    wait(root, lambda: any(s and s.fraction > 0.001 for s in runner.seen["steps"]))
    assert outcome(root, runner, work.double, number=3) == ("done", 6)
    assert runner._helper.process is spare


def test_much_to_send_does_not_stop_the_window_while_the_process_starts(root, runner, work):
    began = time.monotonic()
    heard = []
    runner.start("measuring", work.size_of, done=heard.append, failed=heard.append, blob=b"x" * 50_000_000)
    sent = time.monotonic()
    wait(root, lambda: heard)
    assert heard == [50_000_000]
    assert sent - began < 0.3 * (time.monotonic() - began)  # most of it is the start, and that was not waited for
