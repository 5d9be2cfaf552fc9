"""`skinfab calibrate`: the contract's JSON, the files beside it, and the ways in which it is used wrongly."""

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from calibration.strain.document import load_calibration
from calibration.strain.models import MODELS
from skinfab.cli import calibrate
from skinfab.cli.main import main
from skinfab.readout.logs.log import read_log, write_log

FILES = ["calibration.json", "calibration.png", "result.json", "samples.csv"]


def writer(folder: Path) -> Callable[..., str]:
    def write(*, name: str = "log.csv", scale: float = 1.0, remark: str = "") -> str:
        time = np.arange(3200) / 100
        angle = 45 - 40 * np.cos(2 * np.pi * time / 8)
        reading = 2.5 * (1 + scale * (2e-3 * angle + 2e-5 * angle**2)) + 0.002 * np.random.default_rng(0).standard_normal(3200)
        rows = "\n".join(f"{t},{a},{u}" for t, a, u in zip(time.tolist(), angle.tolist(), reading.tolist(), strict=True))
        (folder / name).write_text(f"{remark}time,PIP,U\n{rows}\n")
        return str(folder / name)

    return write


@pytest.fixture
def log(tmp_path: Path) -> Callable[..., str]:
    return writer(tmp_path)


def test_the_names_are_the_models() -> None:
    assert calibrate.NAMES == ("auto", *MODELS)


def test_json_and_files(log: Callable[..., str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    words = ["calibrate", log(), "--signal", "U", "--angle", "PIP", "-o", str(out), "--json", "--new-task", log(name="b.csv", scale=1.1)]
    assert main(words) == 0
    printed = capsys.readouterr()
    result = json.loads(printed.out)
    assert sorted(path.name for path in out.iterdir()) == FILES and json.loads((out / "result.json").read_text()) == result
    assert (result["model"], result["degree"], result["range_deg"]) == ("poly", 2, [10.0, 80.0])
    assert set(result["sensitivity_per_deg"]) == {"min", "mean", "max"} and set(result["models"]) == set(MODELS)
    assert all(each["us_per_sample"] > 0 and each["held_out_rms_deg"] < 1 for each in result["models"].values())
    (task,) = result["new_tasks"]
    assert task["file"] == "b.csv" and task["models"]["poly"]["rms_deg"] > 2  # a sensor that reads a tenth more
    loaded = load_calibration(out / "calibration.json")
    with (out / "samples.csv").open() as file:
        rows = list(csv.DictReader(file))
    time, change = (np.array([float(row[key]) for row in rows]) for key in ("time_s", "relative_change"))
    angles, _ = loaded.angles(time, loaded.u0 * (1 + change))
    np.testing.assert_allclose(angles, [float(row["estimate_deg"]) for row in rows], atol=1e-4)
    assert sum(int(row["fitted"]) for row in rows) == result["n"]


def test_words_for_people(log: Callable[..., str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["calibrate", log(remark="# simulated: true\n"), "--signal", "U", "--angle", "PIP", "-o", str(tmp_path / "o")]
    assert main([*words, "--model", "lag", "--degree", "3"]) == 0
    text = capsys.readouterr().out
    assert "curve of degree 3" in text and "* lag" in text and "degrees rms on the half that was held out" in text
    assert (tmp_path / "o/samples.csv").read_text().startswith("# simulated: true\n")
    assert json.loads((tmp_path / "o/result.json").read_text())["log"]["simulated"] is True


@pytest.mark.parametrize(
    ("words", "status", "says"),
    [
        (["--signal", "V"], 1, "no column 'V'"),
        (["--range", "80", "10"], 2, "the first must be below the second"),
        (["--range", "100", "120"], 1, "give --range 5 85"),
        (["--degree", "0"], 2, "neither auto nor a degree"),
        (["--model", "magic"], 2, "invalid choice"),
        (["--new-task", "nowhere.csv"], 1, "nowhere.csv: No such file"),
    ],
)
def test_wrong_usage(
    words: list[str], status: int, says: str, log: Callable[..., str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert main(["calibrate", log(), "--signal", "U", "--angle", "PIP", "-o", str(out), *words]) == status
    assert says in capsys.readouterr().err and not out.exists()


def test_another_logs_calibration_is_not_overwritten(log: Callable[..., str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def words(path: str) -> list[str]:
        return ["calibrate", path, "--signal", "U", "--angle", "PIP", "--model", "poly", "--degree", "2", "-o", str(tmp_path / "o")]

    assert main(words(log())) == 0
    assert main(words(log())) == 0  # made anew of the same log
    before = {path.name: path.read_bytes() for path in (tmp_path / "o").iterdir()}
    assert main(words(log(name="b.csv", scale=1.1))) == 1
    assert "calibration.json is there already and is of another log, log.csv; give another -o" in capsys.readouterr().err
    (tmp_path / "o/calibration.json").write_text("{}")
    assert main(words(log())) == 1
    assert "is not a calibration that could be made anew" in capsys.readouterr().err
    assert {path.name: path.read_bytes() for path in (tmp_path / "o").iterdir()} == before | {"calibration.json": b"{}"}


def test_an_interrupted_run_leaves_the_folder_as_it_was(log: Callable[..., str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    words = ["calibrate", log(), "--signal", "U", "--angle", "PIP", "--degree", "2", "-o", str(tmp_path / "o")]
    assert main([*words, "--model", "poly"]) == 0
    before = {path.name: path.read_bytes() for path in (tmp_path / "o").iterdir()}

    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("calibration.strain.figure.draw_calibration", interrupted)  # the last file; three are written by then
    assert main([*words, "--model", "play"]) != 0
    assert {path.name: path.read_bytes() for path in (tmp_path / "o").iterdir()} == before


def test_the_clocks_are_told_and_notes_of_other_tasks(log: Callable[..., str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = Path(log()).read_text().splitlines()
    time = np.array([float(line.partition(",")[0]) for line in lines[1:]])
    warped = 45 - 40 * np.cos(time + 0.6 * np.sin(time / 5))
    late = 2.5 * (1 + 2e-3 * np.interp(time - 0.3, time, warped))
    text = "\n".join(f"{t},{a},{u}" for t, a, u in zip(time.tolist(), warped.tolist(), late.tolist(), strict=True))
    (tmp_path / "late.csv").write_text(f"time,PIP,U\n{text}\n")
    task = "\n".join(line if k != 500 else line.rpartition(",")[0] + ",4e30" for k, line in enumerate(lines))
    (tmp_path / "task.csv").write_text(task + "\n")
    words = ["calibrate", str(tmp_path / "late.csv"), "--signal", "U", "--angle", "PIP", "-o", str(tmp_path / "o")]
    assert main([*words, "--new-task", str(tmp_path / "task.csv")]) == 0
    said = capsys.readouterr()
    assert "readings come 0.30 s after the angles" in said.out
    assert "the clocks of camera and board do not agree" in said.err and "task.csv, row 500: 'U' is 4e+30" in said.err
    result = json.loads((tmp_path / "o/result.json").read_text())
    assert result["clock"]["lag_s"] == pytest.approx(0.3, abs=0.015) and "row 500" in result["new_tasks"][0]["notes"][0]
    low, high = result["clock"]["interval_s"]
    assert low <= 0.3 <= high


def test_what_is_useless_is_not_written_and_why_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Clocks 6 s apart, and a wire that was open for 0.05 s."""
    time = np.arange(6000) / 100
    angle = 45 + 25 * np.sin(1.1 * time + np.sin(0.7 * time)) + 15 * np.sin(2.1 * time)
    reading = 1 + 2e-3 * np.interp(time - 6, time, angle)
    reading[1000:1005] = 60.0
    rows = "\n".join(f"{t},{a},{u}" for t, a, u in zip(time.tolist(), angle.tolist(), reading.tolist(), strict=True))
    (tmp_path / "log.csv").write_text(f"time,PIP,U\n{rows}\n")
    words = ["calibrate", str(tmp_path / "log.csv"), "--signal", "U", "--angle", "PIP", "-o", str(tmp_path / "o")]
    assert main(words) == 3
    said = capsys.readouterr().err
    assert "the calibration is useless: on the half held out" in said and "were both recorded at once" in said
    assert "row 1001: 'U' is 60" in said and not (tmp_path / "o").exists()


def test_a_place_that_is_none(log: Callable[..., str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert main(["calibrate", log(), "--signal", "U", "--angle", "PIP", "-o", str(tmp_path / "file")]) == 1
    assert "file" in capsys.readouterr().err


def result_of(path: Path) -> dict[str, Any]:
    """What a curve of degree 2 is in the JSON."""
    words = ["calibrate", str(path), "--signal", "U", "--angle", "PIP", "--model", "poly", "--degree", "2"]
    assert main([*words, "-o", str(path.with_name(f"of_{path.name}")), "--json"]) == 0
    found: dict[str, Any] = json.loads((path.with_name(f"of_{path.name}") / "result.json").read_text())
    return found


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    """A log, and what comes of it."""
    path = Path(writer(tmp_path_factory.mktemp("plain"))())
    return path, result_of(path)


@pytest.mark.parametrize("name", ["again.csv", "log.mcap", "log.bag", "bag"])
def test_any_log_gives_the_same(plain: tuple[Path, dict[str, Any]], tmp_path: Path, name: str) -> None:
    path, expected = plain
    write_log(read_log(path).recording, tmp_path / name)
    result = result_of(tmp_path / name)
    for key in ("n", "sse", "coefficients", "held_out_rms_deg", "notes"):
        assert result[key] == expected[key]
