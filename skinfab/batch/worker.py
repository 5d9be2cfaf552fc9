"""What a worker of the cluster does with a job: once, however often it is asked, and its result appears whole or not at all."""

from __future__ import annotations

import errno
import fcntl
import json
import os
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from skinfab import __version__
from skinfab.batch.job import ATTEMPTS, RECORD, SAID, Home, Job
from skinfab.batch.record import read_record
from skinfab.batch.runner import Ran
from skinfab.errors import InputError
from skinfab.files import DISK_FULL, atomic_write, explain_os_error

#: A runner that does a job ends at once when it is told to, s.
_END_S = 1.0

#: What Python, skinfab and C++ say that cannot reserve what they need.
_SHORT = ("MemoryError", "not enough memory", "bad_alloc")

#: Of what a job printed, so much is looked at, bytes: its last line says why it failed.
_LAST_BYTES = 4096


class Runners:
    """Processes that do jobs (`skinfab.batch.runner`), each one job at a time; an idle one is taken where there is one.

    Parameters
    ----------
    command : sequence of str
        The program that serves.
    """

    def __init__(self, command: Sequence[str]) -> None:
        self._command = list(command)
        self._idle: list[subprocess.Popen[bytes]] = []
        self._busy: set[subprocess.Popen[bytes]] = set()
        self._closing = False
        self._lock = threading.Lock()

    def run(self, words: Sequence[str], *, said: Path, time_s: float | None, memory_mb: float | None) -> Ran | None:
        """Run a command; None where the runner was killed.

        Raises
        ------
        Closing
            The worker is on its way out.
        """
        runner = self._take()
        assert runner.stdin is not None and runner.stdout is not None
        wanted = {"words": list(words), "said": str(said), "time_s": time_s, "memory_mb": memory_mb}
        answer = b""
        with suppress(BrokenPipeError, ValueError):  # it was killed, or its input was closed from here
            runner.stdin.write(json.dumps(wanted).encode() + b"\n")
            runner.stdin.flush()
            answer = runner.stdout.readline()
        with self._lock:
            if answer and not self._closing:
                self._busy.discard(runner)
                self._idle.append(runner)
                return Ran(**json.loads(answer))
            self._busy.discard(runner)
        _dispose(runner)
        if self._closing:
            raise Closing
        return None

    def close(self) -> None:
        """End them all, and what they are doing."""
        with self._lock:
            self._closing = True
            idle, busy = self._idle, list(self._busy)
            self._idle, self._busy = [], set()
        _dispose(*idle)
        _end(*busy)  # the thread that waits for its answer disposes of it

    def _take(self) -> subprocess.Popen[bytes]:
        with self._lock:
            if self._closing:
                raise Closing
            gone = [runner for runner in self._idle if runner.poll() is not None]  # idle for too long
            self._idle = [runner for runner in self._idle if runner not in gone]
            runner = self._idle.pop() if self._idle else self._start()
            self._busy.add(runner)
        _dispose(*gone)
        return runner

    def _start(self) -> subprocess.Popen[bytes]:
        one_thread = {variable: os.environ.get(variable, "1") for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")}
        # A session of its own: Ctrl-C at the terminal is for the command, which ends its workers, and they what they started.
        return subprocess.Popen(
            self._command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={**os.environ, **one_thread},
            start_new_session=True,
        )


class Closing(Exception):
    """The worker ends while it does a job, which is not over."""


def _end(*runners: subprocess.Popen[bytes]) -> None:
    for runner in runners:
        assert runner.stdin is not None
        with suppress(BrokenPipeError):
            runner.stdin.close()  # at which it kills its job and ends
    end = time.monotonic() + _END_S
    for runner in runners:
        try:
            runner.wait(timeout=max(end - time.monotonic(), 0.0))
        except subprocess.TimeoutExpired:
            runner.kill()  # it is still loading what it needs, and has no job yet
            runner.wait()


def _dispose(*runners: subprocess.Popen[bytes]) -> None:
    _end(*runners)
    for runner in runners:
        assert runner.stdout is not None
        runner.stdout.close()


def do_job(job: Job, folder: str, run: str, runners: Runners) -> dict[str, Any]:
    """Do a job unless it is done, and give its record.

    Parameters
    ----------
    job : Job
    folder : path
        Of the batch; every worker sees the same.
    run : str
        Names this run of the batch: workers that die in another do not count.
    runners : Runners

    Raises
    ------
    InputError
        The folder cannot be written: no job can be done.
    """
    home = Home(Path(folder))
    try:
        home.under_way.mkdir(parents=True, exist_ok=True)
        # A worker that is cut off from its cluster goes on: the same job, given to another, waits here until that one is over.
        with _held(home.under_way / f"{job.name}.lock") as begun:
            if (record := read_record(home.record(job.name), job.name)) is not None:
                return record
            return _do(job, home, run, runners, begun)
    except OSError as fault:
        raise InputError(explain_os_error(fault, home.folder)) from fault


@contextmanager
def _held(path: Path) -> Iterator[Any]:
    """A file that one at a time has open, among all machines that see it."""
    with path.open("a+", encoding="utf-8") as file:
        fcntl.flock(file, fcntl.LOCK_EX)  # let go by the system where the worker is killed
        yield file


def _do(job: Job, home: Home, run: str, runners: Runners, begun: Any) -> dict[str, Any]:
    for left in home.under_way.glob(f"{job.name}-*"):
        shutil.rmtree(left, ignore_errors=True)  # of a worker that was killed
    begun.seek(0)
    attempts = [line.split()[0] for line in begun.read().splitlines()]
    stage = home.under_way / f"{job.name}-{secrets.token_hex(4)}"
    stage.mkdir()
    try:
        ran = None
        while ran is None and attempts.count(run) < ATTEMPTS:
            attempts.append(run)
            begun.write(f"{run} {socket.gethostname()} {os.getpid()}\n")
            begun.flush()
            os.fsync(begun.fileno())
            ran = runners.run(job.words(stage), said=stage / SAID, time_s=job.time_s, memory_mb=job.memory_mb)
        found = _judged(job, ran, _last_line(stage / SAID, stage))
        if job.has_changed():
            return {"job": job.name, "status": "not run", "message": f"{job.mesh}, or a file of its settings, changed meanwhile; run again"}
        return _keep(job, home, stage, {**found, **_figures(stage), "attempts": len(attempts)})
    finally:
        shutil.rmtree(stage, ignore_errors=True)


def _judged(job: Job, ran: Ran | None, last: str) -> dict[str, Any]:
    """How it ended, in one word and a sentence."""
    if ran is None:
        return {"status": "lost", "message": f"{ATTEMPTS} workers died while they did it; run it by itself, or give [limits] memory_mb"}
    used = {"wall_s": round(ran.wall_s, 3), "cpu_s": round(ran.cpu_s, 3), "peak_mb": round(ran.peak_mb, 1)}
    if ran.ended == "time":
        return {**used, "status": "time", "message": f"took longer than the {job.time_s:g} s of [limits] and was ended"}
    short = any(said in last for said in _SHORT)
    if ran.ended == "memory" or (job.memory_mb is not None and ran.exit != 0 and short):
        return {**used, "status": "memory", "message": f"needed more than the {job.memory_mb:g} MB of [limits] and was ended"}
    if ran.exit is None:
        return {**used, "status": "crashed", "message": f"ended by signal {ran.signal}" + (f"; it last said: {last}" if last else "")}
    if ran.exit == 0:
        return {**used, "status": "made", "message": ""}
    if DISK_FULL in last or os.strerror(errno.ENOSPC) in last:
        raise OSError(errno.ENOSPC, last)  # of the whole batch, not of this job
    return {**used, "status": "refused" if ran.exit == 3 else "failed", "message": last or f"exit status {ran.exit}"}


def _last_line(path: Path, stage: Path) -> str:
    """The last line of what was printed, without the program's name; the hidden folder is called after what it becomes."""
    try:
        with path.open("rb") as file:
            file.seek(0, os.SEEK_END)
            file.seek(max(file.tell() - _LAST_BYTES, 0))
            lines = file.read().decode(errors="replace").split("\n")
    except FileNotFoundError:
        return ""
    last = next((line.strip() for line in reversed(lines) if line.strip()), "")
    return last.removeprefix("skinfab: ").replace(str(stage), "its folder")


def _figures(stage: Path) -> dict[str, Any]:
    """What the table shows of a report."""
    try:
        report = json.loads((stage / "report.json").read_bytes())
    except FileNotFoundError:
        return {}
    return {
        "figures": {
            "n_faces": report["mesh"]["n_faces"],
            "n_pieces": len(report["pieces"]),
            "d_mean": report["distortion"]["mean"],
            "d_p99": report["distortion"]["p99"],
            "seam_mm": report["seam_mm"],
            "n_sensors": len(report["sensors"]),
            "ink_mm3": sum(each["ink_mm3"] for each in report["gcode"]),
            "print_s": sum(each["time_s"] for each in report["gcode"]),
            "n_moulds": len(report["moulds"]),
            "n_warnings": len(report["warnings"]),
        }
    }


def _keep(job: Job, home: Home, stage: Path, found: dict[str, Any]) -> dict[str, Any]:
    """Write the record beside the result and move both into place as one."""
    record = {
        "job": job.name,
        "mesh": job.mesh,
        "settings": dict(job.settings),
        "limits": {"time_s": job.time_s, "memory_mb": job.memory_mb},
        "skinfab": __version__,
        "host": socket.gethostname(),
        **found,
    }
    if (stage / SAID).exists():
        said = (stage / SAID).read_text(encoding="utf-8", errors="replace").replace(str(stage), str(home.place(job.name)))
        atomic_write(stage / SAID, said)
    atomic_write(stage / RECORD, json.dumps(record, indent=1) + "\n")
    home.place(job.name).parent.mkdir(exist_ok=True)
    os.rename(stage, home.place(job.name))
    return record


def task(job: Job, folder: str, run: str, runner: Sequence[str]) -> dict[str, Any]:
    """`do_job` on a worker of a Dask cluster, which keeps the runners of this run."""
    from distributed import get_worker

    # Made without starting anything, and put there in one step: a worker may have several threads.
    runners = get_worker().extensions.setdefault(f"skinfab-{run}", Runners(runner))
    return do_job(job, folder, run, runners)


def end_jobs(run: str, dask_worker: Any) -> None:
    """On a worker of a Dask cluster: end the runners of this run, and what they are doing."""
    # A job that comes only now finds them closed.
    dask_worker.extensions.setdefault(f"skinfab-{run}", Runners([])).close()


def dask_setup(worker: Any) -> None:
    """Called by Dask in each worker process of our own: Ctrl-C at the terminal is for the command, which ends its workers."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def runner_command() -> list[str]:
    """The program that serves: `-P`, so that a script of the user's in the working folder is not taken for one of ours."""
    return [sys.executable, "-P", "-m", "skinfab.cli.batch_job"]
