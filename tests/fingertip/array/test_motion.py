"""Slips and rolls of one contact: told by their speed, as long as they are, at any rate of frames."""

from collections.abc import Callable

import numpy as np
import pytest

from skinfab.fingertip.array.motion import SLIP_MM, SLIP_MM_S, At, Motion, Moved

RATES = (6.0, 15.0, 30.0, 100.0)


def moved(path: Callable[[float], float], *, rate: float, seconds: float, noise: float = 0.0) -> list[Moved]:
    rng = np.random.default_rng(0)
    at = [At(k / rate, 10.0, path(k / rate) + noise * rng.standard_normal()) for k in range(round(seconds * rate))]
    motion = Motion(at[0])
    return [each for one in at[1:] for each in motion.step(one)] + motion.end()


def ramp(speed: float, distance: float) -> Callable[[float], float]:
    """Stands for a second, goes so far, and stands."""
    return lambda t: min(max(t - 1, 0) * speed, distance)


@pytest.mark.parametrize("rate", [3.0, *RATES])
@pytest.mark.parametrize(("speed", "distance"), [(4.0, 4.0), (2.5, 20.0), (1.5, 5.0), (6.0, 6.0), (12.0, 10.0)])
def test_a_roll_is_one_and_as_long_as_it_was(speed: float, distance: float, rate: float) -> None:
    for noise in (0.0, 0.05):
        (roll,) = moved(ramp(speed, distance), rate=rate, seconds=3 + distance / speed, noise=noise)
        assert roll.kind == "roll" and roll.around_mm == pytest.approx(distance, abs=0.3) and abs(roll.along_mm) < 0.1
        assert roll.start == pytest.approx(1.0, abs=0.35 / speed + 1.5 / rate + 0.1)
        assert roll.end == pytest.approx(1 + distance / speed, abs=0.5 / speed + 1.5 / rate + 0.1)


@pytest.mark.parametrize("rate", RATES)
def test_back_and_forth_are_two(rate: float) -> None:
    out, back = moved(lambda t: min(max(6 * (t - 1), 0), 6) - min(max(6 * (t - 2), 0), 6), rate=rate, seconds=5)
    assert (out.around_mm, back.around_mm) == pytest.approx((6.0, -6.0), abs=0.2) and out.end == pytest.approx(2.0, abs=0.1) == back.start


@pytest.mark.parametrize("rate", [15.0, 30.0, 100.0])
@pytest.mark.parametrize("jump", [1.5, 2.5, 3.9, 4.1, 7.0])
def test_a_jump_is_a_slip_of_its_size(jump: float, rate: float) -> None:
    (slip,) = moved(lambda t: jump * (t > 1), rate=rate, seconds=3, noise=0.03)
    assert slip.kind == "slip" and slip.around_mm == pytest.approx(jump, abs=0.2) and slip.end - slip.start == pytest.approx(1 / rate)


def test_speed_is_what_tells_them() -> None:
    """At 30 frames a second 15 mm/s roll and 30 slip; between two frames at 3 a second even 6 mm may have rolled."""
    kinds = {speed: [each.kind for each in moved(ramp(speed, 9.0), rate=30, seconds=4)] for speed in (15.0, 30.0)}
    assert kinds == {15.0: ["roll"], 30.0: ["slip"]}
    slow = {jump: [each.kind for each in moved(lambda t, j=jump: j * (t > 1), rate=3, seconds=5)] for jump in (6.0, 7.0)}  # type: ignore[misc]
    assert slow == {6.0: ["roll"], 7.0: ["slip"]} and 6.0 < SLIP_MM_S / 3 < 7.0


def test_what_stands_does_not_move() -> None:
    for rate in RATES:
        assert moved(lambda t: 0.0, rate=rate, seconds=20, noise=0.1) == []
        assert moved(lambda t: 0.5 * t, rate=rate, seconds=10) == []  # it creeps
        assert moved(lambda t: 0.8 * SLIP_MM * (t > 1), rate=rate, seconds=4, noise=0.02) == []


def test_a_slip_between_two_rolls() -> None:
    def path(t: float) -> float:
        return min(max(t - 1, 0), 1) * 5 + 6 * (t > 2) + min(max(t - 3, 0), 1) * 4

    found = moved(path, rate=15, seconds=6)
    assert [each.kind for each in found] == ["roll", "slip", "roll"]
    assert [each.around_mm for each in found] == pytest.approx([5.0, 6.0, 4.0], abs=0.4)
