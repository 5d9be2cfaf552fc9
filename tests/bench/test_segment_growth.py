"""How the time for seams grows: a row for each method and size, and a chart of them."""

from pathlib import Path

import numpy as np

from skinfab.bench.segment import AIMS
from skinfab.bench.segment_growth import draw_growth, follow


def test_every_method_on_every_size(tmp_path: Path) -> None:
    rows, refused = follow(tmp_path, [300, 600], None)
    assert refused == [] and {(row["method"], row["object"]) for row in rows} == {(a, f"ball {n}") for a in AIMS for n in (300, 600)}
    assert all(abs(row["triangles"] / int(row["object"].split()[1]) - 1) < 0.1 for row in rows)
    assert all(row["mean_d"] <= 4.05 and row["overlap_mm2"] == 0 == row["flipped"] and row["seconds"] > 0 for row in rows)
    assert (tmp_path / "growth.csv").read_text(encoding="utf-8").count("\n") == 1 + len(rows)


def test_the_chart_shows_what_the_table_says(tmp_path: Path) -> None:
    from matplotlib.image import imread

    row = {"method": "fewest", "triangles": 1000, "seconds": 1.0, "pieces": 1}
    draw_growth([row, {**row, "triangles": 4000, "seconds": 5.0}], tmp_path / "a.png")
    draw_growth([row, {**row, "triangles": 4000, "seconds": 9.0}], tmp_path / "b.png")
    one, two = imread(tmp_path / "a.png"), imread(tmp_path / "b.png")
    assert one.shape == two.shape and one.shape[0] > 300 and np.abs(one - two).max() > 0.5
