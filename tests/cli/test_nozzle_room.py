"""A thick nozzle: what is placed for it can be printed with it, and what was placed for a thin one is refused."""

from collections.abc import Callable
from pathlib import Path

import pytest
import results

from gcode.check_wall import nozzle_margin
from gcode.printer import load_printer
from gcode.used import with_room_for_nozzle
from skinfab.cli.main import main
from skinfab.document import load_skin
from skinfab.material import load_material
from skinfab.placement.check import edge_curves
from skinfab.placement.distance import Curves, distance

ROOT = Path(__file__).parents[2]


@pytest.fixture
def fat(tmp_path: Path) -> Path:
    path = tmp_path / "fat.toml"
    path.write_text('extends = "ender5plus-vipro"\n[nozzle]\nouter_radius = 2.0\n')
    return path


def nearest_to_an_edge(document: Path) -> float:
    skin = load_skin(document)
    return min(distance(Curves.of_segments(s.printed_path.segments), edge_curves(skin.piece(s.piece))) for s in skin.sensors)


def test_the_bundled_nozzle_needs_no_more_than_the_margin() -> None:
    assert with_room_for_nozzle(load_material(), load_printer()) == (load_material(), [])


def test_make_and_place_keep_the_nozzle_off_the_wall(fat: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    out, document = tmp_path / "out", tmp_path / "out/skin.skin"
    assert main(["make", str(ROOT / "meshes/robot_finger.obj"), "-o", str(out), "--printer", str(fat)]) == 0
    assert "sensors were kept 1.81 mm from the pieces' edges, not the material's 1" in capfd.readouterr().err
    assert any("not the material's 1" in warning for warning in results.read_report(out)["warnings"])
    # The radius of 2 mm and 0.2 mm of clearance; the wall leans outward at the height of the print.
    assert nearest_to_an_edge(document) >= 2.2 - 1e-6
    assert nozzle_margin(load_printer(fat), load_material()) == pytest.approx(2.2 - load_material().ink.bead_width / 2)
    assert main(["place", str(document)]) == 0
    assert main(["gcode", str(document), "-o", str(tmp_path / "again")]) == 0
    capfd.readouterr()
    assert main(["place", str(document), "--shift", "C1", "200", "0"]) == 3
    assert "C1 is" in capfd.readouterr().err


def test_sensors_placed_for_a_thin_nozzle_are_refused(
    fat: Path, cut_once: Callable[[str, Path], Path], tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    document = cut_once("robot_finger", tmp_path / "thin.skin")
    assert main(["place", str(document)]) == 0
    assert nearest_to_an_edge(document) < 2.2
    assert main(["gcode", str(document), "-o", str(tmp_path / "out"), "--printer", str(fat)]) == 3
    assert "take a thinner nozzle" in capfd.readouterr().err and not (tmp_path / "out").exists()
