"""The empty hand: what is learned of it is what was put in, its uncertainty covers, and few poses then tell a centre."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from exact_hand import MOMENT, OFFSET, TRUE, WEIGHT, exact

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.gravity import centre_of_gravity
from skinfab.fingertip.force.gravity_fit import learn_hand, left_over
from skinfab.fingertip.force.gravity_model import HandModel, centre_with, load_hand, mass_with, save_hand
from skinfab.fingertip.force.gravity_simulator import PAPER_TRUTH, HandScene, hold
from skinfab.fingertip.force.poses import poses_of
from skinfab.fingertip.saved import save_model
from skinfab.rates import wilson

ELLIPSOID = 7.814727903251179
SCENE = HandScene(tip_kg=0.01, kinematics_mm=0.0)


def test_without_noise_the_hand_and_what_it_holds_come_out() -> None:
    model = learn_hand([exact(8), exact(6, seed=1)])
    np.testing.assert_allclose(model.offset, OFFSET, atol=1e-3)
    assert model.weight_n == pytest.approx(WEIGHT, abs=1e-4)
    np.testing.assert_allclose(model.moment_nmm, MOMENT, atol=2e-2)
    found = centre_with(model, exact(2, held_n=1.7, seed=2))
    np.testing.assert_allclose(found.point, TRUE, atol=0.05)
    assert mass_with(model, exact(2, held_n=1.7, seed=2)).kg == pytest.approx(1.7 / 9.80665, rel=1e-3)
    assert left_over([exact(8), exact(6, seed=1)])[1] == pytest.approx((0.0, 0.0), abs=0.02)


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


def test_what_tells_nothing() -> None:
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
