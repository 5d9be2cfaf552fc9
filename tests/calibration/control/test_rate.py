"""How often a board sends is measured, whatever it says; too few frames are refused."""

from collections.abc import Iterator

import numpy as np
import pytest

from calibration.control.rate import LEAST_HZ, measured_rate
from skinfab.errors import InputError, RefusedError
from skinfab.readout.frame import Channel, Frame, Stream
from skinfab.readout.paced import PacedFrames


def board(rate_hz: float, frames: int = 1000) -> PacedFrames:
    def made() -> Iterator[Frame]:
        for k in range(frames):
            yield Frame(k / rate_hz, k / rate_hz, k, np.array([1.0]), np.array([True]), np.array([False]))

    return PacedFrames(Stream("b", (Channel("U"),), rate_hz), made)


@pytest.mark.parametrize("rate", [50.0, 130.0])
def test_frames_are_counted(rate: float) -> None:
    with board(rate) as source:
        assert measured_rate(source) == pytest.approx(rate, rel=0.03)


def test_too_few_frames_for_a_joint() -> None:
    with board(0.7 * LEAST_HZ) as source, pytest.raises(RefusedError, match=r"the board sends 1[34].* that takes 20 at least"):
        measured_rate(source)


def test_hardly_any_frame() -> None:
    with board(100.0, frames=1) as source, pytest.raises(InputError, match="hardly any frame came"):
        measured_rate(source, seconds=0.2)
