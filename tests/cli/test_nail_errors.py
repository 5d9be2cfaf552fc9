"""How far off direction, place and force are is told, of what was held out and of new trials."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from skinfab.cli.main import main
from skinfab.cli.nail_errors import mean_errors, off_line


def test_forces_are_judged(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Of trials that press with 0.3 to 3 N, by train and by run, in words and in JSON."""
    options = ["--test", "pins6", "--participants", "1", "--training", "2", "--rounds", "1", "--samples", "256", "--force", "0.3:3"]
    assert main(["nail", "simulate", *options, "-o", str(tmp_path / "logs")]) == 0
    model, table = str(tmp_path / "m.npz"), str(tmp_path / "logs/labels.csv")
    capsys.readouterr()
    assert main(["nail", "train", table, "-o", model]) == 0
    assert " % of the force in the mean" in capsys.readouterr().out
    log = str(tmp_path / "logs/participant-1.csv")
    assert main(["nail", "run", model, log, "--labels", table, "--every", "64", "-o", str(tmp_path / "o")]) == 0
    assert " mm, " in (said := capsys.readouterr().out) and " % of the force in the mean" in said
    labels = json.loads((tmp_path / "o/result.json").read_text())["labels"]
    rows = [row for row in csv.DictReader((tmp_path / "logs/labels.csv").read_text().splitlines()[1:]) if row["part"] == "test"]
    decided = list(csv.DictReader((tmp_path / "o/decisions.csv").read_text().splitlines()[1:]))
    off = []
    for row in rows:
        inside = [each for each in decided if float(row["start_s"]) + 0.0225 <= float(each["time_s"]) <= float(row["end_s"])]
        forces = [float(each["force_n"]) for each in inside if each["contact"] == "1"]
        off.append(np.mean([abs(force / float(row["force_n"]) - 1) for force in forces]))
    assert labels["mean_force_error_percent"] == pytest.approx(100 * np.mean(off), rel=0.01) and 5 < 100 * np.mean(off) < 100


def test_what_is_not_known_is_not_told() -> None:
    unknown = mean_errors(np.full((3, 3), np.nan))
    assert set(unknown.values()) == {None} and off_line(unknown) == "" and off_line(mean_errors(np.empty((0, 3)))) == ""
    assert off_line(mean_errors(np.array([[10.0, 1.0, np.nan], [20.0, 2.0, np.nan]]))) == ", off by 15.0 degrees, 1.5 mm in the mean"
