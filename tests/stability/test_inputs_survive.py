"""Logs that have the name of a result: the usual script replaces them by what it makes of them, these commands refuse."""

import json
from pathlib import Path

import numpy as np
import pytest

from skinfab.cli.main import main
from skinfab.errors import InputError
from skinfab.files import require_apart

CALIBRATE = ["calibrate", "{log}", "--signal", "U", "--angle", "PIP"]
COMMANDS = [
    (CALIBRATE, "samples.csv"),
    ([*CALIBRATE[:1], "{other}", *CALIBRATE[2:], "--new-task", "{log}"], "samples.csv"),
    (["contact", "{log}"], "events.csv"),
    (["contact", "{other}", "{log}"], "table.csv"),
    (["contact", "{log}"], "truth.csv"),
    (["replay", "{log}"], "replay.csv"),
    (["control", "{log}", "--human", "{other}"], "control.csv"),
]


def write(path: Path) -> str:
    time = np.arange(1600) / 100
    angle = 45 - 40 * np.cos(time)
    rows = "\n".join(f"{t},{a},{1 + 2e-3 * a}" for t, a in zip(time.tolist(), angle.tolist(), strict=True))
    path.write_text(f"time,PIP,U\n{rows}\n")
    return str(path)


@pytest.mark.parametrize(("words", "name"), COMMANDS)
def test_no_command_replaces_what_it_reads(words: list[str], name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log, other = write(tmp_path / name), write(tmp_path / "other.csv")
    before = (tmp_path / name).read_bytes()
    assert main([word.format(log=log, other=other) for word in words] + ["-o", str(tmp_path)]) == 1
    assert f"{name} is read and would be replaced by the result of that name; give another -o" in capsys.readouterr().err
    assert (tmp_path / name).read_bytes() == before and len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize("words", [CALIBRATE, ["contact", "{log}"], ["replay", "{log}"]])
def test_no_command_replaces_a_result_of_somebody_else(words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log, out = write(tmp_path / "log.csv"), tmp_path / "out"
    out.mkdir()
    (out / "result.json").write_text(json.dumps({"mine": 1}))
    assert main([word.format(log=log) for word in words] + ["-o", str(out)]) == 1
    assert "result.json is there already and is of no earlier run" in capsys.readouterr().err
    assert [path.name for path in out.iterdir()] == ["result.json"] and json.loads((out / "result.json").read_text()) == {"mine": 1}


def test_the_same_file_under_another_name(tmp_path: Path) -> None:
    """A path through `..`, a symbolic link to the folder, one to the file, a bag that is a folder."""
    out = tmp_path / "out"
    out.mkdir()
    (out / "samples.csv").write_text("")
    (tmp_path / "folder").symlink_to(out)
    (tmp_path / "link.csv").symlink_to(out / "samples.csv")
    for folder, source in (
        (out, tmp_path / "out/../out/samples.csv"),
        (tmp_path / "folder", out / "samples.csv"),
        (out, tmp_path / "link.csv"),
        (out, out),
    ):
        with pytest.raises(InputError, match="is read and would be replaced"):
            require_apart(folder, ["samples.csv"], [source])
    require_apart(out, ["samples.csv"], [tmp_path / "nowhere.csv"])
    require_apart(out, ["other.csv"], [out / "samples.csv"])
    require_apart(tmp_path / "not made yet", ["samples.csv"], [out / "samples.csv"])
