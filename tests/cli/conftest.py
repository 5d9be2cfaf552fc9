"""Shared fixtures: simulated nail logs of two persons, and a model of the first."""

from pathlib import Path

import pytest

from skinfab.cli.main import main


@pytest.fixture(scope="session")
def nail_logs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("nail") / "logs"
    options = ["--test", "pins6", "--participants", "2", "--training", "4", "--rounds", "2", "--samples", "256"]
    assert main(["nail", "simulate", *options, "-o", str(folder)]) == 0
    return folder


@pytest.fixture(scope="session")
def nail_model(nail_logs: Path) -> Path:
    path = nail_logs.parent / "m.npz"
    assert main(["nail", "train", str(nail_logs / "labels.csv"), "--participant", "1", "-o", str(path)]) == 0
    return path
