"""How fast the 3D view turns, enlarges and answers the pointer: the real window, driven by events, on a virtual screen.

``python benchmarks/gui_orbit.py [-o orbit.csv] [--events 200] [--skin GRIP.skin]``. The time of an event is from sending it until
the screen has taken the picture it led to (a round trip to the X server closes it): camera, z-buffer, colours, lines, labels and the
way to the screen are inside. Targets at 900 x 700: 85,000 triangles p95 <= 33 ms (aim 16 ms), 500,000 triangles at 20 pictures a second.
"""

from __future__ import annotations

import argparse
import csv
import os
import subprocess
import sys
import tempfile
import time
import tkinter as tk
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from gui.state.derived import Derived
from gui.state.session import Session
from gui.theme import LIGHT, apply
from gui.view3d.view import View3D
from skinfab.bench.disks import bumpy_cap
from skinfab.document import load_skin
from skinfab.mesh.model import Mesh
from skinfab.skin import Skin, Source

MESHES = Path(__file__).resolve().parent.parent / "meshes"
WIDTH, HEIGHT = 900, 700
COLUMNS = ("mesh", "triangles", "what", "events", "median_ms", "p95_ms", "max_ms", "per_second")


@contextmanager
def screen() -> Iterator[None]:
    """A virtual screen, as in the tests."""
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp"]
    server = subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as pipe:
        os.environ["DISPLAY"] = f":{pipe.readline().strip()}"
    try:
        yield
    finally:
        server.terminate()
        server.wait()


def grip(folder: Path) -> Path:
    """The grip with automatic seams and sensors, as the command line makes it."""
    path = folder / "grip.skin"
    for command in (["segment", str(MESHES / "grip.obj"), "-o", str(path)], ["place", str(path)]):
        subprocess.run([sys.executable, "-m", "skinfab", *command], check=True, stdout=subprocess.DEVNULL)
    return path


def cap() -> Skin:
    """500,000 triangles in one open surface, so that none can be left out because it is seen from behind."""
    return Skin(Mesh(*bumpy_cap(500_000), "cap"), Source("cap", "0" * 64, "mm", 1.0), np.zeros((0, 2), dtype=np.int64), ())


def timed(root: tk.Tk, event: Callable[[int], object], count: int) -> list[float]:
    """Milliseconds from each event to its picture on the screen."""
    times = []
    for k in range(count):
        start = time.perf_counter()
        event(k)
        root.update()
        root.winfo_pointerxy()  # is answered after the picture was taken
        times.append(1e3 * (time.perf_counter() - start))
    return times


def measure(name: str, skin: Skin, events: int) -> Iterator[tuple[object, ...]]:
    """Rows of the table for one object, in a window of its own."""
    root = tk.Tk()
    root.geometry(f"{WIDTH}x{HEIGHT}+0+0")
    apply(root, LIGHT)
    session = Session()
    view = View3D(root, session, Derived(), LIGHT, name="view3d")
    view.pack(fill="both", expand=True)
    root.update()
    canvas, (x, y) = view.canvas, (WIDTH // 2, HEIGHT // 2)

    def row(what: str, times: list[float]) -> tuple[object, ...]:
        median, p95, most = np.percentile(times, [50, 95, 100])
        figures = (f"{value:.2f}" for value in (median, p95, most, 1e3 / np.mean(times)))
        return name, len(skin.mesh.F), what, len(times), *figures

    yield row("first picture", timed(root, lambda k: session.open(skin, None), 1))
    wait_for_likeness(root, view)
    canvas.event_generate("<ButtonPress-1>", x=x, y=y)
    before = view.pictures
    turning = timed(
        root, lambda k: canvas.event_generate("<B1-Motion>", x=x + round(150 * np.sin(k / 9)), y=y + round(90 * np.sin(k / 7))), events
    )
    assert view.pictures - before >= events - 2, "every motion must lead to a picture of its own"
    yield row("orbit", turning)
    canvas.event_generate("<ButtonRelease-1>", x=x, y=y)
    root.update()
    yield row("at rest, smooth edges", timed(root, lambda k: view.settle(), 1))
    yield row("hover", timed(root, lambda k: canvas.event_generate("<Motion>", x=x + k % 150 - 75, y=y + k % 60 - 30), events))
    yield row("wheel", timed(root, lambda k: canvas.event_generate("<Button-4>" if k % 20 < 10 else "<Button-5>", x=x, y=y), events))
    picks = []
    for k in range(events):
        start = time.perf_counter()
        view.hit_at(x + k % 150 - 75, y)
        picks.append(1e3 * (time.perf_counter() - start))
    yield row("pick alone", picks)
    root.destroy()


def wait_for_likeness(root: tk.Tk, view: View3D) -> None:
    """Until the rough likeness of a big object is there, as it is a moment after opening."""
    while not view.ready:
        root.update()
        time.sleep(0.01)


def main() -> None:
    """Measure, print and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, help="also write the table there")
    parser.add_argument("--events", type=int, default=200)
    parser.add_argument("--skin", type=Path, help="a document of the grip that is there already")
    args = parser.parse_args()
    rows: list[tuple[object, ...]] = []
    with screen(), tempfile.TemporaryDirectory() as folder:
        for name, make in (("grip", lambda: load_skin(args.skin or grip(Path(folder)))), ("cap", cap)):
            for row in measure(name, make(), args.events):
                rows.append(row)
                print("  ".join(f"{value!s:>{max(len(head), 9)}}" for value, head in zip(row, COLUMNS, strict=True)), flush=True)
    if args.output:
        with args.output.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([COLUMNS, *rows])


if __name__ == "__main__":
    main()
