"""Time and memory of one call, measured the same way for everybody."""

from __future__ import annotations

import ctypes
import gc
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")

#: A method that has used this much time on a size, s, is not repeated: long runs hardly vary, short ones do.
ENOUGH_S = 10.0

_RESET_PEAK = "5"  # proc(5), clear_refs


@contextmanager
def one_processor() -> Iterator[bool]:
    """Keep this process on one processor: BLAS, OpenMP and every library's own threads alike. False where that cannot be."""
    if not hasattr(os, "sched_setaffinity"):
        yield False
        return
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(before)})
    try:
        yield True
    finally:
        os.sched_setaffinity(0, before)


def timed(work: Callable[[], T]) -> tuple[T, float, float]:
    """The result, wall seconds, and by how much memory rose above what it was before, MB (NaN where the system does not tell).

    Examples
    --------
    >>> timed(lambda: sum(range(10)))[0]
    45
    """
    result, _, seconds, peak_mb = timed_twice(work)
    return result, seconds, peak_mb


def timed_twice(work: Callable[[], T]) -> tuple[T, float, float, float]:
    """As `timed`, with the process's own seconds before the wall's: other programs hardly disturb those."""
    gc.collect()
    before = _restart_peak()
    began, own = time.perf_counter(), time.process_time()
    result = work()
    own_s, wall_s = time.process_time() - own, time.perf_counter() - began
    return result, own_s, wall_s, _status_mb("VmHWM") - before


def _restart_peak() -> float:
    """Hand free memory back, start the kernel's high-water mark anew; what is resident now, MB."""
    try:
        # Memory that an earlier call freed but the allocator kept would hide what this call needs.
        ctypes.CDLL(None).malloc_trim(0)
        Path("/proc/self/clear_refs").write_text(_RESET_PEAK)
    except (OSError, AttributeError):  # not Linux with glibc
        return float("nan")
    return _status_mb("VmRSS")


def _status_mb(name: str) -> float:
    try:
        lines = Path("/proc/self/status").read_text().splitlines()
    except FileNotFoundError:
        return float("nan")
    return next((int(line.split()[1]) * 1024 / 1e6 for line in lines if line.startswith(name + ":")), float("nan"))
