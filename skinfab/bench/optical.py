"""The optical fingertip: the seed's shapes by its own way and the improved one, and how often a contour closes; what a frame costs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinfab.bench.flatten import REPEATS, read_csv, write_csv
from skinfab.bench.optical_ablation import measure_terms
from skinfab.bench.optical_contour import FRAMES, IMPROVED, PUBLISHED, ROUNDS, RUNS, SEEDS, learned, measure_rates, measure_shapes
from skinfab.bench.optical_depth import measure_depths
from skinfab.bench.timing import one_processor
from skinfab.progress import Progress, part_of, silent


def run(folder: Path, *, repeats: int = REPEATS, seeds: int = SEEDS, runs: int = RUNS, progress: Progress = silent) -> dict[str, Any]:
    """Measure, and write optical_shapes.csv, optical_contour.csv and .png, optical_reconstruction.png, optical_depth.csv,
    optical_ablation.csv, the frames' files and optical.txt.

    Parameters
    ----------
    folder : path
        To write into, which is there.
    repeats : int
        Of what is timed.
    seeds : int
        For each point of the chart, and round each shape by the improved way.
    runs : int
        Round each shape by the published way.
    progress : Progress

    Returns
    -------
    dict
        "sentence", "notes" (what to know of the measurement), "shapes", "contours", "depths", "terms" and "frames".
    """
    from skinfab.bench.optical_chart import draw_rates, draw_reconstruction
    from skinfab.bench.optical_frame import frame
    from skinfab.files import atomic_write
    from skinfab.fingertip.optical.simulator import paper_fingertip

    notes = [
        "a simulated fingertip of 271 pins; sides are true / the seed's table 1 / found, mm; areas are of the seed's table 2, cm2",
        f"a robot that has not closed a contour after {ROUNDS} times its length is stopped",
    ]
    with one_processor() as alone:
        notes += [] if alone else ["this system cannot keep a process on one processor"]
        feel = learned(paper_fingertip())
        write_csv(measure_shapes(feel, runs=runs, seeds=seeds, progress=part_of(progress, 0.05, 0.3)), folder / "optical_shapes.csv")
        write_csv(measure_rates(feel, seeds=seeds, progress=part_of(progress, 0.3, 0.86)), folder / "optical_contour.csv")
        draw_reconstruction(feel, folder / "optical_reconstruction.png")
        write_csv(measure_depths(progress=part_of(progress, 0.86, 0.88)), folder / "optical_depth.csv")
        write_csv(measure_terms(progress=part_of(progress, 0.88, 0.9)), folder / "optical_ablation.csv")
    # From here on only what the tables hold is used, so that chart and sentence cannot say anything else.
    made, rates, deep, terms = (read_csv(folder / f"optical_{name}.csv") for name in ("shapes", "contour", "depth", "ablation"))
    draw_rates(rates, folder / "optical_contour.png")
    said = sentence(made, rates)
    cost = frame(folder, repeats=repeats, progress=part_of(progress, 0.9, 1.0))
    said, notes = f"{said} {cost['sentence']}", [*notes, *cost["notes"]]
    atomic_write(folder / "optical.txt", "\n".join([said, *notes]) + "\n")
    return {"sentence": said, "notes": notes, "shapes": made, "contours": rates, "depths": deep, "terms": terms, "frames": cost["rows"]}


def sentence(made: Sequence[Mapping[str, Any]], rates: Sequence[Mapping[str, Any]]) -> str:
    """Published beside improved: every number in it comes from the tables."""
    words = []
    for name in (PUBLISHED, IMPROVED):
        rows = [row for row in made if row["method"] == name]
        right, runs = (sum(row[key] for row in rows) for key in ("right", "runs"))
        keys = ("off_mm", "worst_mm", "side_error_pc", "area_error_pc")
        off, far, side, area = ([row[key] for row in rows if row["right"]] for key in keys)
        worst = (
            f", at most {max(side):.1f} % off in a side, {max(area):.1f} % in an area and {max(off):.2f} mm off the true edge on average "
            f"({max(far):.1f} mm at one point)"
            if off
            else ""
        )
        words.append(f"{name} close {right} of {runs} contours{worst}")
    first = rates[0]
    usual = {row["method"]: row for row in rates if (row["step_mm"], row["noise_mm"]) == (first["step_mm"], first["noise_mm"])}
    return (
        f"On a simulated fingertip, {'; '.join(words)}; of {first['seeds']} circles in steps of {first['step_mm']:g} mm "
        + ", ".join(f"{usual[name]['right']} close by {name}" for name in (PUBLISHED, FRAMES, IMPROVED))
        + f"; the last {_worst([row for row in rates if row['method'] == IMPROVED])}. The default is the last, in steps of 1 mm."
    )


def _worst(rows: Sequence[Mapping[str, Any]]) -> str:
    """Where one way closes fewest, or that it closes all of them everywhere."""
    if all(row["right"] == row["seeds"] for row in rows):
        steps, noises = ([row[key] for row in rows] for key in ("step_mm", "noise_mm"))
        return f"closes all at every step (up to {max(steps):g} mm) and every noise of the tips (up to {max(noises):g} mm)"
    worst = min(rows, key=lambda row: row["rate"])
    return f"is worst at steps of {worst['step_mm']:g} mm and noise of {worst['noise_mm']:g} mm: {worst['right']}"
