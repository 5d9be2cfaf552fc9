"""The measurement of automatic seams: a result is judged by itself, the same way whoever made it, and sentence and chart say the table."""

import json
from pathlib import Path

import numpy as np
import pytest
import shapes

from skinfab.bench import segment
from skinfab.bench.contestants import Contestant, Flat
from skinfab.bench.flatten import read_csv
from skinfab.bench.segment import AIMS, PEER, as_flat, judged, measure_objects, mesh_files, run
from skinfab.bench.segment_words import sentence
from skinfab.errors import InputError, RefusedError
from skinfab.mesh.model import Mesh
from skinfab.seams.auto import Seams, find_seams
from skinfab.seams.cut import seam_length
from skinfab.seams.finish import finish
from skinfab.seams.judge import Limits

CUBE = Mesh(*shapes.cube(1), "cube")


def shattered(V: np.ndarray, F: np.ndarray) -> Flat:
    """Every triangle by itself, in its own plane, all on one spot and turned over: what a peer may come with."""
    a, b, c = (V[F[:, k]] for k in range(3))
    x = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
    n = np.cross(b - a, c - a)
    y = np.cross(n / np.linalg.norm(n, axis=1)[:, None], x)
    UV = np.stack([np.stack([((p - a) * axis).sum(axis=1) for axis in (x, -y)], axis=1) for p in (a, b, c)], axis=1)
    return Flat(np.arange(3 * len(F)).reshape(-1, 3), 7 * UV.reshape(-1, 2), F.ravel())


PEER_STAND_IN = Contestant(PEER, "peer", lambda V, F: lambda: shattered(V, F))


def test_what_is_judged_anew_is_what_the_seams_say() -> None:
    V, F = shapes.sphere(2)
    mesh = Mesh(9 * V + np.sin(2 * V[:, :1]), F)
    seams = finish(mesh, find_seams(mesh, Limits()), Limits())
    flat = as_flat(mesh, seams)
    np.testing.assert_array_equal(flat.origin[flat.F], mesh.F)
    row = judged("ball", mesh, "usual", 4.05, flat, [3.0, 2.0])
    assert row.pieces == len(seams.pieces) and (row.seconds, row.repeats) == (2.0, 2)
    assert row.seam == pytest.approx(seam_length(mesh, seams.cut) / np.sqrt(mesh.area), rel=1e-12)
    area = [mesh.face_areas[piece.faces].sum() for piece, _ in seams.pieces]
    assert row.mean_d == pytest.approx(np.average([v.distortion.mean for _, v in seams.pieces], weights=area), abs=1e-6)
    assert row.mean_d <= row.p99_d <= row.max_d and row.flipped == 0 == row.overlap_mm2


def test_pieces_on_top_of_each_other_turned_over_and_scaled_are_no_worse_for_it() -> None:
    row = judged("cube", CUBE, PEER, np.nan, shattered(CUBE.V, CUBE.F), [1.0])
    assert row.pieces == len(CUBE.F) and row.flipped == 0 and row.overlap_mm2 == 0
    assert row.mean_d == pytest.approx(4, abs=1e-9)
    assert row.seam == pytest.approx(CUBE.edge_lengths.sum() / np.sqrt(CUBE.area), rel=1e-12)


def test_a_boundary_of_the_mesh_is_no_seam() -> None:
    V, F = shapes.grid(4, 3)
    row = judged("square", Mesh(V, F), "usual", 4.05, Flat(F, V[:, :2], np.arange(len(V))), [1.0])
    assert row.seam == 0 and row.pieces == 1


def test_run_writes_a_table_a_chart_and_a_sentence_from_the_table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(segment, "mesh_files", lambda given: given)
    monkeypatch.setattr(segment, "contestants", lambda: [PEER_STAND_IN])
    mesh = tmp_path / "box.obj"
    mesh.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in 20 * CUBE.V) + "".join(f"f {a} {b} {c}\n" for a, b, c in CUBE.F + 1))
    out, seen = tmp_path / "out", []
    out.mkdir()
    found = run(out, meshes=[mesh], repeats=1, progress=lambda fraction, label: seen.append(fraction))
    assert sorted(p.name for p in out.iterdir()) == ["segment.csv", "segment.png", "segment.txt"]
    table = read_csv(out / "segment.csv")
    assert found["rows"] == table and (out / "segment.txt").read_text().splitlines() == [sentence(table), *found["notes"]]
    assert [(r["method"], r["bound"]) for r in table] == [(aim, b) for b in segment.BOUNDS for aim in AIMS] + [(PEER, None)]
    assert all(r["mean_d"] <= r["bound"] for r in table[:-1])
    assert (out / "segment.png").read_bytes().startswith(b"\x89PNG")
    assert seen == sorted(seen) and 0 <= seen[0] and seen[-1] <= 1
    json.dumps(found, allow_nan=False)


def test_a_peer_that_is_not_there_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(segment, "contestants", lambda: [Contestant(PEER, "peer", PEER_STAND_IN.prepare, "no_such_module")])
    monkeypatch.setattr(segment, "mesh_files", lambda given: [Path("cube.obj")])
    monkeypatch.setattr(segment, "load_usable", lambda file, mend: type("Loaded", (), {"mesh": CUBE}))
    monkeypatch.setattr(segment, "BOUNDS", (4.05,))
    found = run(tmp_path, repeats=1)
    assert found["notes"] == ["xatlas is not installed here and was left out; pip install xatlas adds it"]
    assert {row["method"] for row in found["rows"]} == set(AIMS)


def test_what_is_refused_is_told_once_and_the_rest_is_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    def refusing(mesh: Mesh, aim: str, limits: Limits) -> Seams:
        if aim == "fewest":
            raise RefusedError("too rough")
        return find_seams(mesh, limits)

    monkeypatch.setattr(segment, "_seams", refusing)
    rows, refused = measure_objects([("cube", CUBE)], None, bounds=(4.05,), repeats=2)
    assert refused == ["cube: fewest at 4.05 was refused: too rough"]
    assert [(r.method, r.repeats) for r in rows] == [("usual", 2)]


def test_the_sentence_is_about_objects_that_all_have() -> None:
    def row(name: str, method: str, bound: float | None, pieces: int, seam: float) -> dict[str, object]:
        return {"object": name, "method": method, "bound": bound, "pieces": pieces, "seam": seam, "mean_d": 4.01, "seconds": 1.5}

    table = [
        row("a", "usual", 4.05, 2, 3.0),
        row("a", "usual", 4.2, 1, 1.0),
        row("b", "usual", 4.05, 9, 9.0),
        row("a", "fewest", 4.05, 1, 2.5),
        row("a", PEER, None, 7, 6.0),
        row("b", PEER, None, 8, 6.0),
    ]
    assert sentence(table) == (
        "The default, usual pieces at mean d 4.05, makes 2 pieces of 1 object, 3.00 of seam over the root of the area on average, "
        "mean d 4.010 to 4.010, in 1.5 s; fewest makes 1 piece of 1 object, 2.50 of seam over the root of the area on average, "
        "mean d 4.010 to 4.010, in 1.5 s; xatlas makes 7 pieces of 1 object, 6.00 of seam over the root of the area on average, "
        "mean d 4.010 to 4.010, in 1.5 s."
    )


def test_nothing_to_measure_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(segment, "__file__", str(tmp_path / "a" / "b" / "segment.py"))
    with pytest.raises(InputError, match="name mesh files with --meshes"):
        mesh_files()
    assert mesh_files([Path("x.obj"), Path("x.obj")]) == [Path("x.obj")]
