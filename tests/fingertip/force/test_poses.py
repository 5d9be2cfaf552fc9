"""Poses of a log: means, and an uncertainty that is neither too small nor too large."""

from dataclasses import replace

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.poses import poses_of, require_alive


def log(n: int = 400, *, filtered: int = 1, seed: int = 0) -> WrenchLog:
    rng = np.random.default_rng(seed)
    noise = np.stack([np.convolve(rng.standard_normal(n + filtered - 1), np.ones(filtered) / filtered, "valid") for _ in range(6)], axis=1)
    pose = np.repeat(np.arange(4), n // 4).astype(float)
    values = noise + pose[:, None]
    return WrenchLog("a.csv", np.arange(n) / 200, values[:, :3], values[:, 3:], others={"pose": pose})


def test_means_and_their_covariance() -> None:
    found = poses_of(log())
    assert found.force[:, 0] == pytest.approx(np.arange(4), abs=0.4) and found.samples.tolist() == [100] * 4
    assert found.covariance is not None and np.diag(found.covariance[0]) == pytest.approx(np.full(6, 0.01), rel=0.35)


def test_samples_that_follow_one_another_are_not_counted_as_independent() -> None:
    # Filtered over 5 samples, a mean of 100 is about as exact as before, though each sample scatters by a fifth in variance.
    means = np.array([poses_of(log(filtered=5, seed=k)).force[:, 0] - np.arange(4) for k in range(100)])
    stated = np.median([poses_of(log(filtered=5, seed=k)).covariance[0, 0, 0] for k in range(20)])  # type: ignore[index]
    naive = 0.2 / 100
    assert stated > 3 * naive and stated == pytest.approx(means.var(), rel=0.5)


def test_logs_without_poses_or_noise_say_so() -> None:
    plain = replace(log(), others={})
    found = poses_of(plain)
    assert len(found.force) == 400 and found.covariance is None and "each row is one" in found.notes[0]
    few = WrenchLog("b", np.arange(8.0), np.ones((8, 3)), np.ones((8, 3)), others={"pose": np.repeat([0.0, 1], 4)})
    assert poses_of(few).covariance is None and "too few samples" in poses_of(few).notes[-1]
    still = replace(log(), force=np.ones((400, 3)))
    assert poses_of(still).covariance is None and "never changes" in poses_of(still).notes[-1]


def test_rows_between_poses_are_left_out() -> None:
    made = log()
    pose = made.others["pose"].copy()
    pose[95:105] = np.nan
    found = poses_of(replace(made, others={"pose": pose}))
    assert found.samples.tolist() == [95, 95, 100, 100] and "10 rows" in found.notes[0]


def test_a_number_that_comes_again_is_another_pose() -> None:
    made = log()
    pose = np.repeat([0.0, 1.0, 0.0, 1.0], 100)
    found = poses_of(replace(made, others={"pose": pose}))
    assert found.force[:, 0] == pytest.approx(np.arange(4), abs=0.4) and "2 pose numbers come again" in found.notes[0]


def test_samples_that_follow_one_another_are_fewer_independent_ones() -> None:
    assert poses_of(log()).freedom == pytest.approx(396, rel=0.15) and 40 < poses_of(log(filtered=5)).freedom < 150


def test_a_dead_component_is_named() -> None:
    require_alive(log())
    made = log()
    made.force[:, 1], made.moment[:, 0] = 1.0, 0.0
    with pytest.raises(InputError, match=r"a\.csv: Fy, Mx read 1, 0 all the time"):
        require_alive(made)


def test_one_pose_is_none() -> None:
    made = replace(log(), others={"pose": np.zeros(400)})
    with pytest.raises(InputError, match="one pose"):
        poses_of(made)
