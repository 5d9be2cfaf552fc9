"""The chart of contacts: what is measured is what it says, and its sentence holds nothing that its table does not."""

import itertools
import json
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from skinfab.bench import force, force_ablation, force_touch
from skinfab.bench.flatten import read_csv, write_csv
from skinfab.bench.force_chart import draw
from skinfab.cli.main import main
from skinfab.fingertip.force.contact import LEAST_FORCE_N, locate


@pytest.fixture(scope="module")
def rows() -> list[force.Row]:
    return force.measure(contacts=600, repeats=1)


@pytest.fixture(scope="module")
def events() -> list[force.Events]:
    return force.judge_events(grasps=3, spreads=(0.0, 0.1))


def test_contacts_without_noise_or_roll_are_exact(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(force, "ROLL_MM_S", 0.0)
    monkeypatch.setattr("skinfab.fingertip.force.wrench.SensorNoise.averaged", lambda self, n: type(self)(0.0, 0.0))
    point, f, m = force.rolling_contacts(100, average=7, seed=0)
    np.testing.assert_allclose(locate(f, m, least_force=0.0).point, point, atol=1e-9)


def test_a_gate_rejects_more_and_leaves_less_error(rows: list[force.Row]) -> None:
    one = [row for row in rows if row.average == 1]
    assert [row.gate_n for row in one] == list(force.GATES_N)
    assert all(a.rejected <= b.rejected and a.error_p95_mm >= b.error_p95_mm for a, b in itertools.pairwise(one))
    assert one[0].rejected == 0 and one[-1].rejected == pytest.approx(np.log(20) / np.log(100), abs=0.08)


def test_a_long_average_is_late_and_a_short_one_noisy(rows: list[force.Row]) -> None:
    at = {row.average: row.error_p95_mm for row in rows if row.gate_n == LEAST_FORCE_N}
    assert at[force.DEFAULT] < min(at[1], at[50])


def test_events_here_are_better_than_by_the_plain_rule(events: list[force.Events]) -> None:
    by = {(row.rule, row.friction_spread, row.kind): row for row in events}
    assert by["here", 0.1, "all"].precision > by["published", 0.1, "all"].precision


def test_the_sentence_and_the_chart_come_from_the_table(rows: list, events: list, tmp_path: Path) -> None:
    write_csv(rows, tmp_path / "a.csv")
    write_csv(events, tmp_path / "b.csv")
    table, judged = read_csv(tmp_path / "a.csv"), read_csv(tmp_path / "b.csv")
    for row in table:
        if (row["average"], row["gate_n"]) == (force.DEFAULT, LEAST_FORCE_N):
            row["error_median_mm"] = 12.34
    said = force.sentence(table, judged)
    assert "12.34 mm" in said and "simulated" in said
    draw(table, judged, tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_the_command_writes_every_table(
    rows: list, events: list, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(force, "measure", lambda **_: rows)
    monkeypatch.setattr(force, "judge_events", lambda **_: events)
    monkeypatch.setattr(force_ablation, "motions_without", partial(force_ablation.motions_without, grasps=1))
    some = {"all defects": force_touch.DEFECTS["all defects"]}
    monkeypatch.setattr(force_touch, "measure", partial(force_touch.measure, defects=some, touches=(6,), sensors=1))
    assert main(["force", "bench", "contact", "-o", str(tmp_path / "out"), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["simulated"] and said["contact"]["touches"][0]["touches"] == 6 and len(said["contact"]["events"]) == len(events)
    names = ("force.csv", "force.png", "force.txt", "force_ablation.csv", "force_events.csv", "force_touches.csv")
    assert sorted(Path(each).name for each in said["files"]) == sorted(each.name for each in (tmp_path / "out").iterdir()) == list(names)
    assert {row["without"] for row in read_csv(tmp_path / "out" / "force_ablation.csv")} == set(force_ablation.MOTION_TERMS)
