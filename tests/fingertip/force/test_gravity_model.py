"""The empty hand: what is learned of it is what was put in, its uncertainty covers, and few poses then tell a centre."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.gravity import centre_of_gravity
from skinfab.fingertip.force.gravity_model import HandModel, centre_with, learn_hand, left_over, load_hand, mass_with, save_hand
from skinfab.fingertip.force.gravity_simulator import PAPER_TRUTH, HandScene, directions, hold
from skinfab.fingertip.force.poses import Poses, poses_of
from skinfab.fingertip.saved import save_model
from skinfab.rates import wilson

ELLIPSOID = 7.814727903251179
TRUE = np.array([5.0, -3.0, 150.0])
OFFSET, WEIGHT, MOMENT = np.array([0.1, -0.05, 0.2, 4.0, -2.0, 3.0]), 0.4, np.array([1.0, 2.0, 50.0])
SCENE = HandScene(tip_kg=0.01, kinematics_mm=0.0)


def exact(count: int, *, held_n: float = 0.0, seed: int = 0, span: float = 60.0) -> Poses:
    """Readings without noise."""
    g = directions(count, span, np.random.default_rng(seed))
    force = OFFSET[:3] + (WEIGHT + held_n) * g
    moment = OFFSET[3:] + np.cross(MOMENT + held_n * TRUE, g)
    return Poses(force, moment, np.diag([1e-8] * 3 + [1e-6] * 3) * np.ones((count, 1, 1)), np.ones(count, dtype=np.int64))


def test_without_noise_the_hand_and_what_it_holds_come_out() -> None:
    model = learn_hand([exact(8), exact(6, seed=1)])
    np.testing.assert_allclose(model.offset, OFFSET, atol=1e-3)
    assert model.weight_n == pytest.approx(WEIGHT, abs=1e-4)
    np.testing.assert_allclose(model.moment_nmm, MOMENT, atol=2e-2)
    found = centre_with(model, exact(2, held_n=1.7, seed=2))
    np.testing.assert_allclose(found.point, TRUE, atol=0.05)
    assert mass_with(model, exact(2, held_n=1.7, seed=2)).kg == pytest.approx(1.7 / 9.80665, rel=1e-3)
    assert left_over([exact(8), exact(6, seed=1)])[1] == pytest.approx((0.0, 0.0), abs=0.02)


def test_a_hand_without_a_weight_beyond_its_sensors_is_its_offsets_alone() -> None:
    poses = poses_of(hold(seed=4, weighing=0).log)
    model = learn_hand([poses])
    assert model.weight_n == 0 and not model.moment_nmm.any()
    np.testing.assert_allclose(model.offset[:3], poses.force.mean(axis=0), atol=3e-3)


@pytest.fixture(scope="module")
def errors() -> list[tuple[float, float, float]]:
    """Of three poses: error with the model and its squared distance in stated deviations, error with the offset fitted."""
    out = []
    for seed in range(60):
        centre = PAPER_TRUTH[seed % 5]
        poses = poses_of(hold(centre, seed=[seed, 5], scene=replace(SCENE, poses=3)).log)
        # Twelve: of ten poses drawn at will one hand in a hundred turns too little to be weighed, and is refused.
        model = learn_hand([poses_of(hold(centre, seed=[seed, 5], scene=replace(SCENE, poses=12), weighing=0).log)])
        found = centre_with(model, poses)
        off = found.point - centre
        try:
            fitted = centre_of_gravity(poses.force, poses.moment, poses.covariance, freedom=poses.freedom).point
        except RefusedError:
            fitted = np.full(3, np.inf)
        out.append(
            (float(np.linalg.norm(off)), float(off @ np.linalg.solve(found.covariance, off)), float(np.linalg.norm(fitted - centre)))
        )
    return out


def test_three_poses_are_better_than_with_an_offset_fitted_beside(errors: list[tuple[float, float, float]]) -> None:
    known, _, fitted = np.array(errors).T
    assert np.median(known) < np.median(fitted) / 3 and np.quantile(known, 0.9) < np.quantile(fitted, 0.9) / 4


def test_the_stated_uncertainty_covers(errors: list[tuple[float, float, float]]) -> None:
    inside = sum(square < ELLIPSOID for _, square, _ in errors)
    assert wilson(inside, len(errors)).low < 0.95 < wilson(inside, len(errors)).high


def test_offsets_that_drift_are_seen_from_weighing_to_weighing() -> None:
    logs = [hold(seed=8, scene=replace(SCENE, drift_n=0.05), weighing=k).log for k in range(4)]
    steady = [hold(seed=8, scene=SCENE, weighing=k).log for k in range(4)]
    drifting, still = (learn_hand([poses_of(log) for log in each]).covariance[:3, :3] for each in (logs, steady))
    # Four sensors: 0.1 N of the whole hand, an axis.
    assert 0.05 < np.sqrt(np.trace(drifting) / 3) < 0.4 and np.trace(still) < np.trace(drifting) / 10


def test_what_tells_nothing() -> None:
    with pytest.raises(InputError, match="no weighing"):
        learn_hand([])
    angle = np.linspace(-0.7, 0.7, 8)  # turned about one axis only
    g = np.column_stack([np.sin(angle), np.zeros(8), -np.cos(angle)])
    flat = replace(exact(8), force=OFFSET[:3] + WEIGHT * g, moment=OFFSET[3:] + np.cross(MOMENT, g))
    with pytest.raises(RefusedError, match="six poses or more"):
        learn_hand([flat])
    model = learn_hand([exact(8)])
    with pytest.raises(InputError, match=r"pose 1 feels 0\.4 N, no more than the empty hand"):
        centre_with(model, exact(4, seed=3))
    with pytest.raises(RefusedError, match="one direction"):
        centre_with(model, exact(3, held_n=1.7, span=1e-7))


def test_a_model_comes_back_as_it_was_and_others_are_refused(tmp_path: Path) -> None:
    model = learn_hand([exact(8)])
    save_hand(model, tmp_path / "a.npz", facts={"simulated": True})
    back, simulated = load_hand(tmp_path / "a.npz")
    assert simulated and back.weight_n == model.weight_n
    np.testing.assert_array_equal(back.covariance, model.covariance)
    save_model(tmp_path / "b.npz", kind="force hand", facts={}, arrays={"offset": np.zeros(3)})
    with pytest.raises(InputError, match="offset is missing or has another shape"):
        load_hand(tmp_path / "b.npz")
    save_hand(HandModel(model.offset, -1.0, model.moment_nmm, model.covariance, 1), tmp_path / "c.npz", facts={})
    with pytest.raises(InputError, match="its weight or its covariance is none"):
        load_hand(tmp_path / "c.npz")
    save_model(tmp_path / "d.npz", kind="force liquid", facts={}, arrays={})
    with pytest.raises(InputError, match="another kind"):
        load_hand(tmp_path / "d.npz")


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
