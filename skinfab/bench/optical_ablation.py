"""What each term of the simulated fingertip changes in how well an edge is read from its images (simulated)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from skinfab.fingertip.optical.judge import off_by, said
from skinfab.fingertip.optical.labelled import FOLLOWED_MM, SHEAR_MM, labelled
from skinfab.fingertip.optical.regress import Examples, learn
from skinfab.fingertip.optical.simulator import Fingertip
from skinfab.progress import Progress, silent

#: Images that are learned from, and as many that are judged; edges lie within so many mm of the middle.
IMAGES, REACH_MM = 300, 5.0
WHOLE = "whole"


@dataclass(frozen=True)
class TermRow:
    """Mean absolute errors without one term."""

    without: str
    offset_mm: float
    angle_deg: float
    depth_mm: float
    images: int
    simulated: bool = True


def terms() -> dict[str, tuple[Fingertip, float]]:
    """Each a fingertip, and how far its skin is dragged at most, mm.

    Examples
    --------
    >>> list(terms())[:3]
    ['whole', 'no shear', 'no noise of tips']
    """
    tip = Fingertip()
    return {
        WHOLE: (tip, SHEAR_MM),
        "no shear": (tip, 0.0),
        "no noise of tips": (tip.without(pin_mm=0.0), SHEAR_MM),
        "tips at rest not scattered": (tip.without(scatter_mm=0.0), SHEAR_MM),
        "no noise of pixels": (tip.without(grey=0.0), SHEAR_MM),
        "drape of 0.5 in place of 1.5 mm": (replace(tip, dome=replace(tip.dome, drape_mm=0.5)), SHEAR_MM),
    }


def measure_terms(*, names: Sequence[str] | None = None, images: int = IMAGES, progress: Progress = silent) -> list[TermRow]:
    """A row for the whole and for every term that is left out."""
    rows, chosen = [], {name: each for name, each in terms().items() if names is None or name in names}
    for k, (name, (tip, shear)) in enumerate(chosen.items()):
        progress(k / len(chosen), name)
        some, other = (list(labelled(tip, images, reach_mm=REACH_MM, depths_mm=FOLLOWED_MM, shear_mm=shear, seed=seed)) for seed in (1, 2))
        seen = Examples.of([one.image for one in some], [one.edge for one in some])
        model = learn(seen)
        judged = Examples.of([one.image for one in other], [one.edge for one in other], pins=seen.pins)
        offset, depth, angle = (float(each) for each in np.abs(off_by(said(model, judged), judged.truth)).mean(axis=0))
        rows.append(TermRow(name, offset, angle, depth, images))
    return rows
