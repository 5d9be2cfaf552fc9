"""Simulated grasps are in balance, hold by friction, and give their contacts back where nothing is wrong with the joints."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from skinfab.errors import InputError
from skinfab.fingertip.force.grasp import (
    CUBOID,
    CYLINDER,
    GRAVITY_M_S2,
    LEARNED,
    NEW,
    OVER,
    ROUND,
    HandScene,
    Solid,
    simulate_grasp,
    total_wrench,
    touches,
)

EXACT = HandScene(joint_mm=0, joint_deg=0)


@pytest.mark.parametrize("solid", [*NEW, LEARNED[0]], ids=lambda solid: solid.name)
@pytest.mark.parametrize("fingers", [ROUND, OVER], ids=["round", "over"])
def test_forces_balance_the_weight_in_each_pose_and_hold_by_friction(solid: Solid, fingers: tuple) -> None:
    for seed in range(5):
        grasp = simulate_grasp(solid, seed=seed, scene=EXACT, fingers=fingers, poses=4)
        force, moment = total_wrench(grasp)
        np.testing.assert_allclose(np.linalg.norm(force, axis=1), EXACT.mass_kg * GRAVITY_M_S2)
        np.testing.assert_allclose(moment, np.cross(grasp.centre, force), atol=1e-9)
        found = touches(grasp)
        assert found.fault == ""
        turn = Rotation.from_rotvec(grasp.turn)
        for each in grasp.force:
            on_hand = turn.apply(each)
            lean = np.einsum("ij,ij->i", on_hand, found.normal) / np.linalg.norm(on_hand, axis=1)
            assert lean.min() > np.cos(np.radians(EXACT.friction_deg))


def test_contacts_lie_on_the_solid() -> None:
    for seed in range(10):
        ball = simulate_grasp(NEW[0], seed=seed, scene=EXACT)
        found = touches(ball)
        np.testing.assert_allclose(found.point, ball.centre + 37 * found.normal, atol=1e-9)
        box = simulate_grasp(NEW[2], seed=seed, scene=EXACT)
        off = np.abs(np.einsum("ij,ij->i", touches(box).point - box.centre, touches(box).normal))
        assert np.all(np.min(np.abs(off[:, None] - np.array([55, 65, 90]) / 2), axis=1) < 1e-9)


def test_joints_that_are_off_move_the_contacts_by_so_much() -> None:
    apart = []
    for seed in range(30):
        grasp = simulate_grasp(NEW[0], seed=seed)
        found = touches(grasp)
        apart.append(np.linalg.norm(found.point - grasp.centre, axis=1) - 37)
    assert 0.7 < np.std(apart) < 3  # 1.5 mm of the joints along the normal, and what the turns add
    assert simulate_grasp(NEW[0], seed=1).simulated


def test_the_same_seed_gives_the_same_grasp() -> None:
    one, again = simulate_grasp(NEW[1], seed=3), simulate_grasp(NEW[1], seed=3)
    np.testing.assert_array_equal(one.force, again.force)


@pytest.mark.parametrize(("shape", "size"), [("cone", (1.0,)), (CUBOID, (1.0, 2.0)), (CYLINDER, (0.0, 1.0)), ("sphere", (np.nan,))])
def test_solids_that_are_none(shape: str, size: tuple) -> None:
    with pytest.raises(InputError):
        Solid(shape, size)
