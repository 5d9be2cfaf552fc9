"""A port that was sent to before it was opened: what its frames seem to lag, and what the readings do."""

import numpy as np

from skinfab.cli.lag import Lag


def read(arrived: np.ndarray, step_s: float) -> tuple[Lag, np.ndarray]:
    """Frames read one after the other as they come, each in so long, from 0.5 s on; and what each lags, ms."""
    lag, now, naive = Lag(), 0.5, []
    for one in arrived.tolist():
        asked, now = now, max(now, one) + step_s
        lag.add(asked, one, now)
        naive.append(1000 * (now - one))
    return lag, np.array(naive)


def test_a_burst_at_opening_is_no_lag() -> None:
    """90 frames had waited, and 80 come 15 a second: the median of all is that of the burst."""
    lag, naive = read(np.concatenate([np.full(90, 0.4), 0.5 + np.arange(80) / 15]), 0.01)
    assert np.median(naive) > 200
    assert lag.live and 9.9 < lag.times_ms()["median"] <= lag.times_ms()["worst"] < 11


def test_a_computer_that_is_too_busy_still_lags() -> None:
    """Each frame takes longer than the next to come: none is ever waited for after the burst."""
    lag, naive = read(np.concatenate([np.full(90, 0.4), 0.5 + np.arange(80) / 15]), 0.08)
    assert lag.live and lag.times_ms()["median"] > 1000 and lag.times_ms()["worst"] == naive.max()


def test_where_all_came_at_once_nothing_is_said_of_lag() -> None:
    lag, naive = read(np.full(90, 0.4), 0.01)
    assert not lag.live and lag.times_ms()["worst"] == naive.max()
