"""d after every step of the project's refinement and after every iteration of libigl's SLIM, from the same BFF start."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.bench.contestants import Slim
from skinfab.bench.timing import ENOUGH_S
from skinfab.flatten.bff import flatten_scaled
from skinfab.flatten.disk import lower
from skinfab.flatten.distortion import distortion_of, shaped_areas, singular_values
from skinfab.progress import Progress, silent

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

NEWTON, SLIM = "newton", "slim"

#: More than either needs on these disks: Newton stops by itself, SLIM when it is where Newton ended.
MOST_STEPS = 40
#: SLIM is there when its d - 4 is within this of Newton's.
_THERE = 1.001


@dataclass(frozen=True)
class Step:
    """Where a method is after a step: processor seconds since the common start (setting up included), and the mean d.

    Parameters
    ----------
    method : str
    triangles : int
    step : int
        0 is the start.
    seconds : float
        Least of the repeats.
    mean_d : float
    """

    method: str
    triangles: int
    step: int
    seconds: float
    mean_d: float


def follow(disks: Sequence[tuple[FloatArray, IntArray]], *, repeats: int = 3, progress: Progress = silent) -> list[Step]:
    """Every step of both methods on every disk; the two take turns.

    Parameters
    ----------
    disks : sequence of (V (n, 3) float64 mm, F (m, 3) int64)
    repeats : int
    progress : Progress
    """
    steps: list[Step] = []
    for k, (V, F) in enumerate(disks):
        start = flatten_scaled(V, F)
        best: dict[str, list[Step]] = {}
        spent = {NEWTON: 0.0, SLIM: 0.0}
        for turn in range(repeats):
            for method, walk in ((NEWTON, _newton), (SLIM, _slim)):
                if spent[method] >= ENOUGH_S:
                    continue
                progress((k + turn / repeats) / len(disks), f"{method} step by step, {len(F)} triangles")
                aim = 4.0 if method == NEWTON else 4 + (best[NEWTON][-1].mean_d - 4) * _THERE
                new = _steps(method, V, F, start, walk(V, F, start), aim)
                spent[method] += new[-1].seconds
                old = best.get(method, new)
                best[method] = [a if a.seconds <= b.seconds else b for a, b in zip(old, new, strict=True)]
        steps += best[NEWTON] + best[SLIM]
    return steps


def _steps(method: str, V: FloatArray, F: IntArray, start: FloatArray, walk: Iterator[tuple[float, FloatArray]], aim: float) -> list[Step]:
    """Follow a walk until it ends, gains nothing, or is at `aim`; judging it is outside the time."""
    found = [Step(method, len(F), 0, 0.0, _mean_d(V, F, start))]
    for seconds, uv in walk:
        found.append(Step(method, len(F), len(found), seconds, _mean_d(V, F, uv)))
        if found[-1].mean_d <= aim or len(found) > MOST_STEPS:
            break
    return found


def _newton(V: FloatArray, F: IntArray, start: FloatArray) -> Iterator[tuple[float, FloatArray]]:
    """Anew from the start each time, told to end a step later: so every point is what a whole call takes."""
    for most in range(1, MOST_STEPS + 1):
        began = time.process_time()
        refined = lower(V, F, start, max_steps=most)
        seconds = time.process_time() - began
        if len(refined.energy) <= most:
            return
        yield seconds, refined.UV


def _slim(V: FloatArray, F: IntArray, start: FloatArray) -> Iterator[tuple[float, FloatArray]]:
    began = time.process_time()
    slim = Slim(V, F, start)
    seconds = time.process_time() - began
    while True:
        began = time.process_time()
        uv = slim.step()
        seconds += time.process_time() - began
        yield seconds, uv


def _mean_d(V: FloatArray, F: IntArray, uv: FloatArray) -> float:
    area, real = shaped_areas(V, F)
    return float(np.average(distortion_of(singular_values(V, F, uv))[real], weights=area[real]))
