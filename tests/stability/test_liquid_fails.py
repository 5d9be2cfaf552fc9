"""Where a liquid is made up or missed: each test shows that the naive way fails, and what is done instead."""

from dataclasses import replace

import numpy as np
import pytest

from skinfab.errors import RefusedError
from skinfab.fingertip.force.liquid import stirred
from skinfab.fingertip.force.liquid_model import limit_of, stand_out, train_liquid
from skinfab.fingertip.force.liquid_simulator import CupScene, stir
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.simulator import MATERIALS, slide


def test_a_hand_that_trembles_is_water_for_who_knows_only_noise() -> None:
    scene = CupScene(tremble_mm_s2=200.0)
    still = [stir(water_kg=0.0, seconds=3, scene=scene, seed=[k, 1]) for k in range(20)]
    assert np.mean([stirred(log).liquid for log in still]) > 0.3  # 1 % is stated
    model = train_liquid([stir(water_kg=0.0, seconds=30, scene=scene, seed=[k, 2]) for k in range(3)], false_alarm=0.05, seconds=3.0).model
    assert sum(model.judge(log).liquid for log in still) <= 3
    assert model.judge(stir(water_kg=0.2, seconds=3, scene=scene, seed=3)).liquid


def test_a_slide_over_a_towel_wanders_as_water_does_and_is_none() -> None:
    towels = [slide(MATERIALS["towel"], seed=k, label="towel") for k in range(8)]
    pulled = [WrenchLog(log.name, log.time[250:], log.force[250:], log.moment[250:]) for log in towels]
    found = [stirred(log) for log in pulled]
    water = stirred(stir(water_kg=0.005, seed=1))
    assert np.median([each.wander_mm for each in found]) > water.wander_mm  # a limit on how far lines wander takes it for water
    assert sum(each.liquid for each in found) <= 2


def test_a_sensor_that_drifts_wanders_and_does_not_swing() -> None:
    scene = CupScene(drift_nmm_s=10.0)
    found = [stirred(stir(water_kg=0.0, scene=scene, seed=k)) for k in range(10)]
    still = [stirred(stir(water_kg=0.0, seed=k)) for k in range(10)]
    assert min(each.wander_mm for each in found) > 2 * max(each.wander_mm for each in still)
    assert sum(each.liquid for each in found) <= 1


def test_one_full_cup_among_the_empty_ones_would_blind_the_limit_and_is_refused_by_name() -> None:
    empty = [replace(stir(water_kg=0.0, seconds=3, seed=[k, 4]), name=f"e{k}.csv", label="") for k in range(20)]
    full = replace(stir(water_kg=0.1, seconds=3, seed=4), name="f.csv", label="full")
    chance = np.array([stirred(log).chance for log in [*empty, full]])
    asked = np.array([stirred(stir(water_kg=0.1, seconds=3, seed=[k, 5])).chance for k in range(10)])
    assert np.mean(asked < limit_of(chance, 0.05)) < 0.8 and np.mean(asked < limit_of(chance[:-1], 0.05)) == 1  # as it would be
    assert stand_out(chance).nonzero()[0].tolist() == [20]
    with pytest.raises(RefusedError, match=r"^f\.csv swings as the others cannot.*# label: empty"):
        train_liquid([*empty, full], false_alarm=0.05, seconds=3.0)
    said = train_liquid([*empty, replace(full, label="solid")], false_alarm=0.05, seconds=3.0)
    assert said.strange == ("f.csv",) and said.limit_log == "f.csv" and said.limit_mm > 5 * said.middle_mm
    assert not train_liquid(empty[:20], false_alarm=0.05, seconds=3.0).strange


def test_full_cups_alone_are_no_empty_ones() -> None:
    full = [replace(stir(water_kg=0.1, seed=[k, 6]), name=f"f{k}.csv", label="") for k in range(10)]
    with pytest.raises(RefusedError, match=r"f0\.csv, f1\.csv, f2\.csv and \d more swing as the others cannot"):
        train_liquid(full, false_alarm=0.1)


def test_a_swing_that_tells_no_pivot_has_none() -> None:
    # Its point runs off until the matrices are singular, which ended the command.
    log = stir(water_kg=0.0, scene=CupScene(tremble_mm_s2=48.88301277807142), seed=[353, 77])
    found = stirred(log)
    assert found.liquid and np.isnan(found.pivot).all()
    # Farther off still, what rounding leaves of a number of its own is below nothing; its root was a warning.
    found = stirred(stir(water_kg=0.0, scene=CupScene(tremble_mm_s2=100.0), seed=[133, 100, 7]))
    assert found.liquid and np.isnan(found.pivot).all()
