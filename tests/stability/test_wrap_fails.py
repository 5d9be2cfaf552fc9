"""Where skinning the outside alone could fail: parts that the plain way cuts to shreds, and input that no ball can roll on."""

from pathlib import Path

import numpy as np
import pytest
import results
import trimesh

from skinfab.cli.main import main
from skinfab.document import load_skin
from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.mesh.wrap import wrap

ROOT = Path(__file__).parents[2]
LEAP = ROOT / "../shared/meshes/leap_fingertip.obj"


def housing() -> trimesh.Trimesh:
    """A hollow box of 50 x 36 x 30 mm, walls 2 mm thick, with four screw holes of 3 mm and a slot of 2 mm: inside and out one surface."""
    part = trimesh.creation.box((50, 36, 30))
    holes = [trimesh.creation.cylinder(radius=1.5, height=60, sections=16) for _ in range(2)]
    for hole, (x, y) in zip(holes, [(-18, -12), (18, 12)], strict=True):
        hole.apply_translation((x, y, 0))
    slot = trimesh.creation.box((30, 60, 2))
    return trimesh.boolean.difference([part, trimesh.creation.box((46, 32, 26)), *holes, slot])


def written(solid: trimesh.Trimesh, path: Path) -> str:
    path.write_text(trimesh.exchange.obj.export_obj(solid))
    return str(path)


def test_a_housing_is_skinned_outside_and_not_inside(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    part = housing()
    source = written(part, tmp_path / "housing.obj")
    assert main(["segment", source, "--units", "mm", "-o", str(tmp_path / "all.skin")]) == 0
    noted = capfd.readouterr().err
    assert "only the outside" not in noted and ("--wrap 8 skins the outside alone" in noted) == (
        len(load_skin(tmp_path / "all.skin").pieces) > 20
    )
    assert main(["make", source, "--units", "mm", "-o", str(tmp_path / "out"), "--wrap", "6"]) == 0
    said = capfd.readouterr()
    assert f"only the outside is skinned: the object has {part.area:.0f} mm^2" in said.err
    everything, outside = load_skin(tmp_path / "all.skin"), load_skin(tmp_path / "out/skin.skin")
    # The inner walls and those of slot and holes are gone; the skin's neutral surface is larger than the box by 1.25 mm all round.
    assert sum(p.area for p in everything.pieces) > 1.5 * sum(p.area for p in outside.pieces)
    assert len(outside.pieces) < len(everything.pieces)
    report = results.read_report(tmp_path / "out")
    assert any(warning.startswith("only the outside is skinned") for warning in report["warnings"])
    assert len(report["sensors"]) >= 4 and report["distortion"]["mean"] < 4.05
    V, UV, F, FT = results.read_flat_obj(tmp_path / "out/flat.obj")
    assert results.distortion(V, UV, F, FT)[0] == pytest.approx(report["distortion"]["mean"], abs=1e-3)


@pytest.mark.skipif(not LEAP.exists(), reason="the shared meshes are not here")
def test_a_robots_fingertip_is_one_or_two_pieces(tmp_path: Path) -> None:
    """106 pieces as modelled."""
    assert main(["segment", str(LEAP), "-o", str(tmp_path / "a.skin"), "--wrap", "8"]) == 0
    skin = load_skin(tmp_path / "a.skin")
    assert len(skin.pieces) <= 2
    assert main(["place", str(tmp_path / "a.skin")]) == 0
    assert len(load_skin(tmp_path / "a.skin").sensors) >= 4


def test_same_input_same_document(tmp_path: Path) -> None:
    source = written(housing(), tmp_path / "housing.obj")
    for name in "ab":
        assert main(["segment", source, "--units", "mm", "-o", str(tmp_path / f"{name}.skin"), "--wrap", "10"]) == 0
    assert (tmp_path / "a.skin").read_bytes() == (tmp_path / "b.skin").read_bytes()


@pytest.mark.parametrize("flaw", ["apart", "through each other", "twice", "inside out", "needles"])
def test_parts_that_are_no_clean_solid_are_wrapped_all_the_same(flaw: str) -> None:
    box = trimesh.creation.box((30, 20, 10))
    other = trimesh.creation.box((30, 20, 10))
    if flaw == "apart":
        other.apply_translation((31, 0, 0))
    elif flaw == "through each other":
        other.apply_translation((10, 7, 3))
    elif flaw == "inside out":
        box.invert()
    elif flaw == "needles":
        box = box.subdivide().subdivide()
        box.vertices[:, 0] *= 1 + 1e-9 * np.arange(len(box.vertices))
    both = trimesh.util.concatenate([box, other]) if flaw != "needles" else box
    wrapped = wrap(Mesh(np.array(both.vertices), np.array(both.faces, dtype=np.int64)), 4.0)
    assert wrapped.topology.is_oriented_manifold and not wrapped.topology.boundary_loops
    # A gap of 1 mm is bridged too.
    assert wrapped.topology.face_components()[0] == 1
    assert (wrapped.bbox[0] < both.bounds[0]).all() and (wrapped.bbox[1] > both.bounds[1]).all()


@pytest.mark.parametrize(
    ("ball", "says"),
    [(60.0, "larger than the object, which is 50 mm long"), (0.01, r"too small for an object 50 mm long; give 0\.\d+ or more")],
)
def test_a_ball_of_another_scale_is_refused(ball: float, says: str) -> None:
    part = housing()
    with pytest.raises(InputError, match=says):
        wrap(Mesh(np.array(part.vertices), np.array(part.faces, dtype=np.int64)), ball)


def test_the_advice_for_too_small_a_ball_works() -> None:
    part = trimesh.creation.box((2, 2, 2))
    mesh = Mesh(np.array(part.vertices), np.array(part.faces, dtype=np.int64))
    with pytest.raises(InputError, match=r"give 0\.026 or more"):
        wrap(mesh, 1e-9)


def test_an_open_object_is_refused_for_its_inner_side_would_be_skinned(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    finger = str(ROOT / "meshes/robot_finger.obj")
    assert main(["segment", finger, "-o", str(tmp_path / "a.skin"), "--wrap", "8"]) == 1
    assert "open edges round 1 opening" in capfd.readouterr().err and not (tmp_path / "a.skin").exists()


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["{cube}", "--wrap", "0"], "not a positive number"),
        (["{cube}", "--wrap", "8", "--cuts", "a.txt"], "--wrap makes a surface of its own"),
        (["a.skin", "--wrap", "8"], "go with a mesh"),
    ],
)
def test_wrong_usage(words: list[str], says: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    words = [word.replace("{cube}", str(ROOT / "meshes/cube.obj")) for word in words]
    assert main(["make", *words, "-o", str(tmp_path / "out")]) == 2
    assert says in capfd.readouterr().err
