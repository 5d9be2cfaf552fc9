"""`skinfab nail bench`: the bench with the user's numbers, one JSON object, and wrong usage."""

import json
from pathlib import Path
from typing import Any

import pytest

from skinfab.bench import nail
from skinfab.cli.main import main
from skinfab.fingertip.nail.protocol import Protocol


def test_the_users_numbers_reach_the_bench_and_its_result_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    asked: dict[str, Any] = {}

    def run(folder: Path, **options: Any) -> dict[str, Any]:
        asked.update(options)
        (folder / "nail.csv").write_text("a,b\n")
        return {"sentence": "It is so.", "notes": ["as it seems"], "rows": [], "simulated": True}

    monkeypatch.setattr(nail, "run", run)
    words = ["nail", "bench", "--participants", "4", "--training", "3", "--rounds", "2", "--estimates", "1", "--seed", "7"]
    assert main([*words, "-o", str(tmp_path), "--json"]) == 0
    out, err = capsys.readouterr()
    told = json.loads(out)
    assert asked["protocol"] == Protocol(4, 3, 2, 1) and asked["seed"] == 7
    assert told["files"] == [str(tmp_path / "nail.csv")] and told["sentence"] == "It is so." and told["simulated"] is True and err == ""
    assert main([*words, "-o", str(tmp_path)]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("It is so.\n") and "note: as it seems" in err


def test_the_papers_protocol_is_the_default(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: dict[str, Any] = {}

    def run(folder: Path, **options: Any) -> dict[str, Any]:
        asked.update(options)
        return {"sentence": "", "notes": []}

    monkeypatch.setattr(nail, "run", run)
    assert main(["nail", "bench", "-o", str(tmp_path)]) == 0
    assert asked["protocol"] == Protocol()


def test_two_participants_cannot_be_compared(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["nail", "bench", "--participants", "2", "-o", str(tmp_path)]) == 2
    assert "fewer than 3" in capsys.readouterr().err
