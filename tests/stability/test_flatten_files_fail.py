"""`skinfab flatten` on files that make others hang, crash or write nonsense: one sentence, or a sound result."""

import json
import runpy
import signal
from collections.abc import Iterator
from pathlib import Path

import igl
import numpy as np
import pytest
import results
import shapes
import trimesh

from skinfab.cli.flatten import NAMES
from skinfab.cli.main import main
from skinfab.flatten.bff import flatten_disk
from skinfab.flatten.distortion import measure, singular_values
from skinfab.flatten.holes import flatten_least
from skinfab.mesh.topology import Topology

CASES = {case.file: case for case in runpy.run_path(str(Path(__file__).with_name("broken_meshes.py")))["all_cases"]()}
HANG_S = 120  # a hang, not a slow machine that compiles first


@pytest.fixture(autouse=True)
def _no_hang() -> Iterator[None]:
    def too_long(*_: object) -> None:
        raise TimeoutError(f"no answer in {HANG_S} s")

    before = signal.signal(signal.SIGALRM, too_long)
    signal.alarm(HANG_S)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def written(folder: Path, V: np.ndarray, F: np.ndarray) -> Path:
    path = folder / "mesh.obj"
    lines = ["v {:.17g} {:.17g} {:.17g}".format(*v) for v in V.tolist()] + ["f {} {} {}".format(*f) for f in (F + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")
    return path


def flatten(path: Path, *words: str) -> tuple[int, Path]:
    out = path.with_name("flat.obj")
    return main(["flatten", str(path), "-o", str(out), *words]), out


NONSENSE = [
    "only_f_1_1_2.obj",
    "out_of_range.obj",
    "index_zero.obj",
    "words.obj",
    "zero_bytes.obj",
    "cut_off.obj",
    "empty.obj",
    "comments.obj",
    "vertices_only.obj",
    "faces_only.obj",
    "nan.obj",
    "inf.obj",
    "no_area.obj",
    "garbage.ply",
    "garbage.off",
    "garbage.glb",
    "nan.stl",
]


@pytest.mark.parametrize("name", NONSENSE)
def test_no_mesh_no_flat_file(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / name
    path.write_bytes(CASES[name].data)
    status, out = flatten(path)
    err = capsys.readouterr().err
    assert status == 1 and not out.exists()
    assert len(err.splitlines()) == 1 and CASES[name].says in err


def test_plain_readers_pass_nonsense_on(tmp_path: Path) -> None:
    """What is refused above, read as it comes and laid flat: NaN, or vertices that are not there, and no error."""
    path = tmp_path / "only_f_1_1_2.obj"
    path.write_bytes(CASES[path.name].data)
    held = trimesh.load(path, process=False)
    assert held.faces.tolist() == [[0, 0, 1]]
    V = np.zeros((3, 3))  # no area
    flat = igl.lscm(V, np.array([[0, 1, 2]]), np.array([0, 1]), np.array([[0.0, 0], [1, 0]]))[0]
    assert np.isnan(flat[2]).all()
    path = tmp_path / "nan.obj"
    path.write_bytes(CASES[path.name].data)
    held = trimesh.load(path, process=False)
    loop = Topology(np.asarray(held.faces)).boundary_loops[0]
    flat = igl.lscm(np.array(held.vertices), np.array(held.faces), loop[[0, 20]], np.array([[0.0, 0], [1, 0]]))[0]
    assert np.isnan(flat).any()


CLEANED = ["corner_twice.obj", "zero_area.obj", "isolated_last.obj", "isolated_first.obj", "duplicate_face.obj", "mixed_winding.obj"]


@pytest.mark.parametrize("name", [*CLEANED, "single_triangle.obj", "one_hole.obj", "sliver.obj", "two_components.obj"])
@pytest.mark.parametrize("method", ["auto", "bff", "slim"])
def test_what_can_be_cleaned_comes_out_sound(name: str, method: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / name
    path.write_bytes(CASES[name].data)
    status, out = flatten(path, "--method", method, "--units", "mm")
    said = capsys.readouterr()
    assert status == 0, said.err
    mean, flipped = results.distortion(*results.read_flat_obj(out))
    assert flipped == 0 and mean < 4.02
    assert said.out.count("\n") == (3 if name == "two_components.obj" else 2)  # a line a piece and one for all


@pytest.mark.parametrize("method", [name for name in NAMES if name not in ("auto", "bff-cones")])
def test_closed_surfaces_are_sent_to_be_cut(method: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, out = flatten(written(tmp_path, *shapes.sphere()), "--method", method)
    assert status == 1 and not out.exists()
    assert "this is closed; cut it first (skinfab segment, or --method auto)" in capsys.readouterr().err


def test_a_handle_is_sent_to_be_cut(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    V, F = shapes.torus()
    status, _ = flatten(written(tmp_path, V, F[2:]), "--method", "isometric")
    assert status == 1 and "this has a handle; cut it first" in capsys.readouterr().err


@pytest.mark.parametrize("method", ["bff", "isometric", "lscm"])
def test_a_surface_that_covers_itself_is_refused(method: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A ramp of two turns: without a flip, without distortion, and half of it twice in the same place."""
    V, F = shapes.helicoid(2.0, 80, 4)
    plain = measure(V, F, flatten_disk(V, F))
    assert plain.flipped == 0 and plain.mean < 4.001 and plain.overlap_mm2 > 1
    status, out = flatten(written(tmp_path, 30 * V, F), "--method", method)
    assert status == 3 and not out.exists()
    assert "mm^2 twice; use --method bijective, or auto, which also cuts" in capsys.readouterr().err


@pytest.mark.parametrize("method", ["auto", "bijective"])
def test_it_is_kept_from_covering_itself(method: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    V, F = shapes.helicoid(2.0, 80, 4)
    status, out = flatten(written(tmp_path, 30 * V, F), "--method", method)
    assert status == 0 and ("kept from crossing itself" in capsys.readouterr().err) == (method == "auto")
    _, UV, _, FT = results.read_flat_obj(out)
    assert results.overlap(UV, FT) < 1e-6 and len(UV) == len(V)  # and not cut


def test_flips_are_counted_and_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    V, F = shapes.random_disk(5, 100, 1.0)
    flat = flatten_disk(V, F)
    assert np.isfinite(flat).all() and (singular_values(V, F, flat)[:, 1] < 0).sum() > 10  # finite, and wrong
    status, out = flatten(written(tmp_path, 30 * V, F), "--method", "bff")
    assert status == 3 and not out.exists() and "triangles of P1 over; use --method auto" in capsys.readouterr().err
    assert flatten(written(tmp_path, 30 * V, F), "--max-distortion", "200")[0] == 0


def rounded(UV: np.ndarray, form: str) -> np.ndarray:
    """What is left of coordinates written in that format."""
    return np.array([[float(format(x, form)) for x in row] for row in UV.tolist()])


def finer_outwards(s: np.ndarray, t: np.ndarray) -> np.ndarray:
    """A flat sheet divided ever more finely towards its border."""
    x, y = (np.where(a < 0.5, 8 * a**4, 1 - 8 * (1 - a) ** 4) for a in (s, t))
    return np.stack([x, y, 0 * s], axis=1)


@pytest.mark.parametrize(
    ("mesh", "unit", "form"),
    [(shapes.wavy(40), 1e-5, ".6f"), (shapes.grid(100, 6, finer_outwards), 1e4, ".6g")],
    ids=["6 decimals, small", "6 digits, large"],
)
def test_six_decimals_collapse_a_mesh(mesh, unit: float, form: str, tmp_path: Path) -> None:
    V, F = unit * mesh[0], mesh[1]
    flat = flatten_least(V, F)
    assert measure(V, F, flat).flipped == 0
    assert measure(V, F, rounded(flat - flat.min(axis=0), form)).flipped > 10
    status, out = flatten(written(tmp_path, V, F), "--units", "mm", "--json", str(tmp_path / "figures.json"))
    assert status == 0
    mean, flipped = results.distortion(*results.read_flat_obj(out))
    figures = json.loads((tmp_path / "figures.json").read_text())
    assert flipped == 0 and mean == pytest.approx(figures["distortion"]["mean"], abs=1e-6)
