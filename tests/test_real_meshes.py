"""The main job on real robot parts, hands, household objects and scans."""

import time
from pathlib import Path

import pytest
import results

from skinfab.cli.main import main

MESHES = Path(__file__).parents[2] / "shared/meshes"
FOUND = sorted(p for p in MESHES.glob("*") if p.suffix in (".obj", ".ply", ".stl"))
pytestmark = pytest.mark.skipif(not FOUND, reason=f"the real meshes are not at {MESHES.relative_to(MESHES.parents[2])}, beside the project")

#: No bound on speed, only a guard: a run this long is a hang.
HANG_S = 300


@pytest.mark.parametrize("mesh", FOUND, ids=lambda path: path.stem)
def test_a_real_mesh_becomes_a_skin(mesh: Path, tmp_path: Path) -> None:
    began = time.monotonic()
    assert main(["make", str(mesh), "-o", str(tmp_path / "out")]) == 0
    assert time.monotonic() - began < HANG_S
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
