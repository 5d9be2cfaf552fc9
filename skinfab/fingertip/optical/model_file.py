"""A model of an optical fingertip as a file, without pickle."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from skinfab.errors import InputError
from skinfab.fingertip.optical.pins import Pins
from skinfab.fingertip.optical.regress import EdgeModel
from skinfab.fingertip.saved import load_model, save_model

KIND = "optical edge"
_ARRAYS = ("mean", "basis", "support", "weights", "centre", "spacing", "wrong", "usual")


def save_edge(path: str | Path, model: EdgeModel, made_from: Mapping[str, Any]) -> None:
    """Write a model, whole or not at all.

    Parameters
    ----------
    path : path
    model : EdgeModel
    made_from : mapping
        What it was learned from and how good it was; ``simulated`` is in it.
    """
    facts = {"shape": list(model.pins.shape), "level": model.pins.level, "gamma": model.gamma, "ridge": model.ridge}
    arrays = {"rest": model.pins.rest, **{name: getattr(model, name) for name in _ARRAYS}}
    save_model(path, kind=KIND, facts={**facts, "made_from": dict(made_from)}, arrays=arrays)


def load_edge(path: str | Path) -> tuple[EdgeModel, Mapping[str, Any]]:
    """Read a model, and what it was made from.

    Raises
    ------
    InputError
        As `load_model`; or what it holds does not fit together.
    """
    saved = load_model(path, kind=KIND)
    facts, a = saved.facts, saved.arrays
    try:
        height, width = (int(n) for n in facts["shape"])
        pins = Pins(a["rest"], (height, width), int(facts["level"]))
        mean, basis, support, weights, centre, spacing, wrong, usual = (a[name] for name in _ARRAYS)
        model = EdgeModel(pins, mean, basis, support, weights, centre, float(facts["gamma"]), float(facts["ridge"]), spacing, wrong, usual)
        made_from = dict(facts["made_from"])
        (k, two), (n, d), targets = a["rest"].shape, a["support"].shape, a["weights"].shape[1]
        fits = two == 2 and a["mean"].shape == (2 * k,) and a["basis"].shape == (2 * k, d) and a["usual"].shape == (3,)
        fits = fits and a["spacing"].shape == a["wrong"].shape == (n,) and model.gamma > 0 and model.ridge > 0
        fits = fits and bool((a["spacing"] > 0).all() and ((a["wrong"] >= 0) & (a["wrong"] <= 1)).all())
        fits = fits and len(a["weights"]) == n and a["centre"].shape == (targets,) and targets in (3, 4)
        fits = fits and bool((a["rest"] >= 0).all() and (a["rest"] <= np.array([width, height]) - 1).all() and (a["usual"] > 0).all())
    except (KeyError, TypeError, ValueError, IndexError) as fault:
        raise InputError(f"{path} is not whole ({type(fault).__name__}: {fault}); train it again, or take another copy") from fault
    if not fits:
        raise InputError(f"{path}: its arrays do not fit together; train it again, or take another copy")
    return model, made_from
