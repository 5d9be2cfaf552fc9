"""What each term of the simulated array changes in the reported figures: it is left out, and they are measured again."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from skinfab.fingertip.array import simulator
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.matched import ArrayModel
from skinfab.fingertip.array.simulator import Device, Rubber, contact_line
from skinfab.fingertip.array.study import IMPROVED, LINES_DEG, PUBLISHED, Rods, locators, rms, scan, turners, worst


@dataclass(frozen=True)
class Without:
    """Worst errors of place (mm, degrees) and direction (degrees), as published and matched, where a term is left out."""

    term: str
    along: float
    along_matched: float
    around: float
    around_matched: float
    line: float
    line_matched: float
    line_matched_rms: float
    simulated: bool = True


#: Terms, and what is done without each.
TERMS: dict[str, dict[str, float]] = {
    "nothing": {},
    "noise": {"noise": 0.0},
    "scatter of gains": {"gain_scatter": 0.0},
    "electrodes' size (points)": {"fill": 0.0},
    "rubber's volume (nu 0)": {"poisson": 0.0},
    "skin's yielding (stretch 1)": {"stretch": 1.0},
    "longer when turned": {"grows": 0.0},
}


def ablation(*, devices: int = 4, rods: int = 3) -> list[Without]:
    """A row a term; the matched ways know the array as it is drawn, without the term."""
    return [_without(term, changes, devices, rods) for term, changes in TERMS.items()]


def _without(term: str, changes: dict[str, float], devices: int, rods: int) -> Without:
    errors = {key: value for key, value in changes.items() if key in ("noise", "gain_scatter")}
    geometry = Geometry(fill=changes.get("fill", Geometry.fill))
    rubber = Rubber(poisson=changes.get("poisson", Rubber.poisson))
    each = [Device(geometry, rubber, seed=seed).without(**errors) for seed in range(devices)]
    model = replace(ArrayModel.nominal(geometry), rubber=rubber)
    places, turns = locators(geometry, model), turners(geometry, model)
    figures = []
    for axis in ("along", "around"):
        scans = [scan(device, axis, seed=device.seed) for device in each]
        figures += [worst(np.concatenate([one.errors(places[name]) for one in scans])) for name in (PUBLISHED, IMPROVED)]
    laid = [_rods(device, rods, changes) for device in each]
    found = [np.concatenate([one.errors(turns[name]) for one in laid]) for name in ("span", IMPROVED)]
    along, along_matched, around, around_matched = figures
    return Without(term, along, along_matched, around, around_matched, worst(found[0]), worst(found[1]), rms(found[1]))


def _rods(device: Device, count: int, changes: dict[str, float]) -> Rods:
    """Between two stripes, with this law of contact."""
    g, rng = device.geometry, np.random.default_rng((device.seed, 29))
    directions = np.repeat(np.asarray(LINES_DEG, dtype=float), count)
    Z = []
    for line in directions:
        turned = math.radians(float(line))
        length = contact_line(simulator.DENT_N, turned if changes.get("grows", 1.0) else 0.0, g.finger_radius)
        length = min(length * changes.get("stretch", simulator.STRETCH) / simulator.STRETCH, simulator.LONGEST_MM)
        axial = rng.uniform(0.35, 0.65) * (g.rings - 1) * g.ring_pitch
        angle = g.from_tactels(0, int(rng.integers(g.stripes)) + 0.5)[1]
        Z.append(device.skin.lined(simulator.DENT_N, axial_mm=axial, angle_rad=angle, line_rad=turned, length_mm=length))
    return Rods(directions, device.noisy(np.array(Z), rng))
