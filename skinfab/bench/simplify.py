"""Triangles solved for against distortion and time: what a simplified mesh saves, what it costs, and where the default sits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.bench.disks import bumpy_cap
from skinfab.bench.flatten import REPEATS, read_csv, write_csv
from skinfab.bench.timing import ENOUGH_S, one_processor, timed
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import distortion_of, shaped_areas, singular_values
from skinfab.flatten.simplified import SHARE, Simplified, flatten_simplified
from skinfab.progress import Progress, silent

SIZES = (20_000, 80_000, 320_000)
#: Triangles of the mesh to one that is solved for; 1 is no simplifying.
SHARES = (1, 4, 8, 16, 32, 64, 128)

#: Everything is run once on this many triangles before anything is timed: imports, and numba's compiling.
_WARM_UP = 1000
#: Fewer triangles are no surface any more.
_LEAST_COARSE = 4


@dataclass(frozen=True)
class Row:
    """One share at one size.

    Parameters
    ----------
    triangles : int
        Of the mesh.
    share : int
    solved : int
        Triangles solved for.
    carried : bool
        False where the simplified mesh was not good enough, and all triangles were solved for after all.
    seconds : float
        Least of the repeats.
    mean_d : float
        On the mesh.
    effect : float
        What the method says the mean d could lose at most; 0 where all triangles were solved for.
    peak_mb : float
        By how much memory rose; NaN where the system does not tell.
    repeats : int
    """

    triangles: int
    share: int
    solved: int
    carried: bool
    seconds: float
    mean_d: float
    effect: float
    peak_mb: float
    repeats: int


def run(folder: Path, *, sizes: Sequence[int] = SIZES, repeats: int = REPEATS, progress: Progress = silent) -> dict[str, Any]:
    """Measure, and write simplify.csv, simplify.png and simplify.txt into `folder`.

    Parameters
    ----------
    folder : Path
        There already.
    sizes : sequence of int
        About how many triangles.
    repeats : int
        Of each share at each size, in turn with the others; the least time counts.
    progress : Progress

    Returns
    -------
    dict
        "sentence", "notes" (what to know of the measurement) and "rows".

    Raises
    ------
    InputError
        A size is out of range, or a file cannot be written.
    """
    from skinfab.bench.simplify_chart import draw
    from skinfab.files import atomic_write

    disks = [bumpy_cap(size) for size in sizes]
    with one_processor() as alone:
        notes = [] if alone else ["this system cannot keep a process on one processor: libraries with threads of their own may use more"]
        for share in SHARES[:2]:
            _flatten(*bumpy_cap(_WARM_UP), share)
        rows = measure_shares(disks, repeats=repeats, progress=progress)
    write_csv(rows, folder / "simplify.csv")
    # From here on only what the table holds is used, so that chart and sentence cannot say anything else.
    table = read_csv(folder / "simplify.csv")
    said = sentence(table)
    atomic_write(folder / "simplify.txt", "\n".join([said, *notes]) + "\n")
    draw(table, folder / "simplify.png")
    return {"sentence": said, "notes": notes, "rows": table}


def measure_shares(
    disks: Sequence[tuple[NDArray[np.float64], NDArray[np.int64]]], *, repeats: int = REPEATS, progress: Progress = silent
) -> list[Row]:
    """A row for every size and share. The shares take turns, so that a machine that slows down is unfair to none."""
    rows: list[Row] = []
    for k, (V, F) in enumerate(disks):
        shares = [share for share in SHARES if len(F) // share >= _LEAST_COARSE]
        seconds: dict[int, list[float]] = {share: [] for share in shares}
        peak = dict.fromkeys(shares, 0.0)
        flat: dict[int, Simplified] = {}
        for turn in range(repeats):
            for j, share in enumerate(shares):
                progress((k + (turn + j / len(shares)) / repeats) / len(disks), f"one in {share} of {len(F)} triangles")
                if sum(seconds[share]) >= ENOUGH_S:
                    continue
                flat[share], s, mb = timed(partial(_flatten, V, F, share))
                seconds[share].append(s)
                peak[share] = max(peak[share], mb)
        area, real = shaped_areas(V, F)
        for share in shares:
            found = flat[share]
            d = float(np.average(distortion_of(singular_values(V, F, found.UV))[real], weights=area[real]))
            carried = found.n_coarse > 0
            least, count = min(seconds[share]), len(seconds[share])
            rows.append(Row(len(F), share, found.n_coarse or len(F), carried, least, d, found.effect, peak[share], count))
    return rows


def _flatten(V: NDArray[np.float64], F: NDArray[np.int64], share: int) -> Simplified:
    if share == 1:
        return Simplified(flatten_isometric(V, F), len(F), 0, 0.0, "all are asked for")
    return flatten_simplified(V, F, share=share, least_coarse=_LEAST_COARSE)


def sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """Where the default sits and why: every number in it comes from the table."""
    size = max(row["triangles"] for row in table)
    rows = {row["share"]: row for row in table if row["triangles"] == size}
    whole, default = rows[1], rows.get(SHARE)
    if default is None or not default["carried"]:
        return f"At {size} triangles one in {SHARE} is too few to be carried: all of them are solved for, in {whole['seconds']:.3g} s."
    others = [row for row in rows.values() if row["share"] not in (1, SHARE)]
    said = [
        f"--simplify auto solves for one triangle in {SHARE}: at {size} triangles that takes {_time(default, whole)} of what all take "
        f"({whole['seconds']:.3g} s), for a mean d of {default['mean_d']:.5f} instead of {whole['mean_d']:.5f} (promised: at most "
        f"{default['effect']:.2g} above the least)",
        "; ".join(
            f"one in {row['share']} takes {_time(row, whole)}"
            + (
                f", d {row['mean_d'] - whole['mean_d']:+.1g}"
                if row["carried"]
                else ", as it is not good enough and all are solved for after all"
            )
            for row in others
        ),
    ]
    if default["peak_mb"] is not None and whole["peak_mb"] is not None:
        said.append(f"memory rises by {default['peak_mb']:.3g} MB (all: {whole['peak_mb']:.3g} MB)")
    return "; ".join(part for part in said if part) + "."


def _time(row: Mapping[str, Any], whole: Mapping[str, Any]) -> str:
    return f"{row['seconds'] / whole['seconds']:.2f}"
