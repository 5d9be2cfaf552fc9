"""The gravity chart: what it measures, the paper's own errors, and that its sentence says what its table holds."""

from pathlib import Path

import pytest

from skinfab.bench.gravity import measure, paper_errors, sentence
from skinfab.bench.gravity_chart import draw


def test_the_papers_errors_are_those_of_its_table() -> None:
    assert paper_errors() == pytest.approx([3.34, 3.44, 5.20, 3.11, 3.44], abs=0.005)


def test_a_small_table_its_chart_and_its_sentence(tmp_path: Path) -> None:
    rows = [vars(row) for row in measure(spans=(10.0, 45.0), poses=(5, 10), trials=1, repeats=1)]
    assert [(row["way"], row["span_deg"], row["poses"]) for row in rows] == [
        (way, span, n) for span, n in ((10.0, 10), (45.0, 10), (45.0, 5)) for way in ("published", "offset fitted", "hand weighed")
    ]
    by = {(row["way"], row["span_deg"], row["poses"]): row for row in rows}
    assert by["offset fitted", 45.0, 10]["median_mm"] < by["published", 45.0, 10]["median_mm"] / 2
    assert by["offset fitted", 45.0, 10]["median_mm"] < by["offset fitted", 10.0, 10]["median_mm"]
    said = sentence(rows)
    assert f"{by['offset fitted', 45.0, 10]['median_mm']:.2f} mm (median)" in said and "3.1 to 5.2 mm" in said
    draw(rows, tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
