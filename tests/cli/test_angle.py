"""`skinfab angle`: from captures to a log, alone or beside readings, which calibrate then takes."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from captures import positions, vicon_text, write_c3d

from skinfab.cli.main import main
from skinfab.readout.frame import Channel, Recording, Stream
from skinfab.readout.logs.log import read_log, write_log

WORDS = ["--mcp", "MCP", "--pip", "PIP", "--dip", "DIP"]


@pytest.mark.parametrize("kind", ["c3d", "csv"])
def test_a_capture_as_a_log(tmp_path: Path, capsys: pytest.CaptureFixture[str], kind: str) -> None:
    made = positions()
    made["PIP"][50:55] = np.nan  # 30 ms at 200 Hz, 60 ms at 100 Hz
    made["DIP"][100:130] = np.nan
    if kind == "c3d":
        write_c3d(tmp_path / "a.c3d", made)
    else:
        (tmp_path / "a.csv").write_text(vicon_text(made))
    out = tmp_path / "angles.csv"
    assert main(["angle", str(tmp_path / f"a.{kind}"), *WORDS, "-o", str(out), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert (result["frames"], result["seen"], result["bridged"], result["missing"]) == (200, 165, 5, 30)
    angles = read_log(out).recording.column("angle_deg")
    truth = np.linspace(0, 110, 200)
    there = np.isfinite(angles)
    assert np.flatnonzero(~there).tolist() == list(range(100, 130))
    assert np.abs(angles - truth)[there].max() < 0.1 and result["max_deg"] == pytest.approx(110, abs=0.01)
    before = out.read_bytes()
    assert main(["angle", str(tmp_path / f"a.{kind}"), *WORDS, "-o", str(out)]) == 1
    assert "is there already, and logs are never overwritten" in capsys.readouterr().err and out.read_bytes() == before
    assert main(["angle", str(tmp_path / f"a.{kind}"), *WORDS, "-o", str(tmp_path / "more.csv"), "--max-gap", "0"]) == 0
    assert "35 without an angle" in capsys.readouterr().out


def test_beside_readings_for_calibrate(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    time = np.arange(3200) / 100
    truth = 45 - 40 * np.cos(2 * np.pi * time / 8)
    bent, zero = np.radians(truth), np.zeros(3200)
    pip = np.stack([40 + zero, zero, 800 + zero], axis=1)
    dip = pip + 25 * np.stack([np.cos(bent), np.sin(bent), zero], axis=1)
    write_c3d(tmp_path / "a.c3d", {"MCP": pip - [40.0, 0, 0], "PIP": pip, "DIP": dip}, rate=100.0)
    # The readings began half a second before the capture.
    late = np.interp(time - 0.5, time, truth)
    reading = 2.5 * (1 + 2e-3 * late + 2e-5 * late**2)
    stream = Stream("finger", (Channel("U", "V"),), 100.0, simulated=True)
    write_log(Recording.of_values(stream, reading[:, None], device_time=1000 + time), tmp_path / "u.mcap")
    joined = tmp_path / "joined.mcap"
    words = ["angle", str(tmp_path / "a.c3d"), *WORDS, "--log", str(tmp_path / "u.mcap"), "--shift", "0.5", "-o", str(joined)]
    assert main(words) == 0
    assert "50 of 3,200 frames have no angle" in capsys.readouterr().err
    log = read_log(joined).recording
    assert log.stream.names == ("U", "angle_deg") and log.stream.simulated and np.array_equal(log.values[:, 0], reading)
    assert main(["calibrate", str(joined), "--signal", "U", "--angle", "angle_deg", "-o", str(tmp_path / "o"), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["r2"] > 0.9999 and result["held_out_rms_deg"] < 0.2


def irregular(t: np.ndarray) -> np.ndarray:
    return 45 - 40 * np.cos(2 * np.pi * t / 8 - 4 * np.sin(2 * np.pi * t / 37))


def capture_and_log(
    tmp_path: Path, moves: Callable[[np.ndarray], np.ndarray], *, channels: tuple[str, ...] = ("U",), restart: bool = False
) -> None:
    """`a.c3d` of 30 s, and `u.mcap`, whose time was 1.37 s when the capture began."""
    time = np.arange(3000) / 100
    bent, zero = np.radians(moves(time)), np.zeros(3000)
    pip = np.stack([40 + zero, zero, 800 + zero], axis=1)
    dip = pip + 25 * np.stack([np.cos(bent), np.sin(bent), zero], axis=1)
    write_c3d(tmp_path / "a.c3d", {"MCP": pip - [40.0, 0, 0], "PIP": pip, "DIP": dip}, rate=100.0)
    late = moves(time - 1.37)
    reading = 2.5 * (1 + 2e-3 * late + 2e-5 * late**2)
    values = np.column_stack([reading] + [np.cos(time)] * (len(channels) - 1))
    stream = Stream("finger", tuple(Channel(name, "V") for name in channels), 100.0)
    device_time = 1000 + np.where(time >= 20, time - 20, time) if restart else 1000 + time
    write_log(Recording.of_values(stream, values, device_time=device_time), tmp_path / "u.mcap")


def test_the_shift_is_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capture_and_log(tmp_path, irregular, channels=("U", "V"))
    words = ["angle", str(tmp_path / "a.c3d"), *WORDS, "--log", str(tmp_path / "u.mcap"), "--shift", "auto"]
    assert main([*words, "-o", str(tmp_path / "b.mcap")]) == 1
    assert "say with --signal which one goes with this joint: U, V" in capsys.readouterr().err
    assert main([*words, "--signal", "U", "-o", str(tmp_path / "b.mcap"), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    low, high = result["shift_interval_s"]
    assert result["shift_s"] == pytest.approx(1.37, abs=0.015) and low <= 1.37 <= high
    assert main(["calibrate", str(tmp_path / "b.mcap"), "--signal", "U", "--angle", "angle_deg", "-o", str(tmp_path / "o"), "--json"]) == 0
    made = json.loads(capsys.readouterr().out)
    assert abs(made["clock"]["lag_s"]) < 0.02 and made["held_out_rms_deg"] < 0.6
    assert main([*words, "--signal", "U", "-o", str(tmp_path / "c.csv")]) == 0
    assert f"the capture began {result['shift_s']:.3f} s after the log" in capsys.readouterr().out


def test_a_shift_that_cannot_be_told_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["angle", str(tmp_path / "a.c3d"), *WORDS, "--log", str(tmp_path / "u.mcap"), "-o", str(tmp_path / "b.mcap"), "--shift"]
    capture_and_log(tmp_path, lambda t: 45 - 40 * np.cos(2 * np.pi * t / 4))
    assert main([*words, "auto"]) == 1
    assert "the movement repeats, so that shifts of" in capsys.readouterr().err
    (tmp_path / "u.mcap").unlink()
    capture_and_log(tmp_path, irregular, restart=True)
    assert main([*words, "1.37"]) == 1
    assert "frame 2001: times go back from 19.99 to 0 s, as when the board restarts" in capsys.readouterr().err
    assert not (tmp_path / "b.mcap").exists()


@pytest.mark.parametrize(
    ("words", "status", "says"),
    [
        (["--mcp", "TIP", *WORDS[2:], "-o", "x.csv"], 1, "no marker 'TIP'"),
        (["--mcp", "PIP", "--pip", "PIP", "--dip", "PIP", "-o", "x.csv"], 1, "must be three different markers"),
        ([*WORDS, "-o", "none/x.csv"], 1, "folder does not exist"),
        ([*WORDS, "-o", "x.txt"], 1, ".txt is no log"),
        ([*WORDS, "-o", "x.csv", "--log", "none.csv"], 1, "none.csv"),
        ([*WORDS, "-o", "x.csv", "--shift", "1"], 2, "--log"),
        ([*WORDS, "-o", "x.csv", "--shift", "soon"], 2, "soon"),
        ([*WORDS, "-o", "x.csv", "--shift", "auto"], 2, "give --log too"),
        ([*WORDS, "-o", "x.csv", "--log", "a.csv", "--signal", "U"], 2, "give --shift auto too"),
        ([*WORDS, "-o", "x.csv", "--max-gap", "-1"], 2, "-1"),
        (WORDS, 2, "-o"),
    ],
)
def test_wrong_use(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: list[str], status: int, says: str
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.csv").write_text(vicon_text(positions(20)))
    assert main(["angle", "a.csv", *words]) == status
    assert says in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["a.csv"]


def test_no_moment_in_common(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "a.csv").write_text(vicon_text(positions(20)))
    stream = Stream("finger", (Channel("U", "V"),), 100.0)
    write_log(Recording.of_values(stream, np.ones((20, 1)), device_time=np.arange(20) / 100), tmp_path / "u.csv")
    words = ["angle", str(tmp_path / "a.csv"), *WORDS, "--log", str(tmp_path / "u.csv"), "--shift", "-60", "-o", str(tmp_path / "x.csv")]
    assert main(words) == 1
    assert "no moment in common" in capsys.readouterr().err
