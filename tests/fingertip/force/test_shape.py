"""Shapes of new objects, grasped at any turn: told by misfits, hardly by raw contacts; and models that come back as they were."""

from dataclasses import replace

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.force.grasp import LEARNED, NEW, SHAPES, STRANGE, Touches, simulate_grasp, touches
from skinfab.fingertip.force.shape import FEATURES, NONE, ShapeModel, decide, features_of, fit_shapes, is_strange, misfit_limits
from skinfab.fingertip.saved import save_model
from skinfab.rates import wilson


def grasped(solids, per: int, seed: int) -> tuple[list[Touches], np.ndarray]:
    rng = np.random.default_rng(seed)
    found = [(touches(simulate_grasp(solid, seed=rng)), SHAPES.index(solid.shape)) for solid in solids for _ in range(per)]
    return [each for each, _ in found], np.array([shape for _, shape in found])


@pytest.fixture(scope="module")
def learned() -> tuple[list[Touches], np.ndarray]:
    return grasped(LEARNED, 15, 0)


@pytest.fixture(scope="module")
def new() -> tuple[list[Touches], np.ndarray]:
    return grasped(NEW, 30, 1)


@pytest.fixture(scope="module")
def model(learned: tuple) -> ShapeModel:
    X = features_of(learned[0], "misfits")
    return ShapeModel("misfits", fit_shapes(X, learned[1], "misfits"), {"seed": 0, "misfit_limits": misfit_limits(X, learned[1]).tolist()})


def accuracy(features: str, learned: tuple, new: tuple) -> float:
    net = fit_shapes(features_of(learned[0], features), learned[1], features)
    return float((net.probability(features_of(new[0], features)).argmax(axis=1) == new[1]).mean())


def test_misfits_tell_new_objects_and_raw_contacts_do_not(learned: tuple, new: tuple) -> None:
    found = {features: accuracy(features, learned, new) for features in FEATURES}
    assert found["misfits"] > 0.8 and min(found["misfits"], found["pose-free"]) > found["published"] + 0.15


def test_what_is_sure_is_right_more_often(model: ShapeModel, new: tuple) -> None:
    out = model.probability(new[0])
    right, sure = out.argmax(axis=1) == new[1], out.max(axis=1) >= 0.9
    assert right[sure].mean() > right.mean() and sure.mean() > 0.5


def test_grasping_again_makes_it_surer(model: ShapeModel) -> None:
    rng = np.random.default_rng(5)
    asked = [(solid.shape, [simulate_grasp(solid, seed=rng) for _ in range(4)]) for solid in NEW for _ in range(10)]
    said = [(shape, decide(model, grasps[:1]), decide(model, grasps)) for shape, grasps in asked]
    once, often = (np.mean([shape == each[k].shape for shape, *each in said]) for k in (0, 1))
    assert often >= once and often > 0.92
    assert any(again.grasps > 1 for _, _, again in said) and all(again.grasps == 1 for _, first, again in said if first.sure)


def test_a_model_comes_back_as_it_was(model: ShapeModel, new: tuple, tmp_path) -> None:
    model.save(tmp_path / "model.npz")
    back = ShapeModel.load(tmp_path / "model.npz")
    np.testing.assert_array_equal(back.probability(new[0][:5]), model.probability(new[0][:5]))
    assert back.facts["seed"] == 0


def test_models_that_are_none(tmp_path) -> None:
    save_model(tmp_path / "a.npz", kind="force shape", facts={"features": "misfits", "shapes": list(SHAPES)}, arrays={})
    with pytest.raises(InputError, match="lacks a part"):
        ShapeModel.load(tmp_path / "a.npz")
    arrays = {"mean": np.zeros(1), "scale": np.ones(1), "hidden": np.zeros((2, 1)), "output": np.zeros((2, 3))}
    save_model(tmp_path / "b.npz", kind="force shape", facts={"features": "smell", "shapes": list(SHAPES)}, arrays=arrays)
    with pytest.raises(InputError, match="smell"):
        ShapeModel.load(tmp_path / "b.npz")
    for name, limits in (
        ("misfit_limits", [1.0, 2.0, 3.0]),
        ("misfit_limits", [1.0, 0.0, 1.0, 1.0]),
        ("misfit_limits", {}),
        ("misfit_limit", []),
    ):
        facts = {"features": "misfits", "shapes": list(SHAPES), name: limits}
        save_model(tmp_path / "c.npz", kind="force shape", facts=facts, arrays=arrays)
        with pytest.raises(InputError, match=r"limits of the misfit are|lacks a part"):
            ShapeModel.load(tmp_path / "c.npz")


def test_no_grasp_is_no_decision(model: ShapeModel) -> None:
    with pytest.raises(InputError, match="there is none"):
        decide(model, [])
    grasp = simulate_grasp(NEW[0], seed=1)
    grasp.force[0, 2] = 0.0
    with pytest.raises(InputError, match="finger 3: no contact"):
        decide(model, [grasp])


def test_what_is_none_of_the_three_is_said_to_be_none(model: ShapeModel) -> None:
    rng = np.random.default_rng(2)
    grasps = [simulate_grasp(NEW[k % 3], seed=rng) for k in range(30)]
    # Rotation vectors that are another's: points and normals that belong to no solid.
    mixed = [replace(each, turn=other.turn) for each, other in zip(grasps, grasps[::-1], strict=True)]
    naive = model.probability([touches(each) for each in mixed]).max(axis=1) >= 0.9
    said = [decide(model, [each]) for each in mixed]
    assert np.mean([each.shape == NONE for each in said]) > 0.7
    assert np.mean([each.sure for each in said]) < 0.3 * naive.mean() and all(not each.sure for each in said if each.shape == NONE)
    assert np.mean([decide(model, [each]).shape == NONE for each in grasps]) < 0.1


def test_solids_that_are_none_of_the_three_are_seldom_given_a_name(model: ShapeModel) -> None:
    rng = np.random.default_rng(4)
    grasps = [simulate_grasp(solid, seed=rng) for solid in STRANGE for _ in range(20)]
    naive = model.probability([touches(each) for each in grasps]).max(axis=1) >= 0.9
    assert np.mean([decide(model, [each]).sure for each in grasps]) < 0.15 < 0.25 < naive.mean()


def test_a_limit_is_passed_by_its_own_shape_no_oftener_than_stated() -> None:
    rng = np.random.default_rng(1)
    passed = []
    for _ in range(300):
        drawn = np.column_stack([rng.standard_normal(40), *rng.uniform(5, 6, (2, 40))])
        limits = misfit_limits(drawn[:39], np.zeros(39, dtype=int))
        passed.append(is_strange(drawn[39:], np.zeros(1, dtype=int), np.append(limits[:3], np.inf))[0])
    assert wilson(int(sum(passed)), 300).low < 0.05 < wilson(int(sum(passed)), 300).high


def test_a_model_of_the_first_version_is_read(model: ShapeModel) -> None:
    old = replace(model, facts={"misfit_limit": 2.0})
    assert old.limits.tolist() == [np.inf, np.inf, np.inf, 2.0]


def test_units_that_cannot_be_are_named(model: ShapeModel) -> None:
    grasp = simulate_grasp(NEW[0], seed=1)
    with pytest.raises(InputError, match="are their places in mm"):
        decide(model, [replace(grasp, position=grasp.position / 1000)])
    with pytest.raises(InputError, match="are rotation vectors in rad"):
        decide(model, [replace(grasp, turn=np.degrees(grasp.turn))])
