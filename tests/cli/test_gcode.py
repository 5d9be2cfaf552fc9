"""`skinfab gcode` from the command line: files, findings, exit statuses."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gcode.words import read_text
from skinfab.cli.main import main
from skinfab.document import load_skin, save_skin
from skinfab.mesh.model import Mesh
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.pieces import Piece
from skinfab.placement.lifted import Lifted
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source

CORNERS = np.array([[0, 0], [80, 0], [80, 60], [0, 60]], dtype=float)


def skin_with(*sensors: Sensor) -> Skin:
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    mesh = Mesh(np.c_[CORNERS, np.zeros(4)], faces)
    piece = Piece("P1", np.array([0, 1]), np.arange(4), faces, CORNERS)
    return Skin(mesh, Source("plate.obj", "0" * 64, "mm", 1.0), np.empty((0, 2), dtype=np.int64), (piece,), sensors)


@pytest.fixture
def document(tmp_path: Path) -> Path:
    save_skin(skin_with(Sensor("C1", "P1", ContactSpiral(n=3, x=2.0, b=3.0, l=6.0, s=22.0), 20, 30, 0.3, 0)), tmp_path / "a.skin")
    return tmp_path / "a.skin"


def test_what_is_left_of_another_run_is_named_and_left_alone(document: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["gcode", str(document), "-o", str(out), "--preview"]) == 0
    assert "left alone" not in capfd.readouterr().err
    for name in ("P3.gcode", "P3.svg", "P10.GCODE", "flat.svg", "notes.txt"):
        (out / name).write_text("old")
    assert main(["gcode", str(document), "-o", str(out)]) == 0
    (warned,) = capfd.readouterr().err.splitlines()
    # Without --preview the picture of P1 is an old one too; pictures that belong to no G-code are none of ours.
    assert "also holds P1.svg, P3.svg, P3.gcode, P10.GCODE, which are not of this run and were left alone" in warned
    assert (out / "P3.gcode").read_text() == "old"
    assert main(["gcode", str(document), "-o", str(out), "--preview", "--json"]) == 0
    said = capfd.readouterr()
    assert [Path(f).name for f in json.loads(said.out)["left_over"]] == ["P3.svg", "P3.gcode", "P10.GCODE"] and said.err == ""


def test_writes_what_its_own_check_accepts(document: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gcode", str(document), "-o", str(tmp_path / "out")]) == 0
    file = tmp_path / "out/P1.gcode"
    assert str(file) in capsys.readouterr().out
    assert "\nG3 " in read_text(file)
    assert main(["gcode", "check", str(file)]) == 0
    assert "no fault found by these rules on Creality" in capsys.readouterr().out


def test_json_and_arcs_as_lines(document: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gcode", str(document), "-o", str(tmp_path / "out"), "--arcs", "lines", "--printer", "generic-marlin", "--json"]) == 0
    (entry,) = json.loads(capsys.readouterr().out)["gcode"]
    assert entry["piece"] == "P1" and entry["arcs"] == 0 and entry["offset_mm"] == [60.0, 70.0]
    assert entry.keys() >= {"file", "lines", "time_s", "ink_mm3", "bbox_mm", "warnings"}
    text = read_text(entry["file"])
    assert text.count("\n") == entry["lines"] and "\nG3 " not in text


def test_preview_is_written_beside_the_file(document: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gcode", str(document), "-o", str(tmp_path / "out"), "--preview"]) == 0
    picture = tmp_path / "out/P1.svg"
    assert f"{picture}: its tool path" in capsys.readouterr().out
    assert picture.read_text().startswith("<svg") and 'class="wall"' in picture.read_text()
    assert main(["gcode", str(document), "-o", str(tmp_path / "out"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["previews"] == []
    assert main(["gcode", "check", str(tmp_path / "out/P1.gcode"), "--preview"]) == 2
    assert "so it takes no --preview" in capsys.readouterr().err


def test_check_refuses_a_foreign_file_line_by_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "foreign.gcode"
    file.write_text("G90\nG0 Z10 F250\nG0 X20 Y20 F250\nG0 Z2.3 F250\nG1 X30 Y20 E-40 F250\nG02 X50 Y20 I11 J0 E-80 F250\n")
    assert main(["gcode", "check", str(file)]) == 3
    said = capsys.readouterr()
    assert "line 5: E-40.00000 is negative" in said.out and "line 6: its end lies 2.0000 mm off" in said.out
    assert said.err.count("\n") == 1 and "faults on Creality" in said.err
    assert main(["gcode", "check", str(file), "--json"]) == 3
    answer = json.loads(capsys.readouterr().out)
    assert answer["ok"] is False and {f["line"] for f in answer["findings"]} == {0, 5, 6}  # 0: it never homes


def test_what_comes_before_a_line_that_cannot_be_followed_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "broken.gcode"
    file.write_text("G28 X Y\nG0 Z10 F300\nG0 X400 F600\nG5 X1\nG0 X900\n")
    assert main(["gcode", "check", str(file)]) == 1
    said = capsys.readouterr()
    assert said.out.startswith("line 3: it reaches X400.0000") and said.out.count("\n") == 1
    assert f"{file}: line 4: G5 is not supported" in said.err and said.err.count("\n") == 1
    assert main(["gcode", "check", str(file), "--json"]) == 1
    told = json.loads(capsys.readouterr().out)
    assert told["broken_off"].startswith("line 4: G5") and told["ok"] is False and [f["line"] for f in told["findings"]] == [3]


def test_a_file_for_another_printer_gets_a_note(document: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gcode", str(document), "-o", str(tmp_path), "--printer", "generic-grbl"]) == 0
    capsys.readouterr()
    assert main(["gcode", "check", str(tmp_path / "P1.gcode")]) == 3
    head, dialect, *_ = capsys.readouterr().out.splitlines()
    assert head.startswith("note: its head says it is for generic GRBL machine, pump as spindle, it is judged for Creality")
    assert dialect.startswith("note: it looks like a file for GRBL (M3 turns a pump")
    assert main(["gcode", "check", str(tmp_path / "P1.gcode"), "--printer", "generic-grbl", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["notes"] == [] and told["ok"] is True and told["broken_off"] is None


def test_check_in_the_mould_of_a_skin(document: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gcode", str(document), "-o", str(tmp_path), "--printer", "generic-marlin"]) == 0
    file = tmp_path / "P1.gcode"
    capsys.readouterr()
    check = ["gcode", "check", str(file), "--printer", "generic-marlin"]
    assert main(check) == 0
    assert capsys.readouterr().out.endswith("printer; the mould's wall was not judged, for that give --skin SKIN\n")
    for more in ([], ["--piece", "P1"]):
        assert main([*check, "--skin", str(document), *more]) == 0
        assert capsys.readouterr().out == f"{file}: no fault found by these rules on generic Marlin printer in the mould of piece P1\n"
    assert main([*check, "--skin", str(document), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["piece"] == "P1" and told["not_judged"] == []
    assert main([*check, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["piece"] is None and told["not_judged"] == ["the mould's wall was not judged"]


def test_the_printer_of_the_skin_is_the_one_judged_for(document: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    save_skin(replace(load_skin(document), printer="generic-grbl"), document)
    assert main(["gcode", str(document), "-o", str(tmp_path)]) == 0
    capsys.readouterr()
    assert main(["gcode", "check", str(tmp_path / "P1.gcode"), "--skin", str(document)]) == 0
    assert "on generic GRBL machine, pump as spindle in the mould of piece P1" in capsys.readouterr().out


def test_a_file_beside_its_mould_or_over_its_wall(document: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gcode", str(document), "-o", str(tmp_path)]) == 0
    file = tmp_path / "P1.gcode"
    text = read_text(file)
    for shift, says in (
        (90.0, "it lays ink outside piece P1, whose mould holds X135.0 to X215.0 and Y145.0 to Y205.0"),
        (-25.0, "runs across"),
    ):
        body, park, rest = text.partition("; park")
        file.write_text(re.sub(r"X(-?[\d.]+)", lambda m, by=shift: f"X{float(m[1]) + by:.4f}", body) + park + rest)
        capsys.readouterr()
        assert main(["gcode", "check", str(file)]) == 0
        assert main(["gcode", "check", str(file), "--skin", str(document)]) == 3
        said = capsys.readouterr().out
        assert says in said and "pattern C1: " in said


def test_which_piece_a_foreign_file_is_for(document: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gcode", str(document), "-o", str(tmp_path)]) == 0
    file = tmp_path / "P1.gcode"
    text = read_text(file)
    file.write_text(text.partition("\n")[2])  # without its first line it is anyone's
    one = load_skin(document)
    assert main(["gcode", "check", str(file), "--skin", str(document)]) == 0  # the only piece with sensors
    save_skin(replace(one, sensors=()), document)
    capsys.readouterr()
    assert main(["gcode", "check", str(file), "--skin", str(document)]) == 1
    assert f"{file}: it does not say which piece it is for; give --piece, one of P1" in capsys.readouterr().err
    assert main(["gcode", "check", str(file), "--skin", str(document), "--piece", "P1"]) == 0
    assert main(["gcode", "check", str(file), "--skin", str(document), "--piece", "P7"]) == 1
    assert "there is no piece P7 in the skin; give --piece, one of P1" in capsys.readouterr().err
    file.write_text(text.replace("; piece P1", "; piece P9"))
    assert main(["gcode", "check", str(file), "--skin", str(document), "--piece", "P1"]) == 3
    assert "line 2: its head says it is for piece P9, it is judged for piece P1; give the file of that piece" in capsys.readouterr().out
    assert main(["gcode", "check", str(file), "--skin", str(tmp_path / "absent.skin")]) == 1


def test_a_terminal_gets_one_line_for_each_kind_of_fault(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "many.gcode"
    moves = "".join(f"G0 X{400 + k} Y1\nG0 X1 Y1\n" for k in range(30))
    file.write_text("G28 X Y\nM83\nM302 P1\nG0 Z10 F300\n" + moves + "G0 X1 Y-5\nG0 X1 Y-6\nM104 S200\n")
    assert main(["gcode", "check", str(file)]) == 3
    first, second, third = capsys.readouterr().out.splitlines()
    assert first.startswith("line 5: it reaches X400.0000") and first.endswith("(and 29 more lines like it)")
    assert second.startswith("line 65: it reaches Y-5.0000") and second.endswith("(and 1 more line like it)")
    assert third.startswith("line 67: M104 heats") and "like it" not in third
    assert main(["gcode", "check", str(file), "--json"]) == 3
    assert len(json.loads(capsys.readouterr().out)["findings"]) == 33


def test_what_is_no_print_at_all(document: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "empty.gcode").write_bytes(b"")
    assert main(["gcode", "check", str(tmp_path / "empty.gcode")]) == 3
    assert "no move in it" in capsys.readouterr().out
    assert main(["gcode", str(document), "-o", str(tmp_path / "out")]) == 0
    capsys.readouterr()
    assert main(["gcode", "check", str(tmp_path / "out")]) == 1
    said = capsys.readouterr()
    assert not said.out and said.err.count("\n") == 1 and f"such as {tmp_path / 'out/P1.gcode'}" in said.err


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"\0\1\2", "binary file"),
        (b"G1 Z1\nG1 XNaN", "line 2: cannot read 'XNaN'"),
        (b"G1 Z1\n\xff\xfe\xfd", "line 2: cannot read"),
        (b"G1 X" + 400 * b"9", "not a finite number"),
        (b"G1 X" + 10_000 * b"1", "characters long"),
    ],
)
def test_hostile_files_get_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str], content: bytes, says: str) -> None:
    file = tmp_path / "bad.gcode"
    file.write_bytes(content)
    assert main(["gcode", "check", str(file)]) == 1
    said = capsys.readouterr()
    assert says in said.err and said.err.count("\n") == 1
    assert said.out == ("line 1: no speed F was given yet; give F, in mm/min, on the first move\n" if b"\n" in content else "")


def test_refused_and_unusable_skins(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    save_skin(skin_with(Sensor("C1", "P1", ContactSpiral(n=3, x=2.0, b=3.0, l=6.0, s=22.0), 300, 30, 0.3, 0)), tmp_path / "out.skin")
    assert main(["gcode", str(tmp_path / "out.skin"), "-o", str(tmp_path / "g")]) == 3
    assert "C1 is" in capsys.readouterr().err and not (tmp_path / "g").exists()
    save_skin(skin_with(), tmp_path / "none.skin")
    assert main(["gcode", str(tmp_path / "none.skin"), "-o", str(tmp_path / "g")]) == 1
    assert main(["gcode", str(tmp_path / "absent.skin"), "-o", str(tmp_path / "g")]) == 1
    assert main(["gcode", "check", str(tmp_path / "absent.gcode")]) == 1
    assert main(["gcode", "check", "x.gcode", "--printer", "nonesuch"]) == 1


@pytest.mark.parametrize(
    "words",
    [
        ["a.skin"],
        ["a.skin", "b.skin", "-o", "d"],
        ["check"],
        ["check", "a", "b"],
        ["check", "a", "-o", "d"],
        ["check", "a", "--arcs", "lines"],
        ["check", "a", "--piece", "P1"],
        ["a.skin", "-o", "d", "--skin", "b.skin"],
        ["a.skin", "-o", "d", "--piece", "P1"],
        [],
    ],
)
def test_wrong_usage(words: list[str]) -> None:
    assert main(["gcode", *words]) == 2


def test_sensors_that_are_off_change_nothing_and_are_named(document: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """What a cut took off in the window lies in the document: commands say so, and `place` makes anew or leaves alone as for any sensor."""
    skin = load_skin(document)
    second = replace(skin.sensors[0], id="C2", channel=1)
    save_skin(replace(skin, lifted=(Lifted(second, skin.pieces[0], place=1),)), tmp_path / "off.skin")
    off = str(tmp_path / "off.skin")
    for folder, file in (("out", str(document)), ("off", off)):
        assert main(["gcode", file, "-o", str(tmp_path / folder)]) == 0
    (warned,) = capfd.readouterr().err.splitlines()
    assert warned.startswith("warning: 1 sensor is off (C2) and is not printed")
    assert (tmp_path / "out/P1.gcode").read_bytes() == (tmp_path / "off/P1.gcode").read_bytes()
    assert main(["place", off, "--list"]) == 0 and "1 sensor is off (C2)" in capfd.readouterr().err
    assert main(["place", off, "--shift", "C1", "1", "0"]) == 0
    (kept,) = load_skin(off).lifted
    assert kept.sensor == second and load_skin(off).sensors[0].x == 21
    assert main(["place", off]) == 0
    assert "the 2 sensors that" in capfd.readouterr().err and load_skin(off).lifted == ()
