import os
import sys
import time

import numpy as np
import pytest

from skinfab.bench.timing import one_processor, timed, timed_twice


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the kernel's high-water mark is read from /proc")
def test_memory_of_each_call_is_its_own() -> None:
    small, large = 20_000_000, 60_000_000
    peaks = [timed(lambda n=n: np.ones(n // 8).sum())[2] for n in (large, small, large)]
    assert peaks == [pytest.approx(n / 1e6, abs=8) for n in (large, small, large)]


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="this system does not bind processes to processors")
def test_one_processor_inside_and_all_of_them_after_also_after_a_fault() -> None:
    before = os.sched_getaffinity(0)
    inside = []

    def fail() -> None:
        with one_processor() as alone:
            inside.append((alone, len(os.sched_getaffinity(0))))
            raise ValueError("fault")

    with pytest.raises(ValueError, match="fault"):
        fail()
    assert inside == [(True, 1)]
    assert os.sched_getaffinity(0) == before


def test_waiting_is_on_the_wall_but_not_the_processes_own_time() -> None:
    result, own_s, wall_s, _ = timed_twice(lambda: time.sleep(0.2))
    assert result is None and own_s < 0.1 < 0.2 <= wall_s + 1e-3
