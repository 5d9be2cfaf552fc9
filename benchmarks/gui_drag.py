"""How long a dragged sensor takes to follow the pointer, with its validity, in the real flat view: p95 of many events.

    python benchmarks/gui_drag.py [MESH] [--csv FILE]

A window on a virtual screen (Xvfb) shows the pieces of MESH (default: the 85k-triangle grip) with ten sensors. One is taken
hold of and led through motion events from the window system's own queue: over the piece, across its edge, past the others. In
the time of an event is everything from its arrival to the changed picture: hit, snap, exact check against edges and neighbours,
drawing, and the transfer to the screen, which is waited for.
"""

from __future__ import annotations

import argparse
import csv
import os
import sys
import time
import tkinter as tk
from dataclasses import replace
from pathlib import Path

import numpy as np
from gui_orbit import screen

ROOT = Path(__file__).resolve().parent.parent
EVENTS = 400
SENSORS = 10
SIZE = "900x700"


def document(mesh: Path):
    """The mesh, cut and flattened as the command line does it, with ten small sensors on its largest piece."""
    from skinfab.cli.main import main
    from skinfab.document import load_skin
    from skinfab.material import load_material
    from skinfab.patterns.registry import make_pattern
    from skinfab.placement.check import Checker
    from skinfab.placement.sensor import Sensor

    folder = Path(os.environ.get("TMPDIR", "/tmp")) / "skinfab-gui-drag"
    folder.mkdir(exist_ok=True)
    path = folder / f"{mesh.stem}.skin"
    if not path.exists() and main(["segment", str(mesh), "-o", str(path)]) != 0:
        sys.exit(f"{mesh} could not be cut")
    skin = load_skin(path)
    piece = max(skin.pieces, key=lambda p: p.area)
    checker, rng, sensors = Checker(load_material(skin.material)), np.random.default_rng(1), []
    pattern = make_pattern("contact-spiral", {"s": max(piece.area**0.5 / 12, 9.0)})
    while len(sensors) < SENSORS:
        x, y = rng.uniform(piece.UV.min(axis=0), piece.UV.max(axis=0))
        sensor = Sensor(f"C{len(sensors) + 1}", piece.id, pattern, float(x), float(y), float(rng.uniform(0, 6)), len(sensors))
        if not checker.faults(piece, sensor, sensors):
            sensors.append(sensor)
    return replace(skin, sensors=tuple(sensors))


def pointer_path(width: int, height: int, start: tuple[int, int]) -> list[tuple[int, int]]:
    """From `start` in loops over the whole view, a few pixels an event."""
    t = np.linspace(0, 1, EVENTS)
    x = width * (0.5 + 0.42 * np.sin(2 * np.pi * 3 * t))
    y = height * (0.5 + 0.40 * np.sin(2 * np.pi * 2 * t + 0.7))
    blend = np.minimum(t * 10, 1.0)
    return [(int(a), int(b)) for a, b in zip(start[0] + blend * (x - start[0]), start[1] + blend * (y - start[1]), strict=True)]


def drag(root: tk.Tk, view, session, *, sensor: str, step) -> tuple[np.ndarray, np.ndarray, int]:
    """Milliseconds of every event, by the clock and of this process alone, and at how many the sensor did not fit."""
    widget = view.surface.widget
    x, y = view.place_of(sensor)
    events = pointer_path(widget.winfo_width(), widget.winfo_height(), (x, y))
    widget.event_generate("<ButtonPress-1>", x=x, y=y)
    took, own, wrong = [], [], 0
    for px, py in events:
        begin, spent = time.perf_counter(), time.process_time()
        widget.event_generate("<Motion>", x=px, y=py, state=0x100, when="tail")
        root.update()
        step()
        took.append(1e3 * (time.perf_counter() - begin))
        own.append(1e3 * (time.process_time() - spent))
        wrong += bool(view.hands.findings)
    widget.event_generate("<ButtonRelease-1>", x=px, y=py, state=0x100)
    root.update()
    session.undo()
    root.update()
    # The first takes the sensor out of the still part and is told apart.
    return np.array(took), np.array(own), wrong


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", nargs="?", type=Path, default=ROOT / "meshes" / "grip.obj")
    parser.add_argument("--csv", type=Path)
    parser.add_argument("--repeat", type=int, default=5)
    args = parser.parse_args()
    skin = document(args.mesh)
    from gui.state.derived import Derived
    from gui.state.session import Session
    from gui.theme import LIGHT, apply
    from gui.view2d.view import View2D

    rows = []
    with screen():
        root = tk.Tk()
        root.geometry(SIZE)
        apply(root, LIGHT)
        session = Session()
        view = View2D(root, session, Derived(), LIGHT)
        view.pack(fill="both", expand=True)
        root.update()
        begin = time.perf_counter()
        session.open(skin, None)
        root.update()
        first = time.perf_counter() - begin
        print(f"{args.mesh.name}: {len(skin.mesh.F)} triangles, {len(skin.sensors)} sensors, {SIZE}; first picture {first:.2f} s")
        for k in range(args.repeat):
            took, own, wrong = drag(root, view, session, sensor="C1", step=lambda: root.winfo_pointerx())
            p50, p95, own95 = *np.percentile(took[1:], [50, 95]), np.percentile(own[1:], 95)
            rows.append((args.mesh.name, len(skin.mesh.F), k, len(took) - 1, p50, p95, own95, took[1:].max(), took[0], wrong))
            print(
                f"  drag {k + 1}: p50 {p50:.1f} ms, p95 {p95:.1f} (own processor time {own95:.1f}), worst {took[1:].max():.1f}; "
                f"taking hold {took[0]:.1f}; at {wrong} of {len(took)} events it did not fit"
            )
        wall, own = (sorted(row[c] for row in rows) for c in (5, 6))
        middle = len(rows) // 2
        print(f"p95 of {len(rows)} drags: least {wall[0]:.1f} ms, median {wall[middle]:.1f} (bound 16, aim 8); ", end="")
        print(f"own processor time: least {own[0]:.1f} ms, median {own[middle]:.1f}; load {os.getloadavg()[0]:.1f}")
        root.destroy()
    if args.csv:
        with args.csv.open("w", newline="", encoding="utf-8") as file:
            out = csv.writer(file)
            out.writerow(
                [
                    "mesh",
                    "triangles",
                    "drag",
                    "events",
                    "p50_ms",
                    "p95_ms",
                    "p95_own_ms",
                    "worst_ms",
                    "taking_hold_ms",
                    "events_that_did_not_fit",
                ]
            )
            out.writerows([*row[:4], *(f"{v:.2f}" for v in row[4:9]), row[9]] for row in rows)


if __name__ == "__main__":
    main()
