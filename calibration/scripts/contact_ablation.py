"""Tables of docs/contact.md: ``python calibration/scripts/contact_ablation.py``, a few minutes.

What each term of the simulated hand changes, how the detector answers larger disturbances than it was made for, and the rate of
false alarms that was stated against the one that was counted.
"""

import sys
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from calibration.contact.detector import detect
from calibration.contact.objects import OBJECTS
from calibration.contact.score import poisson
from calibration.contact.simulator import Scene, simulate
from calibration.contact.study import ablation, figures, judge
from skinfab.rates import Rate
from skinfab.readout.frame import Channel, Recording, Stream

#: Others than those that the detector was made with.
SEEDS = range(200, 205)
HARDER = {
    "creep": (0.2, 0.3),
    "creep_s": (0.7, 5.0),
    "drift_per_minute": (0.05, 0.1),
    "noise": (0.01, 0.02),
    "ramp_s": (0.5, 1.0),
}
#: Stated rates, a minute, and in how many recordings of two minutes they are counted.
STATED = ((6.0, 100), (1.0, 300), (0.1, 3000))


def ablations() -> Iterator[str]:
    """A row a term: precision and recall of each detector, and how late starts are seen."""
    yield "| left out | CUSUM precision | recall | start late, s | end late, s | fixed threshold | | high-pass | |"
    yield "|---|---|---|---|---|---|---|---|---|"
    for term, by_detector in ablation(list(OBJECTS), SEEDS).items():
        ours, *others = by_detector.values()
        cells = [f"{ours.precision.value:.3f}", f"{ours.recall.value:.3f}", f"{ours.start_s:.3f}", f"{ours.end_s:.3f}"]
        cells += [f"{rate.value:.3f}" for each in others for rate in (each.precision, each.recall)]
        yield f"| {term} | {' | '.join(cells)} |"


def harder() -> Iterator[str]:
    """A row a disturbance: precision, recall and false alarms of ours."""
    yield "| disturbance | precision | recall | false alarms a minute |"
    yield "|---|---|---|---|"
    for name, sizes in HARDER.items():
        for size in sizes:
            scene = replace(Scene(), **{name: size})  # type: ignore[arg-type]
            trials = [simulate(each, seed=seed, scene=scene) for each in OBJECTS for seed in SEEDS]
            found = figures(judge(trials)["cusum"])
            yield f"| {name} {size:g} (made for {getattr(Scene(), name):g}) | {found.precision} | {found.recall} | {found.false_alarms} |"


def counted(per_minute: float, recordings: int, *, channels: int = 8, rate_hz: float = 100.0) -> Rate:
    """False alarms a minute in white noise, two minutes at a time."""
    stream = Stream("noise", tuple(Channel(f"S{j}") for j in range(channels)), rate_hz, simulated=True)
    frames, alarms, minutes = round(120 * rate_hz), 0, 0.0
    for seed in range(recordings):
        noise = np.random.default_rng(seed).standard_normal((frames, channels))
        found = detect(Recording.of_values(stream, 100 + 0.4 * noise, device_time=np.arange(frames) / rate_hz), false_alarms=per_minute)
        alarms += len(found.contacts)
        minutes += 2 - found.channels[0].ready / 60
    return poisson(alarms, minutes)


def false_alarms() -> Iterator[str]:
    """A row a stated rate."""
    yield "| stated, a minute | counted | minutes |"
    yield "|---|---|---|"
    for per_minute, recordings in STATED:
        yield f"| {per_minute:g} | {counted(per_minute, recordings)} | {2 * recordings} |"


if __name__ == "__main__":
    for table in (ablations, harder, false_alarms):
        for line in table():
            sys.stdout.write(line + "\n")
        sys.stdout.write("\n")
