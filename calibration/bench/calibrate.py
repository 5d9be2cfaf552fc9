"""Models and degrees of a strain calibration: the angle's held-out error against microseconds a sample.

The logs are those of the simulated fingers, several seeds of each; the first half of a log is fitted, the second judged.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from calibration.finger.logs import prepared
from calibration.finger.simulated import HUMAN, ROBOT
from calibration.strain.calibrate import MAX_DEGREE, angle_errors, calibrate, step_us
from calibration.strain.models import MODELS
from skinfab.bench.flatten import REPEATS, read_csv, write_csv
from skinfab.bench.timing import one_processor
from skinfab.progress import Progress, silent

#: Logs of each finger.
SEEDS = (7, 8, 9, 10, 11)


@dataclass(frozen=True)
class Row:
    """One model of one degree on one finger.

    Parameters
    ----------
    finger : str
    model : str
    degree : int
    held_out_rms_deg : float
        Root mean square over the logs.
    us_per_sample : float
        Least of the repeats' medians.
    chosen : int
        On how many of the logs `skinfab calibrate` chooses it.
    logs : int
    """

    finger: str
    model: str
    degree: int
    held_out_rms_deg: float
    us_per_sample: float
    chosen: int
    logs: int


def run(folder: Path, *, repeats: int = REPEATS, progress: Progress = silent) -> dict[str, Any]:
    """Measure, and write calibrate.csv, calibrate.png and calibrate.txt into `folder`, which is there already.

    Returns
    -------
    dict
        "sentence", "notes" (what to know of the measurement) and "rows".
    """
    from calibration.bench.calibrate_chart import draw
    from skinfab.files import atomic_write

    notes = [f"simulated fingers, {len(SEEDS)} logs each (calibration/finger/logs.py)"]
    with one_processor() as alone:
        notes += [] if alone else ["this system cannot keep a process on one processor"]
        rows = measure(repeats=repeats, progress=progress)
    write_csv(rows, folder / "calibrate.csv")
    # From here on only what the table holds is used, so that chart and sentence cannot say anything else.
    table = read_csv(folder / "calibrate.csv")
    said = sentence(table)
    atomic_write(folder / "calibrate.txt", "\n".join([said, *notes]) + "\n")
    draw(table, folder / "calibrate.png")
    return {"sentence": said, "notes": notes, "rows": table}


def measure(*, seeds: Sequence[int] = SEEDS, repeats: int = REPEATS, progress: Progress = silent) -> list[Row]:
    """A row for every finger, model and degree."""
    rows = []
    for j, sensor in enumerate((HUMAN, ROBOT)):
        logs = [prepared(sensor, seed=seed) for seed in seeds]
        chosen = []
        for k, log in enumerate(logs):
            progress((j + 0.5 * k / len(logs)) / 2, f"{sensor.name} finger: choosing")
            found = calibrate(log)
            chosen.append((found.model.name, found.plain.degree))
        for k, name in enumerate(MODELS):
            progress((j + 0.5 + 0.5 * k / len(MODELS)) / 2, f"{sensor.name} finger: {name}")
            for degree in range(1, MAX_DEGREE + 1):
                squares, taken = [], []
                for log in logs:
                    first, second = log.halves
                    model = MODELS[name].fit(log.only(first), degree=degree)
                    squares.append(angle_errors(model, log.only(second)) ** 2)
                    taken += [step_us(model, log.runs[0]) for _ in range(repeats)]
                error = float(np.sqrt(np.mean(np.concatenate(squares))))
                rows.append(Row(sensor.name, name, degree, error, min(taken), chosen.count((name, degree)), len(logs)))
    return rows


def sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """What is chosen, how good it is, and what a more costly one would gain: every number in it comes from the table."""
    said = []
    for finger in dict.fromkeys(row["finger"] for row in table):
        rows = [row for row in table if row["finger"] == finger]
        default = max(rows, key=lambda row: row["chosen"])
        best, plain = (min(each, key=lambda row: row["held_out_rms_deg"]) for each in (rows, [r for r in rows if r["model"] == "poly"]))
        said.append(
            f"on the {finger} finger {default['model']} of degree {default['degree']} is chosen most often ({default['chosen']} of "
            f"{default['logs']} logs), {default['held_out_rms_deg']:.2f} degrees held out at {default['us_per_sample']:.1f} us a sample; "
            f"the best of all ({best['model']}, degree {best['degree']}) has {best['held_out_rms_deg']:.2f}, the best curve alone "
            f"{plain['held_out_rms_deg']:.2f}"
        )
    return "Calibration, simulated: " + "; ".join(said) + "."
