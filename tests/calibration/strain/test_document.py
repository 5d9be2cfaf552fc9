"""A calibration and its file: the same angles after it, and one sentence for a file that is none."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibration.strain.document import SensorCalibration, load_calibration, save_calibration
from calibration.strain.models import MODELS, BranchModel, Samples
from skinfab.errors import InputError


@pytest.fixture
def made(log: Callable[..., Samples]) -> Callable[[str], SensorCalibration]:
    def make(name: str) -> SensorCalibration:
        model = MODELS[name].fit([log(width=4.0)], degree=3)
        error = {"rms_deg": 1.5, "held_out_rms_deg": 2.0}
        return SensorCalibration(model, "U", "PIP", 2.5, 10.0, 80.0, {"file": "a.csv", "n": 9}, "2026-01-31T12:00:00+00:00", error)

    return make


@pytest.mark.parametrize("name", MODELS)
def test_the_same_after_its_file(name: str, made: Callable[[str], SensorCalibration], log: Callable[..., Samples], tmp_path: Path) -> None:
    before = made(name)
    save_calibration(before, tmp_path / "c.json")
    after = load_calibration(tmp_path / "c.json")
    run = log(width=4.0, cycles=3)
    readings = 2.5 * (1 + run.signal)
    for one, two in zip(before.angles(run.time, readings), after.angles(run.time, readings), strict=True):
        np.testing.assert_array_equal(one, two)
    assert (after.signal, after.angle, after.u0, after.low, after.high) == ("U", "PIP", 2.5, 10.0, 80.0)
    assert after.error == before.error and after.made_from == before.made_from and after.date == before.date


def test_branches_beside_another_model(made: Callable[[str], SensorCalibration], tmp_path: Path) -> None:
    before, branches = made("lag"), made("branches").model
    assert before.branches is None and made("branches").branches is not None and isinstance(branches, BranchModel)
    save_calibration(replace(before, beside=branches), tmp_path / "c.json")
    after = load_calibration(tmp_path / "c.json")
    assert after.model.name == "lag" and after.branches is not None and after.branches.numbers() == branches.numbers()
    content = json.loads((tmp_path / "c.json").read_text())
    (tmp_path / "c.json").write_text(json.dumps(content | {"branches": {"curve": 1}}))
    with pytest.raises(InputError, match="something in it is wrong"):
        load_calibration(tmp_path / "c.json")


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"schema": 2}, "schema 2, and this skinfab reads 1; update skinfab"),
        ({"kind": "else"}, "is no calibration of a strain sensor"),
        ({"model": "magic"}, "model 'magic' is not known here; it must be one of poly"),
        ({"numbers": {}}, "'curve' is missing"),
        ({"u0": 0}, "U0 is 0"),
        ({"u0": "x"}, "something in it is wrong"),
        ({"range_deg": [80, 10]}, "range 80 to 10 degrees"),
        ({"range_deg": 3}, "something in it is wrong"),
        ({"numbers": {"curve": {"low_deg": 9, "high_deg": 5, "bernstein": [1, 2]}}}, "is none"),
        ({"error": None}, "something in it is wrong"),
    ],
)
def test_files_that_are_none(change: dict[str, object], says: str, made: Callable[[str], SensorCalibration], tmp_path: Path) -> None:
    path = tmp_path / "c.json"
    save_calibration(made("poly"), path)
    path.write_text(json.dumps(json.loads(path.read_text()) | change))
    with pytest.raises(InputError, match=says):
        load_calibration(path)


def test_what_is_no_json(tmp_path: Path, made: Callable[[str], SensorCalibration]) -> None:
    path = tmp_path / "c.json"
    for text, says in (("{", "is no JSON file"), ("[]", "is no calibration"), ("[" * 100_000, "is no JSON file")):
        path.write_text(text)
        with pytest.raises(InputError, match=says):
            load_calibration(path)
    with pytest.raises(InputError, match="No such file"):
        load_calibration(tmp_path / "none.json")


def test_readings_must_be_in_order(made: Callable[[str], SensorCalibration]) -> None:
    with pytest.raises(InputError, match="times run backwards"):
        made("poly").angles(np.array([0.0, -1.0]), np.ones(2))
    with pytest.raises(InputError, match="2 times for 3 readings"):
        made("poly").angles(np.array([0.0, 1.0]), np.ones(3))
