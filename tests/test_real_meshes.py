"""The main job on real robot parts, hands, household objects and scans."""

from itertools import chain
from pathlib import Path

import pytest
import results

from skinfab.cli.main import main
from skinfab.linalg import Cholesky
from skinfab.mesh.decimate import decimate
from skinfab.mesh.door import load_usable

MESHES = Path(__file__).parents[2] / "shared/meshes"
FOUND = sorted(p for p in MESHES.glob("*") if p.suffix in (".obj", ".ply", ".stl"))
pytestmark = pytest.mark.skipif(not FOUND, reason=f"the real meshes are not at {MESHES.relative_to(MESHES.parents[2])}, beside the project")

#: Of a larger mesh a quarter of the triangles, but no fewer than LARGE and no more than LARGEST, is as much of a real object: all of the
#: fourteen at full size took 242 s of processor time, these take less than half. One is left as it is.
LARGE, LARGEST = 1500, 10_000
WHOLE = "human_index_finger_open"

#: No bound on speed, only a guard: the most of them takes 11 600, a run of so many goes in circles.
MOST_FACTORISATIONS = 30_000


@pytest.fixture
def factored(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The size of each system that was factored."""
    sizes: list[int] = []
    numeric = Cholesky._numeric

    def counted(self: Cholesky) -> None:
        sizes.append(self._matrix.size[0])
        numeric(self)

    monkeypatch.setattr(Cholesky, "_numeric", counted)
    return sizes


def of_a_size_for_tests(path: Path, folder: Path) -> Path:
    """The mesh itself, or a file of its surface with fewer triangles."""
    mesh = load_usable(path).mesh
    if len(mesh.F) <= LARGE or path.stem == WHOLE:
        return path
    few = decimate(mesh.V, mesh.F, faces=min(max(len(mesh.F) // 4, LARGE), LARGEST))
    made = folder / f"{path.stem}.obj"
    lines = chain((f"v {x} {y} {z}\n" for x, y, z in few.V.tolist()), (f"f {a} {b} {c}\n" for a, b, c in (few.F + 1).tolist()))
    made.write_text("".join(lines))
    return made


@pytest.mark.parametrize("path", FOUND, ids=lambda path: path.stem)
def test_a_real_mesh_becomes_a_skin(path: Path, factored: list[int], tmp_path: Path) -> None:
    mesh = of_a_size_for_tests(path, tmp_path)
    assert main(["make", str(mesh), "-o", str(tmp_path / "out")]) == 0
    assert 0 < len(factored) < MOST_FACTORISATIONS
    report = results.read_report(tmp_path / "out")
    mean, flipped = results.distortion(*results.read_flat_obj(tmp_path / "out/flat.obj"))
    assert mean <= 4.05 and flipped == 0
    assert mean == pytest.approx(report["distortion"]["mean"], abs=2e-4)
    for piece in report["pieces"]:
        assert piece["distortion"]["mean"] <= 4.05
        assert piece["overlap_mm2"] <= 1e-6 * piece["area_mm2"]
    for entry in report["gcode"]:
        assert results.arc_faults((tmp_path / "out" / entry["file"]).read_text())[1] == []
        assert main(["gcode", "check", str(tmp_path / "out" / entry["file"])]) == 0
