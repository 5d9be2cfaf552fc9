"""Averaging and the least force of a contact against its error and what is rejected, and what a sample costs.

The contacts are simulated: all over the dome, pushed with 0.05 to 5 N (equally often in each octave), leaning up to 30 degrees.
They roll, 20 mm a second: a longer average is quieter and later. Then events, on grasps of seeds that nothing was set on.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.bench.flatten import REPEATS, read_csv, write_csv
from skinfab.bench.timing import one_processor, timed_twice
from skinfab.fingertip.force.contact import LEAST_FORCE_N, Hemisphere, locate
from skinfab.fingertip.force.motion import AVERAGE_S, KINDS, Limits, Motion, MotionWatch, find_motions
from skinfab.fingertip.force.motion_score import figures, published, score
from skinfab.fingertip.force.motion_simulator import GraspScene, grasp_log
from skinfab.fingertip.force.tare import tared
from skinfab.fingertip.force.wrench import RADIUS_MM, SensorNoise
from skinfab.progress import Progress, silent

FloatArray = NDArray[np.float64]

AVERAGES = (1, 2, 5, 10, 20, 50)
GATES_N = (0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0)
#: The default's average.
DEFAULT = round(AVERAGE_S * GraspScene.rate_hz)
CONTACTS, ROLL_MM_S = 4000, 20.0
#: Grasps on which events are judged; limits were set on others.
GRASPS, FIRST_SEED = 40, 5000
#: The paper's rule with the limits that serve it best on the seeds below `FIRST_SEED`.
PUBLISHED_SLIDE_DEG, PUBLISHED_DROP_N, PUBLISHED_ROLL_MM = 22.0, 0.3, 1.5


@dataclass(frozen=True)
class Row:
    """One average and one gate.

    Parameters
    ----------
    average : int
        Samples.
    gate_n : float, N
    error_median_mm, error_p95_mm : float, mm
        Of the contacts that pass the gate.
    sd_mm : float, mm
        Median of what is told of them.
    rejected : float
        Part that does not pass.
    missed : float
        Part of those that pass whose line misses the dome.
    us_per_sample : float
    """

    average: int
    gate_n: float
    error_median_mm: float
    error_p95_mm: float
    sd_mm: float
    rejected: float
    missed: float
    us_per_sample: float


def run(folder: Path, *, repeats: int = REPEATS, progress: Progress = silent) -> dict[str, Any]:
    """Measure, and write force.csv, force_events.csv, force_ablation.csv, force_touches.csv, force.png and force.txt into `folder`.

    Returns
    -------
    dict
        "sentence", "notes" (what to know of the measurement), "rows", "events" and "touches".
    """
    from skinfab.bench.force_ablation import motions_without
    from skinfab.bench.force_chart import draw
    from skinfab.bench.force_touch import SENSORS
    from skinfab.bench.force_touch import measure as judge_touches
    from skinfab.files import atomic_write

    notes = [
        f"simulated: {CONTACTS} rolling contacts with the sensor's noise, {GRASPS} grasps with its offset too, {SENSORS} sensors to touch"
    ]
    with one_processor() as alone:
        notes += [] if alone else ["this system cannot keep a process on one processor"]
        rows = measure(repeats=repeats, progress=progress)
    write_csv(rows, folder / "force.csv")
    events = judge_events(progress=lambda done, what: progress(0.5 + 0.3 * done, what))
    write_csv(events, folder / "force_events.csv")
    write_csv(motions_without(progress=lambda done, what: progress(0.8 + 0.1 * done, what)), folder / "force_ablation.csv")
    write_csv(judge_touches(progress=lambda done, what: progress(0.9 + 0.1 * done, what)), folder / "force_touches.csv")
    table, judged, touched = (read_csv(folder / f"force{name}.csv") for name in ("", "_events", "_touches"))
    said = sentence(table, judged)
    atomic_write(folder / "force.txt", "\n".join([said, *notes]) + "\n")
    draw(table, judged, folder / "force.png")
    return {"sentence": said, "notes": notes, "rows": table, "events": judged, "touches": touched}


def measure(*, contacts: int = CONTACTS, repeats: int = REPEATS, progress: Progress = silent) -> list[Row]:
    """A row for every average and gate."""
    rows = []
    for k, average in enumerate(AVERAGES):
        progress(0.5 * k / len(AVERAGES), f"average of {average}")
        point, force, moment = rolling_contacts(contacts, average=average, seed=1)
        noise = SensorNoise().averaged(average)
        many = (np.tile(force, (25, 1)), np.tile(moment, (25, 1)))
        work = partial(locate, *many, noise=noise, least_force=0.0)
        work()  # compiled by now
        cost = 1e6 * min(timed_twice(work)[1] for _ in range(repeats)) / len(many[0])
        for gate in GATES_N:
            found = locate(force, moment, Hemisphere(), noise=noise, least_force=gate)
            on = found.touching
            error = np.linalg.norm(found.point - point, axis=1)[on]
            median, high = np.quantile(error, (0.5, 0.95)).tolist()
            missed = float(found.missed[on].mean())
            rows.append(Row(average, gate, median, high, float(np.median(found.sd_mm[on])), float(1 - on.mean()), missed, cost))
    return rows


def rolling_contacts(count: int, *, average: int, seed: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Where contacts (n, 3) are at the last of so many samples, and the means (n, 3) of force and moment over these."""
    rng = np.random.default_rng(seed)
    out = rng.standard_normal((count, 3))
    out[:, 2] = np.abs(out[:, 2]) + 0.3  # off the rim, so that none rolls over it
    out /= np.linalg.norm(out, axis=1)[:, None]
    side = np.cross(out, rng.standard_normal((count, 3)))
    side /= np.linalg.norm(side, axis=1)[:, None]
    size = 0.05 * 100 ** rng.uniform(0, 1, count)
    lean = np.radians(rng.uniform(0, 30, count))
    force, moment = np.zeros((count, 3)), np.zeros((count, 3))
    for k in range(average):
        angle = -ROLL_MM_S / RADIUS_MM * (average - 1 - k) / GraspScene.rate_hz
        now = np.cos(angle) * out + np.sin(angle) * side
        along = np.cos(angle) * side - np.sin(angle) * out
        f = size[:, None] * (np.sin(lean)[:, None] * along - np.cos(lean)[:, None] * now)
        force += f / average
        moment += np.cross(RADIUS_MM * now, f) / average
    noise = SensorNoise().averaged(average)
    force += noise.force_n * rng.standard_normal(force.shape)
    moment += noise.moment_nmm * rng.standard_normal(moment.shape)
    return RADIUS_MM * out, force, moment


@dataclass(frozen=True)
class Events:
    """One rule and one kind of event, where the friction angle is known so well.

    Parameters
    ----------
    rule : str
    friction_spread : float
        By how much, relatively, the object's friction differs from what the rule was told, at most.
    kind : str
    precision, precision_low, precision_high, recall, recall_low, recall_high : float
    delay_s : float, s
        Median, from an event's beginning to when it is told.
    true : int
    """

    rule: str
    friction_spread: float
    kind: str
    precision: float
    precision_low: float
    precision_high: float
    recall: float
    recall_low: float
    recall_high: float
    delay_s: float
    true: int


def judge_events(*, grasps: int = GRASPS, spreads: Sequence[float] = (0.0, 0.1, 0.2, 0.3), progress: Progress = silent) -> list[Events]:
    """A row for every rule, spread of the friction and kind."""
    rows = []
    for j, spread in enumerate(spreads):
        scene = GraspScene(friction_spread=spread)
        scores: dict[str, list[Any]] = {"published": [], "here": []}
        for k in range(grasps):
            progress((j + k / grasps) / len(spreads), f"grasps, friction known to {spread:.0%}")
            log, truth = grasp_log(seed=FIRST_SEED + k, scene=scene)
            log = tared(log, seconds=0.9)
            of = (log.time, log.force, log.moment)
            said: dict[str, list[Motion]] = {
                "published": published(*of, slide_deg=PUBLISHED_SLIDE_DEG, drop_n=PUBLISHED_DROP_N, roll_mm=PUBLISHED_ROLL_MM),
                "here": find_motions(*of, MotionWatch(Limits(scene.friction_deg), rate_hz=scene.rate_hz)),
            }
            for rule, events in said.items():
                scores[rule].append(score(events, truth, end=float(log.time[-1])))
        for rule, judged in scores.items():
            for kind, of_kind in figures(judged).items():
                p, r = of_kind["precision"], of_kind["recall"]
                rates = (p.value, p.low, p.high, r.value, r.low, r.high)
                rows.append(Events(rule, spread, kind, *rates, of_kind["delay_s"], of_kind["true"]))
    return rows


def sentence(table: Sequence[Mapping[str, Any]], events: Sequence[Mapping[str, Any]]) -> str:
    """What the default is worth beside no average and no gate: every number in it comes from the tables."""
    default = next(row for row in table if (row["average"], row["gate_n"]) == (DEFAULT, LEAST_FORCE_N))
    plain = next(row for row in table if (row["average"], row["gate_n"]) == (1, 0.0))
    by = {(row["rule"], row["friction_spread"], row["kind"]): row for row in events}
    here, paper = by["here", 0.1, "all"], by["published", 0.1, "all"]
    return (
        f"Contact, simulated: averaged over {DEFAULT} samples and from {LEAST_FORCE_N:g} N on, a rolling contact is found to "
        f"{default['error_median_mm']:.2f} mm (95 %: {default['error_p95_mm']:.2f}) with {default['rejected']:.0%} rejected, one by one "
        f"and ungated to {plain['error_median_mm']:.2f} mm ({plain['error_p95_mm']:.1f}), at {default['us_per_sample']:.2f} us a sample; "
        f"events ({', '.join(KINDS)}) have a precision of {here['precision']:.2f} and a recall of {here['recall']:.2f} where friction is "
        f"known to 10 %, by the paper's rule {paper['precision']:.2f} and {paper['recall']:.2f}."
    )
