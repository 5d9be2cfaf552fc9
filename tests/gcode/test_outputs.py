"""All that is made from a skin: the same bytes whoever asks for it."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
import results

from gcode.outputs import write_all
from gcode.used import used_by, with_room_for_nozzle
from skinfab.cli.main import main
from skinfab.document import load_skin
from skinfab.errors import InputError, RefusedError
from skinfab.mesh.model import Mesh
from skinfab.placement.edit import move
from skinfab.placement.place import place_sensors
from skinfab.skin import Skin

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made") / "out"
    assert main(["make", str(ROOT / "meshes/cube.obj"), "-o", str(folder)]) == 0
    return folder


def test_a_document_gives_what_the_command_gives(made: Path, tmp_path: Path) -> None:
    skin = load_skin(made / "skin.skin")
    seen: list[float] = []
    report = write_all(skin, tmp_path, used_by(skin), progress=lambda part, label: seen.append(part))
    assert seen == sorted(seen) and seen[0] == 0 and seen[-1] == 1
    assert main(["make", str(made / "skin.skin"), "-o", str(tmp_path / "again")]) == 0
    names = {str(p.relative_to(tmp_path / "again")) for p in (tmp_path / "again").rglob("*") if p.is_file()}
    assert {*results.ALWAYS, *(g["file"] for g in report["gcode"])} <= names
    for name in sorted(names - {"report.json"}):
        assert (tmp_path / name).read_bytes() == (tmp_path / "again" / name).read_bytes(), name
    mine, theirs = (json.loads((folder / "report.json").read_text()) for folder in (tmp_path, tmp_path / "again"))
    for told in (mine, theirs):
        del told["timing_s"], told["peak_rss_mb"]
    assert mine == theirs
    assert mine["gcode"] and (made / mine["gcode"][0]["file"]).read_bytes() == (tmp_path / mine["gcode"][0]["file"]).read_bytes()


def test_what_was_said_before_comes_first(made: Path, tmp_path: Path) -> None:
    skin = load_skin(made / "skin.skin")
    report = write_all(skin, tmp_path, used_by(skin), notes=["it was mended"])
    assert report["warnings"][0] == "it was mended" and report == results.read_report(tmp_path)


def test_a_skin_without_sensors_has_moulds_only(made: Path, tmp_path: Path) -> None:
    skin = replace(load_skin(made / "skin.skin"), sensors=())
    report = write_all(skin, tmp_path, used_by(skin))
    assert report["gcode"] == [] and report["moulds"] and not (tmp_path / "gcode").exists()


def test_a_sensor_that_does_not_fit_is_refused(made: Path, tmp_path: Path) -> None:
    skin = load_skin(made / "skin.skin")
    off = replace(skin, sensors=move(skin.sensors, skin.sensors[0].id, x=-500, y=0))
    with pytest.raises(RefusedError, match=f"{skin.sensors[0].id} is .* mm outside piece"):
        write_all(off, tmp_path, used_by(skin))
    assert not list(tmp_path.rglob("*.gcode"))


def test_a_crumb_of_an_object_is_refused(made: Path, tmp_path: Path) -> None:
    skin = load_skin(made / "skin.skin")
    pieces = tuple(replace(p, UV=p.UV / 1000, known=None) for p in skin.pieces)
    crumb: Skin = replace(skin, mesh=Mesh(skin.mesh.V / 1000, skin.mesh.F), pieces=pieces, sensors=())
    with pytest.raises(InputError, match="every piece is too small to be cast"):
        write_all(crumb, tmp_path, used_by(skin))


def test_placing_is_that_of_the_command(made: Path) -> None:
    skin = load_skin(made / "skin.skin")
    used = used_by(skin)
    roomy, _ = with_room_for_nozzle(used.material, used.printer)
    assert place_sensors(replace(skin, sensors=()), roomy)[0] == skin.sensors
