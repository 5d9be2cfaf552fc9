import json
import re
from pathlib import Path

import numpy as np
import pytest

from skinfab.bench.disks import LEAST, bumpy_cap
from skinfab.bench.flatten import read_csv
from skinfab.bench.simplify import SHARES, measure_shares, run, sentence
from skinfab.bench.simplify_chart import draw, why
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import measure
from skinfab.flatten.simplified import SHARE

DISK = bumpy_cap(3000)


def row(share: int, seconds: float, mean_d: float, *, carried: bool = True, effect: float = 1e-4) -> dict[str, object]:
    return {
        "triangles": 6000,
        "share": share,
        "solved": 6000 // share,
        "carried": int(carried and share > 1),
        "seconds": seconds,
        "mean_d": mean_d,
        "effect": effect,
        "peak_mb": 10.0 * seconds,
        "repeats": 1,
    }


def test_a_row_for_every_share_and_what_is_promised_is_kept() -> None:
    rows = measure_shares([DISK], repeats=1)
    assert [r.share for r in rows] == list(SHARES) and {r.triangles for r in rows} == {len(DISK[1])}
    least = measure(*DISK, flatten_isometric(*DISK)).mean
    assert rows[0].mean_d == pytest.approx(least, abs=1e-9) and not rows[0].carried
    assert all(r.solved <= r.triangles / r.share if r.carried else r.solved == r.triangles for r in rows)
    assert all(r.mean_d - least <= r.effect + 1e-5 for r in rows)
    assert next(r for r in rows if r.share == SHARE).carried


def test_the_shares_take_turns_and_the_least_time_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter(np.arange(len(SHARES) * 2, 0, -1.0))
    monkeypatch.setattr("skinfab.bench.simplify.timed", lambda work: (work(), next(clock), 5.0))
    monkeypatch.setattr("skinfab.bench.simplify.ENOUGH_S", 13.5)
    rows = measure_shares([bumpy_cap(1000)], repeats=2)
    assert [r.repeats for r in rows] == [1, 2, 2, 2, 2, 2, 2]  # the first has used its time
    assert rows[1].seconds == 7.0


def test_run_writes_a_table_a_chart_and_a_sentence_from_the_table(tmp_path: Path) -> None:
    seen: list[float] = []
    found = run(tmp_path, sizes=[300, 3000], repeats=1, progress=lambda fraction, label: seen.append(fraction))
    assert sorted(p.name for p in tmp_path.iterdir()) == ["simplify.csv", "simplify.png", "simplify.txt"]
    table = read_csv(tmp_path / "simplify.csv")
    assert (tmp_path / "simplify.txt").read_text().splitlines() == [sentence(table), *found["notes"]]
    assert found["sentence"] == sentence(table) and found["rows"] == table
    assert (tmp_path / "simplify.png").read_bytes().startswith(b"\x89PNG")
    assert seen == sorted(seen) and 0 <= seen[0] and seen[-1] <= 1
    json.dumps(found, allow_nan=False)


def test_the_sentence_says_what_the_table_holds() -> None:
    table = [row(1, 2.0, 4.02, effect=0.0), row(4, 1.5, 4.02001), row(SHARE, 1.0, 4.02003, effect=2e-4), row(64, 3.0, 4.02, carried=False)]
    said = sentence(table)
    assert (
        f"one triangle in {SHARE}: at 6000 triangles that takes 0.50 of what all take (2 s), for a mean d of 4.02003 instead of 4.02000"
        in said
    )
    assert "one in 4 takes 0.75, d +1e-05; one in 64 takes 1.50, as it is not good enough" in said
    assert said.endswith("memory rises by 10 MB (all: 20 MB).") and len(re.findall(r"\. ", said)) == 0
    assert (
        sentence([row(1, 2.0, 4.02)]) == f"At 6000 triangles one in {SHARE} is too few to be carried: all of them are solved for, in 2 s."
    )


def test_the_smallest_disk_there_is_has_a_chart_too(tmp_path: Path) -> None:
    table = [vars(row) for row in measure_shares([bumpy_cap(LEAST)], repeats=1)]
    draw(table, tmp_path / "a.png")
    assert why(table).startswith("one in 16, where the time stops falling: ")
