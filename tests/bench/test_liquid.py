"""The chart of liquids: what it measures, and that its sentence says what its table holds."""

from dataclasses import replace
from pathlib import Path

import pytest

from skinfab.bench import liquid
from skinfab.bench.liquid_chart import draw
from skinfab.fingertip.force.liquid_model import LiquidModel, Trained
from skinfab.fingertip.force.liquid_simulator import CupScene
from skinfab.rates import Rate


def test_a_small_table_its_chart_and_its_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # Ten minutes of empty cups are needed to learn one false alarm in a hundred; tests/fingertip/force/test_liquid_model.py does.
    learned = Trained(LiquidModel(1e-8, 0.01, 6.0, 200.0, 100), Rate(0.0, 0.0, 0.1), 0.4, 0, 2, (), "empty-1", 0.3, 0.2)
    monkeypatch.setattr(liquid, "train_liquid", lambda logs: learned)
    ends = {name: liquid.CONDITIONS[name] for name in ("still", "hand trembles much")}
    few = {"cups": 2, "empty": 8, "limited": 6, "learned": 1, "repeats": 1}
    rows = [vars(row) for row in liquid.measure(conditions=ends, water_g=(10, 20, 50), **few)]  # type: ignore[arg-type]
    assert len(rows) == 2 * 3 * (1 + 2 * 3)
    by = {(row["condition"], row["rule"], row["grams"], row["angle_deg"]): row["found"] for row in rows}
    assert by["still", "spectrum", 50, 10.0] == 1.0 > 0.3 > by["still", "spectrum", 0, 0.0]
    assert by["hand trembles much", "spectrum", 0, 0.0] > by["hand trembles much", "learned", 0, 0.0]
    said = liquid.sentence(rows)
    assert f"where the hand trembles (0.2 m/s2) {by['hand trembles much', 'spectrum', 0, 0.0]:.0%} of the empty cups" in said
    draw(rows, tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_what_each_term_is_there_for() -> None:
    some = {name: liquid.TERMS[name] for name in ("all terms", "nine tenths of the moment's noise")}
    rows = {row.without: row for row in liquid.without(of=some, cups=3)}
    assert set(rows) == set(some)
    assert rows["nine tenths of the moment's noise"].found_10_g_3_deg > rows["all terms"].found_10_g_3_deg
    assert all(replace(CupScene(), **terms) != CupScene() for name, terms in liquid.TERMS.items() if name != "all terms")
