"""Events on simulated grasps: found as well as is claimed, better than the plain rule; and the counting itself."""

import itertools

import numpy as np
import pytest

from skinfab.fingertip.force.motion import KINDS, Limits, Motion, MotionWatch, find_motions
from skinfab.fingertip.force.motion_score import figures, published, score
from skinfab.fingertip.force.motion_simulator import GraspScene, grasp_log
from skinfab.fingertip.force.tare import tared


@pytest.fixture(scope="module")
def grasps() -> list:
    return [(tared(log, seconds=0.9), truth) for log, truth in (grasp_log(seed=s) for s in range(9000, 9008))]


def test_each_counts_once_and_only_its_own_kind() -> None:
    truth = [Motion("rolling", 1.0, 2.0), Motion("sliding", 4.0, 5.0)]
    found = [Motion("rolling", 1.0, 1.6, 1.1), Motion("rolling", 1.6, 2.0, 1.7), Motion("rolling", 4.0, 5.0, 4.1)]
    judged = score(found, truth, end=9.0)
    assert (judged["rolling"].true, judged["rolling"].found, judged["rolling"].right) == (1, 3, 1)
    assert (judged["sliding"].true, judged["sliding"].right) == (1, 0)
    assert judged["rolling"].delays == pytest.approx((0.1,))


def test_one_that_lasts_ends_with_the_log() -> None:
    assert score([Motion("sliding", 4.0, told=4.1)], [Motion("sliding", 4.0, 9.0)], end=9.0)["sliding"].right == 1


def test_most_are_found_and_little_else(grasps: list) -> None:
    judged = []
    for log, truth in grasps:
        watch = MotionWatch(Limits(GraspScene().friction_deg), rate_hz=200)
        judged.append(score(find_motions(log.time, log.force, log.moment, watch), truth, end=log.time[-1]))
    of = figures(judged)
    assert {kind for kind in KINDS if of[kind]["true"] > 10} == set(KINDS)
    assert of["all"]["precision"].value > 0.9 and of["all"]["recall"].value > 0.9
    plain = [
        score(published(log.time, log.force, log.moment, slide_deg=22, drop_n=0.3, roll_mm=1.0), truth, end=log.time[-1])
        for log, truth in grasps
    ]
    assert figures(plain)["all"]["precision"].high < of["all"]["precision"].low


def test_a_log_is_the_same_for_the_same_seed_and_keeps_to_friction() -> None:
    (one, truth), (again, _) = grasp_log(seed=3), grasp_log(seed=3)
    np.testing.assert_array_equal(one.force, again.force)
    assert one.simulated and all(a.end < b.start for a, b in itertools.pairwise(truth))
