"""How fast the tool path is scrubbed: the real canvas and listing at 900 x 700, a program of many short moves, on a virtual screen.

``python benchmarks/gui_toolpath.py [--moves 100000]``. The time of a step is from asking for a moment until all that Tk had to
draw for it is handed to the screen. Target: 30 ms a step at 100,000 moves.
"""

from __future__ import annotations

import argparse
import itertools
import time
import tkinter as tk

import numpy as np
from gui_orbit import screen

from gcode.check_mould import Mould
from gcode.check_wall import wall_of
from gcode.emit import emit, on_grid_of
from gcode.geometry import Straight
from gcode.piece import PieceProgram
from gcode.printer import Printer, load_printer
from gcode.program import Comment, Extrude, Prime, Program, Retract, Step, Travel
from gui.theme import LIGHT, apply
from gui.toolpath.listing import Listing
from gui.toolpath.picture import PathPicture, Scene
from gui.toolpath.timeline import Timeline, timeline
from skinfab.material import load_material
from skinfab.pieces import Piece

WIDTH, HEIGHT, PATTERNS = 900, 700, 200


def spirals(moves: int, printer: Printer) -> PieceProgram:
    """Short straight moves along 200 spirals, on a piece of 240 x 280 mm."""
    steps: list[Step] = [Travel(z=10.0, speed=5.0)]
    for k in range(PATTERNS):
        turn, radius = np.linspace(0, 30 * np.pi, moves // PATTERNS + 1), np.linspace(1, 7, moves // PATTERNS + 1)
        middle = (20 + 16 * (k % 13), 20 + 16 * (k // 13))
        points = (middle + radius[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)).tolist()
        steps += [Comment(f"pattern C{k}"), Travel(*points[0], speed=50.0), Travel(z=1.6, speed=5.0), Prime(0.2, 1.0)]
        for a, b in itertools.pairwise(points):
            line = Straight((a[0], a[1]), (b[0], b[1]))
            steps.append(Extrude(line, 0.5 * line.length, 4.0))
        steps += [Retract(0.2, 1.0), Travel(z=10.0, speed=5.0)]
    program = on_grid_of(Program("P1", tuple(steps), 0.5), printer)
    corners = np.array([[0.0, 0], [240, 0], [240, 280], [0, 280]])
    piece = Piece("P1", np.arange(2), np.arange(4), np.array([[0, 1, 2], [0, 2, 3]]), corners)
    mould = Mould(piece, (0.0, 0.0), wall_of(piece, load_material(), (0.0, 0.0)))
    return PieceProgram(program, emit(program, printer), printer, mould, 0.5, ())


def measure(root: tk.Tk, picture: PathPicture, listing: Listing, path: Timeline, what: str, times: np.ndarray) -> None:
    """Time each moment, and print one line."""
    took = []
    for moment in times.tolist():
        begun = time.perf_counter()
        now = path.at(moment)
        picture.seek(now)
        listing.mark(now.line)
        root.update()
        took.append(1e3 * (time.perf_counter() - begun))
    low, high, most = np.percentile(took, [50, 95, 100])
    print(f"{what}: median {low:.1f}, p95 {high:.1f}, most {most:.1f} ms ({len(took)} steps)")


def main() -> None:
    """Scrub to and fro, at random, and as it plays."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--moves", type=int, default=100_000)
    moves = parser.parse_args().moves
    printer = load_printer()
    planned = spirals(moves, printer)
    begun = time.perf_counter()
    path = timeline(planned)
    print(f"{len(path)} steps, {len(path.parts)} drawn parts, laid out over time in {time.perf_counter() - begun:.2f} s")
    with screen():
        root = tk.Tk()
        root.geometry(f"{WIDTH}x{HEIGHT + 120}+0+0")
        apply(root, LIGHT)
        picture, listing = PathPicture(root, LIGHT, on_step=lambda step: None), Listing(root, LIGHT, on_line=lambda line: None)
        picture.widget.place(x=0, y=0, width=WIDTH, height=HEIGHT)
        listing.place(x=0, y=HEIGHT, width=WIDTH, height=120)
        listing.show(path.lines)
        topology = planned.mould.piece.topology
        wall = planned.mould.piece.UV[topology.E[topology.is_boundary]]
        picture.show(Scene(path, wall, printer), path.at(0.0))
        root.update()
        begun = time.perf_counter()
        picture.draw()
        root.update()
        print(f"all of it drawn anew at {picture.size[0]} x {picture.size[1]} in {1e3 * (time.perf_counter() - begun):.0f} ms")
        whole, rng = np.linspace(0, path.end, 300), np.random.default_rng(0)
        for what, times in (
            ("forwards, 1/300 of the print a step", whole),
            ("backwards", whole[::-1]),
            ("to any place", rng.uniform(0, path.end, 300)),
            ("playing at 20 x", 100 + 0.66 * np.arange(300)),
        ):
            measure(root, picture, listing, path, what, times)
        root.destroy()


if __name__ == "__main__":
    main()
