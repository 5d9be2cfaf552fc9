"""Solids come back exactly from exact contacts, both ways; from the simulated hand's, the fit is the better one for cuboids."""

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.force.grasp import OVER, ROUND, HandScene, Solid, simulate_grasp, total_wrench, touches
from skinfab.fingertip.force.gravity import centre_of_gravity, published_centre
from skinfab.fingertip.force.reconstruct import meeting_point, published, reconstruct

EXACT = HandScene(joint_mm=0, joint_deg=0)
PAPER = (Solid("sphere", (45.0,)), Solid("cylinder", (30.0, 120.0)), Solid("cuboid", (60.0, 80.0, 90.0)))


@pytest.mark.parametrize("solid", PAPER, ids=lambda solid: solid.name)
@pytest.mark.parametrize("way", [published, reconstruct])
def test_exact_contacts_give_the_exact_solid(solid: Solid, way) -> None:
    for seed in range(5):
        grasp = simulate_grasp(solid, seed=seed, scene=EXACT, fingers=OVER if solid.shape == "cuboid" else ROUND)
        found = way(touches(grasp), solid.shape, grasp.centre)
        wanted = sorted(solid.size) if solid.shape == "cuboid" else [solid.size[0]]
        np.testing.assert_allclose(sorted(found.size), wanted, atol=0.01)
        np.testing.assert_allclose(np.linalg.det(found.turn), 1)
        if solid.shape != "cylinder":
            np.testing.assert_allclose(found.centre, grasp.centre, atol=0.01)


def test_the_fit_has_less_error_of_a_cuboid_above_all_less_of_large_ones() -> None:
    errors: dict[str, list] = {"published": [], "here": []}
    for seed in range(25):
        grasp = simulate_grasp(PAPER[2], seed=seed, fingers=OVER, poses=10)
        wrench, found = total_wrench(grasp), touches(grasp)
        plain = published(found, "cuboid", published_centre(*wrench).point)
        here = reconstruct(found, "cuboid", centre_of_gravity(*wrench).point)
        for name, solved in (("published", plain), ("here", here)):
            errors[name].append(np.abs(np.sort(solved.size) - PAPER[2].size))
    assert np.nanmedian(errors["here"]) < np.nanmedian(errors["published"])
    assert np.nanpercentile(errors["here"], 90) < 0.85 * np.nanpercentile(errors["published"], 90)


def test_a_side_that_no_finger_touched_is_not_made_up() -> None:
    grasp = simulate_grasp(PAPER[2], seed=1, scene=EXACT, fingers=ROUND)
    assert sum(np.isnan(reconstruct(touches(grasp), "cuboid", grasp.centre).size)) == 1


def test_parallel_lines_meet_nowhere_far() -> None:
    point = np.array([[0, 0, 0], [2.0, 0, 0]])
    np.testing.assert_allclose(meeting_point(point, np.array([[0, 0, 1.0], [0, 0, -1.0]])), [1, 0, 0])


def test_what_cannot_be_reconstructed() -> None:
    found = touches(simulate_grasp(PAPER[2], seed=1))
    for way in (published, reconstruct):
        with pytest.raises(InputError, match="centre of gravity"):
            way(found, "cuboid")
        with pytest.raises(InputError, match="no shape"):
            way(found, "cone")
