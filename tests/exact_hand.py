"""A hand whose offsets, weight and moment are known, and what it reads without noise."""

import numpy as np

from skinfab.fingertip.force.gravity_simulator import directions
from skinfab.fingertip.force.poses import Poses

#: The centre of what it holds, mm, and the hand's own offsets (N, N mm), weight (N) and moment (N mm).
TRUE = np.array([5.0, -3.0, 150.0])
OFFSET, WEIGHT, MOMENT = np.array([0.1, -0.05, 0.2, 4.0, -2.0, 3.0]), 0.4, np.array([1.0, 2.0, 50.0])


def exact(count: int, *, held_n: float = 0.0, seed: int = 0, span: float = 60.0) -> Poses:
    """Readings without noise."""
    g = directions(count, span, np.random.default_rng(seed))
    force = OFFSET[:3] + (WEIGHT + held_n) * g
    moment = OFFSET[3:] + np.cross(MOMENT + held_n * TRUE, g)
    return Poses(force, moment, np.diag([1e-8] * 3 + [1e-6] * 3) * np.ones((count, 1, 1)), np.ones(count, dtype=np.int64))
