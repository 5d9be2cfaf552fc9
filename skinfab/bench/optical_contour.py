"""Following edges: the seed's shapes by its own way and by a felt pose, and how often a contour closes by step and by noise."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from skinfab.fingertip.optical.follower import MOST_FRAMES, Feel, Trace, follow_pose, follow_published
from skinfab.fingertip.optical.labelled import FOLLOWED_MM, labelled
from skinfab.fingertip.optical.regress import train
from skinfab.fingertip.optical.rig import Platform, Rig
from skinfab.fingertip.optical.shapes import Reconstruction, Shape, reconstruct, shapes
from skinfab.fingertip.optical.simulator import Fingertip, paper_fingertip
from skinfab.progress import Progress, silent
from skinfab.rates import wilson

PUBLISHED, FRAMES, IMPROVED = "merged pins", "pose, each frame alone", "pose, memory and palpation"
#: Images that the pose is learned from, published runs round each shape, and seeds for each point of the chart and each improved run.
IMAGES, RUNS, SEEDS = 700, 5, 20
#: Steps, mm, at the fingertip's own noise; and noise of the tips, mm, at the seed's step.
STEPS_MM, NOISES_MM = (1.0, 4.0, 8.0), (0.1, 0.2, 0.3)
#: A robot that has not closed the contour after so many times its length does not any more; and it always has so many frames.
ROUNDS, LEAST_FRAMES = 3, 100

Follow = Callable[[Rig], Trace]


@dataclass(frozen=True)
class ShapeRow:
    """One shape by one way; lengths mm, over all runs that are right.

    Parameters
    ----------
    shape, method : str
    sides : str
        True / in the seed's table / found here, a side each.
    side_error_pc, repeat_pc, area_error_pc : float
        Largest error of a side's mean; largest spread of a side over its mean; largest error of the hull's area. NaN where no run is
        right.
    off_mm : float
        Mean distance of the trace from the true edge.
    worst_mm : float
        The largest distance of any of its points.
    area_cm2, true_cm2, seed_cm2, humans_cm2 : float
        Mean of the hulls; of the plate; of the seed's fingertip and of people (table 2).
    right, runs : int
    simulated : bool
    """

    shape: str
    method: str
    sides: str
    side_error_pc: float
    repeat_pc: float
    area_error_pc: float
    off_mm: float
    worst_mm: float
    area_cm2: float
    true_cm2: float
    seed_cm2: float
    humans_cm2: float
    right: int
    runs: int
    simulated: bool = True


@dataclass(frozen=True)
class RateRow:
    """How often one way closes the circle's contour; `low` and `high` end the 95 % interval."""

    shape: str
    method: str
    step_mm: float
    noise_mm: float
    right: int
    seeds: int
    rate: float
    low: float
    high: float
    off_mm: float
    simulated: bool = True


def learned(tip: Fingertip, *, images: int = IMAGES, seed: int = 0) -> Feel:
    """A pose that is learned from images of straight edges, pressed as deep as the robot does."""
    some = list(labelled(tip, images, depths_mm=FOLLOWED_MM, seed=seed))
    return train([each.image for each in some], [each.edge for each in some]).edge


def ways(feel: Feel, *, step_mm: float = 1.0, most_frames: int = MOST_FRAMES) -> dict[str, Follow]:
    """The followers that are compared."""
    return {
        PUBLISHED: partial(follow_published, step_mm=step_mm, most_frames=most_frames),
        FRAMES: partial(follow_pose, feel=feel, step_mm=step_mm, most_frames=most_frames, memory=False, palpation=False),
        IMPROVED: partial(follow_pose, feel=feel, step_mm=step_mm, most_frames=most_frames),
    }


def patience(shape: Shape, step_mm: float) -> int:
    """Frames after which a robot is stopped.

    Examples
    --------
    >>> patience(shapes()[-1], 1.0), patience(shapes()[-1], 8.0)
    (566, 100)
    """
    return min(max(math.ceil(ROUNDS * shape.plate.length / step_mm), LEAST_FRAMES), MOST_FRAMES)


@dataclass(frozen=True, eq=False)
class Made:
    """What came of one run, and how far off its edge was at most."""

    shape: Reconstruction
    worst_mm: float


def runs_of(shape: Shape, tip: Fingertip, follow: Follow, seeds: Sequence[int], *, lines: bool) -> list[Made | None]:
    """A reconstruction for each seed; None where the edge was lost before anything could be made of it."""
    out: list[Made | None] = []
    for seed in seeds:
        trace = follow(Rig(shape.plate, tip, shape.plate.start, Platform(), seed))
        known = len(trace.path) >= max(len(shape.sides_mm), 3)
        worst = float(np.abs(shape.plate.distance(trace.edge)).max()) if known else math.nan
        out.append(Made(reconstruct(trace, shape, lines=lines), worst) if known else None)
    return out


def shape_row(shape: Shape, method: str, made: Sequence[Made | None]) -> ShapeRow:
    """What the runs come to."""
    right = [each.shape for each in made if each is not None and each.shape.right]
    areas = (shape.plate.area / 100, shape.area_mm2 / 100, shape.humans_mm2 / 100)
    if not right:
        nan = float("nan")
        return ShapeRow(shape.name, method, "", nan, nan, nan, nan, nan, nan, *areas, 0, len(made))
    sides = np.array([each.sides_mm for each in right])
    mean, true = sides.mean(axis=0), np.array(shape.sides_mm)
    words = " ".join(f"{a:g}/{b:g}/{c:.1f}" for a, b, c in zip(true, shape.published_mm, mean, strict=True))
    return ShapeRow(
        shape.name,
        method,
        words,
        100 * float(np.abs(mean / true - 1).max()),
        100 * float(((sides.max(axis=0) - sides.min(axis=0)) / mean).max()),
        100 * max(abs(each.area_mm2 / shape.plate.area - 1) for each in right),
        float(np.mean([each.off_mm for each in right])),
        max(each.worst_mm for each in made if each is not None and each.shape.right),
        float(np.mean([each.area_mm2 for each in right])) / 100,
        *areas,
        len(right),
        len(made),
    )


def measure_shapes(feel: Feel, *, runs: int = RUNS, seeds: int = SEEDS, progress: Progress = silent) -> list[ShapeRow]:
    """Tables 1 and 2 of the seed by its own way (`runs` times) and by the improved one (`seeds` times), on its own fingertip."""
    tip, rows = paper_fingertip(), []
    for k, shape in enumerate(shapes()):
        both = ways(feel, most_frames=patience(shape, 1.0))
        for j, (name, count) in enumerate(((PUBLISHED, runs), (IMPROVED, seeds))):
            progress((k + j / 2) / 3, f"{shape.name}, {name}")
            rows.append(shape_row(shape, name, runs_of(shape, tip, both[name], range(count), lines=name != PUBLISHED)))
    return rows


def measure_rates(
    feel: Feel,
    *,
    steps_mm: Sequence[float] = STEPS_MM,
    noises_mm: Sequence[float] = NOISES_MM,
    seeds: int = SEEDS,
    images: int = IMAGES,
    progress: Progress = silent,
) -> list[RateRow]:
    """How often the circle closes; where tips are noisier, the pose is learned from images with that noise."""
    tip, shape = paper_fingertip(), shapes()[-1]
    own = tip.errors.pin_mm
    points = [(step, own) for step in steps_mm] + [(steps_mm[0], noise) for noise in noises_mm]
    rows = []
    for k, (step, noise) in enumerate(points):
        noisy = replace(tip, errors=replace(tip.errors, pin_mm=noise))
        felt = feel if noise == own else learned(noisy, images=images)
        for j, (name, follow) in enumerate(ways(felt, step_mm=step, most_frames=patience(shape, step)).items()):
            progress((k + j / 3) / len(points), f"steps of {step:g} mm, noise of {noise:g} mm, {name}")
            made = runs_of(shape, noisy, follow, range(seeds), lines=False)
            off = [each.shape.off_mm for each in made if each is not None and each.shape.right]
            rate = wilson(len(off), seeds)
            mean = float(np.mean(off)) if off else float("nan")
            rows.append(RateRow(shape.name, name, step, noise, len(off), seeds, rate.value, rate.low, rate.high, mean))
    return rows
