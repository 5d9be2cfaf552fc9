"""The framings beside each other: what each promises it keeps, and the sentence says what the table holds."""

import json
from pathlib import Path

import numpy as np
import pytest

from skinfab.bench import readout
from skinfab.bench.flatten import read_csv
from skinfab.bench.framings import DEFAULT, framings
from skinfab.bench.readout import FLIPS, LOSSES, RATES, measure, run, sentence


def test_each_framing_gives_back_what_was_sent() -> None:
    values = np.random.default_rng(3).integers(-5000, 5000, (200, 16))
    wanted = [(k, tuple(row)) for k, row in enumerate(values.astype(float).tolist())]
    for name, way in framings(16).items():
        assert list(way.decode(way.encode(values))) == wanted, name


@pytest.mark.parametrize("name", list(framings(4)))
def test_garbage_before_and_after_costs_one_frame_on_either_side_at_most(name: str) -> None:
    values = np.random.default_rng(3).integers(0, 4096, (50, 4))
    way = framings(4)[name]
    garbage = np.random.default_rng(4).bytes(3000)
    numbers = {number for number, _ in way.decode(garbage + way.encode(values) + garbage)}
    assert set(range(1, 49)) <= numbers


def test_lines_are_wrong_in_silence_and_packets_are_not() -> None:
    rows = measure(frames=3000, repeats=1)
    assert len(rows) == len(framings(1)) * 2 * len(RATES)
    worst = {(r.framing, r.fault): r for r in rows if r.rate == max(RATES)}
    for fault in (FLIPS, LOSSES):
        assert worst["ASCII", fault].wrong > 30
        assert worst[DEFAULT, fault].wrong == 0 and 100 < worst[DEFAULT, fault].lost < 400
    assert all(r.lost >= r.wrong * 0.9 for r in rows if r.framing == "ASCII")


def test_run_writes_a_table_a_chart_and_a_sentence_from_the_table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(readout, "measure", lambda repeats, progress: measure(frames=300, repeats=repeats, progress=progress))
    seen: list[float] = []
    found = run(tmp_path, repeats=1, progress=lambda fraction, label: seen.append(fraction))
    assert sorted(p.name for p in tmp_path.iterdir()) == ["readout.csv", "readout.png", "readout.txt"]
    table = read_csv(tmp_path / "readout.csv")
    assert (tmp_path / "readout.txt").read_text().splitlines() == [sentence(table), *found["notes"]]
    assert found["sentence"] == sentence(table) and found["rows"] == table
    assert (tmp_path / "readout.png").read_bytes().startswith(b"\x89PNG")
    assert seen == sorted(seen) and 0 <= seen[0] and seen[-1] <= 1
    json.dumps(found, allow_nan=False)
