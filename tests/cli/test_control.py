"""`skinfab control`: simulator, log and port; what is refused, and the ways in which it is used wrongly."""

import contextlib
import csv
import json
import os
import pty
import random
import threading
import time
import tty
from collections.abc import Callable
from pathlib import Path

import pytest

from calibration.control.controller import LAWS
from calibration.control.loop import FingerBoard
from calibration.control.margin import critical_gain
from calibration.control.protocols import PAPER_DEG, uniform
from calibration.finger.logs import calibrated
from calibration.finger.simulated import HUMAN, ROBOT
from calibration.strain.document import load_calibration, save_calibration
from skinfab.cli import control
from skinfab.cli.main import main
from skinfab.readout.pty_server import PtyServer

ROOT = Path(__file__).resolve().parents[2]
FILES = ["control.csv", "control.json", "control.png"]


@pytest.fixture(scope="module")
def calibrations(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    folder = tmp_path_factory.mktemp("calibrations")
    for sensor in (HUMAN, ROBOT):
        for model in ("poly", "branches"):
            save_calibration(calibrated(sensor, model), folder / f"{sensor.name}_{model}.json")
    return {path.stem: str(path) for path in folder.iterdir()}


def test_names_are_those_of_the_library() -> None:
    assert control.LAWS == LAWS


def test_simulator(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["control", "simulator", "-o", str(out), "--json"]) == 0
    printed = capsys.readouterr()
    result = json.loads(printed.out)
    assert sorted(path.name for path in out.iterdir()) == FILES and json.loads((out / "control.json").read_text()) == result
    assert [run["protocol"] for run in result["runs"]] == list(PAPER_DEG) and result["simulated"] is True
    assert all(run["mean_error_deg"] < run["paper_mean_error_deg"] / 2 for run in result["runs"])
    assert result["margin"]["gain_margin"] == pytest.approx(3)
    with (out / "control.csv").open() as file:
        assert file.readline() == "# simulated: true\n"
        rows = list(csv.DictReader(file))
    even = [row for row in rows if row["protocol"] == "uniform"]
    mean = sum(abs(float(row["robot_deg"]) - float(row["human_deg"])) for row in even) / len(even)
    assert mean == pytest.approx(result["runs"][0]["mean_error_deg"], abs=1e-3)


def test_words_for_people_and_a_forced_gain(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["control", "simulator", "--controller", "p", "--gain", "9", "-o", str(tmp_path / "o")]
    assert main(words) == 3
    assert "give less than" in capsys.readouterr().err and not (tmp_path / "o").exists()
    assert main([*words, "--force"]) == 0
    printed = capsys.readouterr()
    assert "gain margin 0.8" in printed.out and "uniform: mean error" in printed.out and "the paper's: 18.77" in printed.out
    assert "was forced: expect the joint to swing" in printed.err


def test_whatever_model_calibrate_takes_control_has_its_branches(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The way that docs/control.md names: calibrate as it comes (lag for the human's sensor), then control."""
    words = []
    for name in ("human", "robot"):
        log, signal = str(ROOT / f"calibration/logs/{name}_finger.csv"), ["--signal", f"{name}_V", "--angle", "PIP_deg"]
        degree = ["--degree", "3" if name == "human" else "4"]
        assert main(["calibrate", log, *signal, *degree, "-o", str(tmp_path / name)]) == 0
        words += [f"--{name}", str(tmp_path / name / "calibration.json")]
    human = load_calibration(words[1])
    assert human.model.name != "branches" and human.beside is not None and human.beside is human.branches
    capsys.readouterr()
    assert main(["control", "simulator", *words, "-o", str(tmp_path / "o"), "--json"]) == 0
    uniform_run, random_run = json.loads(capsys.readouterr().out)["runs"]
    assert uniform_run["mean_error_deg"] < 3.3 and random_run["mean_error_deg"] < 7


def test_a_log_is_followed(calibrations: dict[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = str(ROOT / "calibration/logs/human_finger.csv")
    out = tmp_path / "o"
    assert main(["control", log, "--human", calibrations["human_branches"], "-o", str(out), "--json"]) == 0
    (run,) = json.loads(capsys.readouterr().out)["runs"]
    assert run["protocol"] == "human_finger.csv" and run["paper_mean_error_deg"] is None and run["mean_error_deg"] < 3.3


def test_a_log_without_angles(calibrations: dict[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = (ROOT / "calibration/logs/human_finger.csv").read_text().splitlines()[2:2000]
    (tmp_path / "bare.csv").write_text("\n".join(",".join(line.split(",")[::2]) for line in lines))
    words = ["control", str(tmp_path / "bare.csv"), "--human", calibrations["human_branches"], "-o", str(tmp_path / "o")]
    assert main(words) == 0
    assert "has no column 'PIP_deg': the error is that to the angle read" in capsys.readouterr().err


def test_a_hole_in_the_log_stops_the_joint(calibrations: dict[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = (ROOT / "calibration/logs/human_finger.csv").read_text().splitlines()
    (tmp_path / "hole.csv").write_text("\n".join([*lines[:400], *lines[500:1000]]))
    words = ["control", str(tmp_path / "hole.csv"), "--human", calibrations["human_branches"], "-o", str(tmp_path / "o"), "--json"]
    assert main(words) == 0
    (run,) = json.loads(capsys.readouterr().out)["runs"]
    assert run["held_or_stopped"] == pytest.approx(0.9 / 9.97, abs=0.003)  # the first tenth of that second the last frame is fresh enough


@pytest.mark.usefixtures("tidied")
def test_port(calibrations: dict[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Frames from one pseudo-terminal, commands to another, which drive the simulated joint."""
    board = FingerBoard(uniform(length_s=5.0), seed=0)
    ours, theirs = pty.openpty()
    received: list[bytes] = []

    def drive() -> None:
        rest = b""
        while data := os.read(ours, 4096):
            *lines, rest = (rest + data).split(b"\n")
            for line in lines:
                received.append(line)
                if line.startswith(b"end"):
                    return
                board.command(float(line))

    hand = threading.Thread(target=drive, daemon=True)
    hand.start()
    words = ["--human", calibrations["human_branches"], "--robot", calibrations["robot_branches"], "--seconds", "1.5", "--json"]
    with PtyServer(board.stream, board) as device:
        status = main(["control", "--port", str(device.path), "--commands", os.ttyname(theirs), *words, "-o", str(tmp_path / "o")])
    os.write(theirs, b"end\n")
    hand.join(5)
    result = json.loads(capsys.readouterr().out)
    assert status == 0 and sorted(path.name for path in (tmp_path / "o").iterdir()) == FILES
    assert result["simulated"] is True and result["counts"]["bad"] == 0 and result["outages"] == []
    assert result["real_time"] in (True, False) and os.sched_getscheduler(0) == os.SCHED_OTHER
    assert result["commands"] + result["passed_over"] > 130 and 0 < result["latency_ms"]["median"] <= result["latency_ms"]["worst"]
    commands = [line for line in received if not line.startswith(b"end")]
    assert len(commands) == result["commands"] + 1 and float(commands[-1]) == 0.0
    assert abs(board.robot[220] - uniform().angle[220]) < 10 and 95 < result["rate_hz"] < 105


@pytest.mark.usefixtures("tidied")
def test_a_board_of_another_rate_is_taken_as_it_is(
    calibrations: dict[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It says 100 Hz and sends 50: the margin is that of 20 ms; a gain that only 100 Hz would take is refused."""
    words = ["--human", calibrations["human_branches"], "--robot", calibrations["robot_branches"], "--seconds", "0.5"]
    board = FingerBoard(uniform(length_s=5.0), seed=0)
    with PtyServer(board.stream, board, rate_hz=50.0) as device:
        assert main(["control", "--port", str(device.path), *words, "-o", str(tmp_path / "o"), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["rate_hz"] == pytest.approx(50, rel=0.05)
    (note,) = result["notes"]
    assert "frames a second, and says 100; what was measured is used" in note
    gain = {hz: critical_gain(lag_s=0.1, delay_s=0.05, period_s=1 / hz, play=True).gain for hz in (48.0, 52.0, 100.0)}
    assert gain[48.0] < result["margin"]["swings_from_per_s"] < gain[52.0] < gain[100.0]
    board = FingerBoard(uniform(length_s=5.0), seed=0)
    with PtyServer(board.stream, board, rate_hz=50.0) as device:
        words += ["--gain", str(0.98 * gain[100.0])]
        assert main(["control", "--port", str(device.path), *words, "-o", str(tmp_path / "p")]) == 3
    assert "is beyond what the loop takes" in capsys.readouterr().err and not (tmp_path / "p").exists()


def test_what_was_out_of_range_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The protocols go to 85 degrees, 5 beyond the calibrations, and slack holds a reading at the end after the joint has turned."""
    assert main(["control", "simulator", "-o", str(tmp_path / "o")]) == 0
    uniform_run, _ = json.loads((tmp_path / "o/control.json").read_text())["runs"]
    of = uniform_run["outside_of"]
    assert max(of.values()) <= uniform_run["outside"] <= sum(of.values()) and of["human"] > 0.1 and of["robot"] > 0.2
    assert uniform_run["motion_deg"] == [10.0, 85.0]
    assert f"the robot's reading {100 * of['robot']:.0f} %, in a motion from 10 to 85 degrees)" in capsys.readouterr().out


def test_times_in_whole_milliseconds_are_left_out_where_they_are_doubled(
    calibrations: dict[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = (ROOT / "calibration/logs/human_finger.csv").read_text().splitlines()[:1500]
    doubled = [*lines[:500], lines[499], *lines[500:900], *lines[800:805], *lines[900:]]
    (tmp_path / "ms.csv").write_text("\n".join(doubled))
    words = ["--human", calibrations["human_branches"], "-o", str(tmp_path / "o"), "--json"]
    assert main(["control", str(tmp_path / "ms.csv"), *words]) == 0
    result = json.loads(capsys.readouterr().out)
    head = 1 + next(k for k, line in enumerate(lines) if not line.startswith("#"))
    assert result["notes"] == [
        f"ms.csv: 6 of {len(doubled) - head} rows stand still or go back in time (row {500 - head + 1} first); they were left out"
    ]
    (tmp_path / "plain.csv").write_text("\n".join(lines))
    assert main(["control", str(tmp_path / "plain.csv"), *words]) == 0
    assert json.loads(capsys.readouterr().out)["runs"][0]["mean_error_deg"] == result["runs"][0]["mean_error_deg"]


def test_shuffled_rows_are_refused_and_a_restart_is_a_hole(
    calibrations: dict[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """As `calibrate` does. A maximum of the times so far would leave the few rows that happen to be the latest."""
    lines = (ROOT / "calibration/logs/human_finger.csv").read_text().splitlines()
    head = 1 + next(k for k, line in enumerate(lines) if not line.startswith("#"))
    rows = lines[head:]
    random.Random(0).shuffle(rows)
    (tmp_path / "log.csv").write_text("\n".join([*lines[:head], *rows]))
    words = ["control", str(tmp_path / "log.csv"), "--human", calibrations["human_branches"], "-o", str(tmp_path / "o"), "--json"]
    assert main(words) == 1
    assert "log.csv: rows are not in the order of time: row" in capsys.readouterr().err and not (tmp_path / "o").exists()
    (tmp_path / "log.csv").write_text("\n".join([*lines[: head + 1000], *lines[head : head + 500]]))
    assert main(words) == 0
    result = json.loads(capsys.readouterr().out)
    (note,) = result["notes"]
    assert "row 1001: times begin anew" in note and "what follows is taken as after a hole" in note
    (run,) = result["runs"]
    assert 15.5 < run["seconds"] < 16.5 and 0 < run["held_or_stopped"] < 0.1


class Lines:
    """A board that prints lines: what `fault` makes of both sensors at rest with a little noise."""

    def __init__(self, fault: Callable[[float, float], tuple[float, float]]) -> None:
        self._fault = fault
        self._master, self._slave = pty.openpty()
        tty.setraw(self._slave)
        self.path = os.ttyname(self._slave)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._send)

    def _send(self) -> None:
        noise, began = random.Random(0), time.monotonic()
        rest = [sensor.u0 * (1 + float(sensor.curve.signal(40.0))) for sensor in (HUMAN, ROBOT)]
        for k in range(3000):
            human, robot = (each * (1 + 1e-4 * noise.gauss(0, 1)) for each in rest)
            values = self._fault(human, robot)
            heading = "sequence,time_ms,human_V,robot_V\n" if k % 50 == 0 else ""
            os.write(self._master, f"{heading}{k},{10 * k},{values[0]:.6f},{values[1]:.6f}\n".encode())
            if self._ended.wait(max(began + (k + 1) / 100 - time.monotonic(), 0)):
                return

    def __enter__(self) -> "Lines":
        self._thread.start()
        return self

    def __exit__(self, *fault: object) -> None:
        self._ended.set()
        self._thread.join()
        os.close(self._master)
        os.close(self._slave)


@pytest.mark.usefixtures("tidied")
def test_a_broken_wire_is_told_and_what_was_out_of_range_too(
    calibrations: dict[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A board that sends lines says no range: 0 V of the robot's is no saturated reading, and it is not followed all the same."""
    master, slave = pty.openpty()
    tty.setraw(slave)
    driven = threading.Event()

    def hand() -> None:
        lines = 0
        while data := os.read(master, 4096):
            lines += data.count(b"\n")
            if lines >= 100:
                driven.set()
            if data.endswith(b"end"):
                return

    hands = threading.Thread(target=hand)
    hands.start()
    words = ["--human", calibrations["human_branches"], "--robot", calibrations["robot_branches"], "--commands", os.ttyname(slave)]
    try:
        with Lines(lambda human, robot: (human, 0.0 if driven.is_set() else robot)) as board:
            assert main(["control", "--port", board.path, *words, "--seconds", "4", "-o", str(tmp_path)]) == 0
    finally:
        os.write(slave, b"end")
        hands.join()
        os.close(master)
        os.close(slave)
    printed = capsys.readouterr()
    (said,) = [line for line in printed.err.splitlines() if "the robot's channel robot_V reads 0, and was calibrated from 1.6" in line]
    assert "to the end the last command was held and the joint then stopped" in said
    result = json.loads((tmp_path / "control.json").read_text())
    assert said.removeprefix("note: ") in result["notes"] and 0.02 < result["held_or_stopped"] < 0.9
    assert set(result["outside_of"]) == {"human", "target", "robot"}
    assert f"out of range {100 * result['outside']:.0f} %" in printed.out


@pytest.mark.usefixtures("tidied")
@pytest.mark.parametrize("gone", [True, False], ids=["gone", "deaf"])
def test_a_hand_that_is_gone_or_deaf_costs_no_record(
    calibrations: dict[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str], gone: bool
) -> None:
    """The port of the commands closes, or nobody reads them: said of that port, with all that went on until then."""
    master, slave = pty.openpty()
    tty.setraw(slave)
    if not gone:  # as full as it gets
        os.set_blocking(slave, False)
        with contextlib.suppress(BlockingIOError):
            while True:
                os.write(slave, bytes(1024))
    closing = threading.Timer(3.0, os.close, [master])
    name = os.ttyname(slave)
    words = ["--human", calibrations["human_branches"], "--robot", calibrations["robot_branches"], "--commands", name]
    try:
        with Lines(lambda human, robot: (human, robot)) as board:
            if gone:
                closing.start()
            assert main(["control", "--port", board.path, *words, "--seconds", "6", "-o", str(tmp_path)]) == 1
    finally:
        closing.join() if gone else os.close(master)
        os.close(slave)
    said = capsys.readouterr().err
    assert f"{name} takes no commands any more" in said if gone else f"{name}: the hand read no command for 0.05 s" in said
    assert f"what went on until then is in {tmp_path}" in said
    result = json.loads((tmp_path / "control.json").read_text())
    assert name in result["fault"] and (tmp_path / "control.png").is_file()
    rows = (tmp_path / "control.csv").read_text().splitlines()
    assert len(rows) == result["commands"] + 1 and (result["commands"] > 50) == gone


def test_an_interrupted_run_leaves_the_one_before_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["control", "simulator", "-o", str(tmp_path / "o"), "--seed"]
    assert main([*words, "1"]) == 0
    before = {path.name: path.read_bytes() for path in (tmp_path / "o").iterdir()}

    def interrupted(*args: object, **options: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("calibration.control.figure.draw_runs", interrupted)
    assert main([*words, "2"]) == 130
    assert {path.name: path.read_bytes() for path in (tmp_path / "o").iterdir()} == before
    assert "nothing half-written was left" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "status", "says"),
    [
        ([], 2, "give one of: simulator, a LOG, --port PORT"),
        (["simulator", "--port", "x"], 2, "give one of"),
        (["simulator", "--commands", "x"], 2, "--commands goes with --port"),
        (["log.csv"], 2, "--human C.json is needed"),
        (["--port", "x", "--human", "h.json"], 2, "--robot C.json is needed"),
        (["simulator", "--gain", "-1"], 2, "not a positive number"),
        (["simulator", "--human", "nowhere.json"], 1, "nowhere.json"),
        (["simulator", "--delay", "0"], 2, "not a positive number"),
    ],
)
def test_wrong_usage(words: list[str], status: int, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["control", *words, "-o", str(tmp_path / "o")]) == status
    assert says in capsys.readouterr().err and not (tmp_path / "o").exists()


@pytest.mark.parametrize(
    ("more", "says"),
    [
        (["--human", "human_poly", "--robot", "robot_branches"], "model poly"),
        (["--human", "human_branches", "--robot", "human_branches"], "made from the same log; the human's sensor and the robot's are two"),
        (["--human", "human_poly", "--robot", "human_branches", "--controller", "p", "--port", "x"], "both of the sensor 'human_V'"),
        (["--human", "human_branches", "--robot", "robot_branches", "--port", "/dev/no-such-port"], "/dev/no-such-port"),
    ],
)
def test_what_cannot_be_used(
    more: list[str], says: str, calibrations: dict[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [calibrations.get(word, word) for word in more]
    what = [] if "--port" in words else ["simulator"]
    assert main(["control", *what, *words, "-o", str(tmp_path / "o")]) == 1
    assert says in capsys.readouterr().err and not (tmp_path / "o").exists()
