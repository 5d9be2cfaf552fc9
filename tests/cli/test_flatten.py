"""`skinfab flatten`: every method, on what it can flatten, and a sentence where it cannot."""

import json
from pathlib import Path

import numpy as np
import pytest
import results
import shapes

from skinfab.bench.disks import bumpy_cap
from skinfab.cli.flatten import NAMES
from skinfab.cli.main import main
from skinfab.flatten.methods import METHODS

ROOT = Path(__file__).parents[2]
CUBE = str(ROOT / "meshes/cube.obj")


def written(folder: Path, V: np.ndarray, F: np.ndarray) -> str:
    path = folder / "mesh.obj"
    lines = ["v {:.17g} {:.17g} {:.17g}".format(*v) for v in V.tolist()] + ["f {} {} {}".format(*f) for f in (F + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")
    return str(path)


def test_the_names_are_those_of_the_table() -> None:
    assert set(NAMES) == {"auto", "bff-cones", *METHODS}


@pytest.mark.parametrize("method", ["auto", *METHODS])
def test_each_method_on_a_disk(method: str, tmp_path: Path) -> None:
    V, F = shapes.cap(8, 0.8)
    mesh = written(tmp_path, V * 30, F)
    assert main(["flatten", mesh, "-o", str(tmp_path / "flat.obj"), "--method", method, "--json", str(tmp_path / "flat.json")]) == 0
    figures = json.loads((tmp_path / "flat.json").read_text())
    mean, flipped = results.distortion(*results.read_flat_obj(tmp_path / "flat.obj"))
    assert mean == pytest.approx(figures["distortion"]["mean"], abs=1e-6) and flipped == 0
    assert figures["distortion"]["mean_at_kept_area"] >= figures["distortion"]["mean"] - 1e-6
    best = 4.02 if method in ("auto", "isometric", "slim", "arap") else 4.6
    assert mean < best


@pytest.mark.parametrize(("cones", "mean"), [("8", 4.0), ("auto", 4.0), ("0,1,2,3,4,5,6,7", 4.0)])
def test_cones(cones: str, mean: float, tmp_path: Path) -> None:
    assert main(["flatten", CUBE, "-o", str(tmp_path / "o.obj"), "--method", "bff-cones", "--cones", cones]) == 0
    assert results.distortion(*results.read_flat_obj(tmp_path / "o.obj"))[0] == pytest.approx(mean, abs=1e-6)


@pytest.mark.parametrize("method", ["auto", *METHODS])
def test_holes_and_components_one_by_one(method: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Two flat plates, one with two holes: both stay as they are, and nothing is cut."""
    V, F = shapes.holed()
    W, G = shapes.grid(4, 4)
    mesh = written(tmp_path, np.vstack([5 * V, 20 * W + [0, 0, 30]]), np.vstack([F, G + len(V)]))
    assert main(["flatten", mesh, "-o", str(tmp_path / "o.obj"), "--method", method, "--json", str(tmp_path / "f.json")]) == 0
    assert "cut automatically" not in capsys.readouterr().err
    figures = json.loads((tmp_path / "f.json").read_text())
    assert [p["n_faces"] for p in figures["pieces"]] == [len(F), len(G)]
    exact = 2.0 if method == "harmonic" else 1e-6
    assert figures["distortion"]["mean"] == pytest.approx(4, abs=exact)
    assert figures["distortion"]["mean_at_kept_area"] == pytest.approx(4, abs=exact)


def tube(columns: int = 24, rows: int = 10) -> tuple[np.ndarray, np.ndarray]:
    """A cylinder open at both ends: a disk with a hole, which only a cut lays flat."""
    V, F = shapes.cylinder_sheet(columns, rows, radius=20, height=60)
    v = np.arange(len(V)).reshape(rows + 1, columns + 1)
    v[:, -1] = v[:, 0]
    used, local = np.unique(v.ravel()[F], return_inverse=True)
    return V[used], local.reshape(-1, 3)


def test_auto_cuts_a_hole_open_only_where_it_would_stretch_too_far(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mesh = written(tmp_path, *tube())
    assert main(["flatten", mesh, "-o", str(tmp_path / "i.obj"), "--method", "isometric"]) == 0
    assert results.distortion(*results.read_flat_obj(tmp_path / "i.obj"))[0] > 4.5
    assert main(["flatten", mesh, "-o", str(tmp_path / "o.obj")]) == 0
    assert "cut automatically" in capsys.readouterr().err
    assert results.distortion(*results.read_flat_obj(tmp_path / "o.obj"))[0] == pytest.approx(4, abs=1e-3)


def test_simplifying_leaves_holes_alone(tmp_path: Path) -> None:
    V, F = shapes.holed()
    mesh = written(tmp_path, 5 * V, F)
    assert main(["flatten", mesh, "-o", str(tmp_path / "o.obj"), "--simplify", "auto"]) == 0
    assert results.distortion(*results.read_flat_obj(tmp_path / "o.obj"))[0] == pytest.approx(4, abs=1e-6)


def test_auto_cuts_what_is_closed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["flatten", CUBE, "-o", str(tmp_path / "o.obj")]) == 0
    assert "cut automatically" in capsys.readouterr().err
    V, UV, F, FT = results.read_flat_obj(tmp_path / "o.obj")
    assert results.distortion(V, UV, F, FT)[0] == pytest.approx(4) and results.overlap(UV, FT) < 1e-6


def test_auto_leaves_a_disk_whole_and_says_when_it_is_bent_too_far(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    V, F = shapes.cap(8, 2.0)
    assert main(["flatten", written(tmp_path, V * 30, F), "-o", str(tmp_path / "o.obj")]) == 0
    captured = capsys.readouterr()
    assert "1 piece by" in captured.out and "more than a skin stands" in captured.err


@pytest.mark.parametrize(
    ("words", "status", "says"),
    [
        (["--method", "bff"], 1, "only a disk can be flattened"),
        (["--method", "slim"], 1, "only a disk can be flattened"),
        (["--method", "bff-cones", "--cones", "99,"], 1, "cone vertex 99 does not exist"),
        (["--method", "bff-cones", "--cones", "0,"], 1, "at least two cones"),
        (["--method", "bff-cones", "--cones", "none"], 2, "neither auto, nor a number"),
        (["--cones", "8"], 2, "goes with --method bff-cones"),
        (["--method", "magic"], 2, "magic"),
    ],
)
def test_what_cannot_be_done(words: list[str], status: int, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["flatten", CUBE, "-o", str(tmp_path / "o.obj"), *words]) == status
    assert says in capsys.readouterr().err.splitlines()[-1]
    assert not (tmp_path / "o.obj").exists()


def test_flips_and_overlap_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    V, F = shapes.random_disk(5, 100, 1.0)
    mesh = written(tmp_path, V * 30, F)
    assert main(["flatten", mesh, "-o", str(tmp_path / "o.obj"), "--method", "bff"]) == 3
    assert "turned" in capsys.readouterr().err
    assert not (tmp_path / "o.obj").exists()


@pytest.mark.parametrize("scale", ["1e-6", "1e6"])
def test_units_do_not_matter(scale: str, tmp_path: Path) -> None:
    V, F = shapes.cap(6, 0.8)
    mesh = written(tmp_path, V * 30, F)
    assert main(["flatten", mesh, "-o", str(tmp_path / "o.obj"), "--units", "mm"]) == 0
    assert main(["flatten", mesh, "-o", str(tmp_path / "s.obj"), "--units", "mm", "--scale", scale]) == 0
    plain, scaled = (results.distortion(*results.read_flat_obj(tmp_path / name))[0] for name in ("o.obj", "s.obj"))
    assert scaled == pytest.approx(plain, abs=1e-5)


def test_simplify_says_what_it_did_and_keeps_d(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mesh = written(tmp_path, *bumpy_cap(17_000))
    means = []
    for choice in ("off", "auto"):
        out, figures = tmp_path / f"{choice}.obj", tmp_path / f"{choice}.json"
        assert main(["flatten", mesh, "-o", str(out), "--units", "mm", "--simplify", choice, "--json", str(figures)]) == 0
        mean, flipped = results.distortion(*results.read_flat_obj(out))
        assert flipped == 0
        means.append(mean)
    (said,) = json.loads((tmp_path / "auto.json").read_text())["simplified"]
    assert "simplified" not in json.loads((tmp_path / "off.json").read_text())
    assert means[1] - means[0] <= said["effect"] < 0.002 and 0 < said["n_coarse"] < said["n_faces"] / 15
    assert f"note: flattened on {said['n_coarse']} of {said['n_faces']} triangles; that costs at most" in capsys.readouterr().err


def test_simplify_leaves_what_is_small_and_what_is_cut(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    V, F = shapes.cap(8, 0.8)
    command = ["flatten", written(tmp_path, V * 30, F), "-o", str(tmp_path / "o.obj"), "--method", "isometric", "--simplify", "auto"]
    assert main(command) == 0
    assert f"flattened on all {len(F)} triangles: so few need no simplifying" in capsys.readouterr().err
    assert main(["flatten", CUBE, "-o", str(tmp_path / "o.obj"), "--simplify", "auto"]) == 0
    assert "--simplify has no part in an automatic cut" in capsys.readouterr().err


@pytest.mark.parametrize("method", ["bff", "bff-cones", "lscm", "slim"])
def test_simplify_goes_with_what_minimises_d(method: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["flatten", CUBE, "-o", str(tmp_path / "o.obj"), "--method", method, "--simplify", "auto"]) == 2
    assert (
        f"--simplify auto goes with --method auto or isometric, whose aim is the least d; {method} has another" in capsys.readouterr().err
    )


@pytest.mark.parametrize("method", ["auto", "isometric"])
def test_untangling_is_said(method: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    V, F = shapes.random_disk(0, 100, 0.3)
    command = ["flatten", written(tmp_path, V * 30, F), "-o", str(tmp_path / "flat.obj"), "--units", "mm", "--max-distortion", "100"]
    assert main([*command, "--method", method]) == 0
    notes = [line for line in capsys.readouterr().err.splitlines() if "begun anew" in line]
    assert len(notes) == 1 and notes[0].startswith("note: boundary first flattening turned")


def test_small_holes_are_no_reason_to_cut(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A dome that stretches too far is left whole, with small holes as without; a tube is cut."""
    V, F = shapes.cap(12, 1.5)
    middle = V[F].mean(axis=1)
    away = np.linalg.norm(middle[:, :2] - [0.3, 0.2], axis=1) > 0.12
    used, local = np.unique(F[away], return_inverse=True)
    mesh = written(tmp_path, 30 * V[used], local.reshape(-1, 3))
    assert main(["flatten", mesh, "-o", str(tmp_path / "o.obj")]) == 0
    said = capsys.readouterr()
    assert "cut automatically" not in said.err and "more than a skin stands" in said.err and "1 piece by" in said.out
    assert len(results.read_flat_obj(tmp_path / "o.obj")[1]) == len(used)


def test_a_layout_beyond_use_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """lscm lays a long tube around a point, each ring many times the last: flips as soon as it is written."""
    mesh = written(tmp_path, *tube(48, 14))
    assert main(["flatten", mesh, "-o", str(tmp_path / "o.obj"), "--method", "lscm"]) == 3
    assert "beyond use" in capsys.readouterr().err and not (tmp_path / "o.obj").exists()


@pytest.mark.parametrize(
    ("out", "json_file", "says"),
    [
        ("mesh.obj", None, "is the mesh itself"),
        ("nowhere/o.obj", None, "its folder does not exist"),
        ("o.obj", "nowhere/o.json", "its folder does not exist"),
        ("o.obj", ".", "it is a folder"),
        ("o.obj", "o.obj", "give --json another file"),
        ("o.obj", "mesh.obj", "is the mesh itself"),
    ],
)
def test_places_are_looked_at_first(out: str, json_file: str | None, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mesh = Path(written(tmp_path, *shapes.wavy()))
    before = mesh.read_bytes()
    words = ["--json", str(tmp_path / json_file)] if json_file else []
    assert main(["flatten", str(mesh), "-o", str(tmp_path / out), *words]) == 1
    assert says in capsys.readouterr().err
    assert mesh.read_bytes() == before and list(tmp_path.iterdir()) == [mesh]


def test_figures_say_what_was_flattened_and_how(tmp_path: Path) -> None:
    V, F = shapes.cap(8, 0.8)
    mesh = written(tmp_path, V * 0.03, F)
    assert main(["flatten", mesh, "-o", str(tmp_path / "o.obj"), "--json", str(tmp_path / "o.json"), "--keep-area", "--units", "m"]) == 0
    figures = json.loads((tmp_path / "o.json").read_text())
    assert figures["mesh"]["units"] == "m" and figures["mesh"]["scale"] == 1000 and figures["within"] is True
    (piece,) = figures["pieces"]
    assert piece["area_mm2"] == pytest.approx(piece["area_on_object_mm2"], rel=1e-9)
    assert piece["distortion"]["mean"] == pytest.approx(piece["mean_at_kept_area"], rel=1e-9)
    # The parts are of each triangle; their means multiply to no less than nearly d.
    assert 2 <= piece["angle_mean"] < 2.1 and 2 <= piece["area_mean"] < 2.1
    assert figures["flattened_at_mm"] == 0


def test_a_thickness_says_how_far_outside_it_was_flattened(tmp_path: Path) -> None:
    V, F = shapes.cap(24, 0.8)
    mesh = written(tmp_path, V * 30, F)
    words = ["--units", "mm", "--thickness", "2", "--neutral", "0.4", "--json", str(tmp_path / "o.json")]
    assert main(["flatten", mesh, "-o", str(tmp_path / "o.obj"), *words]) == 0
    figures = json.loads((tmp_path / "o.json").read_text())
    assert figures["flattened_at_mm"] == pytest.approx(0.8)
    # A cap of a sphere of 30 mm, 0.8 mm outside it.
    on_object = sum(piece["area_on_object_mm2"] for piece in figures["pieces"])
    flat = (tmp_path / "bare.json", tmp_path / "bare.obj")
    assert main(["flatten", mesh, "-o", str(flat[1]), "--units", "mm", "--json", str(flat[0])]) == 0
    bare = sum(piece["area_on_object_mm2"] for piece in json.loads(flat[0].read_text())["pieces"])
    assert on_object / bare == pytest.approx((30.8 / 30) ** 2, rel=2e-3)
