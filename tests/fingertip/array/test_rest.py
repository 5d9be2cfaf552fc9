"""What is read at rest: it wanders, and some tactels are broken."""

import numpy as np

from skinfab.fingertip.array.rest import Rest, stuck_at_rest


def test_what_is_idle_is_followed() -> None:
    """Up to 6 %: without lag once its speed is known, also of a tactel that reads nothing."""
    rest, off = Rest(np.ones((4, 4))), []
    for k in range(1, 600):
        volts = np.full((4, 4), 1 + 1e-4 * k)
        volts[0, 0] = np.nan
        rest.follow(k / 15, volts, idle=True)
        off.append(np.abs(rest.volts / (1 + 1e-4 * k) - 1).max())
    assert max(off) < 2e-3 and max(off[300:]) < 1e-4


def test_under_a_contact_it_goes_on_as_it_did() -> None:
    rest = Rest(np.ones((4, 4)))
    for k in range(1, 450):
        rest.follow(k / 15, np.full((4, 4), 1 + 1e-4 * k + 0.3 * (k > 300)), idle=k <= 300)
    assert np.abs(rest.volts / (1 + 1e-4 * 449) - 1).max() < 5e-4


def test_a_wire_that_breaks_is_noticed() -> None:
    rng, rest = np.random.default_rng(0), Rest(np.ones((4, 4)))
    for k in range(60):
        volts = 1 + 1e-4 * rng.standard_normal((4, 4))
        if 20 <= k < 50:
            volts[1, 2] = 1.3
        seen = rest.alive(k / 15, volts)
        assert np.isnan(seen[1, 2]) == (35 <= k < 50) and np.isnan(seen).sum() <= 1
    assert np.argwhere(rest.ever_stuck).tolist() == [[1, 2]]


def test_coarse_converters_are_not_broken() -> None:
    """Steps as large as the noise: many tactels read the same for long, and are fine."""
    rng = np.random.default_rng(1)
    volts = np.round(1 + 3e-4 * rng.standard_normal((200, 4, 4)), 3)
    assert not stuck_at_rest(volts[:15]).any() and not stuck_at_rest(np.ones((15, 4, 4))).any()
    rest = Rest(np.ones((4, 4)))
    assert all(np.isfinite(rest.alive(k / 15, each)).all() for k, each in enumerate(volts))
