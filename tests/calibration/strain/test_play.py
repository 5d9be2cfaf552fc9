"""The play operator against its definition, in batch and sample by sample."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from calibration.strain.play import Play, play

signals = st.lists(st.floats(-5, 5), min_size=1, max_size=60)


@given(signals, st.floats(0, 4))
def test_it_lies_within_the_band_and_moves_only_at_its_edge(signal: list[float], radius: float) -> None:
    z = play(signal, radius)
    assert z[0] == signal[0] and np.all(np.abs(z - signal) <= radius + 1e-12)
    moved = np.flatnonzero(np.diff(z)) + 1
    np.testing.assert_allclose(np.abs(z - signal)[moved], radius, atol=1e-12)


@given(signals, st.floats(0, 4))
def test_one_at_a_time_is_the_same(signal: list[float], radius: float) -> None:
    follow = Play(radius)
    assert [follow.step(u) for u in signal] == play(signal, radius).tolist()


@given(signals, st.floats(0, 4))
def test_it_does_not_matter_how_fast(signal: list[float], radius: float) -> None:
    slow = np.repeat(signal, 3)
    np.testing.assert_array_equal(play(slow, radius)[::3], play(signal, radius))


def test_many_radii_stand_side_by_side() -> None:
    signal = np.sin(np.linspace(0, 9, 200))
    both = play(signal, [0.1, 0.4])
    np.testing.assert_array_equal(both, np.column_stack([play(signal, 0.1), play(signal, 0.4)]))
