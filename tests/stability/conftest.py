"""What tests of the joint control share."""

from collections.abc import Callable

import numpy as np
import pytest

from calibration.control.controller import Input
from calibration.finger.logs import calibrated
from calibration.finger.simulated import HUMAN, ROBOT


@pytest.fixture(scope="module")
def branches() -> tuple[Input, Input]:
    return Input(calibrated(HUMAN, "branches")), Input(calibrated(ROBOT, "branches"))


@pytest.fixture
def credulous(monkeypatch: pytest.MonkeyPatch) -> Callable[[], None]:
    """From its call on every reading that is a number is believed, however it repeats and whatever the joint is told meanwhile."""

    def believe() -> None:
        monkeypatch.setattr("calibration.control.controller.FAR_SPANS", np.inf)
        monkeypatch.setattr("calibration.control.frozen.FROZEN_S", np.inf)
        monkeypatch.setattr("calibration.control.follows.FAR_PART", np.inf)

    return believe
