"""Whether the window answers while long work goes on, and how soon that work is stopped: `skinfab gui`, driven from outside.

``python benchmarks/gui_responsive.py [-o responsive.csv] [--mesh MESH] [--events 400] [--cancels 10]``. The object is being cut by
itself all the while (about ten seconds for the grip's 85,000 triangles; begun again when it is done). The time of an event is from moving
the pointer over the object (xdotool, through the X server) until the window has answered a question sent after it and drawn what
was due; a process that is started for each motion is inside it, and its time alone stands in the row `xdotool`. Targets: an
event within 100 ms, cancel within 500 ms. Needs Xvfb, openbox and xdotool (tests/setup_gui.sh).
"""

from __future__ import annotations

import argparse
import csv
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]  # in this order: tests/gui is not gui

from outside import FLAT, OBJECT, Window  # noqa: E402
from screen import Screen, missing, until  # noqa: E402

CANCEL = ".statusbar.work.cancel"
COLUMNS = ("what", "events", "median_ms", "p95_ms", "max_ms", "target_ms")


def row(what: str, times: list[float], target: float) -> tuple[object, ...]:
    """A line of the table, from seconds."""
    figures = np.percentile(1e3 * np.array(times), [50, 95, 100])
    return what, len(times), *(f"{value:.1f}" for value in figures), f"{target:g}"


def busy(window: Window) -> None:
    """See to it that the object is being cut, and has been for a moment."""
    if not window.busy:
        window.key("F5")
        until(lambda: window.busy, "the work to begin")


def timed(window: Window, act: Callable[[int], object], count: int, *, working: bool) -> list[float]:
    """Seconds of each event with its answer."""
    times = []
    while len(times) < count:
        if working:
            busy(window)
        start = time.perf_counter()
        act(len(times))
        window.tcl("update idletasks")
        spent = time.perf_counter() - start
        if not working or window.busy:  # the result has not come in between: that is measured by itself
            times.append(spent)
    return times


def moves(screen: Screen, window: Window, widget: str) -> Callable[[int], object]:
    """Moves the pointer to and fro over a widget."""
    x, y = window.place(widget)
    return lambda k: screen.xdo("mousemove", x + (7 * k) % 60 - 30, y + (5 * k) % 40 - 20)


def arrivals(window: Window, events: int) -> list[float]:
    """The longest silence of the window round the end of each job, when its result comes in and both views are drawn anew."""
    longest = []
    while len(longest) < events:
        busy(window)
        worst = 0.0
        while window.busy:
            start = time.perf_counter()
            window.tcl("update idletasks")
            worst = max(worst, time.perf_counter() - start)
        for _ in range(20):
            start = time.perf_counter()
            window.tcl("update idletasks")
            worst = max(worst, time.perf_counter() - start)
        longest.append(worst)
    return longest


def cancels(window: Window, count: int) -> list[float]:
    """Seconds from the click on Cancel until there is no work any more."""
    times = []
    for _ in range(count):
        busy(window)
        x, y = window.place(CANCEL)
        window.screen.xdo("mousemove", x, y)
        start = time.perf_counter()
        window.screen.xdo("click", 1)
        until(lambda: not window.busy, "the work to end")
        times.append(time.perf_counter() - start)
    return times


def main() -> int:
    """Measure, print and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, help="also write the table there")
    parser.add_argument("--mesh", type=Path, default=ROOT / "meshes/grip.obj")
    parser.add_argument("--events", type=int, default=400)
    parser.add_argument("--cancels", type=int, default=10)
    parser.add_argument("--results", type=int, default=2, help="jobs that are waited for")
    args = parser.parse_args()
    if gone := missing():
        parser.exit(1, f"gui_responsive: {', '.join(gone)} not installed; tests/setup_gui.sh installs them as root\n")
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "state").mkdir()
        screen = Screen(Path(folder))
        window = Window(screen, Path(folder) / "state", args.mesh)
        try:
            window.open_mesh()
            window.settled()
            on_object, on_flat = moves(screen, window, OBJECT), moves(screen, window, FLAT)
            rows = [
                row("xdotool", timed(window, lambda k: screen.xdo("getmouselocation"), args.events // 4, working=False), 0),
                row("object, nothing to do", timed(window, on_object, args.events, working=False), 100),
                row("object, while it is cut", timed(window, on_object, args.events, working=True), 100),
                row("flat skin, while it is cut", timed(window, on_flat, args.events, working=True), 100),
                row("cancel", cancels(window, args.cancels), 500),
                row("when the result comes", arrivals(window, args.results), 100),
            ]
        finally:
            window.kill()
            screen.close()
    for each in (COLUMNS, *rows):
        print("  ".join(f"{value!s:>{26 if k == 0 else 9}}" for k, value in enumerate(each)))
    if args.output:
        with args.output.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([COLUMNS, *rows])
    return 0


if __name__ == "__main__":
    sys.exit(main())
