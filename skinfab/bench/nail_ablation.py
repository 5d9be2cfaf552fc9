"""What each term of the nail's simulator is for: the published method's accuracies without it, on the same participants and touches."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from skinfab.fingertip.nail.patterns import TESTS
from skinfab.fingertip.nail.protocol import Outcome, Protocol, sessions, study
from skinfab.fingertip.nail.simulator import Scene
from skinfab.progress import Progress, silent

NOTHING = "nothing"
#: What a term is called, and the scene without it.
TERMS: Mapping[str, Mapping[str, Any]] = {
    NOTHING: {},
    "scatter of the place": {"place_mm": 0.0},
    "scatter of the turn": {"turn_rad": 0.0},
    "scatter of the force": {"force_scatter": 0.0},
    "scatter of participants": {"person_scatter": 0.0},
    "scatter of the mount": {"mount_mm": 0.0},
    "tilt of the motor": {"tilt_rad": 0.0},
    "scatter of the drive": {"drive_scatter": 0.0},
    "second harmonic": {"harmonic": 0.0},
    "damping of the contact": {"contact_delay_s": 0.0},
    "stiffening with force": {"hertz": 0.0},
    "gravity": {"gravity_g": 0.0},
    "noise of acceleration": {"noise_g": 0.0},
    "noise of angular velocity": {"noise_dps": 0.0},
    "ends of the ranges": {"range_g": 1e3, "range_dps": 1e5},
}
#: Conditions that are looked at: each alone, as a term can matter to one and not to the other.
_LOOKED_AT = ("AxAyAzGxGyGz", "AxAyAz", "GxGyGz")


@dataclass(frozen=True)
class Left:
    """The published method's accuracy where one term is left out.

    Parameters
    ----------
    term : str
        What is left out.
    test, condition : str
    percent : float
        Mean of the participants' accuracies.
    change : float
        By how much that is more than with all terms.
    error : float
        Standard error of the change; participants are compared with themselves.
    counts : bool
        The change is more than twice its error.
    """

    term: str
    test: str
    condition: str
    percent: float
    change: float
    error: float
    counts: bool
    simulated: bool = True


def ablate(protocol: Protocol, *, scene: Scene | None = None, seed: int = 0, progress: Progress = silent) -> list[Left]:
    """A row for every term, test and condition; one estimate a trial."""
    scene = scene or Scene()
    short = replace(protocol, estimates=1)
    rows: list[Left] = []
    whole: dict[str, Outcome] = {}
    for k, (term, without) in enumerate(TERMS.items()):
        progress(k / len(TERMS), f"without {term}")
        for test in TESTS:
            found = study(sessions(test, protocol=short, scene=replace(scene, **without), seed=seed))
            of = whole.setdefault(test, found)
            for condition in _LOOKED_AT:
                change = 100 * (found.accuracy[condition] - of.accuracy[condition])
                error = float(change.std(ddof=1) / np.sqrt(len(change)))
                mean = float(change.mean())
                rows.append(Left(term, test, condition, 100 * found.mean(condition), mean, error, abs(mean) > 2 * error))
    return rows
