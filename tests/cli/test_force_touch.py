"""`skinfab force train contact`: from touches to a model, and what a run makes of it."""

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skinfab.cli.main import main


def said(capsys: pytest.CaptureFixture[str], *arguments: object) -> dict[str, Any]:
    """Run with --json: one object on standard output, and nothing else."""
    assert main(["force", *map(str, arguments), "--json"]) == 0
    result: dict[str, Any] = json.loads(capsys.readouterr().out)
    return result


def test_from_touches_to_a_model_that_a_run_uses(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = said(capsys, "simulate", "contact", "-o", tmp_path / "touches", "--touches", "8", "--seed", "3")["files"]
    *logs, places = made
    learned = said(capsys, "train", "contact", *logs, "--places", places, "-o", tmp_path / "learned")
    assert learned["helps"] and learned["simulated"] and learned["places"] == 8 and len(learned["made_from"]) == 8
    assert learned["held_out_mm"]["after"] < learned["held_out_mm"]["before"]
    model = tmp_path / "learned" / "model.npz"
    place = np.array([float(x) for x in Path(places).read_text().splitlines()[1].split(",")[1:4]])

    def off(*options: object) -> float:
        result = said(capsys, "run", "contact", logs[0], "-o", tmp_path / "out", *options)
        assert result["learned"] == bool(options)
        rows = list(csv.DictReader((tmp_path / "out" / "contacts.csv").read_text().splitlines()))
        points = [[float(row[name]) for name in ("x_mm", "y_mm", "z_mm")] for row in rows if float(row["force_n"]) > 1]
        return float(np.median(np.linalg.norm(np.array(points) - place, axis=1)))

    straight = off("--model", model)
    assert straight < 1.2 and straight < off() - 0.2
    assert main(["force", "run", "contact", logs[0], "--model", str(model), "--radius", "18", "-o", str(tmp_path / "no")]) == 1
    assert "of another fingertip, a dome of 20 mm" in capsys.readouterr().err
    assert main(["force", "train", "contact", *logs[:4], "--places", places, "-o", str(tmp_path / "no")]) == 1
    assert "touch the fingertip all over" in capsys.readouterr().err and not (tmp_path / "no").exists()
