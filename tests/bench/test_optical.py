"""The benchmark of following edges: rows that count what is right, a sentence and charts made of the tables alone."""

import math
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from skinfab.bench.optical import sentence
from skinfab.bench.optical_chart import draw_rates
from skinfab.bench.optical_contour import FRAMES, IMPROVED, PUBLISHED, Made, RateRow, measure_rates, runs_of, shape_row
from skinfab.fingertip.optical.edge import Edge
from skinfab.fingertip.optical.follower import Trace
from skinfab.fingertip.optical.shapes import Shape, reconstruct, shapes
from skinfab.fingertip.optical.simulator import paper_fingertip


def rate(method: str, step: float, noise: float, right: int) -> RateRow:
    return RateRow("circle", method, step, noise, right, 20, right / 20, max(right / 20 - 0.1, 0), min(right / 20 + 0.1, 1), 0.3)


RATES = [
    rate(name, *point, right)
    for point, rights in (((1.0, 0.03), (7, 19, 20)), ((8.0, 0.03), (0, 3, 18)), ((1.0, 0.3), (1, 4, 11)))
    for name, right in zip((PUBLISHED, FRAMES, IMPROVED), rights, strict=True)
]


def around(shape: Shape, scale: float, *, closed: bool = True) -> Trace:
    C = scale * shape.plate.outline()
    P = np.vstack([a + (b - a) * np.linspace(0, 1, 30, endpoint=False)[:, None] for a, b in zip(C, np.roll(C, -1, axis=0), strict=True)])
    return Trace(P, P, len(P), closed, 0)


def test_a_row_tells_errors_and_spread_of_the_runs_that_are_right_alone() -> None:
    shape = shapes()[0]
    made = [Made(reconstruct(around(shape, scale), shape, lines=True), scale) for scale in (1.0, 1.02)]
    lost = Made(reconstruct(around(shape, 0.2, closed=False), shape, lines=True), 30.0)
    row = shape_row(shape, IMPROVED, [*made, lost, None])
    assert (row.right, row.runs, row.simulated) == (2, 4, True)
    assert row.side_error_pc == pytest.approx(1, abs=0.01) and row.repeat_pc == pytest.approx(2 / 1.01, abs=0.01)
    assert row.area_error_pc == pytest.approx(100 * (1.02**2 - 1), abs=0.01)
    assert row.sides.split()[0] == "108/104/109.1" and row.worst_mm == 1.02
    assert row.area_cm2 == pytest.approx(row.true_cm2 * (1 + 1.02**2) / 2, rel=1e-3) and (row.seed_cm2, row.humans_cm2) == (83.57, 94.54)
    none = shape_row(shape, PUBLISHED, [lost, None])
    assert none.right == 0 and math.isnan(none.side_error_pc) and none.sides == ""


def test_an_edge_that_is_never_felt_closes_nothing() -> None:
    made = runs_of(shapes()[-1], paper_fingertip(), lambda _: Trace(np.empty((0, 2)), np.empty((0, 2)), 1, False, 0), range(2), lines=False)
    assert made == [None, None]


def test_rates_are_counted_by_step_with_an_interval(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("skinfab.bench.optical_contour.MOST_FRAMES", 12)
    rows = measure_rates(lambda _: Edge(0.0, 0.0, confidence=0.0), steps_mm=(1.0,), noises_mm=(), seeds=2)
    assert [(row.method, row.right, row.seeds) for row in rows] == [(PUBLISHED, 0, 2), (FRAMES, 0, 2), (IMPROVED, 0, 2)]
    assert all(row.low == 0 < row.high < 1 and math.isnan(row.off_mm) for row in rows)


def test_the_sentence_and_the_chart_are_of_the_tables(tmp_path: Path) -> None:
    shape = shapes()[-1]
    good = shape_row(shape, IMPROVED, [Made(reconstruct(around(shape, 1.0), shape, lines=True), 0.0)])
    bad = shape_row(shape, PUBLISHED, [None])
    table = [asdict(row) for row in RATES]
    said = sentence([asdict(bad), asdict(good)], table)
    assert "merged pins close 0 of 1" in said and "close 1 of 1" in said
    assert "7 close by merged pins, 19 close by" in said and "the last is worst at steps of 1 mm and noise of 0.3 mm: 11." in said
    whole = sentence([asdict(bad), asdict(good)], [row | {"right": 20, "rate": 1.0} for row in table])
    assert "; the last closes all at every step (up to 8 mm) and every noise of the tips (up to 0.3 mm)." in whole
    draw_rates(table, tmp_path / "a.png")
    first = (tmp_path / "a.png").read_bytes()
    table[0]["rate"] = 0.9
    draw_rates(table, tmp_path / "b.png")
    assert (tmp_path / "b.png").read_bytes() != first
