"""The chart of arcs and chords says what the table says, and the table what the files are."""

import json
from pathlib import Path

import numpy as np
import pytest

from gcode.bench import TOLERANCES, bench_programs, measure, off_path, run, sentence
from gcode.printer import load_printer
from skinfab.bench.flatten import read_csv
from skinfab.material import load_material
from skinfab.paths import Arc, Line

#: Of the chord tolerances these, the second for the sentence: the two finest take most of the time of all.
FEW = (0.05, 0.005)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict]:
    folder = tmp_path_factory.mktemp("bench")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("gcode.bench.TOLERANCES", FEW)
        return folder, run(folder, repeats=1)


def test_files_and_sentence_come_from_the_table(written: tuple[Path, dict]) -> None:
    folder, found = written
    table = read_csv(folder / "gcode.csv")
    assert sorted(p.name for p in folder.iterdir()) == ["gcode.csv", "gcode.png", "gcode.txt"]
    assert found["sentence"] == sentence(table) == (folder / "gcode.txt").read_text().splitlines()[0]
    assert (folder / "gcode.png").read_bytes().startswith(b"\x89PNG")
    json.dumps(found, allow_nan=False)


def test_deviation_is_what_was_asked_for_and_arcs_have_none(written: tuple[Path, dict]) -> None:
    rows = written[1]["rows"]
    assert len(rows) == 3 * (1 + len(FEW)) and set(FEW) <= set(TOLERANCES)
    for row in rows:
        if row["arcs"] == "native":
            assert row["chord_tolerance"] is None and row["deviation_mm"] < 2e-4
        else:
            assert 0.25 * row["chord_tolerance"] < row["deviation_mm"] <= row["chord_tolerance"] + 2e-4
    for name in {row["program"] for row in rows}:
        lines = [row["lines"] for row in rows if row["program"] == name]
        assert lines == sorted(lines)  # native first, then finer and finer


def test_times_are_the_least_of_the_turns(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter(range(100, 0, -1))
    monkeypatch.setattr("gcode.bench.timed_twice", lambda work: (work(), float(next(clock)), 0.0, 0.0))
    programs = dict(list(bench_programs(load_printer(), load_material()).items())[1:2])
    rows = measure(programs, load_printer(), repeats=2)
    assert [row.seconds for row in rows] == [92.0 - k for k in range(8)] and {row.repeats for row in rows} == {2}


def test_off_path_against_dense_sampling() -> None:
    path = [Line((0, 0), (5, 0)), Arc((5, 3), 3.0, -np.pi / 2, 2.0), Arc((0, -4), 2.0, 0.3, -4.0)]
    points = np.random.default_rng(1).uniform(-8, 10, (200, 2))
    sampled = np.concatenate([s.point_at(np.linspace(0, 1, 4001)) for s in path])
    nearest = np.linalg.norm(points[:, None] - sampled[None], axis=2).min(axis=1)
    np.testing.assert_allclose(off_path(points, path), nearest, atol=1e-3)
