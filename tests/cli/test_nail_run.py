"""`skinfab nail train` and `run`: from logs to a model, from a model to decisions on a log."""

import argparse
import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skinfab.cli.main import main
from skinfab.cli.nail_judged import judged
from skinfab.cli.nail_run import _facts
from skinfab.fingertip.nail.live import Told, decide_log
from skinfab.fingertip.nail.model_file import load_nail
from skinfab.fingertip.nail.pace import pace_of_log
from skinfab.fingertip.nail.reader import Decision
from skinfab.fingertip.nail.regress import Continuous
from skinfab.readout.logs.log import read_log

FILES = ["decisions.csv", "nail.png", "result.json"]


@pytest.fixture(scope="module")
def logs(nail_logs: Path) -> Path:
    return nail_logs


@pytest.fixture(scope="module")
def model(nail_model: Path) -> Path:
    return nail_model


def result(capsys: pytest.CaptureFixture[str]) -> dict:  # type: ignore[type-arg]
    said = capsys.readouterr()
    assert said.err == ""
    return json.loads(said.out)  # type: ignore[no-any-return]


@pytest.mark.parametrize("method", ["improved", "published"])
def test_train(logs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], method: str) -> None:
    options = ["--participant", "1", "--method", method, "-o", str(tmp_path / "m.npz"), "--json"]
    assert main(["nail", "train", str(logs / "labels.csv"), *options]) == 0
    found = result(capsys)
    assert found["simulated"] and found["trials"] == 28 and found["classes"][0] == "none" and len(found["classes"]) == 7
    held = found["held_out"]
    assert held["by"] == "test part of the table" and sum(map(sum, held["whole trials"]["counts"])) == 12
    rate = held["whole trials"]["accuracy"]
    assert 0.4 < rate["value"] and rate["low"] < rate["value"] <= rate["high"]
    assert ("33 readings" in held) == (method == "improved")
    sure = held["whole trials"]["confidence"]
    assert sure is None if method == "published" else 0.4 < sure["mean"] <= 1 and 0.4 < sure["right"] <= 1
    if method == "published":  # its window is what it learned from
        log = str(logs / "participant-1.csv")
        assert main(["nail", "run", str(tmp_path / "m.npz"), log, "--window", "33", "-o", str(tmp_path / "o")]) == 2
        assert "decides on the 243 readings that m.npz learned from; leave --window out" in capsys.readouterr().err
    assert (tmp_path / "m.npz").read_bytes()[:2] == b"PK" and [each.name for each in tmp_path.iterdir()] == ["m.npz"]


def test_train_says_it_in_words(logs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["nail", "train", str(logs / "labels.csv"), "--participant", "all", "-o", str(tmp_path / "m.npz")]) == 0
    said = capsys.readouterr()
    assert "improved (simulated): 80 trials of 1, 2" in said.out and "held out by participant" in said.out and "% right [" in said.out
    assert "forces from" in said.err and "too much alike" in said.err
    assert "where a finger was aimed at, not where it came to lie" in said.out
    assert "of the contacts are right" in said.out and "train a model for each person" not in said.out  # these are two persons'


def test_one_persons_model_is_told_as_such(logs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model, table = str(tmp_path / "m.npz"), logs / "labels.csv"
    rows = table.read_text().splitlines()
    own = [row for row in rows if row.startswith("participant-1.csv")]
    (logs / "own.csv").write_text("\n".join([*rows[:2], *own, *own[:3]]) + "\n")  # three of them twice
    assert main(["nail", "train", str(logs / "own.csv"), "-o", model]) == 0
    said = capsys.readouterr()
    assert "28 trials of 1" in said.out and "train a model for each person" in said.out
    assert "note: own.csv: 3 rows are there twice, and count once" in said.err
    other = [str(logs / "participant-2.csv"), "--labels", str(table), "--every", "64", "-o", str(tmp_path / "o")]
    main(["nail", "run", model, *other, "--json"])
    found = json.loads(capsys.readouterr().out)
    assert found["participants"] == ["1"] and found["labels"]["trials"] == 40
    assert any("the trials are of 2 and the model learned from 1: fingers differ" in note for note in found["notes"])
    assert any("a model is one person's, here of 1" in note for note in found["notes"])


def test_run_on_a_log(logs: Path, model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    log = str(logs / "participant-1.csv")
    assert (
        main(["nail", "run", str(model), log, "--labels", str(logs / "labels.csv"), "--every", "16", "-o", str(tmp_path / "o"), "--json"])
        == 0
    )
    found = result(capsys)
    assert sorted(each.name for each in (tmp_path / "o").iterdir()) == FILES
    assert json.loads((tmp_path / "o/result.json").read_text()) == found and found["simulated"] and found["window_readings"] == 33
    labels = found["labels"]  # the 28 trials of the training part are in the model
    assert (labels["trials"], labels["learned_from"]) == (12, 28) and labels["accuracy"]["low"] < labels["accuracy"]["value"] > 0.5
    assert "the model learned from 28 of the 40 trials, which are not counted" in found["notes"]
    assert (
        160 < found["drive_hz"]["low"] < found["drive_hz"]["high"] < 180
        and abs(found["drive_hz"]["median"] - 169) < 0.5
        and sum(found["touched"].values()) == found["windows"]
    )
    text = (tmp_path / "o/decisions.csv").read_text().splitlines()
    assert text[0] == "# simulated: true"
    rows = list(csv.DictReader(text[1:]))
    assert len(rows) == found["windows"] and {each["missing"] for each in rows} == {""}
    touched = next(each for each in rows if each["contact"] == "1" and each["strange"] == "0")
    assert abs(float(touched["x_mm"])) < 10 and touched["angle_deg"] == "" and 0 < float(touched["confidence"]) <= 1


def test_a_model_of_simulated_readings_says_so_of_measured_ones(
    logs: Path, model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = (logs / "participant-1.csv").read_text().splitlines()
    (tmp_path / "own.csv").write_text("\n".join(line.replace('"simulated": true', '"simulated": false') for line in lines) + "\n")
    assert main(["nail", "run", str(model), str(tmp_path / "own.csv"), "--every", "64", "-o", str(tmp_path / "o")]) == 0
    assert "m.npz was learned from simulated readings: what it says of measured ones is marked as simulated" in capsys.readouterr().err


def test_run_says_it_in_words(logs: Path, model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert (
        main(["nail", "run", str(model), str(logs / "participant-1.csv"), "--window", "16", "--every", "64", "-o", str(tmp_path / "o")])
        == 0
    )
    said = capsys.readouterr()
    assert "participant-1.csv (simulated):" in said.out and "windows of 11.4 ms" in said.out and "the motor turned at 169." in said.out


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ([], "give a LOG or --port PORT"),
        (["a.csv", "--port", "p"], "one of them"),
        (["a.csv", "--seconds", "3"], "--seconds is for a port"),
        (["--port", "p", "--labels", "l.csv"], "--labels is for a log"),
        (["a.csv", "--window", "0"], "'0' is not a whole number from 1 up"),
    ],
)
def test_wrong_usage(model: Path, arguments: list[str], says: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["nail", "run", str(model), *arguments, "-o", "o"]) == 2
    said = capsys.readouterr().err
    assert says in said and "usage: skinfab nail run" in said


def test_input_that_cannot_be_used(logs: Path, model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    log, out = str(logs / "participant-1.csv"), str(tmp_path / "o")
    for arguments, says in (
        (["train", str(logs / "labels.csv"), "-o", out + ".npz"], "2 participants (1, 2), and fingers differ; choose with --participant"),
        (["train", str(logs / "labels.csv"), "--participant", "Ann", "-o", out + ".npz"], "there is no participant 'Ann'"),
        (["train", str(logs / "labels.csv"), "-o", str(tmp_path / "gone/m.npz")], "its folder does not exist"),
        (["run", log, log, "-o", out], "not a whole model"),
        (["run", str(model), str(logs / "labels.csv"), "-o", out], "labels.csv"),
        (["run", str(model), log, "--window", "7", "-o", out], "a window of 7 readings is none"),
        (["run", str(model), log, "--window", "16000", "-o", out], "give a shorter --window"),
    ):
        assert main(["nail", *arguments]) == 1
        said = capsys.readouterr()
        assert says in said.err and said.err.count("\n") == 1 and said.out == ""
    assert list(tmp_path.iterdir()) == []


def test_a_motor_that_is_off_is_refused(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    still = np.array([0, 0, 1, 0, 0, 0]) + np.array([0.01] * 3 + [0.5] * 3) * np.random.default_rng(0).standard_normal((600, 6))
    rows = "\n".join(f"{k / 1400:.6f}," + ",".join(f"{v:.5f}" for v in row) for k, row in enumerate(still))
    (tmp_path / "off.csv").write_text("time_s,Ax,Ay,Az,Gx,Gy,Gz\n" + rows + "\n")
    assert main(["nail", "run", str(model), str(tmp_path / "off.csv"), "-o", str(tmp_path / "o")]) == 3
    assert "the motor does not turn" in capsys.readouterr().err and not (tmp_path / "o").exists()


def test_another_instrument_is_refused(logs: Path, model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    lines = (logs / "participant-1.csv").read_text().splitlines()
    head = next(k for k, line in enumerate(lines) if ",Ax," in line)
    names, rows = lines[head].split(","), [line.split(",") for line in lines[head + 1 : head + 1500]]
    at = [names.index(name) for name in ("Ax", "Ay", "Az", "Gx", "Gy", "Gz")]
    swapped = "\n".join(f"{k / 1400:.6f}," + ",".join(row[j] for j in at[::-1]) for k, row in enumerate(rows))
    (tmp_path / "a.csv").write_text("time_s,Ax,Ay,Az,Gx,Gy,Gz\n" + swapped + "\n")
    assert main(["nail", "run", str(model), str(tmp_path / "a.csv"), "-o", str(tmp_path / "o")]) == 3
    assert capsys.readouterr().out.startswith("nothing is decided: the windows are like nothing the model learned from")
    table = list(csv.DictReader(line for line in (tmp_path / "o/decisions.csv").read_text().splitlines() if line[0] != "#"))
    assert all((each["confidence"] == "") == (each["strange"] == "1") for each in table if each["label"])


@pytest.fixture(scope="module")
def plain(logs: Path) -> Path:
    """The first participant's log saved anew by another program: the same readings in another file."""
    lines = [line for line in (logs / "participant-1.csv").read_text().splitlines() if line[0] != "#"]
    at = [lines[0].split(",").index(name) for name in ("device_time", "Ax", "Ay", "Az", "Gx", "Gy", "Gz")]
    rows = [[float(line.split(",")[k]) for k in at] for line in lines[1:]]
    path = logs / "plain.csv"
    path.write_text("time_s,Ax,Ay,Az,Gx,Gy,Gz\n" + "\n".join(",".join(f"{v:.6f}" for v in row) for row in rows) + "\n")
    return path


Asked = Callable[[list[str]], tuple[dict[str, Any], list[str]]]


@pytest.fixture(scope="module")
def judged_on(model: Path, plain: Path) -> Asked:
    """What a table's trials of that log come to."""
    content, log = load_nail(model), read_log(plain)
    pace = pace_of_log(log)
    told, _ = decide_log(content.model, log.recording, samples=33, every=64, pace=pace, regression=content.regression)

    def ask(table: list[str]) -> tuple[dict[str, Any], list[str]]:
        path = plain.parent / "l.csv"
        path.write_text("\n".join(line.replace("participant-1.csv", "plain.csv") for line in table) + "\n")
        facts, notes = judged(path, log, told, 33, content, pace)
        return facts["labels"], notes

    return ask


def test_the_same_readings_in_another_file_do_not_judge(logs: Path, judged_on: Asked) -> None:
    labels, notes = judged_on((logs / "labels.csv").read_text().splitlines())
    assert (labels["trials"], labels["learned_from"]) == (12, 28)
    assert "the model learned from 28 of the 40 trials, which are not counted" in notes


def test_a_table_that_does_not_go_with_the_log_is_told(logs: Path, judged_on: Asked) -> None:
    head, *rows = (logs / "labels.csv").read_text().splitlines()[1:]
    own = [row.split(",") for row in rows if row.startswith("participant-1.csv")]
    late = [",".join([row[0], f"{float(row[1]) + 5:.6f}", f"{float(row[2]) + 5:.6f}", *row[3:]]) for row in own]
    labels, notes = judged_on([head, *late])
    assert labels["beyond"] == 28
    assert any("28 of the 40 rows of l.csv end after the log does, at 7.314 s, and count nowhere" in note for note in notes)
    name = next(row[3] for row in own if row[3] != "none")
    labels, notes = judged_on([head, *(",".join(row).replace(f",{name},", ",thumb,") for row in own)])
    assert "the model knows no thumb: 2 of the 12 trials can never be right" in notes
    short = [",".join([*row[:2], f"{float(row[1]) + 0.01:.6f}", *row[3:]]) for row in own]
    labels, notes = judged_on([head, *short])
    assert labels["mean_place_error_mm"] is None
    assert labels["trials"] == 0 and "no trial has a window of 33 readings that could be decided, and counts nowhere; see --window" in notes


def test_trials_in_which_nothing_could_be_decided_are_told(logs: Path, judged_on: Asked) -> None:
    head, *rows = (logs / "labels.csv").read_text().splitlines()[1:]
    own = [row.split(",") for row in rows if row.startswith("participant-1.csv") and ",test," in row]
    own[0][2] = f"{float(own[0][1]) + 0.01:.6f}"
    labels, notes = judged_on([head, *map(",".join, own)])
    assert labels["trials"] == 11 and 0.3 < labels["mean_place_error_mm"] < 3 and labels["mean_angle_error_deg"] is None
    assert "1 of the 12 trials have no window of 33 readings that could be decided, and count nowhere; see --window" in notes


def test_the_published_method_judges_trials_that_lack_some_frames(logs: Path, plain: Path, tmp_path: Path) -> None:
    """It learned from whole trials; a log of which one frame in fifty was lost has its trials counted all the same."""
    model, (head, *rows) = tmp_path / "p.npz", plain.read_text().splitlines()
    options = ["--participant", "1", "--method", "published"]
    assert main(["nail", "train", str(logs / "labels.csv"), *options, "-o", str(model)]) == 0
    kept = np.random.default_rng(0).uniform(size=len(rows)) > 0.02
    for name, lines in (("lost.csv", [row for row, there in zip(rows, kept, strict=True) if there]), ("cut.csv", rows[::2])):
        (tmp_path / name).write_text("\n".join([head, *lines]) + "\n")
        table = (logs / "labels.csv").read_text().replace("participant-1.csv", name)
        (tmp_path / "l.csv").write_text(table)
        log, content = read_log(tmp_path / name), load_nail(model)
        facts, notes = judged(tmp_path / "l.csv", log, [], 243, content, pace_of_log(log))
        if name == "lost.csv":
            assert facts["labels"]["trials"] == 12 and facts["labels"]["right"] >= 6 and not any("count nowhere" in note for note in notes)
        else:
            assert facts["labels"]["trials"] == 0 and any("no trial has 243 readings of all six channels" in note for note in notes)


@pytest.mark.parametrize(("deciding", "says"), [(0.8, "give a larger --every"), (0.1, "busy with other things, as deciding took 10%")])
def test_what_is_said_of_a_run(model: Path, deciding: float, says: str) -> None:
    """Who is late, and why; which wire is off; where forces end."""
    content = load_nail(model)
    far = Decision("pin 1", 0.9, True, False, Continuous(force_n=2.9, force_end="high"), ("Gy",))
    facts = {"notes": [], "simulated": True, "lost": 0, "window_readings": 33, "latency_ms": {"median": 900.0}, "deciding": deciding}
    found = _facts(argparse.Namespace(model=model), content, [Told(k / 10, far, 169.0, 0.0, True) for k in range(5)], facts)
    notes = found["notes"]
    assert any(says in note and "0.9 s behind in the median" in note for note in notes)
    assert "channel Gy had too few readings or stood still, in 100.0% of the windows, decided without it" in notes
    assert "the force is at the high end of those that were learned in 100% of the windows: it may be more" in notes
