"""How much water, swinging how far, is found at which rate of false alarms: by how far lines wander, by lines in the spectrum, and learned.

The paper tells a liquid by lines that do not meet. As a rule that is a limit on how far they wander, set here where it serves best:
passed by one in a hundred of the empty cups of a still hand. Beside it is the spectrum's own chance, at a stated 1 %, and the same
with a limit learned from empty cups of the hand in question. Hands that tremble, and sensors that drift, are other conditions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from skinfab.bench.flatten import REPEATS, read_csv, write_csv
from skinfab.bench.timing import one_processor, timed_twice
from skinfab.fingertip.force.liquid import FALSE_ALARM, stirred
from skinfab.fingertip.force.liquid_model import LiquidModel, train_liquid
from skinfab.fingertip.force.liquid_simulator import WAYS, CupScene, stir
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.wrench import SensorNoise
from skinfab.progress import Progress, part_of, silent
from skinfab.rates import wilson

#: How the empty cups are held.
CONDITIONS = {
    "still": CupScene(),
    "sensor drifts": CupScene(drift_nmm_s=5.0),
    "hand trembles a little": CupScene(tremble_mm_s2=50.0),
    "hand trembles": CupScene(tremble_mm_s2=100.0),
    "hand trembles much": CupScene(tremble_mm_s2=200.0),
}
WATER_G, ANGLES_DEG = (2, 5, 10, 20, 50, 100), (3.0, 10.0)
#: Cups for each amount, angle and condition; empty ones that are judged, that wandering is limited by, and a minute each to learn from.
CUPS, EMPTY, LIMITED, LEARNED = 40, 300, 300, 12
RULES = ("wander", "spectrum", "learned")
#: A still hand's scene without one of its terms.
TERMS: Mapping[str, Mapping[str, Any]] = {
    "all terms": {},
    "swing that fades": {"damping": 0.0},
    "pull of the swing's speed": {"fling": 0.0},
    "nine tenths of the force's noise": {"noise": SensorNoise(CupScene.noise.force_n / 10, CupScene.noise.moment_nmm)},
    "nine tenths of the moment's noise": {"noise": SensorNoise(CupScene.noise.force_n, CupScene.noise.moment_nmm / 10)},
    "offsets": {"offset_n": 0.0, "offset_nmm": 0.0},
}


@dataclass(frozen=True)
class Row:
    """One condition, rule, amount of water and angle.

    Parameters
    ----------
    condition, rule : str
    tremble_mm_s2 : float, mm/s2
        Root mean square of the hand's acceleration.
    grams : float
        Of water; 0: what is found is a false alarm.
    angle_deg : float
        Of the swing at the beginning; 0 where there is no water.
    found, low, high : float
        Part of the cups that are taken for ones with a liquid, and its 95 % interval.
    cups : int
    ms_per_cup : float
        Least processor time.
    """

    condition: str
    rule: str
    tremble_mm_s2: float
    grams: float
    angle_deg: float
    found: float
    low: float
    high: float
    cups: int
    ms_per_cup: float


@dataclass(frozen=True)
class TermRow:
    """A still hand without one term: false alarms, cups found of 10 g swinging by 3 degrees and of 5 g by 10, and how far 50 g wander."""

    without: str
    false_alarms: float
    found_10_g_3_deg: float
    found_5_g_10_deg: float
    wander_50_g_mm: float


def run(folder: Path, *, repeats: int = REPEATS, progress: Progress = silent) -> dict[str, Any]:
    """Measure, and write liquid.csv, liquid_ablation.csv, liquid_training.csv, liquid.png and liquid.txt into `folder`, which is there.

    Returns
    -------
    dict
        "sentence", "notes" (what to know of the measurement), "rows", "ablation" and "training".
    """
    from skinfab.bench import liquid_training
    from skinfab.bench.liquid_chart import draw
    from skinfab.files import atomic_write

    notes = [f"simulated: cups of 150 g, {CUPS} of each amount, angle and condition, {EMPTY} empty ones of each condition, 6 s each"]
    with one_processor() as alone:
        notes += [] if alone else ["this system cannot keep a process on one processor"]
        rows = measure(repeats=repeats, progress=part_of(progress, 0.0, 0.75))
    write_csv(rows, folder / "liquid.csv")
    write_csv(without(progress=part_of(progress, 0.75, 0.87)), folder / "liquid_ablation.csv")
    write_csv(liquid_training.trainings(progress=part_of(progress, 0.87, 1.0)), folder / "liquid_training.csv")
    table, training = read_csv(folder / "liquid.csv"), read_csv(folder / "liquid_training.csv")
    said = f"{sentence(table)} {liquid_training.sentence(training)}"
    atomic_write(folder / "liquid.txt", "\n".join([said, *notes]) + "\n")
    draw(table, folder / "liquid.png")
    ablation = read_csv(folder / "liquid_ablation.csv")
    return {"sentence": said, "notes": notes, "rows": table, "ablation": ablation, "training": training}


def measure(
    *,
    conditions: Mapping[str, CupScene] = CONDITIONS,
    water_g: Sequence[int] = WATER_G,
    angles_deg: Sequence[float] = ANGLES_DEG,
    cups: int = CUPS,
    empty: int = EMPTY,
    limited: int = LIMITED,
    learned: int = LEARNED,
    repeats: int = REPEATS,
    progress: Progress = silent,
) -> list[Row]:
    """A row for every condition, rule, amount and angle, and one of empty cups for every condition and rule."""
    still = [stirred(stir(water_kg=0.0, seed=[9, k])).wander_mm for k in range(limited)]
    wander = float(np.quantile(still, 1 - FALSE_ALARM))
    cost = 1e3 * min(timed_twice(lambda: stirred(stir(water_kg=0.0)))[1] for _ in range(repeats))
    rows = []
    for k, (name, scene) in enumerate(conditions.items()):
        progress(k / len(conditions), f"cups, {name}")
        minutes = [stir(water_kg=0.0, seconds=60.0, scene=scene, seed=[8, k, j]) for j in range(learned)]
        model = train_liquid(minutes).model
        settings = [(0, 0.0, empty)] + [(grams, angle, cups) for angle in angles_deg for grams in water_g]
        for grams, angle, count in settings:
            logs = [
                stir(water_kg=grams / 1000, way=WAYS[j % 2], angle_deg=angle, scene=scene, seed=[k, grams, round(angle), j])
                for j in range(count)
            ]
            for rule, found in _found(logs, wander, model).items():
                rate = wilson(found, count)
                rows.append(Row(name, rule, scene.tremble_mm_s2, grams, angle, rate.value, rate.low, rate.high, count, cost))
    return rows


def _found(logs: Sequence[WrenchLog], wander: float, model: LiquidModel) -> dict[str, int]:
    """How many are taken for ones with a liquid by each of `RULES`."""
    judged = [stirred(log) for log in logs]
    counts = (
        sum(each.wander_mm > wander for each in judged),
        sum(each.liquid for each in judged),
        sum(each.chance < model.limit for each in judged),
    )
    return dict(zip(RULES, counts, strict=True))


def without(*, of: Mapping[str, Mapping[str, Any]] = TERMS, cups: int = 60, progress: Progress = silent) -> list[TermRow]:
    """A row for each term."""
    rows = []
    for k, (name, terms) in enumerate(of.items()):
        progress(k / len(of), f"liquids: {name}")
        scene = replace(CupScene(), **terms)

        def found(grams: int, angle: float, count: int, scene: CupScene = scene) -> float:
            judged = [stirred(stir(water_kg=grams / 1000, angle_deg=angle, scene=scene, seed=[7, grams, j])) for j in range(count)]
            return float(np.mean([each.liquid for each in judged]))

        wander = [stirred(stir(water_kg=0.05, scene=scene, seed=[7, j])).wander_mm for j in range(10)]
        rows.append(TermRow(name, found(0, 0.0, 3 * cups), found(10, 3.0, cups), found(5, 10.0, cups), float(np.median(wander))))
    return rows


def sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """What is found and how often wrongly: every number comes from the table."""
    by = {(row["condition"], row["rule"], row["grams"], row["angle_deg"]): row["found"] for row in table}
    shaky = table[-1]["condition"]
    tremble = table[-1]["tremble_mm_s2"] / 1000
    return (
        f"Liquids, simulated: at a stated {FALSE_ALARM:.0%}, {by['still', 'spectrum', 0, 0.0]:.1%} of the empty cups of a still hand are "
        f"taken for full ones, and 10 g that swing by 10 degrees are found in {by['still', 'spectrum', 10, 10.0]:.0%} (by how far the "
        f"lines wander {by['still', 'wander', 10, 10.0]:.0%}), 20 g by 3 degrees in {by['still', 'spectrum', 20, 3.0]:.0%} "
        f"({by['still', 'wander', 20, 3.0]:.0%}); where the hand trembles ({tremble:g} m/s2) {by[shaky, 'spectrum', 0, 0.0]:.0%} of the "
        f"empty cups are, by the limit learned from such cups {by[shaky, 'learned', 0, 0.0]:.1%}, and 50 g that swing by 10 degrees are "
        f"still found in {by[shaky, 'learned', 50, 10.0]:.0%}."
    )
