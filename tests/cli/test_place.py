"""`skinfab place`: sensors on the pieces of a document."""

import json
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from skinfab.cli.main import main
from skinfab.document import load_skin
from skinfab.patterns.registry import PATTERNS, make_pattern
from skinfab.placement.edit import middle_of

ROOT = Path(__file__).parents[2]
ONE = '[[sensor]]\nkind = "contact-spiral"\nparams = {{ n = 3, x = 1.7, b = 1.5, l = 3, s = {s} }}\npose = {pose}\n'


@pytest.fixture
def document(tmp_path: Path) -> Path:
    path = tmp_path / "cube.skin"
    assert main(["segment", str(ROOT / "meshes/cube.obj"), "-o", str(path)]) == 0
    return path


def test_automatic_and_back_into_the_document(document: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert load_skin(document).sensors == ()
    capsys.readouterr()
    assert main(["place", str(document), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert [s["id"] for s in said["sensors"]] == [s.id for s in load_skin(document).sensors]
    assert len(said["sensors"]) == 6


def test_from_a_file_into_another_document(document: Path, tmp_path: Path) -> None:
    (tmp_path / "one.toml").write_text(ONE.format(s=15, pose='"auto"'))
    assert main(["place", str(document), "--sensors", str(tmp_path / "one.toml"), "-o", str(tmp_path / "one.skin")]) == 0
    assert load_skin(document).sensors == ()
    (sensor,) = load_skin(tmp_path / "one.skin").sensors
    assert sensor.pattern.kind == "contact-spiral"


@pytest.mark.parametrize(
    ("text", "status", "says"),
    [
        (ONE.format(s=200, pose='"auto"'), 3, "fit"),
        (ONE.format(s=15, pose='{ piece = "P1", x = -40, y = 0, angle_deg = 0 }'), 3, "P1"),
        (ONE.format(s=15, pose='{ piece = "P9", x = 0, y = 0, angle_deg = 0 }'), 1, "P9"),
        (ONE.format(s=15, pose='"auto"').replace("kind", "knid"), 1, "knid"),
        ("[[sensor", 1, "TOML"),
    ],
)
def test_a_refused_file_leaves_the_document_alone(
    text: str, status: int, says: str, document: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "one.toml").write_text(text)
    before = document.read_bytes()
    assert main(["place", str(document), "--sensors", str(tmp_path / "one.toml")]) == status
    error = capsys.readouterr().err
    assert says in error and error.startswith("skinfab: ")
    assert document.read_bytes() == before


@pytest.fixture
def placed(document: Path, tmp_path: Path) -> Path:
    (tmp_path / "two.toml").write_text(ONE.format(s=15, pose='"auto"') * 2)
    assert main(["place", str(document), "--sensors", str(tmp_path / "two.toml")]) == 0
    return document


def test_changes_in_the_order_given(placed: Path) -> None:
    before = {s.id: s for s in load_skin(placed).sensors}
    one = before["C1"]
    # Off the piece and back again: only where all changes lead is checked.
    changes = [
        "--shift",
        "C1",
        "900",
        "0",
        "--set",
        "C1",
        "n=2",
        "caps=true",
        "channel=5",
        "--shift",
        "C1",
        "-899.5",
        "0",
        "--rotate",
        "C1",
        "20",
    ]
    assert main(["place", str(placed), *changes, "--remove", "C2"]) == 0
    (after,) = load_skin(placed).sensors
    assert (after.pattern.n, after.pattern.caps, after.channel, after.pattern.s) == (2, True, 5, 15)
    assert (after.angle - one.angle) % 6.283185307179586 == pytest.approx(0.3490658503988659)
    np.testing.assert_allclose(middle_of(after), np.add(middle_of(one), (0.5, 0.0)), atol=1e-9)


def test_a_channel_beyond_the_two_boards_is_said(placed: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["place", str(placed), "--set", "C1", "channel=32"]) == 0
    assert "C1 on channel 32 (board 3): two boards read channels 0 to 31" in capsys.readouterr().err
    assert main(["place", str(placed), "--set", "C1", "channel=31"]) == 0
    assert "boards" not in capsys.readouterr().err


def test_two_sensors_swap_places(placed: Path) -> None:
    one, two = load_skin(placed).sensors
    words = []
    for sensor, to in ((one, two), (two, one)):
        turn = repr(np.degrees(to.angle - sensor.angle).item())
        words += ["--rotate", sensor.id, turn, "--move-to", sensor.id, to.piece, repr(to.x), repr(to.y)]
    assert main(["place", str(placed), *words]) == 0
    swapped = load_skin(placed).sensors
    np.testing.assert_allclose([(s.x, s.y) for s in swapped], [(two.x, two.y), (one.x, one.y)], atol=1e-9)


def test_adding_to_what_is_there(placed: Path, tmp_path: Path) -> None:
    (tmp_path / "more.toml").write_text(ONE.format(s=15, pose='"auto"') + "[auto]\nsizes = [10]\nper_piece = 1\n")
    before = load_skin(placed).sensors
    assert main(["place", str(placed), "--remove", "C1", "--add", str(tmp_path / "more.toml")]) == 0
    after = {s.id: s for s in load_skin(placed).sensors}
    assert after["C2"] == before[1] and after["C1"].channel == 0 and len(after) > 2
    (tmp_path / "more.toml").write_text(ONE.format(s=15, pose='"auto"') + 'id = "C2"\n')
    assert main(["place", str(placed), "--add", str(tmp_path / "more.toml")]) == 1


@pytest.mark.parametrize(
    ("changes", "status", "says"),
    [
        (["--move", "C1", "500", "2"], 3, "C1 is .* outside piece P1"),
        (["--move-to", "C1", "P9", "5", "2"], 3, "C1 is on piece P9, which does not exist; there are P1"),
        (["--set", "C1", "n=40"], 1, "C1: contact-spiral: n is 40; .* the nearest value that works is 3"),
        (["--set", "C1", "bead=0.3"], 1, "C1: contact-spiral: bead is 0.3; it must be at least 0.785, as wide as .* 0.484 mm.2 of ink"),
        (["--set", "C1", "s=300"], 3, "C1 is .* outside piece P1"),
        (["--set", "C1", "m=2"], 1, "unknown parameter 'm'"),
        (["--set", "C1", "n=wide"], 1, "n is 'wide'; it must be a finite number"),
        (["--set", "C1", "channel=1"], 3, "channel 1 is used by more than one sensor"),
        (["--set", "C1", "channel=1.5"], 1, "channel is 1.5; it must be a whole number"),
        (["--remove", "C7"], 1, "there is no sensor C7"),
        (["--set", "C1"], 2, "NAME=VALUE"),
        (["--set", "C1", "n"], 2, "NAME=VALUE"),
        (["--move", "C1", "left", "2"], 2, "'left' is not a number"),
        (["--rotate", "C1", "nan"], 2, "'nan' is not a number"),
        (["--remove", "C1", "--sensors", "x.toml"], 2, "--add FILE adds some"),
        (["--list", "--remove", "C1"], 2, "--list changes and writes nothing"),
    ],
)
def test_a_refused_change_leaves_the_document_alone(
    changes: list[str], status: int, says: str, placed: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = placed.read_bytes()
    capsys.readouterr()
    assert main(["place", str(placed), *changes]) == status
    assert re.search(says, capsys.readouterr().err)
    assert placed.read_bytes() == before


def test_list_says_where_and_writes_nothing(placed: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = placed.read_bytes()
    capsys.readouterr()
    assert main(["place", str(placed), "--list"]) == 0
    assert re.search(r"^C1: contact-spiral on P1 at \(\d+\.\d\d, \d+\.\d\d\) turned \d+\.\d deg, channel 0, ", capsys.readouterr().out)
    assert main(["place", str(placed), "--list", "--json"]) == 0
    said = json.loads(capsys.readouterr().out)["sensors"]
    assert [(s["id"], s["pose"]["x"]) for s in said] == [(s.id, s.x) for s in load_skin(placed).sensors]
    assert placed.read_bytes() == before


def test_every_pattern_is_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["place", "--patterns"]) == 0
    said = capsys.readouterr().out
    for kind, cls in PATTERNS.items():
        assert re.search(rf"^{kind} \({cls.senses}\): ", said, re.M)
        for name in cls.example:
            assert re.search(rf"^  {name} +(mm|count|switch) +[A-Z]", said, re.M)
    assert main(["place", "--patterns", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert [entry["kind"] for entry in listed["patterns"]] == list(PATTERNS)
    spiral = {p["name"]: p for p in listed["patterns"][0]["parameters"]}
    assert spiral["s"] == {
        "name": "s", "unit": "mm", "required": True, "default": None, "meaning": "Outer diameter", "bounds": "at least 4 x + bead + gap"
    }  # fmt: skip
    assert spiral["caps"]["default"] is False and spiral["n"]["unit"] == "count" and "6 at most" in spiral["n"]["default"]
    assert {p["name"]: p["default"] for p in listed["common"]} == {"bead": 0.785, "gap": 0.6, "pad": 3.0}


@pytest.mark.parametrize("kind", PATTERNS)
def test_what_is_listed_as_the_least_is_all_a_sensors_file_needs(kind: str, document: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["place", "--patterns"]) == 0
    (least,) = re.findall(rf"^{kind} .*?^  the least to give:  (params = .*?)$", capsys.readouterr().out, re.M | re.S)
    wanted = document.with_name("least.toml")
    wanted.write_text(f'[[sensor]]\nkind = "{kind}"\n{least.replace("60", "40").replace("l2 = 40", "l2 = 22")}\n')
    assert main(["place", str(document), "--sensors", str(wanted)]) == 0
    (sensor,) = load_skin(document).sensors
    assert sensor.pattern.kind == kind
    assert main(["place", str(document), "--list"]) == 0
    (params,) = re.findall(r"; params = \{ (.*) \}$", capsys.readouterr().out, re.M)
    assert make_pattern(kind, tomllib.loads(params.replace(", ", "\n"))) == sensor.pattern


def test_wrong_usage_of_patterns_and_a_missing_document(capsys: pytest.CaptureFixture[str]) -> None:
    for words, says in ((["--patterns", "a.skin"], "nothing else"), (["--list"], "SKIN is missing: the skin document; --patterns says")):
        assert main(["place", *words]) == 2
        assert says in capsys.readouterr().err


def test_the_user_guides_changes(document: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    guide = (ROOT / "docs/sensors.md").read_text(encoding="utf-8")
    assert main(["place", str(document)]) == 0
    before = {s.id: s for s in load_skin(document).sensors}
    monkeypatch.chdir(document.parent)
    document.rename("skin.skin")
    (program,) = re.findall(r"```python\n(.*?)```", guide, re.S)
    exec(compile(program, "docs/sensors.md", "exec"), {})
    after = {s.id: s for s in load_skin("skin.skin").sensors}
    assert (after["C1"].x - before["C1"].x, after["C2"].pattern.n) == (pytest.approx(0.2), 2)
    (command,) = re.findall(r"^skinfab (place skin.skin .*)$", guide, re.M)
    assert main(command.split()) == 0
    left = {s.id: s for s in load_skin("skin.skin").sensors}
    assert "C3" not in left and left["C2"].pattern.s == 30


def test_placing_anew_is_said(document: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["place", str(document)]) == 0
    assert "placed anew" not in capsys.readouterr().err
    assert main(["place", str(document)]) == 0
    assert "the 6 sensors that" in capsys.readouterr().err


def test_a_mesh_is_no_document_and_a_document_no_mesh(document: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["place", str(ROOT / "meshes/cube.obj"), "-o", str(tmp_path / "o.skin")]) == 1
    assert "make one from a mesh with skinfab make or skinfab segment" in capsys.readouterr().err
    assert main(["flatten", str(document), "-o", str(tmp_path / "o.obj")]) == 1
    assert "is a skin document, which is cut and flat already" in capsys.readouterr().err
