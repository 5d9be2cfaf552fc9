"""The empty hand learned from weighings: offsets, drift from one to the next, and what tells nothing."""

from dataclasses import replace

import numpy as np
import pytest
from exact_hand import MOMENT, OFFSET, WEIGHT, exact

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.gravity_fit import learn_hand
from skinfab.fingertip.force.gravity_simulator import HandScene, hold
from skinfab.fingertip.force.poses import poses_of
from skinfab.rates import wilson

SCENE = HandScene(tip_kg=0.01, kinematics_mm=0.0)


def test_a_hand_without_a_weight_beyond_its_sensors_is_its_offsets_alone() -> None:
    poses = poses_of(hold(seed=4, weighing=0).log)
    model = learn_hand([poses])
    assert model.weight_n == 0 and not model.moment_nmm.any()
    np.testing.assert_allclose(model.offset[:3], poses.force.mean(axis=0), atol=3e-3)


def test_offsets_that_drift_are_seen_from_weighing_to_weighing() -> None:
    logs = [hold(seed=8, scene=replace(SCENE, drift_n=0.05), weighing=k).log for k in range(4)]
    steady = [hold(seed=8, scene=SCENE, weighing=k).log for k in range(4)]
    drifting, still = (learn_hand([poses_of(log) for log in each]).covariance[:3, :3] for each in (logs, steady))
    # Four sensors: 0.1 N of the whole hand, an axis.
    assert 0.05 < np.sqrt(np.trace(drifting) / 3) < 0.4 and np.trace(still) < np.trace(drifting) / 10


def test_a_drift_is_told_beside_a_weight_that_leaves_offsets_along_it_hardly_known() -> None:
    inside = []
    for seed in range(80):
        rng = np.random.default_rng(seed)
        drift = 0.02 * rng.standard_normal((3, 3))  # of two weighings and of the time after them
        own = np.tile(np.diag([0.006] * 3 + [0.5] * 3) ** 2, (8, 1, 1))
        weighings = []
        for k in range(2):
            empty = exact(8, seed=10 * seed + k, span=45.0)
            force = empty.force + drift[k] + 0.006 * rng.standard_normal((8, 3))
            weighings.append(replace(empty, force=force, moment=empty.moment + 0.5 * rng.standard_normal((8, 3)), covariance=own))
        model = learn_hand(weighings)
        off = (OFFSET[:3] + drift[2] - model.offset[:3]) / np.sqrt(model.covariance.diagonal()[:3])
        inside += (np.abs(off[:2]) < 1.96).tolist()  # across gravity, where drift is most of what is not known
    assert wilson(sum(inside), len(inside)).low < 0.95 < wilson(sum(inside), len(inside)).high


def test_what_tells_no_hand() -> None:
    with pytest.raises(InputError, match="no weighing"):
        learn_hand([])
    angle = np.linspace(-0.7, 0.7, 8)  # turned about one axis only
    g = np.column_stack([np.sin(angle), np.zeros(8), -np.cos(angle)])
    flat = replace(exact(8), force=OFFSET[:3] + WEIGHT * g, moment=OFFSET[3:] + np.cross(MOMENT, g))
    with pytest.raises(RefusedError, match="six poses or more"):
        learn_hand([flat])
