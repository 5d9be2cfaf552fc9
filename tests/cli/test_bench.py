import importlib
import inspect
import json
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

from skinfab.bench import readout
from skinfab.cli.bench import MODULES, NAMES
from skinfab.cli.main import main

SMALL = ["--sizes", "300", "--repeats", "1"]


def test_json_is_all_there_is_on_standard_output(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "flatten", "-o", str(tmp_path / "out"), *SMALL, "--json"]) == 0
    shown = json.loads(capsys.readouterr().out)
    assert shown["files"] == [str(p) for p in sorted((tmp_path / "out").iterdir())]
    assert (tmp_path / "out" / "flatten.txt").read_text().splitlines()[0] == shown["flatten"]["sentence"]
    assert {row["triangles"] for row in shown["flatten"]["rows"]} == {294}


def test_the_sentence_is_printed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(readout, "measure", partial(readout.measure, frames=300))
    assert main(["bench", "flatten", "readout", "-o", str(tmp_path), *SMALL]) == 0
    out = capsys.readouterr().out.splitlines()
    assert out[:-1] == [(tmp_path / f"{name}.txt").read_text().splitlines()[0] for name in ("flatten", "readout")]
    assert out[-1].startswith("wrote ") and all(str(tmp_path / f"{name}.png") in out[-1] for name in ("flatten", "readout"))


@pytest.mark.parametrize("options", [[], SMALL], ids=["as they are", "small"])
def test_all_are_measured_where_none_is_named(
    options: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """What each of them measures, its own test beside it says; here, that each is there, is asked, and for no size that it has not."""
    asked = {}

    def stand_in(name: str, real: Callable) -> Callable:
        def run(folder: Path, **given: object) -> dict:
            inspect.signature(real).bind(folder, **given)
            asked[name] = given.get("sizes")
            (folder / f"{name}.txt").write_text("measured")
            return {"sentence": f"{name} is measured", "notes": []}

        return run

    for name, (module, _) in MODULES.items():
        monkeypatch.setattr(f"{module}.run", stand_in(name, importlib.import_module(module).run))
    assert main(["bench", "-o", str(tmp_path), *options]) == 0
    assert capsys.readouterr().out.splitlines()[:-1] == [f"{name} is measured" for name in NAMES]
    assert asked == {name: [300] if options and sized else None for name, (_, sized) in MODULES.items()}
    assert list(MODULES) == list(NAMES) and len(list(tmp_path.iterdir())) == len(NAMES)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["flaten"], "'flaten' is not measured; there are flatten, simplify, gcode"),
        (["--sizes", "300,x"], "'300,x' is not a list of numbers of triangles such as 5000,20000"),
        (["gcode", "--sizes", "300"], "--sizes counts triangles, and gcode has none"),
        (["gcode", "--meshes", "a.obj"], "--meshes are for segment, and what is measured is gcode"),
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
