"""What each term of the simulated slides is there for: taken out, which reported figure changes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.simulator import MATERIALS, Material, SlideScene, texture_logs
from skinfab.fingertip.force.texture import Slide, interpolated_peaks, published_features, sliding_part
from skinfab.fingertip.force.texture_model import train_texture
from skinfab.fingertip.force.wrench import SensorNoise
from skinfab.progress import Progress, silent

#: The scene, and the materials, without one term.
TERMS: Mapping[str, tuple[dict[str, object], dict[str, object]]] = {
    "all terms": ({}, {}),
    "the spool's ripple": ({"spool_ripple": 0.0}, {}),
    "roughness": ({}, {"roughness": 0.0}),
    "roughness fading over 5 mm (white)": ({"roughness_mm": 1e-3}, {}),
    "corrugation": ({}, {"ripple": 0.0, "second": 0.0}),
    "second harmonic": ({}, {"second": 0.0}),
    "scatter of the speed": ({"speed_scatter": 0.0}, {}),
    "scatter of specimens": ({"specimen_scatter": 0.0}, {}),
    "noise": ({"noise": SensorNoise(1e-6, 1e-5)}, {}),
    "offset": ({"offset_n": 0.0, "offset_nmm": 0.0}, {}),
}
#: The paper's first peak of most materials, and the third of its cardboard of 5 mm, Hz; a step of its spectrum.
_FIRST_HZ, _THIRD_HZ, _STEP_HZ = 0.78, 7.42, 0.39
#: So many samples pass until the finger is pressed and pulled: logs without them begin under load.
_BEFORE = 120


@dataclass(frozen=True)
class TermRow:
    """Slides without one term.

    Parameters
    ----------
    without : str
    bands, published : float
        Right on specimens held out.
    under_load : float
        Right by bands where logs begin under load.
    first_peak : float
        Part of the slides whose first peak is within half a step of the paper's 0.78 Hz.
    third_peak : float
        Part of the slides over cardboard of 5 mm whose third peak is within a step of 7.42 Hz.
    peak_sd_hz : float
        Scatter of the strongest peak of cardboard of 5 mm.
    towel_span_deg, paper_span_deg : float
        Between the extremes of the inclination: towel, copy paper.
    third_mn : float
        Magnitude of the third peak of cardboard of 10 mm, |X| / N.
    """

    without: str
    bands: float
    published: float
    under_load: float
    first_peak: float
    third_peak: float
    peak_sd_hz: float
    towel_span_deg: float
    paper_span_deg: float
    third_mn: float


def slides_without(
    *,
    of: Mapping[str, tuple[dict[str, object], dict[str, object]]] = TERMS,
    seeds: int = 2,
    specimens: int = 6,
    slides: int = 3,
    progress: Progress = silent,
) -> list[TermRow]:
    """A row for each term."""
    rows = []
    for k, (name, (scene, material)) in enumerate(of.items()):
        progress(k / len(of), f"slides: {name}")
        made = replace(SlideScene(), **scene)  # type: ignore[arg-type]
        materials: dict[str, Material] = {of: replace(each, **material) for of, each in MATERIALS.items()}  # type: ignore[arg-type]
        sets = [texture_logs(specimens=specimens, slides=slides, seed=seed, scene=made, materials=materials) for seed in range(seeds)]
        rows.append(TermRow(name, *np.mean([_figures(logs) for logs in sets], axis=0).tolist()))
    return rows


def _figures(logs: list[WrenchLog]) -> list[float]:
    """Of one set, in the order of `TermRow`."""
    parts = [sliding_part(log) for log in logs]
    labels, groups = [log.label for log in logs], [log.group for log in logs]
    bands, published = (train_texture(parts, labels, groups, features=of).accuracy.value for of in ("bands", "published"))
    cut = [WrenchLog(log.name, log.time[_BEFORE:], log.force[_BEFORE:], log.moment[_BEFORE:]) for log in logs]
    late = train_texture([sliding_part(log) for log in cut], labels, groups).accuracy.value
    table, of = np.array([published_features(each) for each in parts]), np.array(labels)
    five, ten, towel, paper = (of == name for name in ("cardboard 5 mm", "cardboard 10 mm", "towel", "copy paper"))
    span = table[:, 6] - table[:, 7]
    strongest = [_strongest(each) for each, on in zip(parts, five, strict=True) if on]
    near = (float(np.mean(np.abs(table[:, 0] - _FIRST_HZ) < _STEP_HZ / 2)), float(np.mean(np.abs(table[five, 2] - _THIRD_HZ) <= _STEP_HZ)))
    return [
        *(bands, published, late, *near, float(np.std(strongest))),
        *(float(span[towel].mean()), float(span[paper].mean()), float(np.median(table[ten, 5]))),
    ]


def _strongest(part: Slide) -> float:
    return float(interpolated_peaks(part.tangential, part.rate_hz, count=1).frequency[0])
