"""What trainings of a liquid's limit are like: how often a full cup among the empty ones is named, and how the limits scatter.

A training is a hundred pieces of 6 s, drawn from a larger pool of empty cups of the same hand; one of them is full, or none.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.force.liquid import FALSE_ALARM, stirred
from skinfab.fingertip.force.liquid_model import limit_of, stand_out
from skinfab.fingertip.force.liquid_simulator import WAYS, CupScene, stir
from skinfab.progress import Progress, silent

HANDS = {"hand trembles": CupScene(tremble_mm_s2=100.0), "hand trembles much": CupScene(tremble_mm_s2=200.0)}
#: Of water that swings by 10 degrees; 0: no cup among them is full.
WATER_G = (0, 10, 20, 50, 100)
#: Empty cups in the pool, pieces of a training, full cups of each amount, and trainings.
POOL, PIECES, CUPS, TRAININGS = 500, 100, 40, 400


@dataclass(frozen=True)
class TrainingRow:
    """One hand and amount of water.

    Parameters
    ----------
    condition : str
    tremble_mm_s2 : float, mm/s2
    grams : float
    named : float
        Part of the trainings with one such cup among the empty ones in which some log is named; 0 g: that have none, and ask all the same.
    found, found_low, found_high : float
        Part of such cups that is found by the limit learned without them: the middle of the trainings, and what a tenth is below and above.
    trainings : int
    """

    condition: str
    tremble_mm_s2: float
    grams: float
    named: float
    found: float
    found_low: float
    found_high: float
    trainings: int


def trainings(
    *,
    hands: Mapping[str, CupScene] = HANDS,
    pool: int = POOL,
    pieces: int = PIECES,
    cups: int = CUPS,
    count: int = TRAININGS,
    progress: Progress = silent,
) -> list[TrainingRow]:
    """A row for every hand and amount of water."""
    rows = []
    for k, (name, scene) in enumerate(hands.items()):
        progress(k / len(hands), f"trainings, {name}")
        rng = np.random.default_rng([6, k])
        empty = _chances(0, pool, scene, [6, k])
        drawn = [rng.choice(empty, pieces, replace=False) for _ in range(count)]
        limits = np.array([limit_of(each, FALSE_ALARM) for each in drawn])
        for grams in WATER_G:
            asked = _chances(grams, cups, scene, [5, k]) if grams else empty
            among = [np.append(each[1:], rng.choice(asked)) if grams else each for each in drawn]
            named = float(np.mean([stand_out(each).any() for each in among]))
            found = (asked[:, None] < limits).mean(axis=0)
            middle, low, high = np.quantile(found, (0.5, 0.1, 0.9)).tolist()
            rows.append(TrainingRow(name, scene.tremble_mm_s2, grams, named, middle, low, high, count))
    return rows


def _chances(grams: int, cups: int, scene: CupScene, seed: Sequence[int]) -> NDArray[np.float64]:
    made = (stir(water_kg=grams / 1000, way=WAYS[j % 2], scene=scene, seed=[*seed, grams, j]) for j in range(cups))
    return np.array([stirred(log).chance for log in made])


def sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """What is named and found of the shakiest hand: every number comes from the table."""
    last = table[-1]
    by = {row["grams"]: row for row in table if row["condition"] == last["condition"]}
    return (
        f"Of {last['trainings']} trainings by a hand that trembles by {last['tremble_mm_s2'] / 1000:g} m/s2, {by[0]['named']:.0%} ask "
        f"about an empty cup; one full cup among the hundred pieces is named in {by[100]['named']:.0%} with 100 g and in "
        f"{by[20]['named']:.0%} with 20 g; of cups with 10 g {by[10]['found']:.0%} are found by the middle one, "
        f"{by[10]['found_low']:.0%} to {by[10]['found_high']:.0%} by eight of ten."
    )
