"""Nail models as files: the same decisions after loading, and files that do not go together are refused."""

import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.nail.classify import NailModel
from skinfab.fingertip.nail.histogram_model import HistogramModel, fit_histograms
from skinfab.fingertip.nail.improved import asked, label_of, learn
from skinfab.fingertip.nail.model_file import HISTOGRAMS, PHASORS, NailFile, load_nail, save_nail
from skinfab.fingertip.nail.protocol import Protocol, session
from skinfab.fingertip.nail.regress import Regression, targets_of
from skinfab.fingertip.saved import load_model, save_model

ONE = session("edges4", 1, protocol=Protocol(training=4, rounds=3, estimates=1, samples=256), seed=7)


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    model = learn(ONE)
    regression = Regression(model, targets_of([label_of(touch) for touch in ONE.training.touches]))
    save_nail(tmp_path / "m.npz", NailFile(model, regression, {"trials": 20, "simulated": True}))
    return tmp_path / "m.npz"


@pytest.fixture
def published(tmp_path: Path) -> Path:
    model = fit_histograms(learn(ONE).names, ONE.training.classes, ONE.training.readings[:, 0], rate_hz=1400.0)
    save_nail(tmp_path / "p.npz", NailFile(model, None, {"simulated": True}))
    return tmp_path / "p.npz"


def test_the_same_decisions_and_estimates(saved: Path) -> None:
    loaded, model, windows = load_nail(saved), learn(ONE), asked(ONE, 33)
    assert isinstance(loaded.model, NailModel) and loaded.made_from == {"trials": 20, "simulated": True}
    a, b = loaded.model.decide(windows), model.decide(windows)
    assert (a.classes == b.classes).all() and np.array_equal(a.probability, b.probability)
    assert loaded.regression is not None
    targets = targets_of([label_of(touch) for touch in ONE.training.touches])
    expected = Regression(model, targets).estimate(model.learned)
    np.testing.assert_array_equal(loaded.regression.estimate(model.learned), expected)


def test_the_published_machine_too(published: Path) -> None:
    loaded = load_nail(published)
    assert isinstance(loaded.model, HistogramModel) and loaded.regression is None
    again = fit_histograms(loaded.model.names, ONE.training.classes, ONE.training.readings[:, 0], rate_hz=1400.0)
    windows = ONE.rounds.readings[:, 0]
    assert loaded.model.decide(windows).tolist() == again.decide(windows).tolist()


def test_nothing_of_a_pickle_is_in_it(saved: Path) -> None:
    with zipfile.ZipFile(saved) as archive:
        assert {Path(name).suffix for name in archive.namelist()} == {".npy", ".json"}
        assert all(b"'descr': '<" in archive.read(name)[:80] for name in archive.namelist() if name.endswith(".npy"))


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        ({"names": ["a"]}, "a trial is of no class"),
        ({"temperature": -1.0}, "out of its range"),
        ({"shrinkage": 2.0}, "out of its range"),
        ({"drive_hz": "fast"}, "could not convert"),
        ({"made_from": 3}, "not go together"),
        ({"rate_hz": None}, "not go together"),
    ],
)
def test_facts_that_do_not_fit(saved: Path, changed: dict[str, Any], says: str) -> None:
    was = load_model(saved, kind=PHASORS)
    save_model(saved, kind=PHASORS, facts={**was.facts, **changed}, arrays=was.arrays)
    with pytest.raises(InputError, match=says):
        load_nail(saved)


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        ({"drive_real": np.zeros((3, 6))}, r"drive_real has shape \(3, 6\)"),
        ({"noise": np.zeros(5)}, "noise has shape"),
        ({"classes": np.full(25, -1)}, "is of no class"),
        ({"channels": np.array([1, 0, 0, 0, 0, 0])}, "fewer than two channels"),
        ({"classes": np.ones(25, dtype=np.int64)}, "fewer than two classes"),
    ],
)
def test_arrays_that_do_not_fit(saved: Path, changed: dict[str, np.ndarray], says: str) -> None:
    was = load_model(saved, kind=PHASORS)
    n = len(was.arrays["classes"])
    save_model(
        saved, kind=PHASORS, facts=was.facts, arrays={**was.arrays, **{k: v[:n] if k == "classes" else v for k, v in changed.items()}}
    )
    with pytest.raises(InputError, match=says):
        load_nail(saved)


def test_a_fact_or_an_array_that_is_gone(saved: Path, published: Path) -> None:
    was = load_model(saved, kind=PHASORS)
    save_model(saved, kind=PHASORS, facts={k: v for k, v in was.facts.items() if k != "drive_hz"}, arrays=was.arrays)
    with pytest.raises(InputError, match="'drive_hz' is missing"):
        load_nail(saved)
    of = load_model(published, kind=HISTOGRAMS)
    save_model(published, kind=HISTOGRAMS, facts=of.facts, arrays={k: v for k, v in of.arrays.items() if k != "dual"})
    with pytest.raises(InputError, match="'dual' is missing"):
        load_nail(published)
    save_model(published, kind=HISTOGRAMS, facts={**of.facts, "condition": "Bx"}, arrays=of.arrays)
    with pytest.raises(InputError, match="no sensor condition 'Bx'"):
        load_nail(published)


def test_a_model_of_something_else(tmp_path: Path) -> None:
    save_model(tmp_path / "f.npz", kind="force texture", facts={}, arrays={})
    with pytest.raises(InputError, match=r"another kind, 'force texture', and 'nail phasors' or 'nail histograms' is wanted"):
        load_nail(tmp_path / "f.npz")


def test_what_is_in_it_can_be_read_by_eye(saved: Path) -> None:
    with zipfile.ZipFile(saved) as archive:
        head = json.loads(archive.read("model.json"))
    assert head["facts"]["names"][:2] == ["none", "longitudinal"] and head["facts"]["made_from"]["simulated"]
