"""Each shape is fitted exactly where its contacts are exact, wherever it lies, and worse than the right one where it is wrong."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from skinfab.fingertip.force.fits import FITS, fit_cuboid, fit_cylinder, fit_sphere
from skinfab.fingertip.force.grasp import LEARNED, NEW, SHAPES, HandScene, simulate_grasp, touches

EXACT = HandScene(joint_mm=0, joint_deg=0)


@pytest.mark.parametrize("solid", [*LEARNED, *NEW], ids=lambda solid: solid.name)
def test_exact_contacts_give_the_exact_shape(solid) -> None:
    for seed in range(5):
        found = touches(simulate_grasp(solid, seed=seed, scene=EXACT))
        fit = FITS[solid.shape](found.point, found.normal)
        assert fit.misfit < 1e-3
        if solid.shape != "cuboid":
            assert fit.radius == pytest.approx(solid.size[0], abs=1e-3)


def test_no_turn_or_shift_of_the_object_changes_a_misfit() -> None:
    rng = np.random.default_rng(0)
    for solid in NEW:
        found = touches(simulate_grasp(solid, seed=4))
        turn, shift = Rotation.random(random_state=1), rng.standard_normal(3) * 100
        for fit in (fit_sphere, fit_cylinder, fit_cuboid):
            here = fit(found.point, found.normal).misfit
            there = fit(turn.apply(found.point) + shift, turn.apply(found.normal)).misfit
            assert there == pytest.approx(here, rel=1e-3)


def test_the_right_shape_misses_by_as_much_as_was_reckoned() -> None:
    for k, solid in enumerate(NEW):
        misfits = []
        for seed in range(40):
            found = touches(simulate_grasp(solid, seed=seed))
            misfits.append([FITS[shape](found.point, found.normal).misfit for shape in SHAPES])
        middle = np.median(misfits, axis=0)
        assert np.argmin(middle) == k
        assert 0.5 < middle[k] < 1.8
