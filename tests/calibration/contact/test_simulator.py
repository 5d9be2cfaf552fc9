"""The simulated hand: what the paper says of its sensors, the same trial for a seed, and no term that changes no figure."""

from dataclasses import replace

import numpy as np
import pytest

from calibration.contact.objects import OBJECTS, pads
from calibration.contact.simulator import ABLATIONS, Scene, simulate, without
from calibration.contact.study import figures, judge
from skinfab.errors import InputError

#: Nothing but touches of the mean size.
PLAIN = Scene(noise=1e-6, drift_per_minute=0, creep=0, scatter=0, second=0, drop_outs_per_minute=0)


@pytest.mark.parametrize("name", OBJECTS)
def test_touched_it_reads_what_the_paper_says(name: str) -> None:
    trial = simulate(name, scene=PLAIN)
    log = trial.recording
    for j, pad in enumerate(pads(name)):
        first = next(each for each in trial.truth if each.channel == f"S{j + 1}")
        middle = np.searchsorted(log.device_time, (first.start + first.end) / 2)
        assert log.values[middle, j] == pytest.approx(pad.touched, rel=1e-3)
        assert np.median(log.values[:300, j]) == pytest.approx(pad.r0, rel=1e-3)
        assert first.sign == (1 if pad.touched > pad.r0 else -1)  # type: ignore[operator]


def test_sensors_and_their_counts() -> None:
    assert {name: len(pads) for name, pads in OBJECTS.items()} == {"cube": 6, "cylinder": 4, "dodecahedron": 8, "grip": 4, "cup": 4}
    # The paper's own extremes: +108.5 % on the cup, -15.9 % on the cube.
    changes = [pad.touched / pad.r0 - 1 for rows in OBJECTS.values() for pad in rows if pad.touched]
    assert max(changes) == pytest.approx(1.085, abs=5e-4) and min(changes) == pytest.approx(-0.159, abs=5e-4)
    with pytest.raises(InputError, match="no object 'ball'; there are cube"):
        simulate("ball")


def test_the_same_seed_the_same_trial_and_it_says_simulated() -> None:
    one, same, other = simulate("grip", seed=4), simulate("grip", seed=4), simulate("grip", seed=5)
    np.testing.assert_array_equal(one.recording.values, same.recording.values)
    assert one.truth == same.truth != other.truth and one.recording.stream.simulated


@pytest.mark.parametrize("term", ["noise", "drift", "creep", "drop-outs"])
def test_leaving_a_term_out_changes_nothing_else(term: str) -> None:
    assert simulate("cube", seed=2, scene=without(term)).truth == simulate("cube", seed=2).truth


def test_overlaps_and_a_grip_that_lasts() -> None:
    trial = simulate("dodecahedron", seed=1)
    at_once = [sum(a.start < t < a.end for a in trial.truth) for t in np.arange(0, 80, 0.1)]
    assert max(at_once) >= 3 and max(each.end - each.start for each in trial.truth) > 19


def test_drop_outs_are_silent_or_open() -> None:
    log = simulate("cube", seed=1, scene=replace(PLAIN, drop_outs_per_minute=5)).recording
    assert (~log.valid).any() and log.saturated.any() and not (log.saturated & ~log.valid).any()


@pytest.mark.parametrize("term", ABLATIONS)
def test_every_term_changes_a_figure(term: str) -> None:
    """To three digits, as they are reported: a term whose removal changes none would be one too many."""

    def reported(scene: Scene) -> list[float]:
        scores = judge([simulate(name, seed=seed, scene=scene) for name in OBJECTS for seed in range(3)])
        each = [figures(of) for of in scores.values()]
        return [round(x, 3) for f in each for x in (f.precision.value, f.recall.value, f.start_s, f.end_s)]

    assert reported(without(term)) != reported(Scene())
