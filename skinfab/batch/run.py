"""Do the jobs of a batch that are not done yet: whatever breaks off, the next run goes on from there."""

from __future__ import annotations

import fcntl
import json
import os
import queue
import secrets
import shutil
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab import __version__
from skinfab.batch.cluster import GONE, Slots, connected
from skinfab.batch.job import ATTEMPTS, LOCK, Home, Job
from skinfab.batch.record import read_record
from skinfab.batch.worker import end_jobs, runner_command, task
from skinfab.errors import InputError
from skinfab.files import atomic_write, explain_os_error
from skinfab.progress import Progress, silent

if TYPE_CHECKING:
    from distributed import Client, Future

#: One line for each job that is over, in the order in which they ended.
LINES = "jobs.jsonl"

#: The client looks up so often while no job ends, s.
_LOOK_S = 0.5


@dataclass(frozen=True)
class Outcome:
    """What is known of a batch.

    Parameters
    ----------
    records : dict of str to dict
        Of every job by its name.
    before : int
        How many of them were done before this run.
    notes : tuple of str
        What the user should know.
    """

    records: Mapping[str, Mapping[str, Any]]
    before: int
    notes: tuple[str, ...]


def run_batch(
    jobs: Sequence[Job],
    folder: str | Path,
    *,
    workers: int,
    scheduler: str | None = None,
    runner: Sequence[str] | None = None,
    progress: Progress = silent,
    broken_off: Callable[[Outcome], None] | None = None,
) -> Outcome:
    """Do what is not done yet.

    Parameters
    ----------
    jobs : sequence of Job
    folder : path
        Each job's result is ``jobs/NAME`` in it, whole or not at all, with its record in ``job.json``.
    workers : int
        So many processes are started here; without meaning where `scheduler` is given.
    scheduler : str, optional
        Address of a Dask scheduler.
    runner : sequence of str, optional
        The program that does the jobs; default `runner_command`.
    progress : Progress
    broken_off : callable, optional
        Given what is known where the batch ends before its jobs do, by an interrupt or an error, which goes on afterwards.

    Raises
    ------
    InputError
        The folder cannot be written or another batch is at work in it, its records are damaged, or there is no cluster.
    """
    home = Home(Path(folder).resolve())
    try:
        home.folder.mkdir(parents=True, exist_ok=True)
        with _alone(home.folder / LOCK):
            done, notes = _done(home, jobs)
            atomic_write(home.folder / LINES, "".join(json.dumps(record) + "\n" for record in done.values()))
            left = [job for job in jobs if job.name not in done]
            records = dict(done)
            if left:
                try:
                    with (home.folder / LINES).open("a", encoding="utf-8") as lines:
                        for record in _do_all(left, home, min(workers, len(left)), scheduler, runner or runner_command(), progress):
                            records[record["job"]] = record
                            if record["status"] != "not run":
                                lines.write(json.dumps(record) + "\n")
                                lines.flush()
                except BaseException:
                    if broken_off is not None:
                        not_run = {job.name: _not_run(job, "the batch was broken off before") for job in jobs}
                        broken_off(Outcome({**not_run, **records}, len(done), tuple(notes)))
                    raise
                finally:
                    _sweep(home)
            if not any(record["status"] == "not run" for record in records.values()):
                shutil.rmtree(home.under_way, ignore_errors=True)
    except OSError as fault:
        raise InputError(explain_os_error(fault, home.folder)) from fault
    return Outcome({job.name: records[job.name] for job in jobs}, len(done), tuple(notes))


def _not_run(job: Job, why: str) -> dict[str, Any]:
    return {"job": job.name, "status": "not run", "message": f"{why}; run again"}


@contextmanager
def _alone(path: Path) -> Iterator[None]:
    """Two batches in one folder would not know of each other's jobs."""
    with path.open("a") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError(f"another batch is at work in {path.parent}; wait for its end, or give another -o") from None
        yield


def _sweep(home: Home) -> None:
    """Remove what workers that were killed have left; not what one that lost its scheduler is still at."""
    for stage in home.under_way.glob("*-*"):
        with suppress(BlockingIOError), (home.under_way / f"{stage.name.split('-')[0]}.lock").open("a") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            shutil.rmtree(stage, ignore_errors=True)


def _done(home: Home, jobs: Sequence[Job]) -> tuple[dict[str, dict[str, Any]], list[str]]:
    """Records of the jobs that are over; those that failed for a limit which has been raised since are forgotten."""
    there = home.names()
    done = {}
    for job in jobs:
        if job.name not in there or (record := read_record(home.record(job.name), job.name)) is None:
            continue
        if _raised(record, job):
            home.under_way.mkdir(exist_ok=True)
            aside = home.under_way / f"{job.name}-{secrets.token_hex(4)}"
            os.rename(home.place(job.name), aside)  # in one step: a half of it, left by a kill, would be in the way of the new one
            shutil.rmtree(aside)
        else:
            done[job.name] = record
    others = len(there - {job.name for job in jobs})
    place = home.folder / "jobs"
    notes: list[str] = []
    if others:
        they = f"{others} results in {place} are" if others > 1 else f"1 result in {place} is"
        notes.append(f"{they} of other meshes or settings and left alone")
    old = sum(record["skinfab"] != __version__ for record in done.values())
    if old:
        they = f"{old} of the results were" if old > 1 else "1 of the results was"
        notes.append(f"{they} made by another version of skinfab; remove what is to be made anew from {place}")
    return done, notes


def _raised(record: Mapping[str, Any], job: Job) -> bool:
    """Whether a job was ended for a limit that is a wider one now."""
    was, now = {
        "time": (record["limits"]["time_s"], job.time_s),
        "memory": (record["limits"]["memory_mb"], job.memory_mb),
    }.get(record["status"], (None, None))
    return was is not None and (now is None or now > was)


def _do_all(
    jobs: Sequence[Job], home: Home, workers: int, scheduler: str | None, runner: Sequence[str], progress: Progress
) -> Iterator[dict[str, Any]]:
    """Records, as they come in."""
    run = secrets.token_hex(4)
    progress(0.0, f"starting {workers} workers" if scheduler is None else f"asking {scheduler}")
    with connected(folder=home.folder, scheduler=scheduler, workers=workers) as client:
        try:
            progress(0.0, f"0 of {len(jobs)} jobs")
            bad = 0
            for number, record in enumerate(_Submitting(client, jobs, home, run, runner), 1):
                bad += record["status"] != "made"
                progress(number / len(jobs), f"{number} of {len(jobs)} jobs" + (f", {bad} without a result" if bad else ""))
                yield record
        finally:
            # Also when interrupted: a worker that waits for its job would not end.
            with suppress(Exception):  # nothing is lost where a worker cannot be told
                client.run(end_jobs, run, on_error="ignore")


class _Submitting:
    """Hands out as many jobs as the workers do at once, and gives their records as they end.

    The rest waits here and not at the scheduler: a worker that dies takes nothing with it but what it was doing.
    """

    def __init__(self, client: Client, jobs: Sequence[Job], home: Home, run: str, runner: Sequence[str]) -> None:
        self._client, self._home, self._run, self._runner = client, home, run, list(runner)
        self._waiting = deque((job, 1) for job in jobs)
        self._running: dict[str, tuple[Job, int, Future]] = {}
        self._over: queue.SimpleQueue[Future] = queue.SimpleQueue()
        self._slots = Slots(client)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        while self._waiting or self._running:
            while self._waiting and len(self._running) < self._slots.now():
                self._submit(*self._waiting.popleft())
            try:
                future = self._over.get(timeout=_LOOK_S)
            except queue.Empty:
                self._slots.now()  # says so where there is nobody left to wait for
                continue
            job, times, _ = self._running.pop(str(future.key))
            record = self._record(future, job, times)
            if record is not None:
                yield record

    def _submit(self, job: Job, times: int) -> None:
        key = f"skinfab-{job.name}-{self._run}-{times}"
        future = self._client.submit(task, job, str(self._home.folder), self._run, self._runner, key=key, pure=False)
        self._running[key] = (job, times, future)
        future.add_done_callback(self._over.put)

    def _record(self, future: Future, job: Job, times: int) -> dict[str, Any] | None:
        """None where the job was put back."""
        from distributed import KilledWorker

        fault: BaseException | None = None
        with suppress(OSError, TimeoutError, CancelledError):  # it died while it was asked
            if future.status == "finished":
                found: dict[str, Any] = future.result()
                return found
            if future.status == "error":
                fault = future.exception()
        if fault is None:
            raise InputError(GONE)
        if isinstance(fault, InputError):
            raise fault  # of the folder: no other job could be done either
        if isinstance(fault, KilledWorker) and times <= ATTEMPTS:
            self._waiting.append((job, times + 1))  # the scheduler counts what waited there too: the job's own count decides
            return None
        return _not_run(job, f"{type(fault).__name__}: {fault}")
