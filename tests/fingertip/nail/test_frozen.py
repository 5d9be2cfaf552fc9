"""A channel that stands still is missing, in a window of a run and in a trial that is learned from."""

from dataclasses import replace

import numpy as np

from skinfab.fingertip.nail.frozen import without_frozen
from skinfab.fingertip.nail.improved import label_of, learn
from skinfab.fingertip.nail.labels import Trial
from skinfab.fingertip.nail.live import decide_log
from skinfab.fingertip.nail.protocol import Protocol, session
from skinfab.fingertip.nail.simulator import RATE_HZ, nail_stream
from skinfab.fingertip.nail.train import prepare
from skinfab.readout.frame import Recording


def test_only_what_stands_still_is_left_out() -> None:
    window = np.random.default_rng(0).standard_normal((33, 6))
    assert without_frozen(window) is window
    window[-1, 0] = window[0, 0]  # by chance
    assert without_frozen(window) is window
    window[:, 2], window[:, 4] = 0.0, 1.25
    window[[0, 5, 32], 4] = np.nan  # with gaps at both ends
    window[1:, 5] = np.nan
    found = without_frozen(window)
    assert np.isnan(found[:, [2, 4]]).all()
    np.testing.assert_array_equal(found[:, [0, 1, 3, 5]], window[:, [0, 1, 3, 5]])
    assert without_frozen(np.full((8, 6), np.nan)).shape == (8, 6)


def test_a_wire_that_is_off_is_left_out_of_a_run_and_of_what_is_learned() -> None:
    one = session("pins6", 1, protocol=Protocol(training=4, rounds=1, estimates=1, samples=256), seed=8)
    values = one.rounds.readings.reshape(-1, 6).copy()
    values[:, 5] = 0.0
    log = Recording.of_values(nail_stream(), values, device_time=np.arange(len(values)) / RATE_HZ)
    told, _ = decide_log(learn(one), log, samples=33, every=16)
    assert {each.decision.missing for each in told if each.decision} == {("Gz",)}
    trials = []
    for k, (touch, each) in enumerate(zip(one.training.touches, one.training.readings[:, 0], strict=True)):
        each[:, 5] = 0.0
        trials.append(Trial(replace(label_of(touch), trial=str(k)), each, np.zeros(each.shape, dtype=bool), RATE_HZ))
    made = prepare(trials)
    assert "channel Gz has too few readings in some trials, or stands still, and the model does without" in made.notes
    assert made.fit(np.arange(len(trials))).channels.tolist() == [True] * 5 + [False]
