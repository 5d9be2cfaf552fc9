"""Low-pass filters against what a Butterworth filter must do."""

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.readout.filters import Lowpass

TIME = np.arange(4000) / 200


def gain(values: np.ndarray) -> float:
    middle = values[1000:3000]
    return float(np.sqrt(2 * np.mean(middle**2)))


@pytest.mark.parametrize("hz", [1.0, 5.0, 10.0, 20.0])
def test_gain_of_the_square_and_no_delay(hz: float) -> None:
    wave = np.sin(2 * np.pi * hz * TIME)
    out = Lowpass(5.0, 200.0).zero_phase(wave)
    # To and fro squares 1 / sqrt(1 + (tan w / tan c)^8), the bilinear filter's own gain.
    ratio = np.tan(np.pi * hz / 200) / np.tan(np.pi * 5 / 200)
    assert gain(out) == pytest.approx(1 / (1 + ratio**8), rel=1e-3, abs=1e-6)
    if hz <= 5:
        assert np.corrcoef(out[1000:3000], wave[1000:3000])[0, 1] == pytest.approx(1, abs=1e-6)


def test_the_causal_one_is_late_by_what_it_says() -> None:
    low = Lowpass(5.0, 200.0)
    running = low.causal()
    wave = np.column_stack([np.sin(2 * np.pi * 0.5 * TIME), TIME])
    out = np.array([running.step(row) for row in wave])
    ramp = (TIME - out[:, 1])[2000:]
    np.testing.assert_allclose(ramp, low.delay_s, rtol=1e-3)
    late = np.interp(TIME - low.delay_s, TIME, wave[:, 0])
    np.testing.assert_allclose(out[1000:, 0], late[1000:], atol=2e-3)


def test_it_starts_at_rest() -> None:
    running = Lowpass(5.0, 200.0).causal()
    assert running.step(np.array([7.0, -1.0])).tolist() == pytest.approx([7.0, -1.0])


@pytest.mark.parametrize("cutoff", [0.0, 100.0, 120.0])
def test_a_cut_off_that_cannot_be(cutoff: float) -> None:
    with pytest.raises(InputError, match="sample faster or lower the cut-off"):
        Lowpass(cutoff, 200.0)


def test_too_few_samples() -> None:
    low = Lowpass(5.0, 200.0)
    assert low.zero_phase(np.ones(low.shortest)).tolist() == pytest.approx([1.0] * low.shortest)
    with pytest.raises(InputError, match="are too few"):
        low.zero_phase(np.ones(low.shortest - 1))


def test_milliseconds_that_were_taken_as_seconds() -> None:
    with pytest.raises(InputError, match="times were taken as seconds: if they are milliseconds, call their column time_ms"):
        Lowpass(5.0, 0.1)
    with pytest.raises(InputError, match=r"lower the cut-off$"):
        Lowpass(5.0, 0.001)
