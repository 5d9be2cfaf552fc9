"""Liquids: false alarms at the stated rate, water found, and how it swings told."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, lfilter

from skinfab.errors import InputError
from skinfab.fingertip.force.liquid import FALSE_ALARM, stirred
from skinfab.fingertip.force.liquid_simulator import WAYS, CupScene, stir
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.motion_simulator import grasp_log
from skinfab.rates import wilson


def test_an_empty_cup_is_taken_for_a_full_one_as_often_as_stated() -> None:
    chances = np.array([stirred(stir(water_kg=0.0, seconds=3, seed=k)).chance for k in range(500)])
    for level in (FALSE_ALARM, 0.1, 0.5):
        rate = wilson(int((chances < level).sum()), len(chances))
        assert rate.low < level < rate.high


@pytest.mark.parametrize("way", WAYS)
def test_water_is_found_with_its_period(way: str) -> None:
    for grams in (20, 50, 100):
        for seed in range(3):
            found = stirred(stir(water_kg=grams / 1000, way=way, seed=seed))
            assert found.liquid and found.period_s == pytest.approx(2 * np.pi * np.sqrt(0.022 / 9.80665), rel=0.05)


def test_more_water_wanders_farther() -> None:
    wander = [stirred(stir(water_kg=kg, seed=1)).wander_mm for kg in (0.0, 0.02, 0.1)]
    assert wander[0] < 0.3 < wander[1] < wander[2]


def test_lateral_stirring_moves_along_a_line_and_circumferential_about_a_point() -> None:
    def flat(way: str) -> float:
        apart = (path := stirred(stir(water_kg=0.1, way=way, seed=2)).path) - path.mean(axis=0)
        sizes = np.linalg.svd(apart, compute_uv=False)
        return float(sizes[1] / sizes[0])

    assert flat("lateral") < 0.15 < 0.8 < flat("circumferential")


def test_the_lines_of_swinging_water_meet_about_its_pivot() -> None:
    found = [stirred(stir(water_kg=0.1, way="circumferential", seed=k)).pivot for k in range(5)]
    assert np.median(found, axis=0) == pytest.approx([2, -1, 165], abs=2.5)
    assert np.isnan(stirred(stir(water_kg=0.0, seed=1)).pivot).all()


def test_a_drifting_sensor_holds_no_liquid() -> None:
    drifting = [stir(water_kg=0.0, scene=CupScene(drift_nmm_s=5.0), seed=k) for k in range(10)]
    # Left in, the drift alone would be many times the noise of a block's mean.
    means = drifting[0].moment[:1200].reshape(-1, 10, 3).mean(axis=1)
    assert means.std() > 5 * 1.7 / np.sqrt(10)
    assert sum(stirred(log).liquid for log in drifting) <= 1


def filtered(log: WrenchLog, how: str) -> WrenchLog:
    """As a sensor's electronics may give it."""
    wrench = np.column_stack([log.force, log.moment])
    mean = wrench.mean(axis=0)
    if how == "held":
        wrench = wrench[np.arange(len(wrench)) // 2 * 2]
    elif how == "mean of 5":
        wrench = lfilter(np.full(5, 0.2), 1, wrench - mean, axis=0) + mean
    else:
        b, a = ([0.3], [1, -0.7]) if how == "exponential" else butter(2, 73 / 100)
        wrench = lfilter(b, a, wrench - mean, axis=0) + mean
    return replace(log, time=log.time[50:], force=wrench[50:, :3], moment=wrench[50:, 3:])


@pytest.mark.parametrize("how", ["mean of 5", "exponential", "held", "Butterworth 73 Hz"])
def test_an_empty_cup_stays_empty_behind_a_filter(how: str) -> None:
    found = [stirred(filtered(stir(water_kg=0.0, seconds=4, seed=k), how)) for k in range(40)]
    # 1 % each: five of 40 would be a chance of 5 in 100 000.
    assert sum(each.liquid for each in found) < 5 and not any(each.moves for each in found)
    assert stirred(filtered(stir(water_kg=0.02, seed=3), how)).liquid


def test_what_moves_but_does_not_swing_is_no_liquid() -> None:
    grasp, _ = grasp_log(seed=0)
    assert stirred(grasp).answer == "moves, but does not swing" and np.isnan(stirred(grasp).period_s)
    warm = [stir(water_kg=0.0, seed=k) for k in range(10)]
    warming = [replace(log, force=log.force + 0.3 * np.exp(-log.time)[:, None] * [0, 0, 1]) for log in warm]
    assert sum(stirred(log).liquid for log in warming) <= 1 and all(stirred(log).moves for log in warming if not stirred(log).liquid)
    assert not any(stirred(log).moves for log in warm)


def test_a_swing_is_found_wherever_in_a_long_log_it_is() -> None:
    still, swings = stir(water_kg=0.0, seconds=12, seed=1), stir(water_kg=0.05, seed=2)
    late = np.arange(len(swings)) / swings.rate_hz + 12
    force = np.concatenate([still.force + (swings.force - still.force[:1200]).mean(axis=0), swings.force])
    moment = np.concatenate([still.moment + (swings.moment - still.moment[:1200]).mean(axis=0), swings.moment])
    found = stirred(WrenchLog("a", np.concatenate([still.time, late]), force, moment))
    assert found.liquid and found.period_s == pytest.approx(0.2975, rel=0.05)


def test_what_cannot_be_judged() -> None:
    log = stir(water_kg=0.0)
    with pytest.raises(InputError, match="hold still for 3 s"):
        stirred(WrenchLog("a", log.time[:100], log.force[:100], log.moment[:100]))
    with pytest.raises(InputError, match="record 20 or more"):
        stirred(WrenchLog("a", log.time[::20], log.force[::20], log.moment[::20]))
    with pytest.raises(InputError, match="nothing is held"):
        stirred(WrenchLog("a", log.time, log.force - log.force.mean(axis=0), log.moment))
    with pytest.raises(InputError, match="never changes"):
        stirred(WrenchLog("a", log.time, np.ones_like(log.force), log.moment))
    with pytest.raises(InputError, match="there are lateral"):
        stir(water_kg=0.1, way="upwards")
