"""The measurement of the tactel array: rows, and a sentence and charts made of the tables alone."""

from pathlib import Path

import pytest

from skinfab.bench import array as bench
from skinfab.bench.array_chart import draw


@pytest.fixture(scope="module")
def rows() -> list[bench.Row]:
    return bench.measure(densities=("8x8", "4x16"), devices=1, rods=1, layers=1, repeats=1)


def test_every_way_is_measured(rows: list[bench.Row]) -> None:
    for density in ("8x8", "4x16"):
        for experiment in bench.UNITS:
            ways = [row for row in rows if (row.density, row.experiment) == (density, experiment)]
            if experiment.startswith("layer") and density != "8x8":
                continue  # the seed's array alone
            wanted = {
                "line": {"span", "matched"},
                "tilt": {"odd and even", "matched"},
                "laye": {"sinc", "log-parabola", "matched", "learned"},
            }
            assert {row.method for row in ways} >= wanted.get(experiment[:4], {"sinc", "log-parabola", "matched"})
            assert all(0 <= row.rms <= row.worst and row.simulated for row in ways)
    by = {(row.density, row.experiment, row.method): row.worst for row in rows}
    assert by["4x16", "around", "sinc"] < 0.5 * by["8x8", "around", "sinc"]  # twice as many stripes
    assert by["8x8", "along", "matched"] < 0.5 * by["8x8", "along", "sinc"]


def test_sentence_and_chart(rows: list[bench.Row], tmp_path: Path) -> None:
    table, events = [vars(row) for row in rows], [vars(row) for row in bench.track(logs=1)]
    said = bench.sentence(table, events)
    best = bench.pick(table, "around", "8x8", "matched")
    assert f"{best['worst']:.2g} matched" in said and "the seed measured 10" in said and "matched line finds 1 of 1 slips" in said
    draw(table, tmp_path / "c.png")
    assert (tmp_path / "c.png").read_bytes().startswith(b"\x89PNG")
