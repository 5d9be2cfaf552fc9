"""What is around every measurement: its folder whole or not there, its sentences, or one JSON object."""

import json
from argparse import Namespace
from pathlib import Path
from typing import Any

import pytest

from skinfab.cli.measured import measured
from skinfab.progress import Progress


def one(folder: Path, progress: Progress) -> dict[str, Any]:
    (folder / "b.csv").write_text("b\n")
    (folder / "a.txt").write_text("a\n")
    progress(0.5, "half")
    return {"sentence": "It is so.", "notes": ["mind this"]}


def several(folder: Path, progress: Progress) -> dict[str, Any]:
    return {"first": one(folder, progress), "second": one(folder, progress)}


def test_its_sentences_and_files_are_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    args, files = Namespace(output=tmp_path / "o", json=False), f"wrote {tmp_path}/o/a.txt, {tmp_path}/o/b.csv\n"
    assert measured(args, one) == 0
    assert capsys.readouterr() == ("It is so.\n" + files, "note: mind this\n")
    assert measured(args, several, several=True) == 0
    assert capsys.readouterr() == (2 * "It is so.\n" + files, 2 * "note: mind this\n")


def test_json_is_one_object_with_what_is_known_beside_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert measured(Namespace(output=tmp_path / "o", json=True), several, several=True, simulated=True) == 0
    said = capsys.readouterr()
    found = json.loads(said.out)
    assert said.err == "" and found["simulated"] is True and found["second"]["sentence"] == "It is so."
    assert found["files"] == [str(tmp_path / "o/a.txt"), str(tmp_path / "o/b.csv")]


def test_what_fails_leaves_nothing(tmp_path: Path) -> None:
    def fails(folder: Path, progress: Progress) -> dict[str, Any]:
        one(folder, progress)
        raise RuntimeError

    with pytest.raises(RuntimeError):
        measured(Namespace(output=tmp_path / "o", json=True), fails)
    assert list(tmp_path.iterdir()) == []
