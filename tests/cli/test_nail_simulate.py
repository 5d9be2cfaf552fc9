"""`skinfab nail simulate`: logs and labels that belong together, marked as simulated, the same for the same seed."""

import json
import shlex
from pathlib import Path

import numpy as np
import pytest

from skinfab.cli import nail_simulate
from skinfab.cli.main import main
from skinfab.fingertip.nail.labels import read_trials
from skinfab.fingertip.nail.patterns import TESTS
from skinfab.fingertip.nail.protocol import Protocol, session
from skinfab.readout.table import read_table

SMALL = ["--participants", "2", "--training", "2", "--rounds", "1", "--samples", "64"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("nail") / "logs"
    assert main(["nail", "simulate", "--test", "edges4", *SMALL, "-o", str(out)]) == 0
    return out


def test_the_tests_are_the_libraries() -> None:
    assert nail_simulate.TESTS == tuple(TESTS)


def test_labels_cut_the_logs_into_the_very_trials(folder: Path) -> None:
    trials, simulated, notes = read_trials(folder / "labels.csv")
    assert simulated and notes == []
    assert len(trials) == 2 * (5 * 2 + 4)
    protocol = Protocol(2, 2, 1, 1, 64)
    for number in (1, 2):
        made = session("edges4", number, protocol=protocol, in_a_row=True)
        own = [each for each in trials if each.label.participant == str(number)]
        for part, of in (("train", made.training), ("test", made.rounds)):
            readings = np.array([each.values for each in own if each.label.part == part])
            np.testing.assert_allclose(readings[..., :3], of.readings[:, 0, :, :3], atol=0.5e-4)
            np.testing.assert_allclose(readings[..., 3:], of.readings[:, 0, :, 3:], atol=0.5e-2)


def test_labels_say_what_was_aimed_at_and_where_it_lay(folder: Path) -> None:
    trials, _, _ = read_trials(folder / "labels.csv")
    by_name = {pattern.name: pattern for pattern in TESTS["edges4"]}
    for each in (trial.label for trial in trials):
        if each.label == "none":
            assert each.force_n == 0.0 and np.isnan([each.x_mm, each.angle_deg, each.true_x_mm, each.true_angle_deg]).all()
            continue
        pattern = by_name[each.label]
        assert (each.x_mm, each.y_mm) == (pattern.x_mm, pattern.y_mm)
        assert each.angle_deg == pytest.approx(np.degrees(pattern.angle_rad))
        assert 0.7 < each.force_n < 1.3 and 0 <= each.true_angle_deg < 180
        assert 0 < np.hypot(each.true_x_mm - each.x_mm, each.true_y_mm - each.y_mm) < 6


def test_forces_are_drawn_where_they_are_asked_for(tmp_path: Path) -> None:
    assert main(["nail", "simulate", "--test", "pins6", *SMALL, "--force", "0.3:3", "-o", str(tmp_path / "out")]) == 0
    trials, _, _ = read_trials(tmp_path / "out/labels.csv")
    forces = np.array([each.label.force_n for each in trials if each.label.label != "none"])
    assert 0.3 <= forces.min() < 0.5 and 2 < forces.max() <= 3
    assert np.median(forces) == pytest.approx(np.sqrt(0.9), rel=0.4)


def test_every_file_says_that_it_is_simulated(folder: Path) -> None:
    assert read_table(folder / "participant-1.csv").simulated
    assert (folder / "labels.csv").read_text().startswith("# simulated: true\n")


def test_json_and_the_same_seed(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for seed, alike in (("0", True), ("1", False)):
        out = tmp_path / seed
        assert main(["nail", "simulate", "--test", "edges4", *SMALL, "--seed", seed, "--json", "-o", str(out)]) == 0
        told = json.loads(capsys.readouterr().out)
        assert told["simulated"] is True and told["trials"] == {"train": 20, "test": 8} and len(told["files"]) == 3
        assert all(Path(name).is_file() for name in told["files"])
        same = (out / "participant-1.csv").read_bytes() == (folder / "participant-1.csv").read_bytes()
        assert same is alike


def test_the_documents_next_command_works_on_what_was_simulated(folder: Path, tmp_path: Path) -> None:
    document = Path(__file__).parents[2] / "docs/nail.md"
    line = next(each for each in document.read_text().splitlines() if each.startswith("skinfab nail train logs/labels.csv"))
    words = shlex.split(line, comments=True)[1:]
    places = {"logs/labels.csv": str(folder / "labels.csv"), "model.npz": str(tmp_path / "model.npz")}
    assert main([places.get(word, word) for word in words]) == 0
    assert (tmp_path / "model.npz").is_file()


@pytest.mark.parametrize(
    ("words", "status", "says"),
    [
        (["--participants", "0"], 2, "whole number from 1 up"),
        (["--force", "3:0.3"], 2, "not LOW:HIGH in N"),
        (["--force", "1"], 2, "not LOW:HIGH in N"),
        (["--test", "edges5"], 2, "invalid choice"),
        (["--sampels", "4"], 2, "did you mean --samples?"),
    ],
)
def test_wrong_usage_is_told(words: list[str], status: int, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["nail", "simulate", *words, "-o", str(tmp_path / "out")]) == status
    assert says in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_folder_that_cannot_be_made_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert main(["nail", "simulate", *SMALL, "-o", str(tmp_path / "file" / "out")]) == 1
    assert capsys.readouterr().err.count("\n") == 1
