"""`skinfab contact`: on logs, on the simulator, the files it leaves, and the ways in which it is used wrongly."""

import csv
import json
import os
import re
import signal
import time as clock
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from interrupts import pressed, pressed_twice

from calibration.contact.detector import ContactDetector, Detection, detect
from calibration.contact.objects import OBJECTS
from calibration.contact.simulator import simulate
from skinfab.cli import contact
from skinfab.cli.contact import Trial
from skinfab.cli.contact_files import write_files
from skinfab.cli.contact_port import Told
from skinfab.cli.main import main
from skinfab.readout.frame import Channel, Frame, Recording, Stream
from skinfab.readout.logs.log import read_log, write_log
from skinfab.readout.pty_server import PtyServer

FILES = ["contact.png", "events.csv", "result.json", "table.csv"]


@pytest.fixture
def log(tmp_path: Path) -> Callable[..., str]:
    def write(name: str = "a.csv", *, seed: int = 0, touched: float = 1.4) -> str:
        time = np.arange(1500) / 100
        rng = np.random.default_rng(seed)
        first = 100 * np.where((time > 5) & (time < 8), touched, 1.0) + 0.4 * rng.standard_normal(1500)
        second = 50 * np.where((time > 6) & (time < 9), 0.8, 1.0) + 0.2 * rng.standard_normal(1500)
        rows = "\n".join(f"{t},{a:.3f},{b:.3f}," for t, a, b in zip(time.tolist(), first.tolist(), second.tolist(), strict=True))
        (tmp_path / name).write_text(f"time,S1,S2,S3\n{rows}\n")
        return str(tmp_path / name)

    return write


def rows(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text().splitlines()))


def test_the_names_are_the_objects() -> None:
    assert tuple(OBJECTS) == contact.OBJECTS


def test_trials_of_any_logger(log: Callable[..., str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["contact", log(), log("b.csv", seed=1, touched=1.5), "-o", str(out), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert sorted(each.name for each in out.iterdir()) == FILES and json.loads((out / "result.json").read_text()) == result
    ((_, found),) = result["objects"].items()
    assert not found["simulated"] and [each["log"] for each in found["trials"]] == ["a.csv", "b.csv"]
    assert all(len(each["sha256"]) == 64 and each["contacts"] == 2 for each in found["trials"])
    first, second, third = found["table"]
    assert first["touched"] == pytest.approx(145, abs=0.5) and first["scatter"] == pytest.approx(10 / 2**0.5, abs=0.3)
    assert second["change"] == pytest.approx(-0.2, abs=0.01) and third["r0"] is None
    assert any("channel S3 never read anything" in note for note in result["notes"])
    events = rows(out / "events.csv")
    assert [(each["log"], each["channel"], each["sign"]) for each in events] == [
        (name, channel, sign) for name in ("a.csv", "b.csv") for channel, sign in (("S1", "1"), ("S2", "-1"))
    ]
    assert float(events[0]["start_s"]) == pytest.approx(5, abs=0.05) and float(events[0]["end_s"]) == pytest.approx(8, abs=0.1)
    table = rows(out / "table.csv")
    assert [each["state"] for each in table] == ["", "", "silent"] and float(table[0]["watched"]) == pytest.approx(0.8, abs=0.01)
    assert {each["simulated"] for each in events + table} == {"0"}


def test_words_for_people(log: Callable[..., str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["contact", log(), "--channel", "S2", "-o", str(tmp_path / "o")]) == 0
    said = capsys.readouterr()
    assert "1 contacts in 1 trial" in said.out and "-20" in said.out and "S1" not in said.out and said.err == ""


def test_a_hole_in_the_log_is_said(log: Callable[..., str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = Path(log()).read_text().splitlines(keepends=True)
    (tmp_path / "hole.csv").write_text("".join(lines[:1000] + lines[1400:]))
    assert main(["contact", str(tmp_path / "hole.csv"), "-o", str(tmp_path / "o"), "--json"]) == 0
    assert any("its time has 1 hole, the longest of 4.01 s" in note for note in json.loads(capsys.readouterr().out)["notes"])


def test_fewer_false_alarms_ask_for_more(log: Callable[..., str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    thresholds = []
    for rate in ("5", "0.01"):
        assert main(["contact", log(), "--false-alarms", rate, "-o", str(tmp_path / "o"), "--json"]) == 0
        (found,) = json.loads(capsys.readouterr().out)["objects"].values()
        thresholds.append(found["threshold_sigma"])
    assert thresholds[0] < thresholds[1]


def test_the_simulator_is_judged(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    words = ["contact", "simulator", "--object", "grip", "--trials", "2", "--seed", "3", "-o", str(out)]
    assert main([*words, "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert sorted(each.name for each in out.iterdir()) == sorted([*FILES, "truth.csv"])
    assert set(result["evaluation"]) == {"grip", "all"} and result["objects"]["grip"]["simulated"]
    ours = result["evaluation"]["grip"]["cusum"]
    assert ours["recall"]["value"] > 0.9 and ours["precision"]["low"] > 0.8 and ours["trials"] == 2
    assert ours["true"] == len(rows(out / "truth.csv"))
    for name in ("events.csv", "truth.csv", "table.csv"):
        assert {each["simulated"] for each in rows(out / name)} == {"1"}
    assert main(words) == 0
    assert "grip (simulated):" in capsys.readouterr().out


def test_a_simulated_log_stays_simulated(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    trial = simulate("cube", seed=1)
    write_log(trial.recording, tmp_path / "cube.mcap")
    assert main(["contact", str(tmp_path / "cube.mcap"), "-o", str(tmp_path / "o"), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["objects"]["cube"]["simulated"] and "evaluation" not in result
    assert {each["simulated"] for each in rows(tmp_path / "o/events.csv")} == {"1"}
    # Its channels' kind says what to watch.
    other = replace(trial.recording.stream.channels[0], kind="strain")
    stream = replace(trial.recording.stream, channels=(other, *trial.recording.stream.channels[1:]))
    write_log(replace(trial.recording, stream=stream), tmp_path / "mixed.csv")
    assert main(["contact", str(tmp_path / "mixed.csv"), "-o", str(tmp_path / "p")]) == 0
    assert "S1" not in {each["channel"] for each in rows(tmp_path / "p/events.csv")}


@pytest.mark.parametrize(
    ("words", "status", "says"),
    [
        (["nowhere.csv"], 1, "nowhere.csv: No such file"),
        (["LOG", "--channel", "S9"], 1, "no channel 'S9'"),
        (["LOG", "--false-alarms", "0"], 2, "not a positive number"),
        (["LOG", "--false-alarms", "1e9"], 1, "cannot be promised"),
        (["LOG", "simulator"], 2, "stands alone"),
        (["LOG", "--object", "cube"], 2, "--object is for the simulator"),
        (["LOG", "--seed", "0"], 2, "--seed is for the simulator"),
        (["simulator", "--object", "ball"], 2, "invalid choice"),
        (["simulator", "--trials", "0"], 2, "no trial"),
        (["simulator", "--channel", "S1"], 2, "--channel is for logs"),
        (["LOG", "--seconds", "3"], 2, "--seconds is for the port, not for a log"),
        (["simulator", "--baud", "9600"], 2, "--baud is for the port, not for a simulator"),
    ],
)
def test_wrong_usage(
    words: list[str], status: int, says: str, log: Callable[..., str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = log()
    assert main(["contact", *(made if word == "LOG" else word for word in words), "-o", str(tmp_path / "out")]) == status
    said = capsys.readouterr()
    assert says in said.err and said.out == "" and not (tmp_path / "out").exists()


def test_a_log_that_is_too_short_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "short.csv").write_text("time,S1\n" + "".join(f"{k / 100},1.0\n" for k in range(20)))
    assert main(["contact", str(tmp_path / "short.csv"), "-o", str(tmp_path / "out")]) == 1
    assert "short.csv: 20 frames are too few" in capsys.readouterr().err


def test_a_log_in_which_nothing_can_be_watched_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    time = np.arange(1500) / 100
    moving = 100 + 40 * np.sin(time) + 5 * np.sin(7 * time)
    rows = "\n".join(f"{t},{a:.3f},7," for t, a in zip(time.tolist(), moving.tolist(), strict=True))
    (tmp_path / "a.csv").write_text(f"time,S1,S2,S3\n{rows}\n")
    assert main(["contact", str(tmp_path / "a.csv"), "-o", str(tmp_path / "out")]) == 1
    said = capsys.readouterr().err
    assert "no channel could be watched: S1 of a.csv was never at rest, S2 of a.csv read one value all the time, S3 of a.csv never" in said
    assert not (tmp_path / "out").exists()


def test_a_port_is_watched_and_told_as_it_comes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = simulate("grip", seed=2).recording
    short = [log.frame(k) for k in range(900)]
    out = tmp_path / "out"
    with PtyServer(log.stream, short, rate_hz=0) as server, pressed(ContactDetector, after=900):
        assert main(["contact", str(server.path), "--seconds", "60", "-o", str(out)]) == 0
    said = capsys.readouterr()
    assert "contact: 4." in said.err and "S1 touched, +" in said.err and "S1 let go after" in said.err
    assert "grip (simulated):" in said.out and sorted(each.name for each in out.iterdir()) == FILES
    there = detect(Recording.of_frames(log.stream, short)).contacts
    events = rows(out / "events.csv")
    assert [each["channel"] for each in events] == [each.channel for each in there]
    assert [float(each["start_s"]) for each in events] == pytest.approx([each.start for each in there], abs=0.03)


def test_lines_that_do_not_say_their_rate_are_counted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = simulate("grip", seed=2).recording
    frames = (log.frame(k) for k in range(700))
    with PtyServer(log.stream, frames, rate_hz=0, ascii_lines=True) as server, pressed(ContactDetector, after=700):
        assert main(["contact", str(server.path), "--seconds", "60", "-o", str(tmp_path / "out")]) == 0
    said = capsys.readouterr()
    counted = float(re.search(r"does not say how many frames come a second; ([0-9.]+) were counted", said.err)[1])  # type: ignore[index]
    # The lines bring the device's own clock, which says 100 Hz, however fast they are sent here.
    assert counted == pytest.approx(100, rel=0.02) and "S1 touched, +" in said.err and "note: 2.99 s, S1, S2, S3, S4 at rest" in said.err
    assert rows(tmp_path / "out/events.csv")[0]["channel"] == "S1"


def test_lines_for_too_short_a_while_have_no_rate(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = simulate("grip", seed=2).recording
    with PtyServer(log.stream, (log.frame(k) for k in range(1000)), rate_hz=5, ascii_lines=True) as server:
        assert main(["contact", str(server.path), "--seconds", "0.5", "-o", str(tmp_path / "out")]) == 1
    assert "too few to count how many come a second; watch it for longer" in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_what_is_not_watched_is_said_while_it_lasts(capsys: pytest.CaptureFixture[str]) -> None:
    rng = np.random.default_rng(0)
    time = np.arange(2500) / 100
    values = 100 + 0.4 * rng.standard_normal((2500, 3))
    values[:, 0] += 30 * np.sin(time)  # never at rest
    values[1000:1500, 1] = 500.0  # froze, and came back
    values[:, 2] = np.nan
    stream = Stream("skin", (Channel("S1"), Channel("S2"), Channel("S3")), 100.0)
    told = Told(ContactDetector(stream))
    for frame in Recording.of_values(stream, values, device_time=time):
        told.step(frame)
    said = capsys.readouterr().err.splitlines()
    assert said == [
        "note: 2.99 s, S2 at rest; watched from now on",
        "note: 10.00 s, S1, S3 not watched yet: never at rest for 3 s, or silent; leave the object alone",
        "contact: 10.02 s, S2 touched, +400.0 %",
        "contact: 11.00 s, S2 was not touched at 10.00 s: it had frozen",
        "note: 11.00 s, S2 froze; it is not watched, check its wires and its range",
        "note: 15.30 s, S2 reads again",
        "note: 20.00 s, S1, S3 not watched yet: never at rest for 3 s, or silent; leave the object alone",
    ]


def test_a_channel_that_froze_is_named_everywhere(log: Callable[..., str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = Path(log()).read_text().splitlines()
    stuck = [f"{row.split(',')[0]},500,{row.split(',', 2)[2]}" for row in lines[1001:]]
    (tmp_path / "stuck.csv").write_text("\n".join([*lines[:1001], *stuck, ""]))
    assert main(["contact", str(tmp_path / "stuck.csv"), "-o", str(tmp_path / "o")]) == 0
    said = capsys.readouterr()
    assert "stuck.csv: channel S1 froze at 10.00 s (500, the most that it ever read, as at the end of a range), to the end" in said.err
    assert "(frozen)" in said.out and [each["state"] for each in rows(tmp_path / "o/table.csv")] == ["frozen", "", "silent"]
    (found,) = json.loads((tmp_path / "o/result.json").read_text())["objects"].values()
    first = found["trials"][0]["channels"][0]
    assert first["state"] == "frozen" and first["freezes"] == [{"start": 10.0, "end": None, "value": 500.0}]
    assert [each["channel"] for each in rows(tmp_path / "o/events.csv")] == ["S1", "S2"]


def test_a_clock_set_back_in_a_log_is_said(log: Callable[..., str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = Path(log()).read_text().splitlines()
    anew = [f"{k / 100}," + row.split(",", 1)[1] for k, row in enumerate(lines[701:])]
    (tmp_path / "anew.csv").write_text("\n".join([*lines[:701], *anew, ""]))
    assert main(["contact", str(tmp_path / "anew.csv"), "-o", str(tmp_path / "o"), "--json"]) == 0
    assert any("anew.csv: the clock is set back before frame 801" in note for note in json.loads(capsys.readouterr().out)["notes"])
    events = [(each["channel"], float(each["start_s"]), each["dropped"]) for each in rows(tmp_path / "o/events.csv")]
    assert events[:2] == [("S1", pytest.approx(5, abs=0.05), "1"), ("S2", pytest.approx(6, abs=0.05), "1")]


def test_a_run_that_is_stopped_leaves_the_folder_as_it_was(
    log: Callable[..., str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert main(["contact", log(), "-o", str(out)]) == 0
    before = {each.name: each.read_bytes() for each in out.iterdir()}

    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("calibration.contact.figure.draw_contacts", stopped)
    for folder in (out, tmp_path / "new"):
        with pytest.raises(KeyboardInterrupt):
            write_files(folder, {"a": [Trial("a", "", *_found(log("b.csv", seed=1)))]}, {"a": ()}, {})
    assert {each.name: each.read_bytes() for each in out.iterdir()} == before and not (tmp_path / "new").exists()


def _found(path: str) -> tuple[Recording, Detection]:
    recording = read_log(path).recording
    return recording, detect(recording)


def test_the_truth_of_an_earlier_run_is_no_truth_of_this_one(log: Callable[..., str], tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert main(["contact", "simulator", "--object", "grip", "--trials", "1", "-o", str(out)]) == 0
    assert (out / "truth.csv").exists()
    assert main(["contact", log(), "-o", str(out)]) == 0
    assert sorted(each.name for each in out.iterdir()) == FILES
    (out / "truth.csv").write_text("what,somebody\nelse,wrote\n")
    assert main(["contact", log(), "-o", str(out)]) == 0
    assert (out / "truth.csv").read_text() == "what,somebody\nelse,wrote\n"


def test_a_port_without_a_frame_in_time_is_an_error(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = simulate("grip", seed=2).recording
    with PtyServer(log.stream, (log.frame(k) for k in range(300)), rate_hz=300) as server:
        assert main(["contact", str(server.path), "--seconds", "1e-9", "-o", str(tmp_path / "out")]) == 1
    assert "sent no frame" in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_a_second_ctrl_c_loses_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log, out = simulate("grip", seed=2).recording, tmp_path / "out"
    with (
        PtyServer(log.stream, (log.frame(k) for k in range(700)), rate_hz=0) as server,
        pressed_twice(ContactDetector, "calibration.contact.figure.draw_contacts", after=600),
    ):
        assert main(["contact", str(server.path), "--seconds", "60", "-o", str(out), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == json.loads((out / "result.json").read_text())
    assert sorted(each.name for each in out.iterdir()) == FILES and rows(out / "events.csv")[0]["channel"] == "S1"


def test_ctrl_c_while_frames_are_counted_ends_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Too few have come to be watched; so it says, as where the time was too short."""
    log = simulate("grip", seed=2).recording

    def sent() -> Iterator[Frame]:
        yield from (log.frame(k) for k in range(5))
        clock.sleep(0.1)
        os.kill(os.getpid(), signal.SIGINT)
        clock.sleep(0.05)
        os.kill(os.getpid(), signal.SIGINT)
        yield log.frame(5)

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with PtyServer(log.stream, sent(), rate_hz=0, ascii_lines=True) as server:
            assert main(["contact", str(server.path), "--seconds", "60", "-o", str(tmp_path / "out")]) == 1
    finally:
        signal.signal(signal.SIGINT, before)
    assert "too few to count how many come a second" in capsys.readouterr().err and not (tmp_path / "out").exists()
