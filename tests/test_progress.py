"""Progress and timing: phases add up, silence is silent, a terminal gets a bar."""

import os
import pty
import subprocess
import sys
import time

import pytest

from skinfab.progress import PHASES, Stopwatch, part_of, peak_rss_mb, silent, terminal_progress

BAR = """
import time
from skinfab.progress import terminal_progress
with terminal_progress(quiet={quiet}) as progress:
    progress(0.25, "flattening [/]*.obj"); time.sleep(0.3)
    progress(0.75, "moulds"); time.sleep(0.3)
"""


def test_phases_add_up_and_stay_under_the_total() -> None:
    watch = Stopwatch()
    for _ in range(2):
        with watch.phase("flatten"):
            time.sleep(0.02)
    with pytest.raises(ZeroDivisionError), watch.phase("place"):
        raise ZeroDivisionError
    timing = watch.timing_s()
    assert list(timing) == [*PHASES, "total"]
    assert timing["flatten"] >= 0.04 and timing["load"] == 0.0 and timing["place"] > 0.0
    assert sum(timing[p] for p in PHASES) <= timing["total"]


def test_misspelt_phase_is_refused() -> None:
    with pytest.raises(ValueError, match="no phase 'flaten'"), Stopwatch().phase("flaten"):
        pass


def test_peak_memory_sees_an_allocation() -> None:
    grow = "from skinfab.progress import peak_rss_mb as p; a = p(); b = b'x' * 80_000_000; print(p() - a)"
    grown = float(subprocess.run([sys.executable, "-c", grow], capture_output=True, text=True, check=True).stdout)
    assert 75 < grown < 90
    assert peak_rss_mb() > 10


def test_parts_nest() -> None:
    seen: list[float] = []
    second = part_of(lambda fraction, label: seen.append(fraction), 0.5, 1.0)
    first_half_of_second = part_of(second, 0.0, 0.5)
    first_half_of_second(1.0, "x")
    assert seen == [0.75]


def test_no_terminal_means_silence(capsys: pytest.CaptureFixture[str]) -> None:
    with terminal_progress() as progress:
        progress(0.5, "half")
    assert progress is silent and capsys.readouterr() == ("", "")


@pytest.mark.parametrize("quiet", [False, True])
def test_terminal_gets_a_bar_unless_quiet(quiet: bool) -> None:
    master, slave = pty.openpty()
    environment = {**os.environ, "TERM": "xterm-256color", "COLUMNS": "100"}
    run = subprocess.run(
        [sys.executable, "-c", BAR.format(quiet=quiet)], stderr=slave, stdout=subprocess.PIPE, env=environment, check=True, timeout=30
    )
    os.set_blocking(master, False)
    os.close(slave)
    shown = b""
    try:
        while block := os.read(master, 65536):
            shown += block
    except OSError:  # the other end is closed and all has been read
        pass
    os.close(master)
    assert run.stdout == b""
    assert (b"[/]*.obj" in shown and b"moulds" in shown and b"left" in shown) is not quiet
