"""Detectors judged on simulated trials, side by side; and which figure each term of the simulator changes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from calibration.contact.detector import FALSE_ALARMS, Contact, detect
from calibration.contact.peers import fixed_threshold, high_pass
from calibration.contact.score import Score, poisson, score
from calibration.contact.simulator import ABLATIONS, Scene, Trial, simulate, without
from skinfab.rates import Rate, by_trial
from skinfab.readout.frame import Recording

#: Ours first.
DETECTORS = ("cusum", "fixed threshold", "high-pass")


@dataclass(frozen=True)
class Figures:
    """A detector on some trials.

    Parameters
    ----------
    precision, recall : Rate
        Intervals by drawing whole trials, no narrower than Wilson's.
    false_alarms : Rate
        A minute, all channels together, where nothing was touched.
    sign : float
        Part of the contacts that are right whose sign is right too.
    start_s, end_s : float
        Median error.
    end_p95_s : float
        95 % of ends are off by less.
    true, trials : int
        How many contacts there were, in how many trials.
    """

    precision: Rate
    recall: Rate
    false_alarms: Rate
    sign: float
    start_s: float
    end_s: float
    end_p95_s: float
    true: int
    trials: int


def judge(trials: Sequence[Trial], *, false_alarms: float = FALSE_ALARMS) -> dict[str, list[Score]]:
    """Every detector on the same trials."""
    found: dict[str, Callable[[Recording], Sequence[Contact]]] = {
        "cusum": lambda log: detect(log, false_alarms=false_alarms).contacts,
        "fixed threshold": fixed_threshold,
        "high-pass": high_pass,
    }
    return {
        name: [score(find(each.recording), each.truth, end=float(each.recording.device_time[-1])) for each in trials]
        for name, find in found.items()
    }


def figures(scores: Sequence[Score]) -> Figures:
    """Sum up trials.

    Examples
    --------
    >>> found = figures([score([Contact("S1", 1.1, 2.9, 1, 0.4)], [Contact("S1", 1.0, 3.0, 1, 0.4)], end=60.0)])
    >>> found.recall.value, round(found.start_s, 2), found.sign
    (1.0, 0.1, 1.0)
    """
    right = [each.right for each in scores]
    starts = np.array([error for each in scores for error in each.start_errors])
    ends = np.array([error for each in scores for error in each.end_errors])
    any_right = len(starts) > 0
    return Figures(
        by_trial(right, [each.found for each in scores]),
        by_trial(right, [each.true for each in scores]),
        poisson(sum(each.false_alarms for each in scores), sum(each.minutes for each in scores)),
        sum(each.right_sign for each in scores) / sum(right) if any_right else float("nan"),
        float(np.median(starts)) if any_right else float("nan"),
        float(np.median(ends)) if any_right else float("nan"),
        float(np.quantile(np.abs(ends), 0.95)) if any_right else float("nan"),
        sum(each.true for each in scores),
        len(scores),
    )


def ablation(names: Sequence[str], seeds: Sequence[int]) -> dict[str, dict[str, Figures]]:
    """By term left out (``nothing`` first) and detector: what is reported then."""
    scenes = {"nothing": Scene()} | {term: without(term) for term in ABLATIONS}
    out = {}
    for term, scene in scenes.items():
        scores = judge([simulate(name, seed=seed, scene=scene) for name in names for seed in seeds])
        out[term] = {name: figures(each) for name, each in scores.items()}
    return out
