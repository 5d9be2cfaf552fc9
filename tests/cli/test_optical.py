"""`skinfab optical`: simulate, and the ways in which it is used wrongly."""

import csv
import json
from pathlib import Path

import cv2
import pytest

from skinfab.cli.main import main


def simulate(folder: Path, *words: str) -> int:
    return main(["optical", "simulate", "--images", "12", "-o", str(folder), *words])


def test_images_and_their_poses_are_written_and_say_that_they_are_simulated(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert simulate(tmp_path / "a", "--json") == 0
    said = json.loads(capsys.readouterr().out)
    assert said["simulated"] and said["pins"] == 127
    rows = list(csv.DictReader((tmp_path / "a/targets.csv").read_text().splitlines()))
    assert len(rows) == 12 and {row["simulated"] for row in rows} == {"1"} and len({row["group"] for row in rows}) == 2
    for row in rows:
        assert abs(float(row["offset_mm"])) <= 8 and 0.3 <= float(row["depth_mm"]) <= 2.4 and abs(float(row["angle_deg"])) <= 180
        assert b"simulated: true" in (tmp_path / "a" / row["image"]).read_bytes()[:80]
        assert cv2.imread(str(tmp_path / "a" / row["image"]), cv2.IMREAD_GRAYSCALE).shape == (240, 240)


def test_the_same_seed_gives_the_same_images(tmp_path: Path) -> None:
    for name, seed in (("a", "3"), ("b", "3"), ("c", "4")):
        assert simulate(tmp_path / name, "--seed", seed, "--json") == 0
    first = (tmp_path / "a/images/00001.png").read_bytes()
    assert (tmp_path / "b/images/00001.png").read_bytes() == first != (tmp_path / "c/images/00001.png").read_bytes()
    assert (tmp_path / "a/targets.csv").read_bytes() == (tmp_path / "b/targets.csv").read_bytes()


def test_depths_are_those_asked_for(tmp_path: Path) -> None:
    assert simulate(tmp_path, "--depth", "1.0", "1.2", "--json") == 0
    rows = list(csv.DictReader((tmp_path / "targets.csv").read_text().splitlines()))
    assert {1.0 <= float(row["depth_mm"]) <= 1.2 for row in rows} == {True}
    assert max(abs(float(row["offset_mm"])) for row in rows) < 8  # a lighter touch reaches less far


def test_pictures_of_another_run_are_not_mixed_in(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert simulate(tmp_path) == simulate(tmp_path, "--seed", "1") == 0  # as many take the place of those before
    before = (tmp_path / "targets.csv").read_bytes()
    capsys.readouterr()
    assert simulate(tmp_path, "--images", "5") == 1
    assert "holds 7 others already (00006.png, ...)" in capsys.readouterr().err
    assert (tmp_path / "targets.csv").read_bytes() == before


def test_the_seeds_dome_has_more_pins(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["optical", "simulate", "--images", "1", "--paper", "--shear", "0", "-o", str(tmp_path)]) == 0
    assert "271 pins" in capsys.readouterr().out
    assert cv2.imread(str(tmp_path / "images/00001.png"), cv2.IMREAD_GRAYSCALE).shape == (440, 440)


@pytest.mark.parametrize(
    "words",
    [
        ["--reach", "21"],
        ["--reach", "far"],
        ["--shear", "-1"],
        ["--images", "0"],
        ["--depth", "2", "1"],
        ["--depth", "0", "1"],
        ["--depth", "1", "4"],
    ],
)
def test_wrong_words_are_wrong_usage(words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert simulate(tmp_path / "a", *words) == 2
    assert capsys.readouterr().err and not (tmp_path / "a").exists()


def test_a_place_that_cannot_be_written_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert simulate(tmp_path / "file" / "out") == 1
    assert len(capsys.readouterr().err.strip().splitlines()) == 1
