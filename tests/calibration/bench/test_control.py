"""The benchmark of the control laws: rows, and a sentence and a chart made of the table alone."""

import json
from pathlib import Path

import pytest

from calibration.bench import control as bench_control
from calibration.bench.control import GAINS, Row, _Case, measure, run, sentence
from calibration.control.controller import LAWS
from calibration.control.protocols import PAPER_DEG
from skinfab.bench.flatten import read_csv


def test_a_row_a_case() -> None:
    seen: list[float] = []
    cases = [_Case("period", "p", "uniform", 5.0, period_s=4.0), _Case("gain", "full", "random")]
    even, uneven = measure(cases, seeds=1, progress=lambda part, label: seen.append(part))
    assert (even.gain, even.period_s, even.margin < 2, even.scatter_deg, even.seeds) == (5.0, 4.0, True, 0.0, 1)
    assert uneven.gain == pytest.approx(3.99, abs=0.01) and uneven.margin == pytest.approx(3) and uneven.period_s != uneven.period_s
    assert uneven.mean_error_deg < even.mean_error_deg and seen == [0.0, 0.5]


def row(experiment: str, law: str, protocol: str, gain: float, error: float, margin: float) -> Row:
    return Row(experiment, law, protocol, gain, 0.05, 8.0, error, 0.1, margin, 5)


def a_table() -> list[Row]:
    rows = []
    for protocol, paper in PAPER_DEG.items():
        rows += [row("published", "p", protocol, 5.1, paper, 1.4), row("default", "full", protocol, 4.0, paper / 3, 3.0)]
        rows += [row("gain", law, protocol, gain, abs(gain - 6) + 4, 12 / gain) for law in LAWS for gain in GAINS]
    return rows


def test_the_table_is_all_that_chart_and_sentence_know(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench_control, "measure", lambda cases, **options: a_table())
    found = run(tmp_path, repeats=1)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["control.csv", "control.png", "control.txt"]
    table = read_csv(tmp_path / "control.csv")
    assert found["rows"] == table and found["sentence"] == sentence(table)
    assert (tmp_path / "control.txt").read_text().splitlines() == [sentence(table), "the finger is simulated"]
    assert (tmp_path / "control.png").read_bytes().startswith(b"\x89PNG")
    json.dumps(found, allow_nan=False)
    assert (
        "uniform: as published 6.61 degrees (the paper: 6.61), at its best gain 4.00 (6 1/s, margin 2.00), the default 2.20"
        in found["sentence"]
    )
    assert found["sentence"].endswith("between 1 and 7 1/s the error of the random protocol only goes from 4.00 to 9.00 degrees.")
