"""What each term of the simulated grasps is there for: taken out, which reported figure changes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from skinfab.bench.force import FIRST_SEED, PUBLISHED_DROP_N, PUBLISHED_ROLL_MM, PUBLISHED_SLIDE_DEG
from skinfab.fingertip.force.grasp import CUBOID, LEARNED, NEW, OVER, PAPER, SHAPES, HandScene, simulate_grasp, total_wrench, touches
from skinfab.fingertip.force.gravity import centre_of_gravity
from skinfab.fingertip.force.motion import Limits, MotionWatch, find_motions
from skinfab.fingertip.force.motion_score import figures, published, score
from skinfab.fingertip.force.motion_simulator import GraspScene, grasp_log
from skinfab.fingertip.force.reconstruct import reconstruct
from skinfab.fingertip.force.shape import features_of, fit_shapes
from skinfab.fingertip.force.wrench import SensorNoise
from skinfab.progress import Progress, silent

#: The scene of a grasp that slides without one of its terms.
MOTION_TERMS = {
    "all terms": {},
    "friction as told": {"friction_spread": 0.0},
    "static = kinetic friction": {"kinetic": 1.0},
    "no sensor noise": {"noise": SensorNoise(0.0, 0.0)},
    "no offset": {"offset_n": 0.0, "offset_nmm": 0.0},
}
#: The scene of a hand without one of its terms.
HAND_TERMS = {
    "all terms": {},
    "object in place": {"place_mm": 0.0},
    "object not turned": {"yaw_deg": 0.0},
    "object not tilted": {"tilt_deg": 0.0},
    "fingers at right angles": {"azimuth_deg": 0.0},
    "fingers at one height": {"along_mm": 0.0},
    "joints' places exact": {"joint_mm": 0.0},
    "joints' turns exact": {"joint_deg": 0.0},
}


@dataclass(frozen=True)
class MotionRow:
    """Events without one term, untared: precision and recall here and by the paper's rule."""

    without: str
    precision: float
    recall: float
    published_precision: float
    published_recall: float


@dataclass(frozen=True)
class HandRow:
    """Shapes and sizes without one term: right on new objects by each kind of features, and a cuboid's median error."""

    without: str
    published: float
    pose_free: float
    misfits: float
    cuboid_error_mm: float


def motions_without(*, grasps: int = 20, progress: Progress = silent) -> list[MotionRow]:
    """A row for each of `MOTION_TERMS`; nothing is taken off the readings, so that the offset shows."""
    rows = []
    for k, (name, terms) in enumerate(MOTION_TERMS.items()):
        progress(k / len(MOTION_TERMS), f"events: {name}")
        scene = replace(GraspScene(), **terms)  # type: ignore[arg-type]
        here, plain = [], []
        for seed in range(FIRST_SEED, FIRST_SEED + grasps):
            log, truth = grasp_log(seed=seed, scene=scene)
            of = (log.time, log.force, log.moment)
            end = float(log.time[-1])
            here.append(score(find_motions(*of, MotionWatch(Limits(scene.friction_deg), rate_hz=scene.rate_hz)), truth, end=end))
            said = published(*of, slide_deg=PUBLISHED_SLIDE_DEG, drop_n=PUBLISHED_DROP_N, roll_mm=PUBLISHED_ROLL_MM)
            plain.append(score(said, truth, end=end))
        ours, theirs = figures(here)["all"], figures(plain)["all"]
        rates = (ours["precision"], ours["recall"], theirs["precision"], theirs["recall"])
        rows.append(MotionRow(name, *(each.value for each in rates)))
    return rows


def hands_without(*, sets: int = 2, grasps: int = 15, progress: Progress = silent) -> list[HandRow]:
    """A row for each of `HAND_TERMS`."""
    rows = []
    for k, (name, terms) in enumerate(HAND_TERMS.items()):
        progress(k / len(HAND_TERMS), f"shapes: {name}")
        scene = replace(HandScene(), **terms)  # type: ignore[arg-type]
        right: dict[str, list[bool]] = {"published": [], "pose-free": [], "misfits": []}
        for seed in range(sets):
            rng = np.random.default_rng(seed)
            known, asked = (
                [(touches(simulate_grasp(solid, seed=rng, scene=scene)), SHAPES.index(solid.shape)) for solid in of for _ in range(grasps)]
                for of in (LEARNED, NEW)
            )
            y, truth = (np.array([shape for _, shape in of]) for of in (known, asked))
            for features, of in right.items():
                net = fit_shapes(features_of([found for found, _ in known], features), y, features, seed=seed)
                of += (net.probability(features_of([found for found, _ in asked], features)).argmax(axis=1) == truth).tolist()
        off = []
        for seed in range(grasps):
            grasp = simulate_grasp(PAPER[2], seed=3000 + seed, scene=scene, poses=10, fingers=OVER)
            size = reconstruct(touches(grasp), CUBOID, centre_of_gravity(*total_wrench(grasp)).point).size
            off.append(np.abs(np.sort(size) - PAPER[2].size))
        plain, free, misfits = (float(np.mean(of)) for of in right.values())
        rows.append(HandRow(name, plain, free, misfits, float(np.nanmedian(off))))
    return rows
