"""A nail model as a file: the trials it was learned from as phasors, or the published machine's support vectors.

What follows from the trials (means, scatter, gate, regression) is worked out again when it is loaded, in a millisecond: so a channel
that breaks later can be left out as if it had never been.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.nail.classify import NailModel
from skinfab.fingertip.nail.histogram_model import HistogramModel
from skinfab.fingertip.nail.labels import NOTHING
from skinfab.fingertip.nail.published import CONDITIONS
from skinfab.fingertip.nail.regress import TARGETS, Regression
from skinfab.fingertip.saved import Saved, load_model, save_model

FloatArray = NDArray[np.float64]

PHASORS, HISTOGRAMS = "nail phasors", "nail histograms"


@dataclass(frozen=True, eq=False)
class NailFile:
    """What a model's file holds.

    Parameters
    ----------
    model : NailModel or HistogramModel
    regression : Regression, optional
        Of a `NailModel`.
    made_from : mapping
        The labels: ``file``, ``participant``, ``trials``, ``simulated``, and how good it was on trials that were held out.
    """

    model: NailModel | HistogramModel
    regression: Regression | None
    made_from: Mapping[str, Any]


def save_nail(path: str | Path, content: NailFile) -> None:
    """Write a model, whole or not at all."""
    model = content.model
    facts: dict[str, Any] = {"names": list(model.names), "rate_hz": model.rate_hz, "made_from": dict(content.made_from)}
    if isinstance(model, HistogramModel):
        facts |= {"condition": model.condition, "samples": model.samples, "gamma": model.gamma}
        names = ("vectors", "dual", "intercept", "counts", "classes")
        save_model(path, kind=HISTOGRAMS, facts=facts, arrays={name: getattr(model, name) for name in names})
        return
    targets = np.full((len(model.classes), len(TARGETS)), np.nan) if content.regression is None else content.regression.targets
    facts |= {
        "drive_hz": model.drive_hz,
        "shrinkage": model.shrinkage,
        "temperature": model.temperature,
        "units": {"Ax, Ay, Az": "G", "Gx, Gy, Gz": "deg/s", "otherwise": "as logged, where no unit was declared", "targets": list(TARGETS)},
    }
    arrays = {
        "classes": model.classes,
        "drive_real": model.drive.real,
        "drive_imag": model.drive.imag,
        "noise": model.noise,
        "channels": model.channels.astype(np.int64),
        "targets": np.nan_to_num(targets),
        "targets_known": np.isfinite(targets).astype(np.int64),
    }
    save_model(path, kind=PHASORS, facts=facts, arrays=arrays)


def load_nail(path: str | Path) -> NailFile:
    """Read a model.

    Raises
    ------
    InputError
        As `skinfab.fingertip.saved.load_model`, or what is in it does not go together.
    """
    saved = load_model(path, kind=(PHASORS, HISTOGRAMS))
    try:
        made = _phasors(saved) if saved.kind == PHASORS else _histograms(saved)
    except (KeyError, TypeError, ValueError, IndexError, np.linalg.LinAlgError) as fault:
        what = f"{fault.args[0]!r} is missing" if isinstance(fault, KeyError) else str(fault)
        raise InputError(f"{path}: the model does not go together ({what}); train it again, or take another copy") from fault
    return made


def _phasors(saved: Saved) -> NailFile:
    facts, arrays = saved.facts, saved.arrays
    names, classes = tuple(str(name) for name in facts["names"]), arrays["classes"]
    n = len(classes)
    shapes = {"drive_real": (n, 6), "drive_imag": (n, 6), "noise": (6,), "channels": (6,), "targets": (n, 5), "targets_known": (n, 5)}
    _require(arrays, shapes)
    if not n or classes.ndim != 1 or classes.min() < 0 or classes.max() >= len(names):
        raise ValueError("a trial is of no class that is named")
    numbers = {name: float(facts[name]) for name in ("rate_hz", "drive_hz", "shrinkage", "temperature")}
    if not (0 <= numbers["shrinkage"] <= 1 and min(numbers["rate_hz"], numbers["drive_hz"], numbers["temperature"]) > 0):
        raise ValueError("a number in it is out of its range")
    drive = arrays["drive_real"] + 1j * arrays["drive_imag"]
    model = NailModel(names, classes, drive, arrays["noise"], channels=arrays["channels"].astype(bool), **numbers)
    if len(model.touched) < 2 or model.channels.sum() < 2:
        raise ValueError("it has fewer than two classes of contact, or fewer than two channels")
    regression = Regression(model, np.where(arrays["targets_known"] > 0, arrays["targets"], np.nan))
    return NailFile(model, regression, dict(facts["made_from"]))


def _histograms(saved: Saved) -> NailFile:
    facts, arrays = saved.facts, saved.arrays
    names, condition = tuple(str(name) for name in facts["names"]), str(facts["condition"])
    if condition not in CONDITIONS:
        raise ValueError(f"there is no sensor condition {condition!r}")
    k, v = len(arrays["counts"]), int(arrays["counts"].sum())
    width = 36 * len(CONDITIONS[condition])
    _require(arrays, {"vectors": (v, width), "dual": (k - 1, v), "intercept": (k * (k - 1) // 2,), "counts": (k,), "classes": (k,)})
    if k < 2 or arrays["counts"].min() < 0 or arrays["classes"].min() < 0 or arrays["classes"].max() >= len(names):
        raise ValueError("a class of it is none that is named")
    numbers = (int(facts["samples"]), float(facts["rate_hz"]), float(facts["gamma"]))
    parts = (arrays[name] for name in ("vectors", "dual", "intercept", "counts", "classes"))
    return NailFile(HistogramModel(names, condition, *numbers, *parts), None, dict(facts["made_from"]))


def _require(arrays: Mapping[str, NDArray[Any]], shapes: Mapping[str, tuple[int, ...]]) -> None:
    for name, shape in shapes.items():
        if arrays[name].shape != shape:
            raise ValueError(f"{name} has shape {arrays[name].shape} and {shape} is wanted")


def class_names(labels: list[str]) -> tuple[str, ...]:
    """Classes in the order in which they come, `NOTHING` first where it is among them.

    Examples
    --------
    >>> class_names(["lateral", "none", "diagonal", "lateral"])
    ('none', 'lateral', 'diagonal')
    """
    found = list(dict.fromkeys(labels))
    return tuple(sorted(found, key=lambda name: name != NOTHING))
