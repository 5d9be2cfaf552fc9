"""`skinfab replay`: angles from a log, the files beside them, the same for every kind of log, and over a pseudo-terminal."""

import csv
import json
import math
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from skinfab.cli.main import main
from skinfab.readout.frame import Channel, Recording, Stream
from skinfab.readout.logs.log import write_log


def recording(*, simulated: bool = True) -> Recording:
    time = np.arange(3200) / 100
    angle = 45 - 40 * np.cos(2 * np.pi * time / 8)
    reading = 2.5 * (1 + 2e-3 * angle + 2e-5 * angle**2) + 0.001 * np.random.default_rng(0).standard_normal(3200)
    channels = (Channel("U", "V", "strain", 0.0, 3.3), Channel("PIP", "deg", "angle"))
    return Recording.of_values(Stream("finger", channels, 100.0, simulated), np.column_stack([reading, angle]), device_time=time)


@pytest.fixture(scope="module")
def calibration(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("calibration")
    write_log(recording(), folder / "log.csv")
    words = ["calibrate", str(folder / "log.csv"), "--signal", "U", "--angle", "PIP", "--model", "poly", "-o", str(folder / "c")]
    assert main(words) == 0
    return folder / "c" / "calibration.json"


@pytest.mark.parametrize("name", ["log.csv", "log.mcap", "log.bag", "log", "log.frames"])
def test_any_log_gives_the_same_angles(tmp_path: Path, calibration: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    write_log(recording(), tmp_path / name)
    out = tmp_path / "out"
    assert main(["replay", str(tmp_path / name), "--calibration", str(calibration), "-o", str(out), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert json.loads((out / "result.json").read_text()) == result
    assert sorted(p.name for p in out.iterdir()) == ["replay.csv", "replay.png", "result.json"]
    assert (result["frames"], result["lost"], result["checks"], result["log"]["simulated"]) == (3200, 0, [], True)
    angle = result["angle"]
    assert angle["rms_in_step_deg"] < 0.5 < angle["rms_deg"] < 5  # the filter's delay is all of the error
    assert angle["without"] == 0 and 5 < angle["min_deg"] < 12 and 78 < angle["max_deg"] < 86
    lines = (out / "replay.csv").read_text().splitlines()
    assert lines[0] == "# simulated: true"
    rows = list(csv.DictReader(lines[1:]))
    assert len(rows) == 3200 and float(rows[1000]["angle_deg"]) == pytest.approx(45 - 40 * math.cos(2 * math.pi * 9.917 / 8), abs=1)


def test_an_interrupted_run_leaves_the_one_before_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_log(recording(), tmp_path / "a.mcap")
    write_log(recording(simulated=False), tmp_path / "b.mcap")
    assert main(["replay", str(tmp_path / "a.mcap"), "-o", str(tmp_path / "out")]) == 0
    before = {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()}

    def interrupted(*args: object, **options: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("calibration.strain.time_figure.draw_over_time", interrupted)
    assert main(["replay", str(tmp_path / "b.mcap"), "-o", str(tmp_path / "out")]) == 130
    assert {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()} == before


def test_words_and_checks_for_people(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = recording(simulated=False)
    made.values[:, 1] = 7.0
    made.sequence[500:] += 10
    write_log(made, tmp_path / "a.mcap")
    data = (tmp_path / "a.mcap").read_bytes()
    (tmp_path / "a.mcap").write_bytes(data[: len(data) // 2])
    assert main(["replay", str(tmp_path / "a.mcap"), "--bridge", "3.3", "100"]) == 0
    printed = capsys.readouterr()
    assert "10 missing" in printed.out and "simulated" not in printed.out
    for says in ("PIP never changes", "10 frames are missing", "cut off or damaged"):
        assert says in printed.err


def test_a_log_without_a_truth_and_another_channel(tmp_path: Path, calibration: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = recording()
    stream = Stream("other", (Channel("V7", "V"),), 100.0)
    write_log(Recording.of_values(stream, made.values[:, :1], device_time=made.device_time), tmp_path / "a.csv")
    assert main(["replay", str(tmp_path / "a.csv"), "--calibration", str(calibration), "--json"]) == 1
    assert "no channel 'U'; it has V7" in capsys.readouterr().err
    assert main(["replay", str(tmp_path / "a.csv"), "--calibration", str(calibration), "--signal", "V7", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["angle"]["rms_deg"] is None and result["angle"]["max_deg"] > 78


def test_at_its_own_pace(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    import time

    made = recording()
    short = Recording.of_values(made.stream, made.values[:40], device_time=made.device_time[:40])
    write_log(short, tmp_path / "a.mcap")
    begin = time.monotonic()
    assert main(["replay", str(tmp_path / "a.mcap"), "--speed", "2", "--json"]) == 0
    assert time.monotonic() - begin >= 0.39 / 2
    assert json.loads(capsys.readouterr().out)["frames"] == 40


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--speed", "0"], "0"),
        (["--speed", "fast"], "fast"),
        (["--signal", "U"], "--calibration"),
        (["--serve", "--json"], "--serve"),
        (["--bridge", "3.3", "-1"], "-1"),
    ],
)
def test_wrong_usage(tmp_path: Path, capsys: pytest.CaptureFixture[str], words: list[str], says: str) -> None:
    assert main(["replay", str(tmp_path / "a.csv"), *words]) == 2
    assert says in capsys.readouterr().err


def test_logs_that_are_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "x.bag").write_bytes(b"\0\xff" * 100)
    for path in (tmp_path / "x.bag", tmp_path / "none.mcap"):
        assert main(["replay", str(path)]) == 1
        assert len(capsys.readouterr().err.splitlines()) == 1
    made = recording()
    write_log(Recording.of_frames(made.stream, []), tmp_path / "empty.mcap")
    assert main(["replay", str(tmp_path / "empty.mcap"), "-o", str(tmp_path / "out")]) == 0
    assert "no frame in it" in capsys.readouterr().err


def test_served_over_a_pseudo_terminal(tmp_path: Path) -> None:
    from skinfab.readout.serial_port import SerialPort

    made = recording()
    short = Recording.of_values(made.stream, made.values[:300], device_time=made.device_time[:300])
    write_log(short, tmp_path / "a.mcap")
    command = [sys.executable, "-m", "skinfab", "replay", str(tmp_path / "a.mcap"), "--serve", "--speed", "10"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        path = process.stdout.readline().strip()
        with SerialPort(path) as port:
            got = [frame.values for frame in iter(lambda: port.read(timeout=2.0), None)]
            assert port.stream.names == ("U", "PIP") and port.counts.bad == 0
        rest = process.communicate(timeout=20)[0]
    assert process.returncode == 0 and "300 frames sent" in rest
    assert np.array_equal(np.array(got), short.values)


def test_serving_ends_where_its_reader_leaves(tmp_path: Path) -> None:
    from skinfab.readout.serial_port import SerialPort

    write_log(recording(), tmp_path / "a.mcap")
    command = [sys.executable, "-m", "skinfab", "replay", str(tmp_path / "a.mcap"), "--serve", "--speed"]
    for speed in ("max", "1"):  # at the first it waits for room in the terminal, at the second for the next frame
        with subprocess.Popen([*command, speed], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            with SerialPort(process.stdout.readline().strip()) as port:
                assert port.read(timeout=2.0) is not None
            said = process.communicate(timeout=20)[1].splitlines()[-1]
        assert process.returncode == 0 and "the reader closed the port before the log's end" in said and "of 3,200 frames" in said


def test_serving_can_be_interrupted(tmp_path: Path) -> None:
    write_log(recording(), tmp_path / "a.mcap")
    command = [sys.executable, "-m", "skinfab", "replay", str(tmp_path / "a.mcap"), "--serve"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        port = Path(process.stdout.readline().strip())
        process.send_signal(signal.SIGTERM)  # as Ctrl-C, but not ignored where the tests run in the background
        said = process.communicate(timeout=20)[1]
    assert process.returncode == 130 and said.splitlines()[-1] == "skinfab: interrupted; nothing half-written was left"
    assert "Traceback" not in said and not port.parent.exists()
