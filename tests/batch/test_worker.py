"""A job is done once, ends in one of the known ways, and leaves all of its result or nothing."""

import json
import os
import signal
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from batches import RUNNER, quick_job, wait_for

from skinfab.batch.worker import Closing, Runners, do_job
from skinfab.errors import InputError


@pytest.fixture(scope="module")
def runners() -> Iterator[Runners]:
    runners = Runners(RUNNER)
    yield runners
    runners.close()


def hidden(folder: Path) -> list[str]:
    """What is under way, but for the files that are locked."""
    return [path.name for path in (folder / ".under-way").iterdir() if path.suffix != ".lock"]


def test_a_result_and_its_record(tmp_path: Path, runners: Runners) -> None:
    job = quick_job(tmp_path, "make")
    record = do_job(job, str(tmp_path), "r", runners)
    place = tmp_path / "jobs" / job.name
    assert (record["status"], record["attempts"], record["message"]) == ("made", 1, "")
    assert record["figures"]["n_pieces"] == 2 and record["figures"]["ink_mm3"] == 2.0
    assert {path.name for path in place.iterdir()} == {"job.json", "report.json", "said.txt"}
    assert json.loads((place / "job.json").read_text()) == record
    assert hidden(tmp_path) == []


def test_a_job_that_is_done_is_not_done_again(tmp_path: Path, runners: Runners) -> None:
    job = quick_job(tmp_path, "failed")
    first = do_job(job, str(tmp_path), "r", runners)
    Path(job.mesh).write_text("make")
    assert do_job(job, str(tmp_path), "other", runners) == first


def test_two_workers_given_the_same_job_do_it_once(tmp_path: Path, runners: Runners) -> None:
    job, records = quick_job(tmp_path, "sleep 0.3"), []
    threads = [threading.Thread(target=lambda: records.append(do_job(job, str(tmp_path), "r", runners))) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert records[0] == records[1] == records[2] and records[0]["attempts"] == 1


@pytest.mark.parametrize(
    ("text", "limits", "status", "says"),
    [
        ("failed", {}, "failed", "was failed, see its folder"),
        ("refused", {}, "refused", "was refused"),
        ("abort", {}, "crashed", "signal 6"),
        ("sleep 600", {"time_s": 0.2}, "time", "longer than the 0.2 s"),
        ("eat", {"memory_mb": 150}, "memory", "more than the 150 MB"),
        ("leap", {"memory_mb": 150}, "memory", "more than the 150 MB"),
        ("kill-runner", {}, "lost", "3 workers died"),
    ],
)
def test_every_end_has_its_word(tmp_path: Path, runners: Runners, text: str, limits: dict[str, float], status: str, says: str) -> None:
    job = quick_job(tmp_path, text, **limits)
    record = do_job(job, str(tmp_path), "r", runners)
    assert record["status"] == status and says in record["message"]
    assert record["attempts"] == (3 if status == "lost" else 1)
    assert not any(str(tmp_path / ".under-way") in path.read_text() for path in (tmp_path / "jobs" / job.name).iterdir())
    if status == "memory":
        assert record["peak_mb"] < 300  # ended soon
    assert hidden(tmp_path) == []


def test_deaths_of_another_run_do_not_count(tmp_path: Path, runners: Runners) -> None:
    job = quick_job(tmp_path, "make")
    lock = tmp_path / ".under-way" / f"{job.name}.lock"
    lock.parent.mkdir()
    lock.write_text("r host 1\n" * 3)
    (lock.parent / f"{job.name}-0abc").mkdir()  # what a killed worker leaves
    assert do_job(job, str(tmp_path), "s", runners)["attempts"] == 4
    assert hidden(tmp_path) == []
    other = quick_job(tmp_path, "make ")
    (lock.parent / f"{other.name}.lock").write_text("r host 1\n" * 3)
    assert do_job(other, str(tmp_path), "r", runners)["status"] == "lost"


def test_a_mesh_that_changes_meanwhile_is_told_and_nothing_kept(tmp_path: Path, runners: Runners) -> None:
    job = quick_job(tmp_path, "make")
    Path(job.mesh).write_text("make 2")
    assert do_job(job, str(tmp_path), "r", runners)["status"] == "not run"
    assert not (tmp_path / "jobs").exists() and hidden(tmp_path) == []


def test_a_full_disk_is_the_batch_s_fault(tmp_path: Path, runners: Runners) -> None:
    job = quick_job(tmp_path, "full")
    with pytest.raises(InputError, match=f"^cannot write {tmp_path}: the disk is full; free some space and run again$"):
        do_job(job, str(tmp_path), "r", runners)
    assert not (tmp_path / "jobs").exists() and hidden(tmp_path) == []


def test_a_worker_that_ends_takes_its_job_with_it_and_keeps_nothing(tmp_path: Path) -> None:
    own, job, ends = Runners(RUNNER), quick_job(tmp_path, "sleep 600"), []

    def work() -> None:
        try:
            do_job(job, str(tmp_path), "r", own)
        except Closing:
            ends.append(hidden(tmp_path))

    thread = threading.Thread(target=work)
    thread.start()
    half = f"{job.name}-*/half.txt"
    wait_for(lambda: any((tmp_path / ".under-way").glob(half)))
    own.close()
    thread.join(timeout=20)
    assert ends == [[]] and not (tmp_path / "jobs").exists()
    with pytest.raises(Closing):
        own.run(["x"], said=tmp_path / "said", time_s=None, memory_mb=None)


def test_a_runner_that_still_loads_ends_with_the_worker(tmp_path: Path) -> None:
    own, ends = Runners([sys.executable, "-S", "-c", "import time; time.sleep(600)"]), []

    def work() -> None:
        with pytest.raises(Closing):
            own.run(["x"], said=tmp_path / "said", time_s=None, memory_mb=None)
        ends.append(True)

    thread = threading.Thread(target=work)
    thread.start()
    wait_for(lambda: own._busy)
    (runner,) = own._busy
    own.close()
    assert runner.poll() is not None
    thread.join(timeout=20)
    assert ends == [True]


def test_a_job_dies_with_the_process_that_watches_it(tmp_path: Path) -> None:
    own, job = Runners(RUNNER), quick_job(tmp_path, "sleep 600")
    thread = threading.Thread(target=lambda: do_job(job, str(tmp_path), "r", own))
    thread.start()
    wait_for(lambda: any((tmp_path / ".under-way").glob(f"{job.name}-*/half.txt")))
    (runner,) = own._busy
    children = f"/proc/{runner.pid}/task/{runner.pid}/children"
    pid = int(Path(children).read_text())
    Path(job.mesh).write_text("make")  # the next attempt has something quick to do
    runner.send_signal(signal.SIGKILL)
    wait_for(lambda: not alive(pid))
    thread.join(timeout=20)
    own.close()
    assert not thread.is_alive()


def alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return "State:\tZ" not in Path(f"/proc/{pid}/status").read_text()
