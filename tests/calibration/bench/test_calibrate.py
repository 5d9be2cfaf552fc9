"""The measurement of models and degrees: every way is there, and the sentence says what the table says."""

from pathlib import Path

import pytest

from calibration.bench import calibrate as bench
from calibration.bench.calibrate_chart import draw
from calibration.strain.calibrate import MAX_DEGREE
from calibration.strain.models import MODELS


@pytest.fixture(scope="module")
def rows() -> list[bench.Row]:
    return bench.measure(seeds=(7,), repeats=1)


def test_every_way_is_measured(rows: list[bench.Row]) -> None:
    assert len(rows) == 2 * len(MODELS) * MAX_DEGREE and sum(row.chosen for row in rows) == 2
    assert all(row.us_per_sample > 0 for row in rows)
    for finger in ("human", "robot"):
        best = {name: min(r.held_out_rms_deg for r in rows if (r.finger, r.model) == (finger, name)) for name in MODELS}
        assert max(best["branches"], best["play"]) < 0.7 * best["poly"]  # the fingers have slack


def test_sentence_and_chart(rows: list[bench.Row], tmp_path: Path) -> None:
    table = [vars(row) for row in rows]
    said = bench.sentence(table)
    for row in rows:
        if row.chosen:
            assert f"{row.model} of degree {row.degree} is chosen" in said and f"{row.held_out_rms_deg:.2f} degrees held out" in said
    draw(table, tmp_path / "c.png")
    assert (tmp_path / "c.png").read_bytes().startswith(b"\x89PNG")
