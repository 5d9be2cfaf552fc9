"""A process that does jobs one after the other, each in a process of its own that can be ended: too long, too large, or crashed.

It has everything imported already and forks for each job, so that a job does not pay for the imports. What it is to do
comes as lines of JSON on standard input, and what became of it goes out as lines of JSON. When its input ends, because whoever started it
was ended or killed, so do the job under way and the process itself.
"""

from __future__ import annotations

import ctypes
import gc
import json
import os
import resource
import select
import signal
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Literal, NoReturn, TypeAlias

#: A job's time and memory are looked at so often, s: a hundredth of the shortest job, and it costs nothing to speak of.
WATCH_S = 0.02

#: Without a job for so long, s, the process ends: a client that was killed leaves it behind on a cluster that goes on.
IDLE_S = 300.0

_PR_SET_PDEATHSIG = 1  # linux/prctl.h

#: What a job is ended for.
Ended: TypeAlias = Literal["time", "memory"]


@dataclass(frozen=True)
class Ran:
    """What became of a process.

    Parameters
    ----------
    exit : int, optional
        Its exit status; None where a signal ended it.
    signal : int, optional
        The signal that ended it.
    ended : str, optional
        "time" or "memory": the limit it was ended for.
    wall_s, cpu_s : float, s
    peak_mb : float, MB (10^6 bytes)
        Its largest resident memory.
    """

    exit: int | None
    signal: int | None
    ended: Ended | None
    wall_s: float
    cpu_s: float
    peak_mb: float


def serve(work: Callable[[list[str]], int]) -> None:
    """Do the jobs that standard input names until it ends.

    Parameters
    ----------
    work : callable
        Takes the words of a command and returns its exit status; called in a process of its own for each job. A line of
        input is an object with ``words``, ``said`` (the file that takes what the job prints), ``time_s`` and ``memory_mb``
        (limits, or null).
    """
    # Whatever is printed here, or by a library, must not get between the answers.
    answers = os.dup(1)
    os.dup2(2, 1)
    gc.collect()
    gc.freeze()  # a collector that walks what was loaded would give each job a copy of it
    while select.select([0], [], [], IDLE_S)[0] and (line := sys.stdin.buffer.readline()):
        wanted = json.loads(line)
        ran = run_apart(work, wanted["words"], said=wanted["said"], time_s=wanted["time_s"], memory_mb=wanted["memory_mb"], leash=0)
        os.write(answers, json.dumps(asdict(ran)).encode() + b"\n")


def run_apart(
    work: Callable[[list[str]], int],
    words: list[str],
    *,
    said: str | Path,
    time_s: float | None = None,
    memory_mb: float | None = None,
    leash: int | None = None,
) -> Ran:
    """Call `work` in a process of its own, and end that where it passes a limit.

    Parameters
    ----------
    work : callable
    words : list of str
        What it is called with.
    said : path
        The file that takes its standard output and standard error.
    time_s : float, s, optional
        Wall-clock time at most.
    memory_mb : float, MB (10^6 bytes), optional
        Resident memory at most, looked at every `WATCH_S`; beyond what is there already no more than this can be reserved at all.
    leash : int, optional
        A file descriptor; when it becomes readable (its other end is gone), the job and this process end.
    """
    loaded = _status_bytes(os.getpid(), "VmSize:")
    reserved = loaded + int(memory_mb * 1e6) if loaded and memory_mb is not None else None
    began = time.monotonic()
    mine = os.getpid()
    pid = os.fork()
    if pid == 0:
        _be_the_job(work, words, said, reserved, mine)
    ended: Ended | None = None
    while True:
        done, status, used = os.wait4(pid, os.WNOHANG)
        if done:
            break
        if ended is None and time_s is not None and time.monotonic() - began > time_s:
            ended = "time"
        elif ended is None and memory_mb is not None and _status_bytes(pid, "VmRSS:") > memory_mb * 1e6:
            ended = "memory"
        gone = select.select([] if leash is None else [leash], [], [], WATCH_S)[0]
        if ended or gone:
            os.kill(pid, signal.SIGKILL)
            _kill_group(pid)
        if gone:
            os._exit(1)
    _kill_group(pid)  # whatever it started itself
    code, by = (os.WEXITSTATUS(status), None) if os.WIFEXITED(status) else (None, os.WTERMSIG(status))
    peak = used.ru_maxrss * (1 if sys.platform == "darwin" else 1024)  # counts from the fork, as no other program was started
    return Ran(code, by, ended, time.monotonic() - began, used.ru_utime + used.ru_stime, peak / 1e6)


def _be_the_job(work: Callable[[list[str]], int], words: list[str], said: str | Path, reserved: int | None, parent: int) -> NoReturn:
    """In the new process: never returns."""
    status = 1
    try:
        os.setsid()  # so that all it starts is ended with it
        _die_with_parent(parent)
        nothing, output = os.open(os.devnull, os.O_RDONLY), os.open(said, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666)
        for taken, number in ((nothing, 0), (output, 1), (output, 2)):
            os.dup2(taken, number)
        if reserved is not None:
            resource.setrlimit(resource.RLIMIT_AS, (reserved, resource.getrlimit(resource.RLIMIT_AS)[1]))
        status = work(words)
        sys.stdout.flush()
        sys.stderr.flush()
    except BaseException as fault:  # `work` tells its own; what still comes here is told too, and nothing may go back into the loop
        os.write(2, f"unexpected {type(fault).__name__}: {fault}\n".encode())
    finally:
        os._exit(status)


def _die_with_parent(parent: int) -> None:
    """Also where the parent is killed outright (Linux; elsewhere such a job goes on to its end, and is thrown away)."""
    if sys.platform == "linux":
        ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != parent:
            os._exit(1)


def _kill_group(pid: int) -> None:
    with suppress(ProcessLookupError, PermissionError):  # empty, or not yet made
        os.killpg(pid, signal.SIGKILL)


def _status_bytes(pid: int, field: str) -> int:
    """A size from /proc/PID/status, bytes; 0 where the process is over or the system has no such file."""
    try:
        for line in Path(f"/proc/{pid}/status").read_text().splitlines():
            if line.startswith(field):
                return int(line.split()[1]) * 1024
    except (FileNotFoundError, ProcessLookupError):
        pass
    return 0
