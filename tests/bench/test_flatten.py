import itertools
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skinfab.bench import contestants as table_of
from skinfab.bench.contestants import Contestant, Flat, contestants
from skinfab.bench.disks import bumpy_cap
from skinfab.bench.flatten import judge, measure_methods, read_csv, run
from skinfab.bench.refinement import MOST_STEPS, follow
from skinfab.bench.words import sentence
from skinfab.flatten.bff import flatten_scaled

V, F = bumpy_cap(300)
PRESENT = [c for c in contestants() if c.present]


@pytest.mark.parametrize("c", PRESENT, ids=lambda c: c.name)
def test_everybody_lays_the_disk_flat(c: Contestant) -> None:
    row = judge(c, V, F, c.prepare(V, F)(), 1.0, 1.0, 1.0, 1)
    assert row.triangles == len(F) and row.flipped == 0 and 4 <= row.mean_d < 4.5
    assert row.overlap_mm2 == pytest.approx(0, abs=1e-6)
    assert row.usable == (row.pieces == 1)


def test_results_are_judged_right_side_up_and_at_their_best_scale() -> None:
    uv = flatten_scaled(V, F)
    same = np.arange(len(V))
    plain, mirrored = (judge(PRESENT[0], V, F, Flat(F, uv * by, same), 1.0, 1.0, 1.0, 1) for by in ([1.0, 1.0], [-0.01, 0.01]))
    assert mirrored.mean_d == pytest.approx(plain.mean_d, rel=1e-12) and mirrored.usable


def test_flips_and_overlap_are_not_usable() -> None:
    uv = flatten_scaled(V, F)
    inner = int(np.argmin(np.linalg.norm(V[:, :2], axis=1)))
    uv[inner] += [200, 0]
    row = judge(PRESENT[0], V, F, Flat(F, uv, np.arange(len(V))), 1.0, 1.0, 1.0, 1)
    assert row.flipped > 0 and not row.usable


def test_the_methods_take_turns_and_the_least_time_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[str] = []

    def contestant(name: str) -> Contestant:
        def work() -> Flat:
            calls.append(name)
            return Flat(F, V[:, :2], np.arange(len(V)))

        return Contestant(name, "ours", lambda V, F: work)

    seconds = iter([(3.0, 3.5), (6.0, 20.0), (1.0, 4.0), (2.0, 2.0)])
    monkeypatch.setattr("skinfab.bench.flatten.timed_twice", lambda work: (work(), *next(seconds), 5.0))
    rows = measure_methods([contestant("a"), contestant("b")], [(V, F)], repeats=3)
    assert calls == ["a", "b", "a", "a"]  # b has used its time
    assert [(r.method, r.seconds, r.wall_s, r.repeats) for r in rows] == [("a", 1.0, 2.0, 3), ("b", 6.0, 20.0, 1)]


def test_refinement_steps_are_those_of_the_default() -> None:
    steps = follow([(V, F)], repeats=2)
    newton = [s for s in steps if s.method == "newton"]
    slim = [s for s in steps if s.method == "slim"]
    assert newton[0].mean_d == slim[0].mean_d
    assert [s.step for s in newton] == list(range(len(newton)))
    assert all(a.mean_d > b.mean_d for a, b in itertools.pairwise(newton)) and len(slim) <= MOST_STEPS + 1
    whole = next(c for c in PRESENT if c.name == table_of.DEFAULT)
    assert newton[-1].mean_d == pytest.approx(judge(whole, V, F, whole.prepare(V, F)(), 1.0, 1.0, 1.0, 1).mean_d, abs=1e-6)


def test_run_writes_tables_charts_and_a_sentence_from_the_tables(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    few = [c for c in PRESENT if c.name in ("bff", "isometric", "slim", "igl.lscm")]
    away = replace(few[-1], name="somebody", needs="no_such_module")
    monkeypatch.setattr("skinfab.bench.flatten.contestants", lambda: [*few, away])
    seen: list[float] = []
    found = run(tmp_path, sizes=[300, 600], repeats=1, progress=lambda fraction, label: seen.append(fraction))
    assert sorted(p.name for p in tmp_path.iterdir()) == ["flatten.csv", "flatten.png", "flatten.txt", "refine.csv", "refine.png"]
    header = (tmp_path / "flatten.csv").read_text().splitlines()[0]
    assert header.startswith("method,kind,triangles,seconds,wall_s,mean_d,max_d,flipped,overlap_mm2,")
    rows, refinement = read_csv(tmp_path / "flatten.csv"), read_csv(tmp_path / "refine.csv")
    assert [(r["method"], r["triangles"]) for r in rows] == [(c.name, n) for n in (294, 600) for c in few]
    text = (tmp_path / "flatten.txt").read_text()
    assert text == sentence(rows, refinement) + "\nsomebody is left out: the module no_such_module is not installed\n"
    assert found["notes"] == text.splitlines()[1:]
    assert all((tmp_path / name).read_bytes().startswith(b"\x89PNG") for name in ("flatten.png", "refine.png"))
    assert seen == sorted(seen) and 0 <= seen[0] and seen[-1] <= 1
    json.dumps(found, allow_nan=False)


def test_no_number_is_read_as_none(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("method,peak_mb,pieces,mean_d\nbff,nan,1,4.5\n")
    assert read_csv(tmp_path / "a.csv") == [{"method": "bff", "peak_mb": None, "pieces": 1, "mean_d": 4.5}]
