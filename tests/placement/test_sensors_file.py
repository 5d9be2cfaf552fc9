"""Reading a file of sensors: what is in it, and what is wrong with it."""

import math
import re
from pathlib import Path

import pytest

from skinfab.errors import InputError
from skinfab.material import load_material
from skinfab.placement.sensors_file import Anywhere, FlatPose, OnObject, read_sensors_file

MATERIAL = load_material()
GOOD = '[[sensor]]\nkind = "contact-spiral"\nparams = { n = 3, x = 1.7, b = 1.5, l = 3, s = 15 }\npose = "auto"\n'


def read(tmp_path: Path, text: str) -> object:
    file = tmp_path / "sensors.toml"
    file.write_text(text)
    return read_sensors_file(file, material=MATERIAL)


def test_the_example_of_the_user_guide(tmp_path: Path) -> None:
    guide = (Path(__file__).parents[2] / "docs" / "sensors.md").read_text(encoding="utf-8")
    least, most = re.findall(r"```toml\n(.*?)```", guide, re.S)[:2]
    (only,) = read(tmp_path, least).requests
    assert (only.id, only.pose, only.pattern.s, only.pattern.n, only.pattern.x) == ("C1", Anywhere(), 20, 3, 1.95)
    wanted = read(tmp_path, most)
    assert [(r.id, r.channel) for r in wanted.requests] == [("C1", 0), ("S1", 7), ("C2", 1)]
    assert wanted.requests[0].pose == FlatPose("P1", 12.5, 20.0, math.pi / 2)
    assert wanted.requests[1].pose == Anywhere() and wanted.requests[1].pattern.b == 6
    assert wanted.requests[2].pose == OnObject((4.0, 0.0, 31.5), None)
    assert (wanted.auto.kinds, wanted.auto.sizes, wanted.auto.per_piece) == (("contact-spiral",), (22.0, 15.0), 2)
    assert wanted.requests[0].pattern.pad == MATERIAL.pad


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "asks for no sensor"),
        ("sensor = 3", r"write \[\[sensor\]\]"),
        ("[sensors]", "unknown field 'sensors' .did you mean 'sensor'"),
        ("a = ", "is not a TOML file"),
        (GOOD.replace("pose", "poses"), r"sensor 1 .C1. of sensors.toml: unknown field 'poses' \(did you mean 'pose'"),
        (GOOD.replace('kind = "contact-spiral"', ""), "field 'kind' is missing; it needs kind and params"),
        (GOOD.replace('"auto"', '"automatic"'), "pose is 'automatic'; it must be"),
        (GOOD.replace('"auto"', "{ x = 3, y = 4 }"), "field 'piece' is missing"),
        (GOOD.replace('"auto"', '{ piece = "P1", x = "3", y = 4 }'), "x is '3'; it must be a number"),
        (GOOD.replace('"auto"', "{ point = [3, 4] }"), r"point is \[3, 4\]"),
        (GOOD.replace("x = 1.7", "x = 1.0"), "sensor 1 .C1. of sensors.toml: contact-spiral: x is 1.0; it must be at least 1.385"),
        (
            GOOD.replace("x = 1.7", "x = 1.7, bead = 0.784"),
            "sensor 1 .C1. of sensors.toml: contact-spiral: bead is 0.784; .* at least 0.785",
        ),
        (GOOD.replace("x = 1.7", "pitch = 1.7"), "sensor 1 .C1. of sensors.toml: contact-spiral: unknown parameter 'pitch'"),
        (GOOD + "channel = -1", "channel is -1; it must be a whole number"),
        (GOOD + 'id = ""', "sensor 1 of sensors.toml: id is ''"),
        (GOOD + 'id = "=A1"', "id is '=A1'; it must be a name such as \"C1\": 1 to 64 letters"),
        (GOOD + r'id = "A\nG28 Z"', r"id is 'A\\nG28 Z'"),
        (GOOD + 'id = "a/b"', "id is 'a/b'"),
        (GOOD + 'id = "thumb"\nchannel = -1', "sensor 1 .thumb. of sensors.toml: channel is -1"),
        (GOOD + GOOD.replace("kind =", "knid ="), "sensor 2 of sensors.toml: unknown field 'knid'"),
        (GOOD + GOOD.replace("s = 15", "s = -1"), "sensor 2 .C2. of sensors.toml: contact-spiral: s is -1"),
        (GOOD + "channel = 3\n" + GOOD + "channel = 3", "sensor 2 .C2. of sensors.toml: channel 3 is used more than once"),
        (GOOD + 'id = "C1"\n' + GOOD + 'id = "C1"', "id C1 is used more than once"),
        ("[auto]\nsize = [3]", r"\[auto\]: unknown field 'size' .did you mean 'sizes'"),
        ('[auto]\nkinds = "strain-lines"', "kinds is 'strain-lines'; it must be a list"),
        ('[auto]\nkinds = ["strain"]', "knows no kind 'strain'"),
        ("[auto]\nsizes = [-3]", "sizes are"),
        *((f"[auto]\nper_piece = {n}", f"per_piece is {n}; it must be a whole number, 1 or more") for n in (1.5, -1, 0)),
    ],
)
def test_mistakes_are_named(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        read(tmp_path, text)


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot read sensors from"):
        read_sensors_file(tmp_path / "none.toml", material=MATERIAL)
