"""`skinfab place`: sensors on the pieces of a document."""

import json
from pathlib import Path

import pytest

from skinfab.cli.main import main
from skinfab.document import load_skin

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
