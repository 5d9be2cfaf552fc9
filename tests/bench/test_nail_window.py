"""The chart of window lengths: rows that add up, the improved method ahead at short windows, and a sentence of the table's numbers."""

from pathlib import Path

import pytest

from skinfab.bench import nail_window
from skinfab.bench.flatten import read_csv
from skinfab.bench.nail_terms import TERMS
from skinfab.fingertip.nail.protocol import Protocol
from skinfab.progress import silent


def test_the_whole_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(nail_window, "LENGTHS", (8, 33, 128))
    monkeypatch.setattr(nail_window, "_TIMED", 2)
    small = Protocol(participants=2, training=4, rounds=3, estimates=2, samples=128)
    found = nail_window.run(tmp_path, repeats=1, progress=silent, protocol=small)
    assert sorted(each.name for each in tmp_path.iterdir()) == ["nail_terms.csv", "nail_window.csv", "nail_window.png", "nail_window.txt"]
    rows = {(row["method"], row["samples"]): row for row in found["rows"]}
    assert len(rows) == 9 and all(row["simulated"] and row["low"] <= row["percent"] <= row["high"] for row in found["rows"])
    assert rows[nail_window.IMPROVED, 8]["percent"] > rows[nail_window.PUBLISHED, 8]["percent"]
    assert rows[nail_window.TEN, 33]["window_ms"] == pytest.approx(2 * rows[nail_window.PUBLISHED, 33]["window_ms"])
    for row in found["rows"]:
        assert row["latency_ms"] == pytest.approx(row["window_ms"] + row["us_per_window"] / 1000)
    terms = {(row["test"], row["term"]): row for row in read_csv(tmp_path / "nail_terms.csv")}
    assert len(terms) == 2 * len(TERMS) and all(row["simulated"] for row in terms.values())
    assert terms["edges4", "temperature"]["too_sure"] > terms["edges4", "nothing"]["too_sure"]
    default = rows[nail_window.IMPROVED, 33]
    assert default["default"] and f"{default['percent']:.1f} %" in found["sentence"] and "simulated" in found["sentence"]
    assert default["angle_deg"] < default["weighted_angle_deg"] < rows[nail_window.PUBLISHED, 33]["angle_deg"]
