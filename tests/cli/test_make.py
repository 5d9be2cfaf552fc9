"""The main job on the seven objects, judged from what it wrote."""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import ezdxf
import numpy as np
import pytest
import results
from wire_crossings import crossings

from gcode.emit import emit
from gcode.parse import parse
from gcode.printer import load_printer
from skinfab.cli.main import main
from skinfab.document import load_skin, save_skin
from skinfab.material import load_material
from skinfab.mould import skin_moulds
from skinfab.placement.lifted import Lifted
from skinfab.wire_exits import wire_pads

ROOT = Path(__file__).parents[2]

#: Mean d in "Soft Sensing Skins for Arbitrary Objects", section III, by object.
PUBLISHED = {
    "cube": 4.0,
    "dodecahedron": 4.0,
    "cylinder": 4.0002,
    "cup": 4.039,
    "grip": 4.037,
    "human_finger": 4.042,
    "robot_finger": 4.005,
}


@pytest.fixture(scope="module")
def made_once(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """The folder that an object is made into by the defaults, once for all tests here, which only read it."""

    @cache
    def make(name: str) -> Path:
        folder = tmp_path_factory.mktemp(name) / "out"
        assert main(["make", str(ROOT / f"meshes/{name}.obj"), "-o", str(folder)]) == 0
        return folder

    return make


@pytest.fixture(scope="module", params=PUBLISHED)
def made(request: pytest.FixtureRequest, made_once: Callable[[str], Path]) -> tuple[str, Path, dict]:
    folder = made_once(request.param)
    return request.param, folder, results.read_report(folder)


def test_all_files_are_there(made: tuple[str, Path, dict]) -> None:
    _, folder, report = made
    names = {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()}
    listed = {entry["file"] for part in ("gcode", "moulds") for entry in report[part]}
    tool_paths = {f"toolpath/{Path(g['file']).stem}.svg" for g in report["gcode"]}
    assert names == {*results.ALWAYS, *listed, *tool_paths}
    assert {Path(m["file"]).stem for m in report["moulds"]} == {p["id"] for p in report["pieces"]}
    assert report["gcode"]


def test_as_flat_as_published(made: tuple[str, Path, dict]) -> None:
    name, folder, report = made
    V, UV, F, FT = results.read_flat_obj(folder / "flat.obj")
    assert len(F) == report["mesh"]["n_faces"]
    mean, flipped = results.distortion(V, UV, F, FT)
    assert mean <= PUBLISHED[name] + 1e-6 and (name != "grip" or len(report["pieces"]) <= 2)
    assert mean == pytest.approx(report["distortion"]["mean"], abs=1e-6)
    assert flipped == 0 == sum(p["flipped"] for p in report["pieces"])
    assert results.overlap(UV, FT) < 1e-6


def test_the_skin_closes_without_being_stretched(made: tuple[str, Path, dict]) -> None:
    """Half of the 2.5 mm of skin lies outside: the middle of the skin is what was flattened, and is not stretched on."""
    name, folder, report = made
    assert report["made_for"]["flattened_at_mm"] == 1.25 and report["made_for"]["conductor_mm"] == 1.6
    V, *_ = results.read_flat_obj(folder / "flat.obj")
    low, high = np.array(report["mesh"]["bbox_mm"])  # of the object
    # The cylinder's side is a polygon of 96 flat faces: it is they that move by 1.25 mm, its corners by a little more.
    moved = {"cube": np.full(3, 1.25), "cylinder": 1.25 / np.cos([np.pi / 96, np.pi / 96, 0])}
    if name in moved:
        assert np.array([V.min(axis=0), V.max(axis=0)]) == pytest.approx(np.array([low - moved[name], high + moved[name]]), abs=1e-6)
    for strain in (s["wrap_strain"] for s in report["sensors"]):
        assert strain["mean"] == pytest.approx(strain["membrane"]["mean"] + strain["bending"]["mean"], abs=1e-12)
        if name in ("cube", "cylinder", "dodecahedron"):
            assert strain["membrane"]["max"] == pytest.approx(0, abs=1e-4)
    # What is left is the flattening's own, some places stretched and others squeezed.
    membrane = np.average(
        [s["wrap_strain"]["membrane"]["mean"] for s in report["sensors"]], weights=[s["length_mm"] for s in report["sensors"]]
    )
    assert abs(membrane) < 0.006


def test_where_the_skin_would_fold_over_it_is_rounded_off_and_said_once(made_once: Callable[[str], Path]) -> None:
    """The cup's handle meets its wall in corners tighter than half a skin; nothing of the cube is hollow."""
    for name, times in (("cup", 1), ("cube", 0)):
        assert sum("rounded off" in warning for warning in results.read_report(made_once(name))["warnings"]) == times


def test_every_piece_has_a_sensor_or_a_reason(made: tuple[str, Path, dict]) -> None:
    _, _, report = made
    with_sensor = {s["piece"] for s in report["sensors"]}
    for piece in report["pieces"]:
        named = [re.search(rf"\b{piece['id']}\b", w.split(" no sensor")[0]) for w in report["warnings"] if " no sensor" in w]
        assert piece["id"] in with_sensor or any(named)


def test_fingers_have_a_strain_sensor(made: tuple[str, Path, dict]) -> None:
    name, _, report = made
    assert ("strain-lines" in {s["kind"] for s in report["sensors"]}) == name.endswith("finger")


def test_gcode_is_fit_to_print(made: tuple[str, Path, dict], capfd: pytest.CaptureFixture[str]) -> None:
    _, folder, report = made
    printer = load_printer()
    for entry in report["gcode"]:
        text = (folder / entry["file"]).read_text()
        assert main(["gcode", "check", str(folder / entry["file"])]) == 0, capfd.readouterr()
        arcs, faults = results.arc_faults(text)
        assert faults == []
        assert arcs == entry["arcs"] > 0
        program = parse(text)
        assert emit(program, printer) == text
        assert parse(emit(program, printer)) == program


def test_others_find_the_same_ink(made: tuple[str, Path, dict]) -> None:
    _, folder, report = made
    factor = {"e_per_mm3": load_printer().pump.e_per_mm3}
    for entry in report["gcode"]:
        text = (folder / entry["file"]).read_text()
        assert results.gcodeparser_ink_mm3(text, **factor) == pytest.approx(entry["ink_mm3"], rel=1e-4)
        if not results.OCTOPRINT.exists():
            pytest.skip("OctoPrint is not installed: run tests/setup_octoprint.sh")
        assert results.octoprint_ink_mm3(folder / entry["file"], **factor) == pytest.approx(entry["ink_mm3"], rel=0.01)


def test_ink_adds_up(made: tuple[str, Path, dict]) -> None:
    _, _, report = made
    assert sum(s["ink_mm3"] for s in report["sensors"]) == pytest.approx(sum(g["ink_mm3"] for g in report["gcode"]), rel=1e-3)


def test_moulds_hold_the_piece(made: tuple[str, Path, dict]) -> None:
    _, folder, report = made
    areas = {p["id"]: p["area_mm2"] for p in report["pieces"]}
    for entry in report["moulds"]:
        area = areas[Path(entry["file"]).stem]
        assert entry["cavity_ml"] == pytest.approx(area * 2.5 / 1000, rel=0.005)
        # Below the lip's shelf only the piece itself is open: the lower 2 of the 2.5 mm.
        assert results.cavity_ml(folder / entry["file"], 1.6, 2.0) == pytest.approx(area * 2.0 / 1000, rel=0.005)


def test_every_wire_has_a_way_of_its_own(made: tuple[str, Path, dict]) -> None:
    skin = load_skin(made[1] / "skin.skin")
    for mould in skin_moulds(skin, material=load_material()):
        pads = wire_pads(skin.sensors_on(mould.piece))
        assert [(s.sensor, s.terminal) for s in mould.wire_slots] == [(p.sensor, p.terminal) for p in pads]
        assert crossings(pads, mould.wire_slots) == [] and not any("wire" in note for note in mould.warnings)


def test_drawings_have_true_arcs(made: tuple[str, Path, dict]) -> None:
    _, folder, report = made
    in_svg, in_dxf = results.drawn_arcs(folder)
    # A spiral has 2 n + 2 arcs, parallel lines one a turn.
    drawn = sum(2 * s["params"]["n"] + 2 if "n" in s["params"] else s["params"]["lines"] - 1 for s in report["sensors"])
    assert in_svg >= drawn and in_dxf >= drawn
    assert not ezdxf.readfile(folder / "flat.dxf").audit().errors


def test_times_and_memory_are_told(made: tuple[str, Path, dict]) -> None:
    report = made[2]
    assert set(report["timing_s"]) == {"load", "segment", "flatten", "place", "gcode", "mould", "draw", "total"}
    phases = sum(v for k, v in report["timing_s"].items() if k != "total")
    assert 0 < phases <= report["timing_s"]["total"] <= phases * 1.5 + 3  # the rest is importing
    assert report["timing_s"]["flatten"] > 0
    assert report["peak_rss_mb"] > 10


def test_same_input_same_bytes(made_once: Callable[[str], Path], first_skin: tuple[Path, str]) -> None:
    before, (again, _) = made_once("robot_finger"), first_skin
    for file in sorted(p.relative_to(before) for p in before.rglob("*") if p.is_file()):
        if file.name not in ("report.json", "report.html", "preview.png"):
            assert (before / file).read_bytes() == (again / file).read_bytes(), file


def test_the_document_makes_the_same_gcode_again(made_once: Callable[[str], Path], tmp_path: Path) -> None:
    before = made_once("cube")
    assert main(["gcode", str(before / "skin.skin"), "-o", str(tmp_path / "again")]) == 0
    for file in (before / "gcode").iterdir():
        assert (tmp_path / "again" / file.name).read_bytes() == file.read_bytes()


def test_a_document_in_place_of_a_mesh(made_once: Callable[[str], Path], tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    mesh, skin = str(ROOT / "meshes/cube.obj"), str(tmp_path / "cube.skin")
    assert main(["segment", mesh, "-o", skin, "--thickness", "2.5"]) == 0
    assert main(["make", skin, "-o", str(tmp_path / "from_skin")]) == 0
    one, two = tmp_path / "from_skin", made_once("cube")
    for file in ("gcode/P1.gcode", "mould/P1.stl", "flat.obj", "flat.svg", "skin.skin"):
        assert (one / file).read_bytes() == (two / file).read_bytes()
    # Its sensors are kept; those that are off stay so.
    cut = load_skin(one / "skin.skin")
    save_skin(replace(cut, lifted=(Lifted(replace(cut.sensors[0], id="C99"), cut.pieces[0]),)), tmp_path / "off.skin")
    assert main(["make", str(tmp_path / "off.skin"), "-o", str(tmp_path / "again")]) == 0
    assert (tmp_path / "again/gcode/P1.gcode").read_bytes() == (one / "gcode/P1.gcode").read_bytes()
    assert (tmp_path / "again/skin.skin").read_bytes() == (tmp_path / "off.skin").read_bytes()
    assert [w for w in results.read_report(tmp_path / "again")["warnings"] if w.startswith("1 sensor is off (C99)")]
    capfd.readouterr()
    assert main(["make", skin, "-o", str(tmp_path / "x"), "--units", "m"]) == 2
    assert "go with a mesh" in capfd.readouterr().err


def test_the_terminal_ends_with_the_result_and_tells_warnings_of_a_kind_once(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    # A piece a face, too small for a sensor and for most of its lip.
    words = ["make", str(ROOT / "meshes/dodecahedron.obj"), "-o", str(tmp_path / "out"), "--cuts", str(_all_edges(tmp_path))]
    assert main([*words, "--scale", "0.05"]) == 0
    said = capfd.readouterr()
    report = results.read_report(tmp_path / "out")
    warned = [line for line in said.err.splitlines() if line.startswith("warning: ")]
    alike = [w for w in report["warnings"] if "the adhesive lip has room along" in w]
    assert len(alike) > 5 and sum("the adhesive lip has room along" in line for line in warned) == 1
    assert any(line.startswith(f"warning: {len(alike)} pieces, first P") for line in warned)
    last = said.out.splitlines()[-1]
    assert "next, open" in last and last.endswith(f"all {len(report['warnings'])} warnings")
    assert said.out.splitlines()[-2].startswith(f"{tmp_path / 'out'}: {len(report['pieces'])} pieces, d mean")


def _all_edges(folder: Path) -> Path:
    """A cut along every edge that is sharp."""
    from skinfab.mesh.io import load_mesh

    mesh = load_mesh(ROOT / "meshes/dodecahedron.obj").mesh
    topology = mesh.topology
    sides = mesh.face_normals[topology.EF]
    sharp = topology.E[np.einsum("ij,ij->i", sides[:, 0], sides[:, 1]) < 0.9]
    path = folder / "cuts.txt"
    path.write_text("".join(f"{a} {b}\n" for a, b in sharp))
    return path


def test_cuts_by_hand(tmp_path: Path) -> None:
    (tmp_path / "cuts.txt").write_text("0 1\n")
    words = ["make", str(ROOT / "meshes/cube.obj"), "-o", str(tmp_path / "out"), "--cuts", str(tmp_path / "cuts.txt")]
    assert main(words) == 1  # one edge opens nothing
    assert main([*words, "--complete"]) == 0
    assert results.read_report(tmp_path / "out")["distortion"]["mean"] == pytest.approx(4)


def test_json_is_the_report_and_nothing_else(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["make", str(ROOT / "meshes/cube.obj"), "-o", str(tmp_path / "out"), "--json"]) == 0
    assert json.loads(capfd.readouterr().out) == json.loads((tmp_path / "out/report.json").read_text())


def test_sensors_from_a_file(tmp_path: Path) -> None:
    (tmp_path / "one.toml").write_text(
        '[[sensor]]\nkind = "contact-spiral"\nparams = { n = 3, x = 1.7, b = 1.5, l = 3, s = 15 }\npose = "auto"\n'
    )
    mesh = str(ROOT / "meshes/cube.obj")
    assert main(["make", mesh, "-o", str(tmp_path / "out"), "--sensors", str(tmp_path / "one.toml")]) == 0
    (sensor,) = results.read_report(tmp_path / "out")["sensors"]
    assert sensor["params"]["s"] == 15 and sensor["resistance_kohm"]["median"] == pytest.approx(154.5, abs=1)


def test_a_scaled_object_scales_its_skin(tmp_path: Path) -> None:
    mesh = str(ROOT / "meshes/cube.obj")
    assert main(["make", mesh, "-o", str(tmp_path / "out"), "--scale", "1.5", "--thickness", "0"]) == 0
    area = sum(p["area_mm2"] for p in results.read_report(tmp_path / "out")["pieces"])
    assert area == pytest.approx(6 * 60**2, rel=1e-9)  # six squares of 40 mm, half as long again


def test_a_printer_that_is_too_small_gets_smaller_pieces(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    # The cube's net is 170 mm long; this bed leaves 126 mm between the mould's rims.
    text = (
        (ROOT / "gcode/profiles/ender5plus-vipro.toml")
        .read_text()
        .replace("size = [350, 350]", "size = [150, 150]")
        .replace("y = 345", "y = 145")
    )
    (tmp_path / "small.toml").write_text(text)
    assert main(["make", str(ROOT / "meshes/cube.obj"), "-o", str(tmp_path / "out"), "--printer", str(tmp_path / "small.toml")]) == 0
    report = results.read_report(tmp_path / "out")
    assert len(report["pieces"]) > 1
    (told,) = [w for w in report["warnings"] if "parts of what does not fit the bed with its mould" in w]
    # Said while it is cut, and not once more at the end.
    said = capsys.readouterr().err
    assert "1 piece would do on a larger bed" in told and said.count(told) == 1 and f"note: {told}" in said.splitlines()
    V, UV, F, FT = results.read_flat_obj(tmp_path / "out/flat.obj")
    assert results.distortion(V, UV, F, FT)[0] == pytest.approx(4.0, abs=1e-6)
    for entry in report["gcode"]:
        assert np.max(entry["bbox_mm"]) < 150


@pytest.mark.parametrize("bed", [(120.2, 120.2), (90, 300)], ids=["the lips' corners", "deeper than wide"])
def test_a_mould_that_would_not_lie_on_the_bed_is_known_while_cutting(bed: tuple[float, float], tmp_path: Path) -> None:
    # In one piece the skin is 96.3 x 66.4 mm and its mould 120.6 x 87.7 mm, long side along x.
    text = (ROOT / "gcode/profiles/ender5plus-vipro.toml").read_text()
    text = re.sub(r"(?ms)^\[park\].*?(?=^\[|\Z)", "", text.replace("size = [350, 350]", f"size = [{bed[0]}, {bed[1]}]"))
    (tmp_path / "small.toml").write_text(text)
    words = ["make", str(ROOT / "meshes/human_finger.obj"), "-o", str(tmp_path / "out"), "--printer", str(tmp_path / "small.toml")]
    assert main(words) == 0
    report = results.read_report(tmp_path / "out")
    assert len(report["pieces"]) > 1
    for mould in report["moulds"]:
        assert mould["size_mm"][0] <= bed[0] and mould["size_mm"][1] <= bed[1]


@pytest.mark.parametrize(
    ("arguments", "status", "says"),
    [
        (["nowhere.obj"], 1, "nowhere.obj"),
        (["{cube}", "--max-distortion", "4"], 2, "above 4"),
        (["{cube}", "--scale", "0"], 2, "positive"),
        (["{cube}", "--printer", "nosuch"], 1, "nosuch"),
        (["{cube}", "--sensors", "nosuch.toml"], 1, "nosuch.toml"),
        (["{cube}", "--units", "furlong"], 2, "furlong"),
    ],
)
def test_wrong_input_gets_one_line(arguments: list[str], status: int, says: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    words = [a.replace("{cube}", str(ROOT / "meshes/cube.obj")) for a in arguments]
    assert main(["make", *words, "-o", str(tmp_path / "out")]) == status
    error = capfd.readouterr().err
    assert says in error.splitlines()[-1]
    assert not (tmp_path / "out").exists()
