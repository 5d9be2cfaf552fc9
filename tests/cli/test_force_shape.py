"""`skinfab force simulate|train|run shape`: grasps to a model to decisions, and the ways in which it is used wrongly."""

import csv
import json
from pathlib import Path
from typing import Any

import pytest

from skinfab.cli.main import main
from skinfab.fingertip.force.grasp_file import read_grasps
from skinfab.fingertip.force.shape import ShapeModel


def said(capsys: pytest.CaptureFixture[str], *arguments: object) -> dict[str, Any]:
    """Run with --json: one object on standard output, and nothing else."""
    assert main(["force", *map(str, arguments), "--json"]) == 0
    result: dict[str, Any] = json.loads(capsys.readouterr().out)
    return result


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("shape")
    assert main(["force", "simulate", "shape", "-o", str(folder), "--grasps", "8"]) == 0
    assert main(["force", "train", "shape", str(folder / "grasps.csv"), "-o", str(folder / "model")]) == 0
    return folder


def test_training_tells_what_it_is_worth_on_objects_held_out(made: Path) -> None:
    result = json.loads((made / "model/result.json").read_text())
    rate = result["held_out"]
    assert 0.4 < rate["low"] <= rate["accuracy"] <= rate["high"] and result["simulated"] and result["objects"] == 6
    assert sum(map(sum, result["confusion"]["counts"])) == 48
    model = ShapeModel.load(made / "model/model.npz")
    assert model.facts["simulated"] is True and (made / "model/confusion.png").read_bytes().startswith(b"\x89PNG")


def test_from_grasps_to_decisions_and_sizes(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    result = said(capsys, "run", "shape", made / "new.csv", made / "held.csv", "--model", made / "model/model.npz", "-o", tmp_path)
    by = {each["object"]: each for each in result["objects"]}
    assert result["simulated"] and [by[k]["shape"] for k in (200, 201, 202)] == ["sphere", "cylinder", "cuboid"]
    assert by[200]["size_mm"][0] == pytest.approx(45, abs=4) and by[201]["size_mm"][0] == pytest.approx(30, abs=4)
    assert any("centre of gravity" in note for note in result["notes"])  # the new cuboid was held in a single pose
    assert sorted(each.name for each in tmp_path.iterdir()) == ["result.json", "shape.png", "shapes.csv"]
    rows = list(csv.DictReader((tmp_path / "shapes.csv").read_text().splitlines()))
    assert len(rows) == 6 and {row["simulated"] for row in rows} == {"1"}


def test_what_is_unclear_asks_for_another_grasp(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = [
        "run",
        "shape",
        str(made / "held.csv"),
        "--model",
        str(made / "model/model.npz"),
        "-o",
        str(tmp_path),
        "--confidence",
        "0.9999999",
    ]
    assert main(["force", *arguments]) == 0
    assert "grasp again" in capsys.readouterr().out


def test_a_file_comes_back_as_it_was(made: Path) -> None:
    grasps = read_grasps(made / "held.csv")
    assert len(grasps) == 12 and grasps[0].force.shape == (10, 4, 3) and grasps[0].simulated
    assert [each.object for each in grasps[::4]] == [200, 201, 202]


def replaced(source: Path, target: Path, column: str, value: str, *, row: int = 3) -> Path:
    """The file with one cell changed."""
    lines = source.read_text().splitlines()
    at = lines[1].split(",").index(column)
    cells = lines[row].split(",")
    cells[at] = value
    lines[row] = ",".join(cells)
    target.write_text("\n".join(lines) + "\n")
    return target


@pytest.mark.parametrize(
    ("column", "value", "says"),
    [
        ("f1_x", "", "a number of a finger is missing"),
        ("grasp", "", "needs the number of its grasp"),
        ("shape", "7", "shape 7 is none"),
        ("shape", "", "does not say its shape"),
        ("size_1", "-1", "sizes"),
        ("shape", "2", "has 3 size"),
    ],
)
def test_grasps_that_cannot_be_learned_from(
    column: str, value: str, says: str, made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = replaced(made / "grasps.csv", tmp_path / "wrong.csv", column, value)
    assert main(["force", "train", "shape", str(wrong), "-o", str(tmp_path / "out")]) == 1
    error = capsys.readouterr().err
    assert says.replace("sizes", "size") in error and "Traceback" not in error and not (tmp_path / "out").exists()


def test_fingers_that_move_between_poses_are_no_grasp(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    wrong = replaced(made / "held.csv", tmp_path / "wrong.csv", "f2_y", "3.0")
    assert main(["force", "run", "shape", str(wrong), "--model", str(made / "model/model.npz"), "-o", str(tmp_path / "out")]) == 1
    assert "change from pose to pose" in capsys.readouterr().err


def test_one_object_of_a_shape_cannot_be_held_out(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["force", "train", "shape", str(made / "new.csv"), "-o", str(tmp_path / "out")]) == 1
    assert "1 object of the shape sphere" in capsys.readouterr().err


def test_the_same_object_in_two_files_is_refused(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "b.csv").write_bytes((made / "grasps.csv").read_bytes())
    assert main(["force", "train", "shape", str(made / "grasps.csv"), str(tmp_path / "b.csv"), "-o", str(tmp_path / "out")]) == 1
    assert "object 0 is in" in capsys.readouterr().err


def test_what_is_no_model(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["force", "run", "shape", str(made / "new.csv"), "--model", str(made / "new.csv"), "-o", str(tmp_path / "out")]) == 1
    assert "Traceback" not in capsys.readouterr().err
    wrong_use = ["run", "shape", str(made / "new.csv"), "--model", "m", "--confidence", "1", "-o", str(tmp_path / "out")]
    assert main(["force", *wrong_use]) == 2
