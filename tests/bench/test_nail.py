"""The three tests as a bench: what is written, that the sentence is the tables', and that each term of the simulator is for something."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skinfab.bench import nail_ablation
from skinfab.bench.flatten import read_csv
from skinfab.bench.nail import PUBLISHED, run, sentence
from skinfab.bench.nail_ablation import NOTHING, TERMS, ablate
from skinfab.fingertip.nail.paper import ACCURACY, AROUND, DIFFERING
from skinfab.fingertip.nail.patterns import TESTS
from skinfab.fingertip.nail.protocol import Protocol
from skinfab.fingertip.nail.published import CONDITIONS
from skinfab.fingertip.nail.simulator import Scene

SMALL = Protocol(participants=4, training=3, rounds=2, estimates=1, samples=128)


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any], list[float]]:
    folder = tmp_path_factory.mktemp("nail")
    seen: list[float] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(nail_ablation, "TERMS", {term: TERMS[term] for term in (NOTHING, "scatter of the turn")})
        found = run(folder, protocol=SMALL, progress=lambda fraction, label: seen.append(fraction))
    return folder, found, seen


def test_tables_charts_and_a_sentence_are_written(ran: tuple[Path, dict[str, Any], list[float]]) -> None:
    folder, found, seen = ran
    charts = ["nail.png", *(f"nail_confusion_{test}.png" for test in TESTS)]
    assert {p.name for p in folder.iterdir()} >= {"nail.csv", "nail_pairs.csv", "nail_ablation.csv", "nail.txt", *charts}
    assert all((folder / name).read_bytes().startswith(b"\x89PNG") for name in charts)
    assert seen == sorted(seen) and 0 <= seen[0] and seen[-1] <= 1
    json.dumps(found, allow_nan=False)
    assert found["simulated"] is True
    for name in ("nail.csv", "nail_pairs.csv", "nail_ablation.csv"):
        assert all(row["simulated"] == 1 for row in read_csv(folder / name))


def test_the_table_has_every_condition_of_every_test_beside_the_papers(ran: tuple[Path, dict[str, Any], list[float]]) -> None:
    rows = {(row["test"], row["condition"]): row for row in ran[1]["rows"] if row["method"] == PUBLISHED}
    assert set(rows) == {(test, condition) for test in TESTS for condition in CONDITIONS}
    for (test, condition), row in rows.items():
        assert row["paper"] == (AROUND.get(test, {}) | ACCURACY[test]).get(condition)
        if row["paper"] is not None:
            assert bool(row["within"]) == (abs(row["percent"] - row["paper"]) <= row["deviation"])


def test_the_sentence_is_the_tables(ran: tuple[Path, dict[str, Any], list[float]]) -> None:
    folder, found, _ = ran
    table, pairs = read_csv(folder / "nail.csv"), read_csv(folder / "nail_pairs.csv")
    assert (folder / "nail.txt").read_text().splitlines()[0] == sentence(table, pairs) == found["sentence"]
    known = [row for row in table if row["paper"] is not None]
    assert len(known) == 16 + 3 and f" of {len(known)} accuracies" in found["sentence"]
    for row in known:
        row.update(percent=row["paper"], within=1)
    assert "are not" not in sentence(table, pairs) and "19 of 19" in sentence(table, pairs)


def test_the_papers_pairs_are_pairs(ran: tuple[Path, dict[str, Any], list[float]]) -> None:
    assert {test: len(pairs) for test, pairs in DIFFERING.items()} == {"edges4": 8, "pins6": 4, "edges12": 15}
    pairs = ran[1]["pairs"]
    assert len(pairs) == 3 * 36
    for test, printed in DIFFERING.items():
        assert sum(row["paper"] for row in pairs if row["test"] == test) == len(printed)


def test_every_term_is_one_of_the_scene() -> None:
    changed = [name for without in TERMS.values() for name in without]
    assert set(changed) == set(vars(Scene())) - {"drive_hz", "range_g", "range_dps"}


def test_leaving_nothing_out_changes_nothing_and_the_turn_counts() -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(nail_ablation, "TERMS", {term: TERMS[term] for term in (NOTHING, "scatter of the turn")})
        rows = ablate(Protocol(participants=6, training=5, rounds=3, samples=128))
    assert all(row.change == 0.0 and not row.counts for row in rows if row.term == NOTHING)
    turned = {row.test: row for row in rows if row.term != NOTHING and row.method == "AxAyAzGxGyGz"}
    assert turned["edges4"].counts and turned["edges4"].change > 10
    # A pin has no direction, so its accuracy cannot change but for the draws.
    assert turned["pins6"].change == pytest.approx(0.0, abs=3 * turned["pins6"].error + 1)
    assert np.isfinite([row.error for row in rows]).all()
