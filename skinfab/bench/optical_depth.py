"""What is felt of an edge by depth, learned and not: how far off it is, how often it is called sure, and how often wrongly (simulated)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from skinfab.fingertip.optical.follower import LEAST_CONFIDENCE
from skinfab.fingertip.optical.follower import REACH_MM as FOLLOWED_TO_MM
from skinfab.fingertip.optical.labelled import DEPTHS_MM, FOLLOWED_MM, labelled
from skinfab.fingertip.optical.plates import HalfPlane
from skinfab.fingertip.optical.regress import EdgeModel, train
from skinfab.fingertip.optical.simulator import Fingertip
from skinfab.progress import Progress, silent

#: Images that are learned from (as docs/optical.md says), depths that are tried, mm, and frames of each.
IMAGES, TRIED_MM, FRAMES = 1000, (0.1, 0.3, 0.5, 0.8, 1.0, 1.2, 1.4, 1.8, 2.2, 2.6, 2.9), 150
#: Edges lie within so many mm of the middle.
REACH_MM = 4.0
#: A reading is wrong that is farther off, mm and degrees; sure above this confidence (as `skinfab optical run` marks it).
WRONG_MM, WRONG_DEG, SURE = 2.0, 45.0, 0.5


@dataclass(frozen=True)
class DepthRow:
    """One depth with one model.

    Parameters
    ----------
    learned_from_mm, learned_to_mm : float
        Depths that the model learned.
    depth_mm : float
        That it feels.
    offset_mm, angle_deg : float
        Mean absolute errors of all frames.
    wrong : float
        Part of the frames whose offset or angle is wrong.
    sure, sure_wrong : float
        Part of the frames that are called sure; part of all frames that are, and wrong.
    followed_wrong : float
        Part of all frames that a follower believes, and that are wrong.
    frames : int
    simulated : bool
    """

    learned_from_mm: float
    learned_to_mm: float
    depth_mm: float
    offset_mm: float
    angle_deg: float
    wrong: float
    sure: float
    sure_wrong: float
    followed_wrong: float
    frames: int
    simulated: bool = True


def measure_depths(
    *,
    ranges: Sequence[tuple[float, float]] = (DEPTHS_MM, FOLLOWED_MM),
    tried_mm: Sequence[float] = TRIED_MM,
    images: int = IMAGES,
    frames: int = FRAMES,
    progress: Progress = silent,
) -> list[DepthRow]:
    """A row for every range that is learned and every depth that is felt."""
    tip, rows = Fingertip(), []
    for k, learned in enumerate(ranges):
        progress(k / len(ranges), f"depths from {learned[0]:g} to {learned[1]:g} mm")
        some = list(labelled(tip, images, depths_mm=learned))
        model = train([one.image for one in some], [one.edge for one in some])
        rows += [depth_row(model, tip, learned, depth, frames) for depth in tried_mm]
    return rows


def depth_row(model: EdgeModel, tip: Fingertip, learned: tuple[float, float], depth: float, frames: int) -> DepthRow:
    """What a model feels of edges at one depth."""
    rng, said = np.random.default_rng(3), []
    for _ in range(frames):
        offset, angle = float(rng.uniform(-REACH_MM, REACH_MM)), float(rng.uniform(-math.pi, math.pi))
        felt = model.edge(tip.frame(HalfPlane(offset, angle), rng=rng, depth_mm=depth))
        turn = abs(math.degrees(math.remainder(felt.angle_rad - angle, math.tau)))
        said.append((abs(felt.offset_mm - offset), turn, felt.confidence, abs(felt.offset_mm)))
    off, turned, confidence, beside = np.array(said).T
    wrong, sure = (off > WRONG_MM) | (turned > WRONG_DEG), confidence > SURE
    followed = (confidence >= LEAST_CONFIDENCE) & (beside <= FOLLOWED_TO_MM)
    a, b, c, d, e, f = (float(each.mean()) for each in (off, turned, wrong, sure, sure & wrong, followed & wrong))
    return DepthRow(*learned, depth, a, b, c, d, e, f, frames)
