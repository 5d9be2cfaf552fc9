"""How far the work is, how long each phase took, and how much memory it needed at most."""

from __future__ import annotations

import resource
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Protocol

#: The phases of the main job, in the order of the report.
PHASES = ("load", "segment", "flatten", "place", "gcode", "mould", "draw")


class Progress(Protocol):
    """Something that long work tells how far it is: `fraction` of the whole from 0 to 1, and `label`, what is being done."""

    def __call__(self, fraction: float, label: str) -> None: ...


def silent(fraction: float, label: str) -> None:
    """Progress that nobody watches.

    Examples
    --------
    >>> silent(0.5, "flattening")
    """


def part_of(progress: Progress, start: float, stop: float) -> Progress:
    """Progress for one part of the work: its 0 to 1 is `start` to `stop` of the whole.

    Examples
    --------
    >>> seen = []
    >>> half = part_of(lambda fraction, label: seen.append((fraction, label)), 0.5, 1.0)
    >>> half(0.5, "moulds"); seen
    [(0.75, 'moulds')]
    """

    def report(fraction: float, label: str) -> None:
        progress(start + (stop - start) * fraction, label)

    return report


@contextmanager
def terminal_progress(*, quiet: bool = False) -> Iterator[Progress]:
    """A bar with an estimate on standard error where that is a terminal; silent otherwise and where `quiet`.

    Yields
    ------
    Progress

    Examples
    --------
    >>> with terminal_progress(quiet=True) as progress:
    ...     progress(1.0, "done")
    """
    if quiet or not sys.stderr.isatty():
        yield silent
        return
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bars

    columns = (TextColumn("{task.description}", markup=False), BarColumn(), TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn())
    with Bars(*columns, console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task("", total=1.0)

        def show(fraction: float, label: str) -> None:
            bars.update(task, completed=min(max(fraction, 0.0), 1.0), description=label)

        yield show


class Stopwatch:
    """Wall-clock seconds by phase, from its making on.

    Examples
    --------
    >>> watch = Stopwatch()
    >>> with watch.phase("load"):
    ...     pass
    >>> sorted(watch.timing_s()) == sorted([*PHASES, "total"])
    True
    """

    def __init__(self) -> None:
        self._started = time.perf_counter()
        self._seconds = dict.fromkeys(PHASES, 0.0)

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """Count the time inside towards `name`, one of `PHASES`; a phase may come more than once."""
        if name not in self._seconds:
            raise ValueError(f"no phase {name!r}; there are {', '.join(PHASES)}")
        began = time.perf_counter()
        try:
            yield
        finally:
            self._seconds[name] += time.perf_counter() - began

    def timing_s(self) -> dict[str, float]:
        """Seconds of every phase, and "total" since the stopwatch was made (reading and writing included)."""
        return {**self._seconds, "total": time.perf_counter() - self._started}


def peak_rss_mb() -> float:
    """Largest resident memory of this process so far, MB (10^6 bytes).

    Examples
    --------
    >>> peak_rss_mb() > 1
    True
    """
    # getrusage would also count what the parent had before exec; the kernel's high-water mark of this program does not.
    try:
        for line in Path("/proc/self/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * 1024 / 1e6
    except FileNotFoundError:
        pass  # no /proc: not Linux
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6
