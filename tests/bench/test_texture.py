"""The texture chart: what it measures, and that its sentence says what its table holds."""

from pathlib import Path

import numpy as np
import pytest

from skinfab.bench.texture import measure, peak_errors, sentence, slides_of
from skinfab.bench.texture_ablation import TERMS, slides_without
from skinfab.bench.texture_chart import draw
from skinfab.bench.texture_peaks import BANDS, measure_peaks, with_peaks
from skinfab.fingertip.force.texture_model import feature_table


def test_interpolation_beats_the_grid_at_every_length() -> None:
    for n_fft in (128, 512):
        (f_grid, m_grid), (f_ours, m_ours) = (peak_errors(way, n_fft) for way in ("published", "interpolated"))
        assert f_ours < f_grid / 8 and m_ours < m_grid / 2
    # The grid's error is that of a uniform distribution over a step.
    assert peak_errors("published", 512)[0] == pytest.approx(200 / 512 / 12**0.5, rel=0.1)


def test_a_small_table_its_chart_and_its_sentence(tmp_path: Path) -> None:
    sets = slides_of(seeds=(0,), specimens=3, slides=2)
    rows = [vars(row) for row in measure(sets, lengths=(256, 512), repeats=1)]
    assert {(row["way"], row["n_fft"]) for row in rows} == {(w, n) for w in ("published", "interpolated") for n in (256, 512)}
    assert all(0 <= row["low"] <= row["accuracy"] <= row["high"] <= 1 for row in rows)
    said = sentence(rows)
    ours = next(row for row in rows if row["way"] == "interpolated" and row["n_fft"] == 512)
    assert said.startswith("Texture, simulated: from 512 samples") and f"{100 * ours['accuracy']:.1f} % of the slides" in said
    peaks = [vars(row) for row in measure_peaks(sets, counts=(1, 3))]
    assert [(row["way"], row["peaks"], row["features"]) for row in peaks] == [
        *((way, n, 2 * n + 3) for way in ("published", "interpolated") for n in (1, 3)),
        (BANDS, 0, 18),
    ]
    np.testing.assert_array_equal(with_peaks(sets[0], "published", 3), feature_table(sets[0].parts, "published"))
    # One in six would be right by chance, and all where the classifier had seen the specimens that it is asked about.
    assert all(0.4 < row["low"] <= row["accuracy"] <= row["high"] < 1 for row in peaks)
    draw(rows, peaks, tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_what_each_term_of_the_slides_is_there_for() -> None:
    some = {name: TERMS[name] for name in ("all terms", "the spool's ripple", "corrugation", "second harmonic", "noise")}
    rows = {row.without: row for row in slides_without(of=some, seeds=1, specimens=3, slides=2)}
    assert list(rows) == list(some)
    whole = rows["all terms"]
    assert rows["the spool's ripple"].first_peak < whole.first_peak - 0.1
    assert rows["corrugation"].bands < whole.bands - 0.1 and rows["corrugation"].peak_sd_hz > 2 * whole.peak_sd_hz
    assert rows["second harmonic"].third_mn > 2 * whole.third_mn
    assert rows["noise"].paper_span_deg < 0.7 * whole.paper_span_deg
    assert all(0 <= part <= 1 for row in rows.values() for part in (row.bands, row.published, row.under_load, row.third_peak))
