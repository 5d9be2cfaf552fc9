"""The workers of a batch: processes on this machine, or any Dask cluster by its scheduler's address."""

from __future__ import annotations

import fcntl
import logging
import math
import secrets
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from skinfab import __version__
from skinfab.batch.job import LOCK
from skinfab.errors import InputError
from skinfab.staging import signals_wait

if TYPE_CHECKING:
    from distributed import Client

#: A scheduler that has not answered in that time will not, s.
CONNECT_S = 20.0

#: So long a cluster may be without a worker, s: one that is started through a queue takes its time.
WORKERS_S = 120.0

_RESUMES = "run the same command again: what is done is kept and not done again"

#: What is said where the scheduler does not answer any more.
GONE = f"the Dask scheduler went away; start it and {_RESUMES}"

#: How often the number of workers is asked for, s.
COUNTED_S = 1.0

#: A scheduler of our own never gives a job up: a job that kills its workers is told by its own count (`skinfab.batch.worker`), and the
#: scheduler's would blame jobs that only waited beside it.
_NEVER = 1_000_000

#: Begin of the name of a folder for the files of workers here.
_SCRATCH = "skinfab-batch-"

#: Dask gives some of its loggers a level of their own.
_LOGGERS = ("distributed", "distributed.client", "tornado", "tornado.application", "asyncio")


@contextmanager
def connected(*, folder: Path, scheduler: str | None, workers: int) -> Iterator[Client]:
    """A client of a cluster whose workers can do jobs.

    Parameters
    ----------
    folder : path
        Of the batch, whose `LOCK` the caller holds; every worker must see both.
    scheduler : str, optional
        Address of a Dask scheduler such as ``tcp://10.0.0.5:8786``; without it workers are started here, on the loopback interface alone.
    workers : int
        How many are started here.

    Yields
    ------
    Client

    Raises
    ------
    InputError
        No scheduler answers, it has no workers, or they do not see `folder` and its lock, or have another skinfab.
    """
    import dask
    import distributed  # noqa: F401  (it sets the levels of its loggers when it is imported: first)

    config = {"distributed.comm.timeouts.connect": f"{CONNECT_S:g}s", "distributed.scheduler.allowed-failures": _NEVER}
    with _silent_logs(), dask.config.set(config), _local(workers) if scheduler is None else _remote(scheduler, folder) as client:
        yield client


@contextmanager
def _local(workers: int) -> Iterator[Client]:
    from distributed import Client, LocalCluster

    begun: list[LocalCluster] = []
    with _scratch() as scratch:
        try:
            # Interrupted half-way it would be nobody's: Dask ends it as Python shuts down, and complains of workers that had not begun.
            with signals_wait():
                begun.append(
                    LocalCluster(
                        n_workers=workers,
                        threads_per_worker=1,
                        processes=True,
                        host="127.0.0.1",
                        dashboard_address="127.0.0.1:0",  # None would take port 8787 of all interfaces
                        memory_limit=0,  # that of a worker itself, which only waits
                        local_directory=scratch,
                        silence_logs=logging.CRITICAL,
                        preload=["skinfab.batch.worker"],
                    )
                )
            with Client(begun[0], set_as_default=False) as client:
                yield client
        finally:
            for cluster in begun:
                cluster.close()


@contextmanager
def _scratch() -> Iterator[str]:
    """A folder for the workers' own files; those that clients left which were killed are removed."""
    for lock in Path(tempfile.gettempdir()).glob(f"{_SCRATCH}*/{LOCK}"):
        with suppress(OSError), lock.open("a") as file:  # of a client at work, or of another user
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            shutil.rmtree(lock.parent, ignore_errors=True)
    with tempfile.TemporaryDirectory(prefix=_SCRATCH, ignore_cleanup_errors=True) as folder:
        new = Path(folder, "new")
        with new.open("a") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            new.rename(new.with_name(LOCK))  # so that nobody meets it without its lock
            yield folder


@contextmanager
def _remote(scheduler: str, folder: Path) -> Iterator[Client]:
    from distributed import Client

    try:
        client = Client(scheduler, timeout=CONNECT_S, set_as_default=False)
    except (OSError, ValueError, TypeError) as fault:
        why = " ".join(str(fault).split()) or type(fault).__name__
        raise InputError(f"no Dask scheduler answers at {scheduler} ({why}); start one with `dask scheduler`") from fault
    with client:
        try:
            client.wait_for_workers(1, timeout=WORKERS_S)
        except TimeoutError:
            raise InputError(f"the scheduler at {scheduler} has no workers; start some with `dask worker {scheduler}`") from None
        _require_fit(client, folder)
        yield client


def _require_fit(client: Client, folder: Path) -> None:
    """Every worker sees the folder, and has this skinfab."""
    with tempfile.NamedTemporaryFile(dir=folder, prefix=".seen-") as token:
        token.write(secrets.token_bytes())
        token.flush()
        try:
            seen = client.run(look, token.name, str(folder / LOCK))
        except Exception as fault:  # whatever the other machine raises
            raise InputError(f"the workers cannot import skinfab {__version__}: {fault}; install it there") from fault
        want = (__version__, Path(token.name).read_bytes())
    for address, (version, content, free) in seen.items():
        if version != want[0]:
            raise InputError(f"worker {address} has skinfab {version}, and here it is {want[0]}; install the same on both")
        if content != want[1]:
            raise InputError(f"worker {address} does not see {folder}; give a folder on a disk that all machines share, by the same path")
        if free:
            raise InputError(f"worker {address} is not kept out by the lock on {folder / LOCK}; mount that disk with locks (flock)")


def look(path: str, locked: str) -> tuple[str, bytes | None, bool]:
    """On a worker: its version of skinfab, what it reads at a path, and whether it gets a lock that the client has."""
    try:
        content = Path(path).read_bytes()
        with Path(locked).open("a") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return __version__, content, False
    except OSError:
        return __version__, None, False
    return __version__, content, True


class Slots:
    """How many jobs the workers can do at once, asked for now and then.

    Parameters
    ----------
    client : Client
    """

    def __init__(self, client: Client) -> None:
        self._client = client
        self._asked = self._seen = -math.inf
        self._number = 0

    def now(self) -> int:
        """Threads of all workers.

        Raises
        ------
        InputError
            The scheduler is gone, or has been without workers for `WORKERS_S`.
        """
        now = time.monotonic()
        if now - self._asked < COUNTED_S:
            return self._number
        try:
            self._number = sum(self._client.nthreads().values()) if self._client.status == "running" else -1
        except (OSError, TimeoutError):
            self._number = -1
        if self._number < 0:
            raise InputError(GONE)
        self._asked = now
        self._seen = now if self._number or self._seen < 0 else self._seen
        if now - self._seen > WORKERS_S:
            raise InputError(f"there has been no worker for {WORKERS_S:g} s; start some and {_RESUMES}")
        return self._number


@contextmanager
def _silent_logs() -> Iterator[None]:
    """What Dask logs of lost workers is told in our own words."""
    loggers = [logging.getLogger(name) for name in _LOGGERS]
    before = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(loggers, before, strict=True):
            logger.setLevel(level)
