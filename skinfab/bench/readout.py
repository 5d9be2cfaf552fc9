"""Framing and byte errors against frames that are lost and frames that are wrong in silence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from skinfab.bench.flatten import REPEATS, read_csv, write_csv
from skinfab.bench.framings import DEFAULT, framings
from skinfab.bench.timing import one_processor, timed_twice
from skinfab.progress import Progress, silent
from skinfab.readout.faults import Faults, Wire

#: Frames sent each way, and what is in them: one board of the seed's, 12 bits a channel.
FRAMES, CHANNELS, _COUNTS = 20_000, 16, 4096
#: Chance of a byte to be hurt.
RATES = (1e-5, 1e-4, 1e-3)
#: How a byte is hurt.
FLIPS, LOSSES = "one bit flipped", "byte lost"
#: Frames whose reading is timed.
_TIMED = 2000


@dataclass(frozen=True)
class Row:
    """One framing at one rate of errors.

    Parameters
    ----------
    framing : str
    fault : str
    rate : float
        Chance of a byte.
    frames : int
        Sent.
    lost : int
        Of these, not read as they were sent.
    wrong : int
        Frames given out that were never sent so.
    bytes_per_frame : float
    us_per_frame : float
        Least processor time to read one, nothing being wrong.
    """

    framing: str
    fault: str
    rate: float
    frames: int
    lost: int
    wrong: int
    bytes_per_frame: float
    us_per_frame: float


def run(folder: Path, *, repeats: int = REPEATS, progress: Progress = silent) -> dict[str, Any]:
    """Measure, and write readout.csv, readout.png and readout.txt into `folder`.

    Parameters
    ----------
    folder : Path
        There already.
    repeats : int
        Of the timing, in turns; the least time counts.
    progress : Progress

    Returns
    -------
    dict
        "sentence", "notes" (what to know of the measurement) and "rows".
    """
    from skinfab.bench.readout_chart import draw
    from skinfab.files import atomic_write

    with one_processor() as alone:
        notes = [] if alone else ["this system cannot keep a process on one processor"]
        rows = measure(repeats=repeats, progress=progress)
    write_csv(rows, folder / "readout.csv")
    # From here on only what the table holds is used, so that chart and sentence cannot say anything else.
    table = read_csv(folder / "readout.csv")
    said = sentence(table)
    atomic_write(folder / "readout.txt", "\n".join([said, *notes]) + "\n")
    draw(table, folder / "readout.png")
    return {"sentence": said, "notes": notes, "rows": table}


def measure(*, frames: int = FRAMES, repeats: int = REPEATS, progress: Progress = silent) -> list[Row]:
    """A row for every framing, fault and rate."""
    values = np.random.default_rng(0).integers(0, _COUNTS, (frames, CHANNELS))
    ways = framings(CHANNELS)
    few = {name: way.encode(values[:_TIMED]) for name, way in ways.items()}
    seconds: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(repeats):
        for name, way in ways.items():
            seconds[name].append(timed_twice(partial(way.decode, few[name]))[1])
    sent = {k: tuple(row) for k, row in enumerate(values.astype(float).tolist())}
    rows = []
    cases = [(name, fault, rate) for name in ways for fault in (FLIPS, LOSSES) for rate in RATES]
    for k, (name, fault, rate) in enumerate(cases):
        progress(k / len(cases), f"{name}, {fault}")
        data = ways[name].encode(values)
        wire = Wire(Faults(flipped=rate, seed=k) if fault == FLIPS else Faults(lost=rate, seed=k))
        right, wrong = set(), 0
        for number, read in ways[name].decode(wire.hurt(data)):
            if sent.get(number) == read:
                right.add(number)
            else:
                wrong += 1
        least = min(seconds[name]) / len(values[:_TIMED]) * 1e6
        rows.append(Row(name, fault, rate, frames, frames - len(right), wrong, len(data) / frames, least))
    return rows


def sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """Where the default sits and why: every number in it comes from the table."""
    worst = max(row["rate"] for row in table)
    names = list(dict.fromkeys(row["framing"] for row in table))
    said = []
    for name in [DEFAULT, *(n for n in names if n != DEFAULT)]:
        rows = {row["fault"]: row for row in table if row["framing"] == name and row["rate"] == worst}
        parts = (f"{rows[fault]['wrong'] / rows[fault]['frames']:.3%}" for fault in (FLIPS, LOSSES))
        lost = (f"{rows[fault]['lost'] / rows[fault]['frames']:.1%}" for fault in (FLIPS, LOSSES))
        row = rows[FLIPS]
        said.append(
            f"{name} gives {' and '.join(parts)} wrong in silence and loses {' and '.join(lost)} ({row['bytes_per_frame']:.0f} bytes and "
            f"{row['us_per_frame']:.0f} us a frame)"
        )
    every = [row for row in table if row["framing"] == DEFAULT]
    total, wrong = sum(row["frames"] for row in every), sum(row["wrong"] for row in every)
    return (
        f"The default is {DEFAULT}: {wrong} of {total} frames wrong in silence at all rates together; at {worst:g} of the bytes with a bit "
        f"flipped and lost, {'; '.join(said)}; it is chosen before a length because its end mark cannot occur inside a packet, so that no "
        "reader ever waits for bytes that a hurt length promised."
    )
