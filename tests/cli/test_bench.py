import json
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import pytest

from calibration.bench import calibrate
from skinfab.bench import array, gravity, nail, nail_ablation, readout, texture
from skinfab.cli.bench import NAMES
from skinfab.cli.main import main
from skinfab.fingertip.nail.patterns import EDGES4
from skinfab.fingertip.nail.protocol import Protocol

SMALL = ["--sizes", "300", "--repeats", "1"]


def test_json_is_all_there_is_on_standard_output(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "flatten", "-o", str(tmp_path / "out"), *SMALL, "--json"]) == 0
    shown = json.loads(capsys.readouterr().out)
    assert shown["files"] == [str(p) for p in sorted((tmp_path / "out").iterdir())]
    assert (tmp_path / "out" / "flatten.txt").read_text().splitlines()[0] == shown["flatten"]["sentence"]
    assert {row["triangles"] for row in shown["flatten"]["rows"]} == {294}


@pytest.fixture
def fewer(monkeypatch: pytest.MonkeyPatch) -> None:
    """Less of what --sizes does not make less; each measurement as a whole has its own test beside it."""
    monkeypatch.setattr("gcode.bench.TOLERANCES", (0.05, 0.005))
    monkeypatch.setattr("calibration.bench.control.GAINS", (1.0, 4.0))
    monkeypatch.setattr("calibration.bench.control.DELAYS_S", (0.05,))
    monkeypatch.setattr("calibration.bench.control.PERIODS_S", (8.0,))
    monkeypatch.setattr(calibrate, "measure", partial(calibrate.measure, seeds=(7,)))
    monkeypatch.setattr(readout, "measure", partial(readout.measure, frames=300))
    monkeypatch.setattr(array, "measure", partial(array.measure, densities=("8x8",), devices=1, rods=1))
    monkeypatch.setattr(array, "track", partial(array.track, logs=1))
    monkeypatch.setattr(array, "ablation", partial(array.ablation, devices=1, rods=1))
    monkeypatch.setattr(texture, "measure", partial(texture.measure, seeds=(0,), specimens=3, slides=2, lengths=(256, 512)))
    monkeypatch.setattr(gravity, "measure", partial(gravity.measure, trials=3))
    monkeypatch.setattr(nail_ablation, "TERMS", {nail_ablation.NOTHING: nail_ablation.TERMS[nail_ablation.NOTHING]})
    for module in (nail, nail_ablation):
        monkeypatch.setattr(module, "TESTS", {"edges4": EDGES4})
    monkeypatch.setattr(nail, "run", partial(nail.run, protocol=Protocol(participants=3, training=3, rounds=2, estimates=1, samples=128)))


@pytest.mark.usefixtures("fewer")
def test_the_sentence_is_printed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "-o", str(tmp_path), *SMALL]) == 0
    out = capsys.readouterr().out.splitlines()
    assert out[:-1] == [(tmp_path / f"{name}.txt").read_text().splitlines()[0] for name in NAMES]
    assert out[-1].startswith("wrote ") and all(str(tmp_path / f"{name}.png") in out[-1] for name in (*NAMES, "refine"))


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["flaten"], "'flaten' is not measured; there are flatten, simplify, gcode"),
        (["--sizes", "300,x"], "'300,x' is not a list of numbers of triangles such as 5000,20000"),
        (["gcode", "--sizes", "300"], "--sizes counts triangles, and gcode has none"),
        (["--repeats", "0"], "'0' is not a whole number from 1 up"),
    ],
)
def test_wrong_usage(arguments: list[str], says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", *arguments, "-o", str(tmp_path)]) == 2
    assert says in capsys.readouterr().err


def test_a_size_out_of_range_leaves_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "-o", str(tmp_path / "out"), "--sizes", "5"]) == 1
    assert "a test disk of 5 triangles is not made" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_interrupt_leaves_nothing(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "skinfab", "bench", "-o", str(tmp_path / "out"), "--sizes", "5000", "--repeats", "1000"]
    work = subprocess.Popen(
        command, stderr=subprocess.PIPE, text=True, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler)
    )
    for _ in range(200):
        if (tmp_path / "out").exists():
            break
        time.sleep(0.1)
    time.sleep(1)
    work.send_signal(signal.SIGINT)
    _, complaint = work.communicate(timeout=60)
    assert work.returncode == 130 and complaint == "skinfab: interrupted; nothing half-written was left\n"
    assert list(tmp_path.iterdir()) == []
