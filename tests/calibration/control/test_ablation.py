"""Every term of the simulated finger earns its place: without it a reported figure is another one."""

from dataclasses import astuple

import numpy as np
import pytest

from calibration.control.ablation import FULL_GAIN, TERMS, Figures, figures_without
from calibration.control.controller import Input
from calibration.control.margin import judged
from calibration.finger.logs import calibrated
from calibration.finger.simulated import ROBOT
from skinfab.errors import InputError

#: By more than a figure changes from seed to seed: sums of squares and R2 as parts, degrees.
MATTERS = Figures(0.1, 0.005, 0.1, 0.005, 0.3, 0.8, 0.3, 0.5)


@pytest.fixture(scope="module")
def whole() -> np.ndarray:
    return np.array(astuple(figures_without("nothing", seeds=(0,))))


@pytest.mark.parametrize("term", TERMS[1:])
def test_a_figure_changes_without_it(term: str, whole: np.ndarray) -> None:
    change = np.abs(np.array(astuple(figures_without(term, seeds=(0,)))) - whole)
    change[[0, 2]] /= whole[[0, 2]]
    assert (change > astuple(MATTERS)).any(), change


def test_the_gain_is_the_default_one() -> None:
    robot = Input(calibrated(ROBOT, "branches"))
    assert judged(robot, "full", None, lag_s=0.1, delay_s=0.05, period_s=0.01).gain == pytest.approx(FULL_GAIN, abs=0.005)


def test_a_term_that_there_is_not() -> None:
    with pytest.raises(InputError, match="no term 'friction'; it has nothing, lag"):
        figures_without("friction")
