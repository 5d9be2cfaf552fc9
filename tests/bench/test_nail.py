"""The three tests as a bench: what is written, that the sentence is the tables', and that each term of the simulator is for something."""

import json
from pathlib import Path
from typing import Any

import pytest

from skinfab.bench import nail, nail_ablation, nail_confidence, nail_force
from skinfab.bench.flatten import read_csv
from skinfab.bench.nail import FULL, IMPROVED, PUBLISHED, run, sentence
from skinfab.bench.nail_ablation import NOTHING, TERMS, ablate
from skinfab.fingertip.nail.paper import ACCURACY, AROUND, DIFFERING
from skinfab.fingertip.nail.patterns import EDGES4, PINS6
from skinfab.fingertip.nail.protocol import Protocol
from skinfab.fingertip.nail.published import CONDITIONS
from skinfab.fingertip.nail.simulator import Scene

TEST = "edges4"
SMALL = Protocol(participants=3, training=3, rounds=3, estimates=1, samples=64)


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any], list[float]]:
    folder = tmp_path_factory.mktemp("nail")
    seen: list[float] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(nail_ablation, "TERMS", {term: TERMS[term] for term in (NOTHING, "scatter of the turn")})
        for module in (nail, nail_ablation):  # one of the three, as the others take the same way at ten times the cost
            patch.setattr(module, "TESTS", {TEST: EDGES4})
        found = run(folder, repeats=1, protocol=SMALL, progress=lambda fraction, label: seen.append(fraction))
    return folder, found, seen


def test_tables_charts_and_a_sentence_are_written(ran: tuple[Path, dict[str, Any], list[float]]) -> None:
    folder, found, seen = ran
    charts = ["nail.png", f"nail_confusion_{TEST}.png", "nail_confidence.png", "nail_window.png"]
    assert {p.name for p in folder.iterdir()} >= {
        "nail.csv",
        "nail_pairs.csv",
        "nail_ablation.csv",
        "nail_confusion.csv",
        "nail_force.csv",
        "nail_confidence.csv",
        "nail.txt",
        *charts,
    }
    assert all((folder / name).read_bytes().startswith(b"\x89PNG") for name in charts)
    assert seen == sorted(seen) and 0 <= seen[0] and seen[-1] <= 1
    json.dumps(found, allow_nan=False)
    assert found["simulated"] is True
    for name in ("nail.csv", "nail_pairs.csv", "nail_ablation.csv", "nail_force.csv", "nail_confidence.csv"):
        assert all(row["simulated"] == 1 for row in read_csv(folder / name))


def test_the_table_has_every_condition_beside_the_papers(ran: tuple[Path, dict[str, Any], list[float]]) -> None:
    rows = {(row["test"], row["condition"]): row for row in ran[1]["rows"] if row["method"] == PUBLISHED}
    assert set(rows) == {(TEST, condition) for condition in CONDITIONS}
    for (test, condition), row in rows.items():
        assert row["paper"] == (AROUND.get(test, {}) | ACCURACY[test]).get(condition)
        if row["paper"] is not None:
            assert bool(row["within"]) == (abs(row["percent"] - row["paper"]) <= row["deviation"])


def test_the_confusion_adds_up_to_the_accuracy(ran: tuple[Path, dict[str, Any], list[float]]) -> None:
    folder, found, _ = ran
    taken = [row for row in read_csv(folder / "nail_confusion.csv") if row["condition"] == FULL]
    right = sum(row["trials"] for row in taken if row["was"] == row["taken_for"])
    percent = next(row["percent"] for row in found["rows"] if row["condition"] == FULL and row["method"] == PUBLISHED)
    assert sum(row["trials"] for row in taken) == SMALL.participants * SMALL.rounds * 4
    assert 100 * right / (SMALL.participants * SMALL.rounds * 4) == pytest.approx(percent)


def test_the_sentence_is_the_tables(ran: tuple[Path, dict[str, Any], list[float]]) -> None:
    folder, found, _ = ran
    table, pairs = read_csv(folder / "nail.csv"), read_csv(folder / "nail_pairs.csv")
    assert (folder / "nail.txt").read_text().splitlines()[0] == found["sentence"]
    windows = (folder / "nail_window.txt").read_text().splitlines()[0]
    forces, sure = nail_force.sentence(found["forces"]), nail_confidence.sentence(found["confidence"])
    assert found["sentence"] == f"{sentence(table, pairs, participants=3)} {forces} {sure} {windows}"
    known = [row for row in table if row["paper"] is not None]
    assert len(known) == 8 and " of 8 accuracies" in found["sentence"]
    for row in known:
        row.update(percent=row["paper"], within=1)
    said = sentence(table, pairs, participants=10)
    assert "are not" not in said and "8 of 8" in said and "around" not in said


def test_the_yardstick_and_what_few_participants_cannot_show_are_said(ran: tuple[Path, dict[str, Any], list[float]]) -> None:
    folder, found, _ = ran
    table, pairs = read_csv(folder / "nail.csv"), read_csv(folder / "nail_pairs.csv")
    widest = max(row["deviation"] for row in table if row["paper"] is not None)
    assert f"(up to {widest:.1f} points)" in found["sentence"]
    assert (
        "3 participants are too few to show which sensor conditions differ" in found["sentence"] and "differ here" not in found["sentence"]
    )
    assert "differ here" in sentence(table, pairs, participants=6)
    table[0]["around"] = 1
    assert '1 of the 8 are only said to be "around 50 %"' in sentence(table, pairs, participants=10)
    # No figure of the paper's, nothing to be within: the improved method's row and that of AxAyAz.
    assert all((row["within"] is None) == (row["paper"] is None) for row in table)
    assert sum(row["within"] is None for row in table) == 2


def test_the_improved_method_is_asked_about_the_same_trials(ran: tuple[Path, dict[str, Any], list[float]]) -> None:
    improved = [row for row in ran[1]["rows"] if row["method"] == IMPROVED]
    assert [(row["test"], row["condition"], row["paper"]) for row in improved] == [(TEST, FULL, None)]
    published = next(row for row in ran[1]["rows"] if row["method"] == PUBLISHED and row["condition"] == FULL)
    assert improved[0]["percent"] > published["percent"] + 3


def test_the_papers_pairs_are_pairs(ran: tuple[Path, dict[str, Any], list[float]]) -> None:
    assert {test: len(pairs) for test, pairs in DIFFERING.items()} == {"edges4": 8, "pins6": 4, "edges12": 15}
    pairs = ran[1]["pairs"]
    assert len(pairs) == 36 and sum(row["paper"] for row in pairs) == len(DIFFERING[TEST])
    assert all(each <= set(CONDITIONS) and len(each) == 2 for printed in DIFFERING.values() for each in printed)


def test_every_term_is_one_of_the_scene() -> None:
    changed = [name for without in TERMS.values() for name in without]
    assert set(changed) == set(vars(Scene())) - {"drive_hz", "force_n", "range_g", "range_dps"}


def test_leaving_nothing_out_changes_nothing_and_the_place_counts() -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(nail_ablation, "TERMS", {term: TERMS[term] for term in (NOTHING, "scatter of the turn", "scatter of the place")})
        patch.setattr(nail_ablation, "TESTS", {"pins6": PINS6})
        rows = {(row.term, row.method): row for row in ablate(Protocol(participants=8, training=5, rounds=3, samples=128))}
    # A pin has no direction to be turned in.
    assert all(row.change == 0.0 and not row.counts for (term, _), row in rows.items() if term != "scatter of the place")
    placed = rows["scatter of the place", "AxAyAz"]
    assert placed.counts and placed.change > 10 and placed.percent > 95
