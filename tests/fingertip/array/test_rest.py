"""What is read at rest: it wanders, and some tactels are broken."""

import numpy as np
import pytest

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


def test_under_a_contact_what_is_far_from_it_is_followed() -> None:
    """Also where it wanders otherwise than before: here it stops."""
    rest, far = Rest(np.ones((4, 4))), np.arange(16).reshape(4, 4) >= 8
    for k in range(1, 600):
        volts = (1 + 1e-4 * min(k, 450)) * np.where(~far & (k > 300), 1.3, 1.0)
        rest.follow(k / 15, volts, idle=k <= 300, untouched=far)
    assert np.abs(rest.volts / 1.045 - 1).max() < 5e-4


def test_where_all_is_touched_it_goes_on_for_a_while() -> None:
    rest, volts = Rest(np.ones((4, 4))), []
    for k in range(1, 15 * 320):
        rest.follow(k / 15, np.full((4, 4), 1 + 2e-5 * k + 0.3 * (k > 300)), idle=k <= 300, untouched=np.arange(16).reshape(4, 4) == 8)
        volts.append(float(rest.volts[0, 0]))
    assert abs(volts[375] / (1 + 2e-5 * 376) - 1) < 2e-4  # five seconds on
    assert volts[-1] == pytest.approx(1 + 2e-5 * (300 + 15 * 20), abs=2e-4) and abs(volts[-1] - volts[-150]) < 1e-6  # and not for ever


def test_a_slow_press_is_not_taken_for_wandering() -> None:
    """One tactel that grows beside the others is followed up to a speed, all of them together at any."""
    rest, most = Rest(np.ones((4, 4))), 0.0
    for k in range(150):
        volts = np.ones((4, 4))
        volts[1, 1] += 2e-3 * k / 15  # as 0.05 N a second
        rest.follow(k / 15, volts, idle=True)
        most = max(most, volts[1, 1] - rest.volts[1, 1])
    assert most > 0.01


def test_all_off_alike_is_stepped_over() -> None:
    rest = Rest(np.ones((4, 4)))
    assert rest.step_back(np.full((4, 4), 0.97), least=4e-3) == pytest.approx(-0.03) and rest.volts[2, 2] == pytest.approx(0.97)
    pressed = np.full((4, 4), 0.97)
    pressed[1, 1] = 1.0
    assert rest.step_back(pressed, least=4e-3) == 0.0


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
