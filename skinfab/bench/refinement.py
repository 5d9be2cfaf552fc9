"""d after every iteration of the project's Newton method and of libigl's SLIM, from the same BFF start."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.bench.contestants import Slim
from skinfab.bench.timing import ENOUGH_S
from skinfab.flatten.bff import flatten_scaled
from skinfab.flatten.distortion import distortion_of, shaped_areas, singular_values
from skinfab.flatten.isometric import IsometricSolver
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
    """Where a method is after an iteration: seconds since the common start (setting up included), and the mean d.

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


def _steps(method: str, V: FloatArray, F: IntArray, start: FloatArray, walk: Iterator[FloatArray], aim: float) -> list[Step]:
    """Follow a walk until it ends, or is at `aim`; judging it is outside the time."""
    found = [Step(method, len(F), 0, 0.0, _mean_d(V, F, start))]
    seconds = 0.0
    while len(found) <= MOST_STEPS and found[-1].mean_d > aim:
        began = time.perf_counter()
        uv = next(walk, None)
        seconds += time.perf_counter() - began
        if uv is None:
            break
        found.append(Step(method, len(F), len(found), seconds, _mean_d(V, F, uv)))
    return found


def _newton(V: FloatArray, F: IntArray, start: FloatArray) -> Iterator[FloatArray]:
    solver, uv, converged = IsometricSolver(V, F), start, False
    while not converged:
        refined = solver.refine(uv, max_steps=1)
        uv, converged = refined.UV, refined.converged
        if len(refined.energy) > 1:
            yield uv


def _slim(V: FloatArray, F: IntArray, start: FloatArray) -> Iterator[FloatArray]:
    slim = Slim(V, F, start)
    while True:
        yield slim.step()


def _mean_d(V: FloatArray, F: IntArray, uv: FloatArray) -> float:
    area, real = shaped_areas(V, F)
    return float(np.average(distortion_of(singular_values(V, F, uv))[real], weights=area[real]))
