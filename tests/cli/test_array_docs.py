"""The commands of docs/array.md, as they are written there."""

import re
import shlex
from functools import partial
from pathlib import Path

import pytest

from skinfab.bench import array as bench
from skinfab.cli.main import main
from skinfab.fingertip.array.protocols import twirl
from skinfab.fingertip.array.simulator import Device
from skinfab.readout.pty_server import PtyServer

PAGE = Path(__file__).parents[2] / "docs/array.md"


def test_the_commands_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In their order, in an empty folder; the port is a simulated one, and what bench measures is less of the same."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(bench, "measure", partial(bench.measure, densities=("8x8",), devices=1, rods=1, layers=1))
    monkeypatch.setattr(bench, "track", partial(bench.track, logs=1))
    monkeypatch.setattr(bench, "ablation", partial(bench.ablation, devices=1, rods=1))
    (block,) = re.findall(r"```\n(skinfab array simulate.*?)```", PAGE.read_text(), re.DOTALL)
    commands = [shlex.split(line, comments=True) for line in block.splitlines()]
    assert [words[2] for words in commands] == ["simulate", "train", "run", "run", "bench"]
    for words in commands:
        given = [name for word in words[1:] for name in (sorted(map(str, Path().glob(word))) if "*" in word else [word])]
        if "--port" not in given:
            assert main(given) == 0, given
            continue
        recording, _ = twirl(Device(), seed=1)
        with PtyServer(recording.stream, recording, rate_hz=0) as device:
            swapped = [str(device.path) if word == "/dev/ttyACM0" else "3" if word == "60" else word for word in given]
            assert main(swapped) == 0, swapped
    for name in ("model/model.npz", "felt/events.csv", "bench/array.png"):
        assert Path(name).stat().st_size


def test_the_python_runs() -> None:
    (code,) = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
    exec(compile(code, str(PAGE), "exec"), {})


def test_files_and_figures_are_there() -> None:
    for name in re.findall(r"\]\((pictures/[^)]+)\)", PAGE.read_text()):
        assert (PAGE.parent / name).stat().st_size > 10_000
