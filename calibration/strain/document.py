"""A calibration as a file: JSON that one can read, with all that is needed to use it and to know where it comes from."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calibration.strain.models import MODELS, BranchModel, Model, model_of
from skinfab.errors import InputError
from skinfab.files import atomic_write
from skinfab.readout.bridge import relative
from skinfab.strict_json import strict_json

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

KIND = "skinfab strain calibration"
SCHEMA = 1
#: A larger file is no calibration.
MAX_BYTES = 10_000_000


@dataclass(frozen=True, eq=False)
class SensorCalibration:
    """A strain sensor that can be read as an angle.

    Parameters
    ----------
    model : Model
        Of dU/U0.
    signal, angle : str
        Columns it was made from.
    u0 : float
        The reading at rest, in the signal's own unit.
    low, high : float, deg
        The range of angles it was made for.
    made_from : mapping
        The log: ``file``, ``sha256``, ``simulated``, ``n``.
    date : str
        ISO 8601.
    error : mapping
        ``rms_deg`` and ``held_out_rms_deg``.
    beside : BranchModel, optional
        Curves for rising and falling readings where `model` is another: what a controller needs, however angles are best told.
    """

    model: Model
    signal: str
    angle: str
    u0: float
    low: float
    high: float
    made_from: Mapping[str, Any]
    date: str
    error: Mapping[str, float]
    beside: BranchModel | None = None

    @property
    def branches(self) -> BranchModel | None:
        """Curves for rising and falling readings, the model's or those beside it."""
        return self.model if isinstance(self.model, BranchModel) else self.beside

    def relative(self, readings: FloatArray) -> FloatArray:
        """dU/U0 of readings."""
        return relative(readings, self.u0)

    def angles(self, time: FloatArray, readings: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Angles (deg) of readings in the order of time (s), and which lie outside what the sensor knows.

        Raises
        ------
        InputError
            Times and readings are not of one length, or a time runs backwards.
        """
        if np.shape(time) != np.shape(readings):
            raise InputError(f"{np.size(time)} times for {np.size(readings)} readings; give one a reading")
        if np.any(np.diff(time) < 0):
            raise InputError("times run backwards; give readings in the order of time")
        return self.model.estimate(time, self.relative(readings))


def save_calibration(calibration: SensorCalibration, path: str | Path) -> None:
    """Write a calibration, whole or not at all."""
    content = {
        "kind": KIND,
        "schema": SCHEMA,
        "date": calibration.date,
        "units": {"signal": "relative change of the reading, (U - U0) / U0", "angle": "deg", "time": "s"},
        "signal": calibration.signal,
        "angle": calibration.angle,
        "u0": calibration.u0,
        "range_deg": [calibration.low, calibration.high],
        "model": calibration.model.name,
        "numbers": calibration.model.numbers(),
        **({} if calibration.beside is None else {"branches": calibration.beside.numbers()}),
        "error": dict(calibration.error),
        "made_from": dict(calibration.made_from),
    }
    atomic_write(path, json.dumps(content, indent=1, allow_nan=False) + "\n")


def load_calibration(path: str | Path) -> SensorCalibration:
    """Read a calibration.

    Raises
    ------
    InputError
        The file cannot be read, is none of these, is of a newer schema, or something in it is missing or wrong.
    """
    path = Path(path)
    again = "make it anew with skinfab calibrate"
    try:
        if path.stat().st_size > MAX_BYTES:
            raise InputError(f"{path} has {path.stat().st_size / 1e6:.0f} MB and is no calibration; give the calibration.json of a sensor")
        content = strict_json(path.read_text(encoding="utf-8"))
    except OSError as fault:
        raise InputError(f"{path}: {fault.strerror or fault}; give the calibration.json that skinfab calibrate wrote") from fault
    except (ValueError, RecursionError) as fault:  # ValueError: JSON, UTF-8 and digits alike
        raise InputError(f"{path} is no JSON file ({fault}); {again}") from fault
    if not isinstance(content, dict) or content.get("kind") != KIND:
        raise InputError(f"{path} is no calibration of a strain sensor; give the calibration.json that skinfab calibrate wrote")
    if content.get("schema") != SCHEMA:
        raise InputError(f"{path} has schema {content.get('schema')!r}, and this skinfab reads {SCHEMA}; update skinfab, or {again}")
    try:
        name = content["model"]
        if name not in MODELS:
            raise InputError(f"{path}: model {name!r} is not known here; it must be one of {', '.join(MODELS)}; {again}")
        low, high = (float(each) for each in content["range_deg"])
        loaded = SensorCalibration(
            model_of(name, content["numbers"]),
            str(content["signal"]),
            str(content["angle"]),
            float(content["u0"]),
            low,
            high,
            dict(content["made_from"]),
            str(content["date"]),
            {key: float(value) for key, value in content["error"].items()},
            BranchModel.of_numbers(content["branches"]) if "branches" in content else None,
        )
    except (KeyError, TypeError, ValueError, AttributeError) as fault:
        if isinstance(fault, InputError):
            raise
        raise InputError(f"{path}: {_missing(fault)}; {again}") from fault
    if not (math.isfinite(loaded.u0) and loaded.u0 and loaded.low < loaded.high):
        raise InputError(f"{path}: U0 is {loaded.u0:g} and the range {loaded.low:g} to {loaded.high:g} degrees; {again}")
    return loaded


def _missing(fault: Exception) -> str:
    return f"{fault.args[0]!r} is missing" if isinstance(fault, KeyError) else f"something in it is wrong ({fault})"
