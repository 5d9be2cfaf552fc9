"""Time against distortion d of every way to flatten a disk, at several sizes, all in one run."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from skinfab.bench.contestants import Contestant, Flat, contestants
from skinfab.bench.disks import bumpy_cap
from skinfab.bench.timing import ENOUGH_S, one_processor, timed_twice
from skinfab.flatten.distortion import best_scale, measure, shaped_areas, singular_values
from skinfab.mesh.topology import Topology
from skinfab.progress import Progress, part_of, silent
from skinfab.tolerances import OVERLAP_FRACTION

SIZES = (5_000, 20_000, 80_000)
REPEATS = 3

#: Everybody flattens this many triangles once before anything is timed: imports, and numba's compiling.
_WARM_UP = 300
#: Share of the work that is the methods; the refinement is the rest.
_METHODS_SHARE = 0.7


@dataclass(frozen=True)
class Row:
    """One method at one size: least times of `repeats`, and how good its result is, at the scale of its least d.

    Parameters
    ----------
    method, kind : str
        Kind is "ours" or "peer".
    triangles : int
    seconds, wall_s : float
        Of the process itself, and by the clock on the wall, which other programs lengthen.
    mean_d, max_d : float
    flipped : int
    overlap_mm2 : float
    pieces : int
        1 is a disk that was left whole.
    usable : bool
        In one piece, nothing flipped, no overlap that counts.
    peak_mb : float
        By how much memory rose during the call; NaN where the system does not tell.
    repeats : int
    """

    method: str
    kind: str
    triangles: int
    seconds: float
    wall_s: float
    mean_d: float
    max_d: float
    flipped: int
    overlap_mm2: float
    pieces: int
    usable: bool
    peak_mb: float
    repeats: int


def run(folder: Path, *, sizes: Sequence[int] = SIZES, repeats: int = REPEATS, progress: Progress = silent) -> dict[str, Any]:
    """Measure, and write flatten.csv, flatten.png, flatten.txt, refine.csv and refine.png into `folder`.

    Parameters
    ----------
    folder : Path
        There already.
    sizes : sequence of int
        About how many triangles.
    repeats : int
        Of each method at each size, in turn with the others; the least time counts.
    progress : Progress

    Returns
    -------
    dict
        "sentence", "notes" (what was left out, and why), "rows" and "refinement".

    Raises
    ------
    InputError
        A size is out of range, or a file cannot be written.
    """
    from skinfab.bench.charts import draw_methods, draw_refinement
    from skinfab.bench.refinement import follow
    from skinfab.bench.words import sentence
    from skinfab.files import atomic_write

    disks = [bumpy_cap(size) for size in sizes]
    present, notes = [], []
    for c in contestants():
        if c.present:
            present.append(c)
        else:
            notes.append(f"{c.name} is left out: the module {c.needs} is not installed")
    with one_processor() as alone:
        if not alone:
            notes.append("this system cannot keep a process on one processor: libraries with threads of their own may use more")
        V, F = bumpy_cap(_WARM_UP)
        for c in present:
            c.prepare(V, F)()
        follow([(V, F)], repeats=1)
        rows = measure_methods(present, disks, repeats=repeats, progress=part_of(progress, 0, _METHODS_SHARE))
        steps = follow(disks, repeats=repeats, progress=part_of(progress, _METHODS_SHARE, 1))
    write_csv(rows, folder / "flatten.csv")
    write_csv(steps, folder / "refine.csv")
    # From here on only what the tables hold is used, so that charts and sentence cannot say anything else.
    table, refinement = read_csv(folder / "flatten.csv"), read_csv(folder / "refine.csv")
    said = sentence(table, refinement)
    atomic_write(folder / "flatten.txt", "\n".join([said, *notes]) + "\n")
    draw_methods(table, folder / "flatten.png", notes=notes)
    draw_refinement(refinement, folder / "refine.png")
    return {"sentence": said, "notes": notes, "rows": table, "refinement": refinement}


def measure_methods(
    present: Sequence[Contestant], disks: Sequence[tuple[Any, Any]], *, repeats: int = REPEATS, progress: Progress = silent
) -> list[Row]:
    """A row for every method and size. The methods take turns, so that a machine that slows down is unfair to nobody."""
    rows, done, rounds = [], 0, len(present) * len(disks) * repeats
    for V, F in disks:
        seconds: list[list[float]] = [[] for _ in present]
        walls: list[list[float]] = [[] for _ in present]
        peaks: list[list[float]] = [[] for _ in present]
        flat: list[Flat | None] = [None] * len(present)
        for _ in range(repeats):
            for k, c in enumerate(present):
                progress(done / rounds, f"{c.name}, {len(F)} triangles")
                done += 1
                if sum(walls[k]) >= ENOUGH_S:
                    continue
                flat[k], s, wall, peak = timed_twice(c.prepare(V, F))
                seconds[k].append(s)
                walls[k].append(wall)
                peaks[k].append(peak)
        rows += [
            judge(c, V, F, f, min(s), min(w), max(p), len(s))
            for c, f, s, w, p in zip(present, flat, seconds, walls, peaks, strict=True)
            if f is not None
        ]
    return rows


def judge(c: Contestant, V: Any, F: Any, flat: Flat, seconds: float, wall_s: float, peak_mb: float, repeats: int) -> Row:
    """How good a result is: right side up and at the scale of the least d, whatever it came as."""
    origin, uv = V[flat.origin], flat.UV
    if 2 * (singular_values(origin, flat.F, uv)[:, 1] < 0).sum() > len(flat.F):
        uv = uv * [1.0, -1.0]
    uv = uv * best_scale(origin, flat.F, uv)
    topology = Topology(flat.F)
    d = measure(origin, flat.F, uv, topology=topology)
    pieces = int(topology.face_components()[0])
    area = shaped_areas(V, F)[0].sum()
    usable = pieces == 1 and d.flipped == 0 and d.overlap_mm2 <= OVERLAP_FRACTION * area
    return Row(c.name, c.kind, len(F), seconds, wall_s, d.mean, d.max, d.flipped, d.overlap_mm2, pieces, bool(usable), peak_mb, repeats)


def write_csv(rows: Sequence[Any], path: Path) -> None:
    """One line for each of these dataclass objects, all of one class; 9 significant digits."""
    import io

    from skinfab.files import atomic_write

    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow([f.name for f in fields(rows[0])])
    for row in rows:
        table.writerow([format(v, ".9g") if isinstance(v, float) else int(v) if isinstance(v, bool) else v for v in asdict(row).values()])
    atomic_write(path, text.getvalue())


def read_csv(path: Path) -> list[dict[str, Any]]:
    """The lines of a table that `write_csv` wrote: numbers as numbers, no number (NaN) as None."""
    with path.open(newline="", encoding="utf-8") as file:
        return [{k: _value(v) for k, v in line.items()} for line in csv.DictReader(file)]


def _value(text: str) -> str | int | float | None:
    for kind in (int, float):
        try:
            value = kind(text)
        except ValueError:
            continue
        return value if np.isfinite(value) else None
    return text
