"""Models: each meets what it is made for, looks only at the past, and is the same sample by sample and after a file."""

import json
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from calibration.strain.models import MODELS, Samples, model_of
from skinfab.errors import InputError


def rms(model: object, run: Samples) -> float:
    estimate, _ = model.estimate(run.time, run.signal)  # type: ignore[attr-defined]
    return float(np.sqrt(np.mean((estimate - run.angle)[run.fit] ** 2)))


@pytest.mark.parametrize("name", MODELS)
def test_without_hysteresis_all_are_exact(name: str, log: Callable[..., Samples]) -> None:
    run = log()
    assert rms(MODELS[name].fit([run], degree=2), run) < 0.3


def test_slack_is_met_by_branches_and_play(log: Callable[..., Samples]) -> None:
    run, unseen = log(width=6.0), log(width=6.0, cycles=5.5)
    error = {name: rms(kind.fit([run], degree=3), unseen) for name, kind in MODELS.items()}
    # Where the finger turns, the reading stands still while it crosses its slack: no model can know where it is there.
    assert error["poly"] > 5 and max(error["branches"], error["play"]) < error["poly"] / 2, error


def test_delay_is_met_by_lag(log: Callable[..., Samples]) -> None:
    def late(run: Samples) -> Samples:
        return replace(run, signal=np.interp(run.time - 0.1, run.time, run.signal))

    run, unseen = late(log(cycles=16)), late(log(cycles=13))
    error = {name: rms(kind.fit([run], degree=2), unseen) for name, kind in MODELS.items()}
    assert error["poly"] > 6 and error["lag"] < min(error["poly"] / 5, error["branches"], error["play"]), error


@pytest.mark.parametrize("name", MODELS)
def test_sample_by_sample_and_from_a_file_is_the_same(name: str, log: Callable[..., Samples]) -> None:
    run = log(width=4.0, noise=0.003)
    model = model_of(name, json.loads(json.dumps(MODELS[name].fit([run], degree=3).numbers())))
    tracker = model.tracker()
    steps = [tracker.step(t, u) for t, u in zip(run.time.tolist(), run.signal.tolist(), strict=True)]
    angles, outside = model.estimate(run.time, run.signal)
    np.testing.assert_allclose([angle for angle, _ in steps], angles, atol=1e-9)
    assert [out for _, out in steps] == outside.tolist() and outside.any()


@pytest.mark.parametrize("name", MODELS)
def test_the_past_does_not_change(name: str, log: Callable[..., Samples]) -> None:
    run = log(width=4.0)
    model = MODELS[name].fit([run], degree=3)
    whole, _ = model.estimate(run.time, run.signal)
    part, _ = model.estimate(run.time[:500], run.signal[:500])
    np.testing.assert_allclose(part, whole[:500], atol=1e-9)


@pytest.mark.parametrize("name", MODELS)
def test_uneven_times(name: str, log: Callable[..., Samples]) -> None:
    run = log(width=4.0)
    keep = np.sort(np.random.default_rng(3).choice(len(run.time), len(run.time) // 2, replace=False))
    model = MODELS[name].fit([run], degree=3)
    tracker = model.tracker()
    steps = [tracker.step(t, u)[0] for t, u in zip(run.time[keep].tolist(), run.signal[keep].tolist(), strict=True)]
    np.testing.assert_allclose(steps, model.estimate(run.time[keep], run.signal[keep])[0], atol=1e-9)


def test_one_way_only_has_no_branches(log: Callable[..., Samples]) -> None:
    run = log(cycles=0.5)
    with pytest.raises(InputError, match="hardly ever fall: curves for both branches need"):
        MODELS["branches"].fit([run], degree=2)


def test_branches_do_not_jump_where_the_finger_turns(log: Callable[..., Samples]) -> None:
    run = log(width=6.0)
    angles, _ = MODELS["branches"].fit([run], degree=3).estimate(run.time, run.signal)
    # The finger does at most 31 degrees a second, 0.31 a sample; its 12 degrees of slack are crossed in no single step.
    assert np.abs(np.diff(angles)).max() < 3
