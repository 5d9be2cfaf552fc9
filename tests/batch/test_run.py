"""A real scheduler and two workers, which are killed; so is the client. Nothing is lost, and nothing done twice."""

import json
import logging
import os
import signal
import subprocess
import sys
import tempfile
import threading
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from batches import RUNNER, quick_job, quick_jobs, wait_for

from skinfab import __version__
from skinfab.batch import cluster
from skinfab.batch.job import STATUSES, Job
from skinfab.batch.plan import read_plan
from skinfab.batch.run import Outcome, run_batch
from skinfab.errors import InputError


@pytest.fixture(scope="module")
def scheduler(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a cluster with two workers that a nanny starts again when they die; it gives a task up when two have died of it."""
    import dask
    from distributed import LocalCluster

    with (
        cluster._silent_logs(),
        dask.config.set({"distributed.scheduler.allowed-failures": 1}),
        LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
            memory_limit=0,
            local_directory=str(tmp_path_factory.mktemp("dask")),
            silence_logs=logging.CRITICAL,
        ) as local,
    ):
        yield local.scheduler_address


def run(jobs: list[Job], folder: Path, scheduler: str) -> Outcome:
    return run_batch(jobs, folder, workers=0, scheduler=scheduler, runner=RUNNER)


def in_background(jobs: list[Job], folder: Path, scheduler: str) -> tuple[threading.Thread, list[Outcome]]:
    outcomes: list[Outcome] = []
    thread = threading.Thread(target=lambda: outcomes.append(run(jobs, folder, scheduler)), daemon=True)
    thread.start()
    return thread, outcomes


def attempts(folder: Path, job: Job) -> list[int]:
    """Process ids of the workers that began a job."""
    path = folder / ".under-way" / f"{job.name}.lock"
    return [int(line.split()[2]) for line in path.read_text().splitlines()] if path.exists() else []


def ends(records: Mapping[str, Mapping[str, Any]]) -> Counter[str]:
    return Counter(str(record["status"]) for record in records.values())


def test_a_killed_worker_s_job_is_done_again_and_a_deadly_one_is_told(tmp_path: Path, scheduler: str) -> None:
    (tmp_path / "meshes").mkdir()
    out = tmp_path / "out"
    jobs = quick_jobs(tmp_path / "meshes", ["sleep 600", "failed", "refused", *(f"make {k}" for k in range(8)), "sleep-once"])
    deadly, once = jobs[0], jobs[-1]
    thread, outcomes = in_background(jobs, out, scheduler)
    wait_for((tmp_path / "meshes/sleep-once.begun").exists)
    os.kill(attempts(out, once)[0], signal.SIGKILL)
    for time in range(3):
        wait_for(lambda time=time: len(attempts(out, deadly)) > time)
        os.kill(attempts(out, deadly)[time], signal.SIGKILL)
    thread.join(timeout=60)
    (outcome,) = outcomes
    assert ends(outcome.records) == {"made": 9, "failed": 1, "refused": 1, "lost": 1}
    assert {name: r["attempts"] for name, r in outcome.records.items() if r["attempts"] != 1} == {deadly.name: 3, once.name: 2}
    lines = [json.loads(line)["job"] for line in (out / "jobs.jsonl").read_text().splitlines()]
    assert sorted(lines) == sorted(job.name for job in jobs)
    assert {path.name for path in (out / "jobs").iterdir()} == set(lines) and not (out / ".under-way").exists()


CLIENT = """
import sys
from pathlib import Path
from batches import RUNNER, quick_job, quick_jobs
from skinfab.batch import cluster
from skinfab.batch.run import run_batch
from skinfab.errors import InputError
folder, scheduler, cluster.CONNECT_S, *texts = sys.argv[1], sys.argv[2], float(sys.argv[3]), *sys.argv[4:]
try:
    run_batch(quick_jobs(Path(folder), texts), Path(folder) / "out", workers=0, scheduler=scheduler, runner=RUNNER)
except InputError as fault:
    sys.exit(str(fault))
"""


def client_of(folder: Path, scheduler: str, texts: list[str], connect_s: float = 20.0) -> subprocess.Popen[str]:
    program = [sys.executable, "-c", CLIENT, str(folder), scheduler, str(connect_s), *texts]
    return subprocess.Popen(program, env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[1])}, stderr=subprocess.PIPE, text=True)


def test_a_killed_client_is_resumed_and_what_its_workers_still_do_is_waited_for(tmp_path: Path, scheduler: str) -> None:
    out, texts = tmp_path / "out", ["make 1", "make 2", "make 3", "sleep 2", "failed"]
    jobs = quick_jobs(tmp_path, texts)
    client = client_of(tmp_path, scheduler, texts[:4])
    wait_for(lambda: attempts(out, jobs[3]))
    with pytest.raises(InputError, match="another batch is at work in"):
        run(jobs, out, scheduler)
    client.kill()
    client.communicate()
    before = sum((out / "jobs" / job.name / "job.json").exists() for job in jobs)
    (out / "jobs.jsonl").write_text((out / "jobs.jsonl").read_text() + '{"job": "torn')
    outcome = run(jobs, out, scheduler)
    assert ends(outcome.records) == {"made": 4, "failed": 1} and before <= outcome.before < 5  # another may have ended since
    assert [r["attempts"] for r in outcome.records.values()] == [1] * 5  # the sleeper too was done once, by the worker of the first run
    assert len((out / "jobs.jsonl").read_text().splitlines()) == 5
    again = run(jobs, out, "tcp://127.0.0.1:1")  # nothing is left to do, so nobody is asked
    assert again.before == 5 and again.records == outcome.records
    record = out / "jobs" / jobs[0].name / "job.json"
    record.write_text(record.read_text().replace(f'"{__version__}"', '"0.0.0"'))
    (note,) = run(jobs, out, "tcp://127.0.0.1:1").notes
    assert note.startswith("1 of the results was made by another version of skinfab; remove what")


def test_a_scheduler_that_dies_is_told_and_another_goes_on(tmp_path: Path, scheduler: str) -> None:
    """A scheduler and a worker as they are started by hand, and a client that has not imported Dask before: it says one sentence."""
    texts, file = ["make", "sleep-once"], tmp_path / "scheduler.json"
    jobs = quick_jobs(tmp_path, texts)
    dask, quiet = [str(Path(sys.executable).with_name("dask"))], {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    options = ["--scheduler-file", str(file), "--no-dashboard"]
    served = subprocess.Popen([*dask, "scheduler", "--host", "127.0.0.1", "--port", "0", *options], **quiet)  # type: ignore[call-overload]
    works = subprocess.Popen([*dask, "worker", "--no-nanny", "--local-directory", str(tmp_path), *options], **quiet)  # type: ignore[call-overload]
    try:
        wait_for(lambda: file.exists() and file.read_text().endswith("}"))
        client = client_of(tmp_path, json.loads(file.read_text())["address"], texts, connect_s=2.0)
        wait_for((tmp_path / "sleep-once.begun").exists)
        wait_for((tmp_path / "out/jobs" / jobs[0].name).exists)
        served.kill()
        _, told = client.communicate(timeout=60)
    finally:
        for process in (served, works):
            process.kill()
            process.wait()
    assert told == f"{cluster.GONE}\n" and client.returncode == 1
    outcome = run(jobs, tmp_path / "out", scheduler)
    assert ends(outcome.records) == {"made": 2} and [r["attempts"] for r in outcome.records.values()] == [1, 2]


def test_what_failed_for_a_limit_is_done_again_when_that_is_raised(tmp_path: Path, scheduler: str, monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = tmp_path / "meshes"
    mesh.mkdir()
    jobs = [quick_job(mesh, "sleep 0.5", time_s=0.1), quick_job(mesh, "failed", time_s=0.1), quick_job(mesh, "make", time_s=60)]
    assert ends(run(jobs, tmp_path / "out", scheduler).records) == {"time": 1, "failed": 1, "made": 1}
    assert run(jobs, tmp_path / "out", scheduler).before == 3
    wider = [replace(job, time_s=60) for job in jobs]

    def broken_off(path: Path) -> None:
        (path / "job.json").unlink()
        raise KeyboardInterrupt

    with monkeypatch.context() as killed:
        killed.setattr("shutil.rmtree", broken_off)
        with pytest.raises(KeyboardInterrupt):
            run(wider, tmp_path / "out", scheduler)
    raised = run(wider, tmp_path / "out", scheduler)
    assert raised.before == 2 and ends(raised.records) == {"made": 2, "failed": 1}
    fewer = run(jobs[:1], tmp_path / "out", scheduler)
    assert fewer.notes == (f"2 results in {tmp_path / 'out/jobs'} are of other meshes or settings and left alone",)


def test_folders_of_killed_clients_are_removed_and_those_at_work_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    killed = tmp_path / "skinfab-batch-killed"
    killed.mkdir()
    (killed / cluster.LOCK).touch()
    (tmp_path / "skinfab-batch-begins").mkdir()
    with cluster._scratch() as first, cluster._scratch() as second:
        assert not killed.exists() and Path(first).is_dir() and Path(second).is_dir()
    assert os.listdir(tmp_path) == ["skinfab-batch-begins"]


def test_a_full_disk_ends_the_batch_and_what_is_done_is_given(tmp_path: Path, scheduler: str) -> None:
    jobs, told = quick_jobs(tmp_path, ["make", "full"]), []
    with pytest.raises(InputError, match="the disk is full"):
        run_batch(jobs, tmp_path / "out", workers=0, scheduler=scheduler, runner=RUNNER, broken_off=told.append)
    (outcome,) = told
    last = outcome.records[jobs[1].name]
    assert (last["status"], last["message"]) == ("not run", "the batch was broken off before; run again")
    assert ends(outcome.records) in ({"made": 1, "not run": 1}, {"not run": 2}) and outcome.before == 0
    assert not (tmp_path / "out/jobs").exists() or len(list((tmp_path / "out/jobs").iterdir())) == 1


def test_the_example_of_the_page_runs(tmp_path: Path, scheduler: str) -> None:
    page = (Path(__file__).parents[2] / "docs/batch.md").read_text()
    (tmp_path / "plan.toml").write_text(page.split("```toml\n")[1].split("```")[0])
    (tmp_path / "objects").mkdir()
    for name in ("objects/a.stl", "objects/b.stl", "grip.obj"):
        (tmp_path / name).write_text(f"make {name}")
    plan = read_plan(tmp_path / "plan.toml", output=tmp_path / "out")
    assert f"these are {len(plan.jobs)} jobs" in page
    outcome = run(list(plan.jobs), tmp_path / "out", scheduler)
    assert ends(outcome.records) == {"made": 18}
    assert all(f"`{status}`" in page for status in STATUSES)


def test_a_cluster_that_will_not_do_is_told(tmp_path: Path, scheduler: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "CONNECT_S", 0.2)
    jobs = quick_jobs(tmp_path, ["make"])
    for address in ("tcp://127.0.0.1:1", "nonsense://x"):
        with pytest.raises(InputError, match="no Dask scheduler answers at"):
            run(jobs, tmp_path / "out", address)
    monkeypatch.setattr(cluster, "CONNECT_S", 20.0)
    monkeypatch.setattr(cluster, "LOCK", ".another")  # not held by anybody
    with pytest.raises(InputError, match=r"is not kept out by the lock on .*\.another"):
        run(jobs, tmp_path / "out", scheduler)
    monkeypatch.setattr(cluster, "__version__", "0.0.0")
    with pytest.raises(InputError, match=r"has skinfab .*, and here it is 0\.0\.0"):
        run(jobs, tmp_path / "out", scheduler)
