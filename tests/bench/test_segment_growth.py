"""How the time for seams grows: a row for each method and size, a chart of them, and an end to what would take too long."""

from pathlib import Path

import numpy as np
import pytest

from skinfab.bench.contestants import Contestant, Flat
from skinfab.bench.segment import AIMS, PEER, Row
from skinfab.bench.segment_growth import draw_growth, expected, follow, growth_sentence

#: What it makes has no meaning: each triangle's corners, beside those of all others.
PEER_STAND_IN = Contestant(PEER, "peer", lambda V, F: lambda: Flat(F, V[:, :2], np.arange(len(V))))


def row(triangles: int, seconds: float, *, method: str = "fewest", peak_mb: float = 50.0) -> Row:
    return Row(f"ball {triangles}", triangles, method, 4.05, 1, 2.0, 4.04, 4.3, 5.0, 0, 0.0, seconds, peak_mb, 1)


def test_every_method_on_every_size(tmp_path: Path) -> None:
    rows, notes = follow(tmp_path, [600, 300], None)
    assert notes == [] and [(r["method"], r["object"]) for r in rows] == [(aim, f"ball {n}") for n in (300, 600) for aim in AIMS]
    assert all(abs(r["triangles"] / int(r["object"].split()[1]) - 1) < 0.1 for r in rows)
    assert all(r["mean_d"] <= 4.05 and r["overlap_mm2"] == 0 == r["flipped"] and r["seconds"] > 0 for r in rows)
    assert (tmp_path / "growth.csv").read_text(encoding="utf-8").count("\n") == 1 + len(rows)


def test_what_would_take_too_long_is_left_out_and_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []

    def measured(objects, peer, *, aims, bounds, repeats, progress):  # type: ignore[no-untyped-def]
        [(name, mesh)] = objects
        asked.append((name, *aims, *([] if peer is None else [peer.name])))
        # The peer's time grows with the square of the triangles, the others' with their root.
        s = {PEER: 1e-6 * len(mesh.F) ** 2}
        return [row(len(mesh.F), s.get(m, 0.01 * len(mesh.F) ** 0.5), method=m) for m in asked[-1][1:]], []

    monkeypatch.setattr("skinfab.bench.segment_growth.measure_objects", measured)
    rows, notes = follow(tmp_path, [200, 800, 3200, 7200], PEER_STAND_IN, longest_s=8.0)
    assert asked == [*((f"ball {n}", *AIMS, PEER) for n in (200, 800)), *((f"ball {n}", *AIMS) for n in (3200, 7200))]
    assert notes == [f"{PEER} was left out from 3200 triangles on: by its growth it would have taken 10 s there"]
    assert [r["triangles"] for r in rows if r["method"] == PEER] == [200, 800]


def test_what_a_size_will_take_goes_by_the_last_two() -> None:
    assert expected([], 500) == 0
    assert expected([row(100, 2.0)], 300) == pytest.approx(6.0)
    assert expected([row(10, 99.0), row(100, 1.0), row(200, 4.0)], 400) == pytest.approx(16.0)


def test_the_sentence_is_the_table() -> None:
    table = [vars(row(1000, 1.0)), vars(row(4000, 4.0, peak_mb=120.0)), {**vars(row(1000, 3.0, method=PEER)), "peak_mb": None}]
    assert growth_sentence(table) == (
        "On a ball with bumps, at mean d 4.05, fewest takes 4 s and 120 MB for 4000 triangles, growing with the triangles to the power of "
        "1.00; xatlas takes 3 s for 1000 triangles."
    )


def test_the_chart_shows_what_the_table_says(tmp_path: Path) -> None:
    from matplotlib.image import imread

    one = vars(row(1000, 1.0))
    draw_growth([one, vars(row(4000, 5.0))], tmp_path / "a.png")
    draw_growth([one, vars(row(4000, 9.0))], tmp_path / "b.png")
    draw_growth([one, vars(row(4000, 5.0, peak_mb=90.0))], tmp_path / "c.png", notes=["something was left out"])
    a, b, c = (imread(tmp_path / f"{name}.png") for name in "abc")
    assert a.shape == b.shape and a.shape[0] > 300
    left, right = np.s_[:, : int(0.45 * a.shape[1])], np.s_[:, a.shape[1] // 2 :]  # time, memory
    assert np.abs(a - b)[left].max() > 0.5 and not np.abs(a - b)[right].any()
    assert np.abs(a - c)[right].max() > 0.5
