"""Gain, delay and period against error and margin: the three control laws on the same simulated finger with the same noise."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from calibration.bench.control_chart import draw
from calibration.control.controller import LAWS, Input, JointController, Law
from calibration.control.margin import judged
from calibration.control.protocols import PAPER_DEG, PAPER_GAIN, Motion, follow, mean_error, random, uniform
from calibration.finger.logs import calibrated
from calibration.finger.simulated import HUMAN, RATE_HZ, ROBOT, Plant
from skinfab.bench.flatten import read_csv, write_csv
from skinfab.files import atomic_write
from skinfab.progress import Progress, silent

#: Of the controller, 1/s.
GAINS = (1.0, 2.0, 3.0, 4.0, 5.1, 6.0, 7.0, 8.0, 10.0, 12.0)
DELAYS_S = (0.03, 0.05, 0.1, 0.2)
PERIODS_S = (8.0, 4.0, 2.0, 1.0)
MODEL = {"p": "poly", "branches": "branches", "full": "branches"}


@dataclass(frozen=True)
class Row:
    """One law, on one protocol, some seeds.

    Parameters
    ----------
    experiment : str
        What is varied: ``gain``, ``delay`` or ``period``; ``published`` and ``default`` are the laws with their own gains.
    law, protocol : str
    gain : float, 1/s
    delay_s, period_s : float
        Of the plant and of the motion; the period is NaN where that is random.
    mean_error_deg, scatter_deg : float
        Over the seeds.
    margin : float
        By how much the gain could be raised until the joint swings.
    seeds : int
    """

    experiment: str
    law: str
    protocol: str
    gain: float
    delay_s: float
    period_s: float
    mean_error_deg: float
    scatter_deg: float
    margin: float
    seeds: int


@dataclass(frozen=True)
class _Case:
    experiment: str
    law: Law
    protocol: str
    gain: float | None = None
    delay_s: float = 0.05
    period_s: float = 8.0


def _cases() -> Iterator[_Case]:
    for protocol in PAPER_DEG:
        yield _Case("published", "p", protocol, PAPER_GAIN)
        for law in LAWS:
            yield _Case("default", law, protocol)
            yield from (_Case("gain", law, protocol, gain) for gain in GAINS)
            yield from (_Case("delay", law, protocol, delay_s=delay) for delay in DELAYS_S)
    for law in LAWS:
        yield from (_Case("period", law, "uniform", PAPER_GAIN if law == "p" else None, period_s=period) for period in PERIODS_S)


def run(folder: Path, *, repeats: int = 5, progress: Progress = silent) -> dict[str, Any]:
    """Measure, and write ``control.csv``, ``control.png`` and ``control.txt`` into `folder`.

    Parameters
    ----------
    folder : Path
    repeats : int
        Seeds of noise and random motion, from 0 up.
    progress : Progress
    """
    write_csv(measure(list(_cases()), seeds=repeats, progress=progress), folder / "control.csv")
    # From here on only what the table holds is used, so that chart and sentence cannot say anything else.
    table = read_csv(folder / "control.csv")
    said = sentence(table)
    notes = ["the finger is simulated"]
    atomic_write(folder / "control.txt", "\n".join([said, *notes]) + "\n")
    draw(table, folder / "control.png")
    return {"sentence": said, "notes": notes, "rows": table}


def measure(cases: Sequence[_Case], *, seeds: int, progress: Progress = silent) -> list[Row]:
    """A row a case."""
    inputs = {
        model: (Input(calibrated(HUMAN, model)), Input(calibrated(ROBOT, model))) for model in sorted({MODEL[case.law] for case in cases})
    }
    rows = []
    for k, case in enumerate(cases):
        progress(k / len(cases), f"{case.law}, {case.experiment}")
        human, robot = inputs[MODEL[case.law]]
        plant = Plant(delay_s=case.delay_s)
        times = {"lag_s": plant.lag_s, "delay_s": plant.delay_s}
        margin = judged(robot, case.law, case.gain, **times, period_s=1 / RATE_HZ, force=True)
        runs = [
            follow(_motion(case, seed), JointController(human, robot, law=case.law, gain=margin.gain, **times), seed=seed, plant=plant)
            for seed in range(seeds)
        ]
        mean, scatter = mean_error(runs)
        period = case.period_s if case.protocol == "uniform" else float("nan")
        rows.append(Row(case.experiment, case.law, case.protocol, margin.gain, case.delay_s, period, mean, scatter, margin.ratio, seeds))
    return rows


def _motion(case: _Case, seed: int) -> Motion:
    return uniform(period_s=case.period_s) if case.protocol == "uniform" else random(seed)


def sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """Where the default sits and why: every number in it comes from the table."""

    def found(experiment: str, law: str, protocol: str) -> list[Mapping[str, Any]]:
        return [row for row in table if (row["experiment"], row["law"], row["protocol"]) == (experiment, law, protocol)]

    parts = []
    for protocol, paper in PAPER_DEG.items():
        (published,), (default,) = found("published", "p", protocol), found("default", "full", protocol)
        best = min(found("gain", "p", protocol), key=lambda row: row["mean_error_deg"])
        parts.append(
            f"{protocol}: as published {published['mean_error_deg']:.2f} degrees (the paper: {paper}), at its best gain "
            f"{best['mean_error_deg']:.2f} ({best['gain']:g} 1/s, margin {best['margin']:.2f}), the default {default['mean_error_deg']:.2f}"
        )
    (default,) = found("default", "full", "uniform")
    swept = [row for row in found("gain", "full", "random") if row["margin"] > 1.5]
    errors = [row["mean_error_deg"] for row in swept]
    parts.append(
        f"the default gain of {default['gain']:.2f} 1/s leaves a margin of {default['margin']:.1f}, and between {swept[0]['gain']:g} and "
        f"{swept[-1]['gain']:g} 1/s the error of the random protocol only goes from {min(errors):.2f} to {max(errors):.2f} degrees"
    )
    return "; ".join(parts) + "."
