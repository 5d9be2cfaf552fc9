"""How near the project's flattenings come to the least d there is: libigl's SLIM driven until it gains nothing more."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinfab.bench.contestants import Slim
from skinfab.bench.cut import cut_disk
from skinfab.flatten.bff import flatten_scaled
from skinfab.flatten.bijective import flatten_bijective
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import best_scale, measure
from skinfab.flatten.tutte import tutte_embedding
from skinfab.mesh.door import load_usable

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Parts of real objects that are disks: file, direction, share of the triangles that lie farthest in it.
CUTS: Mapping[str, tuple[str, tuple[float, float, float], float]] = {
    "spot's head": ("spot.obj", (0, 0, -1), 0.25),
    "bunny, half": ("bff_bunny.obj", (0, 0, 1), 0.5),
    "kitten's face": ("bff_kitten.obj", (0, 0, 1), 0.25),
    "mustard bottle, half": ("ycb_mustard.obj", (0, 1, 0), 0.5),
    "human finger, half": ("human_index_finger_open.obj", (0, -1, 0), 0.5),
    "robot finger, half": ("jaco_finger_proximal.obj", (0, 1, 0), 0.5),
}

#: SLIM has converged when this many iterations together gain less than this fraction of d - 4.
_WINDOW, _GAIN = 5, 2e-5
_MOST = 400


@dataclass(frozen=True)
class Nearness:
    """Mean d of one disk by each method, and seconds of processor time (the whole way from the mesh, a start included).

    Parameters
    ----------
    disk : str
    triangles : int
    bff, isometric, bijective, slim_tutte, slim_bff : float
        Mean d; SLIM's at its end, from Tutte's start (its own, as a rule) and from BFF's.
    flipped : int
        Of isometric and bijective together.
    overlap_mm2 : float
        Of bijective.
    isometric_s, bijective_s, slim_s : float
        SLIM's from the BFF start to its end.
    slim_there_s : float
        Until SLIM's d was where isometric ended, or its end if it never was.
    """

    disk: str
    triangles: int
    bff: float
    isometric: float
    bijective: float
    slim_tutte: float
    slim_bff: float
    flipped: int
    overlap_mm2: float
    isometric_s: float
    bijective_s: float
    slim_s: float
    slim_there_s: float

    @property
    def excess(self) -> float:
        """By how much of the least d isometric's is larger."""
        return self.isometric / min(self.slim_tutte, self.slim_bff) - 1


def real_disks(folder: Path) -> dict[str, tuple[FloatArray, IntArray]]:
    """`CUTS` of the objects in a folder, as far as they are there."""
    return {
        name: cut_disk(load_usable(folder / file).mesh, towards, share)
        for name, (file, towards, share) in CUTS.items()
        if (folder / file).is_file()
    }


def nearness(disk: str, V: FloatArray, F: IntArray) -> Nearness:
    """Flatten one disk in every way, and say how near it came."""
    began = time.process_time()
    plain = flatten_isometric(V, F)
    plain_s = time.process_time() - began
    began = time.process_time()
    apart = flatten_bijective(V, F)
    apart_s = time.process_time() - began
    began = time.process_time()
    start = flatten_scaled(V, F)
    start_s = time.process_time() - began
    bff, isometric, bijective = (measure(V, F, uv) for uv in (start, plain, apart))
    own = tutte_embedding(V, F)
    walk = converged_slim(V, F, start)
    there = next((seconds for seconds, d in walk if d <= isometric.mean), walk[-1][0])
    return Nearness(
        disk=disk,
        triangles=len(F),
        bff=bff.mean,
        isometric=isometric.mean,
        bijective=bijective.mean,
        slim_tutte=converged_slim(V, F, own * best_scale(V, F, own))[-1][1],
        slim_bff=walk[-1][1],
        flipped=isometric.flipped + bijective.flipped,
        overlap_mm2=bijective.overlap_mm2,
        isometric_s=plain_s,
        bijective_s=apart_s,
        slim_s=start_s + walk[-1][0],
        slim_there_s=start_s + there,
    )


def converged_slim(V: FloatArray, F: IntArray, start: FloatArray) -> list[tuple[float, float]]:
    """Processor seconds since the start and mean d after each iteration of SLIM, until it gains nothing more."""
    began = time.process_time()
    slim = Slim(V, F, start)
    spent = time.process_time() - began
    walk: list[tuple[float, float]] = []
    while len(walk) < _MOST:
        began = time.process_time()
        uv = slim.step()
        spent += time.process_time() - began
        walk.append((spent, measure(V, F, uv).mean))
        if len(walk) > _WINDOW and walk[-1 - _WINDOW][1] - walk[-1][1] < _GAIN * (walk[-1][1] - 4):
            break
    return walk
