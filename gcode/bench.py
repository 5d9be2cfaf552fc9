"""Arcs or chords: the size of a file, its lines and the time to write it, against how far it leaves the sensor's path.

The paths are contact spirals and a strain sensor of the seed's sizes. The deviation is that of the shapes in the text,
read back, from the path before any rounding.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcode.check import check_program
from gcode.emit import Arcs, emit
from gcode.estimate import print_time
from gcode.parse import parse
from gcode.plan import Plan, plan
from gcode.printer import Printer, load_printer
from gcode.program import Extrude
from skinfab.bench.flatten import REPEATS, read_csv, write_csv
from skinfab.bench.timing import one_processor, timed_twice
from skinfab.material import Material, load_material
from skinfab.paths import Arc, Segment
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.strain_lines import StrainLines
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.progress import Progress, silent

#: Chord tolerances, mm.
TOLERANCES = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
NATIVE = "native"
#: Points looked at on each shape of the text.
_SAMPLES = 9


@dataclass(frozen=True)
class Row:
    """One way to write one program.

    Parameters
    ----------
    program : str
    arcs : str
        "native" or "lines".
    chord_tolerance : float, mm
        NaN for native arcs.
    bytes, lines : int
        Of the file.
    deviation_mm : float
        Farthest that the text leaves the path.
    shortest_ms : float
        What the shortest extrusion takes at its speed; a firmware must read and plan one line in about that time.
    print_s : float
        Time of the print.
    seconds : float
        Least processor time to emit and check it.
    repeats : int
    """

    program: str
    arcs: str
    chord_tolerance: float
    bytes: int
    lines: int
    deviation_mm: float
    shortest_ms: float
    print_s: float
    seconds: float
    repeats: int


def run(folder: Path, *, repeats: int = REPEATS, progress: Progress = silent) -> dict[str, Any]:
    """Measure, and write gcode.csv, gcode.png and gcode.txt into `folder`.

    Parameters
    ----------
    folder : Path
        There already.
    repeats : int
        Of each way, in turn with the others; the least time counts.
    progress : Progress

    Returns
    -------
    dict
        "sentence", "notes" (what to know of the measurement) and "rows".
    """
    from gcode.bench_chart import draw
    from skinfab.files import atomic_write

    printer, material = load_printer(), load_material()
    programs = bench_programs(printer, material)
    with one_processor() as alone:
        notes = [] if alone else ["this system cannot keep a process on one processor"]
        rows = measure(programs, printer, repeats=repeats, progress=progress)
    write_csv(rows, folder / "gcode.csv")
    # From here on only what the table holds is used, so that chart and sentence cannot say anything else.
    table = read_csv(folder / "gcode.csv")
    said = sentence(table)
    atomic_write(folder / "gcode.txt", "\n".join([said, *notes]) + "\n")
    draw(table, folder / "gcode.png")
    return {"sentence": said, "notes": notes, "rows": table}


def bench_programs(printer: Printer, material: Material) -> dict[str, tuple[Plan, tuple[Segment, ...]]]:
    """Plans by name, each with its paths on the bed before any rounding."""
    large = ContactSpiral(n=6, x=2.0, b=3.0, l=6.0, s=45.0)
    small = ContactSpiral(n=2, x=2.0, b=3.0, l=5.0, s=15.0)
    finger = StrainLines(l1=60.0, l2=54.0, b=6.0)
    skin = [Sensor(f"C{k}", "P1", small, 30 + 50 * (k % 3), 40 + 50 * (k // 3), 0.7 * k, k) for k in range(6)]
    wanted = {
        "spiral, s = 45": [Sensor("C1", "P1", large, 60, 80, 0.3, 0)],
        "finger, 60 x 6": [Sensor("S1", "P1", finger, 60, 80, 0.3, 0)],
        "six spirals, s = 15": skin,
    }
    corners = np.array([[0, 0], [180, 0], [180, 160], [0, 160]], dtype=float)
    piece = Piece("P1", np.array([0, 1]), np.arange(4), np.array([[0, 1, 2], [0, 2, 3]]), corners)
    found = {}
    for name, sensors in wanted.items():
        planned = plan(piece, sensors, printer=printer, material=material)
        paths = [s.printed_path.transformed(angle=0.0, shift=planned.offset) for s in sensors]
        found[name] = planned, tuple(segment for path in paths for segment in path.segments)
    return found


def measure(
    programs: Mapping[str, tuple[Plan, tuple[Segment, ...]]], printer: Printer, *, repeats: int = REPEATS, progress: Progress = silent
) -> list[Row]:
    """A row for every program and way to write it; the ways take turns, so that a machine that slows down is unfair to none."""
    rows = []
    ways = (math.nan, *TOLERANCES)
    for j, (name, (planned, path)) in enumerate(programs.items()):
        seconds: dict[int, list[float]] = {k: [] for k in range(len(ways))}
        for turn in range(repeats):
            for k, tolerance in enumerate(ways):
                progress((j + (turn + k / len(ways)) / repeats) / len(programs), name)
                work = partial(_emit_and_check, planned, _with_tolerance(printer, tolerance), math.isnan(tolerance))
                seconds[k].append(timed_twice(work)[1])
        for k, tolerance in enumerate(ways):
            rows.append(_row(name, planned, path, tolerance, _with_tolerance(printer, tolerance), seconds[k]))
    return rows


def _with_tolerance(printer: Printer, tolerance: float) -> Printer:
    return printer if math.isnan(tolerance) else replace(printer, process=replace(printer.process, chord_tolerance=tolerance))


def _emit_and_check(planned: Plan, printer: Printer, native: bool) -> str:
    text = emit(planned.program, printer, arcs="native" if native else "lines")
    check_program(parse(text), printer)
    return text


def _row(name: str, planned: Plan, path: Sequence[Segment], tolerance: float, printer: Printer, seconds: list[float]) -> Row:
    arcs: Arcs = "native" if math.isnan(tolerance) else "lines"
    text = emit(planned.program, printer, arcs=arcs)
    program = parse(text)
    laid = [s for s in program.steps if isinstance(s, Extrude)]
    points = np.array([s.shape.point_at(t) for s in laid for t in np.linspace(0, 1, _SAMPLES)])
    deviation = float(off_path(points, path).max())
    shortest = min(s.shape.length / s.speed for s in laid) * 1000
    size, lines = len(text.encode()), text.count("\n")
    return Row(name, arcs, tolerance, size, lines, deviation, shortest, print_time(program, printer), min(seconds), len(seconds))


def off_path(points: NDArray[np.float64], path: Sequence[Segment]) -> NDArray[np.float64]:
    """Distance of each point, (n, 2) mm, from the nearest of the path's lines and arcs, (n,) mm.

    Examples
    --------
    >>> off_path(np.array([[0.0, 2.0], [3.0, 0.5]]), [Arc((0, 0), 1.5, 0.0, np.pi)]).round(6).tolist()
    [0.5, 1.541381]
    """
    away = np.full(len(points), np.inf)
    for segment in path:
        if isinstance(segment, Arc):
            spoke = points - segment.centre
            turned = np.sign(segment.sweep) * (np.arctan2(spoke[:, 1], spoke[:, 0]) - segment.start_angle) % (2 * np.pi)
            on = turned <= abs(segment.sweep)
            ends = np.minimum(*(np.linalg.norm(points - end, axis=1) for end in (segment.start, segment.end)))
            here = np.where(on, np.abs(np.linalg.norm(spoke, axis=1) - segment.radius), ends)
        else:
            along = segment.end - segment.start
            t = np.clip((points - segment.start) @ along / max(float(along @ along), np.finfo(float).tiny), 0, 1)
            here = np.linalg.norm(points - segment.start - t[:, None] * along, axis=1)
        away = np.minimum(away, here)
    return away


def sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """What arcs cost and what chords cost, and the default: every number in it comes from the table."""
    names = list(dict.fromkeys(row["program"] for row in table))
    default = load_printer().process.chord_tolerance
    native = {row["program"]: row for row in table if row["arcs"] == NATIVE}
    lines = {row["program"]: row for row in table if row["chord_tolerance"] == default}

    def spread(values: list[float], form: str) -> str:
        low, high = format(min(values), form), format(max(values), form)
        return low if low == high else f"{low} to {high}"

    more = [lines[n]["bytes"] / native[n]["bytes"] for n in names]
    slower = [lines[n]["seconds"] / native[n]["seconds"] for n in names]
    drawn = [lines[n]["print_s"] / native[n]["print_s"] - 1 for n in names]
    off, chords_off = (max(rows[n]["deviation_mm"] for n in names) for rows in (native, lines))
    size, count = sum(native[n]["bytes"] for n in names) / 1000, sum(native[n]["lines"] for n in names)
    return (
        f"The default is native arcs: they leave the path by {off:.1g} mm at most, which is the rounding, "
        f"in {size:.3g} kB and {count} lines for all three programs; "
        f"chords of the default tolerance of {default:g} mm (--arcs lines) leave it by {chords_off:.2g} mm "
        f"and take {spread(more, '.1f')} times the bytes and {spread(slower, '.1f')} times as long to emit and check, "
        f"the print being as long within {max(abs(d) for d in drawn):.2%}."
    )
