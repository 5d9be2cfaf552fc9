"""An array's model learned from presses at known places: the skin's depth and Poisson's ratio, its modulus, and each tactel's gain.

For a depth and a ratio the gains are linear; these two are searched for. Gains are held to their common one by as much as a scatter of
`GAIN_PRIOR` allows, so that a tactel that was never pressed keeps it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.logs import ArrayLog
from skinfab.fingertip.array.matched import ArrayModel
from skinfab.fingertip.array.response import add_force
from skinfab.fingertip.array.simulator import Rubber
from skinfab.fingertip.saved import load_model, save_model

FloatArray = NDArray[np.float64]

KIND = "tactel array"
#: Scatter of gains that is taken for granted.
GAIN_PRIOR = 0.1
#: Fewer presses say nothing of an array.
LEAST_PRESSES = 20
#: What the search may come to, as parts of the drawn depth.
_DEPTHS = (0.5, 1.8)


def learn(logs: Sequence[ArrayLog], geometry: Geometry) -> ArrayModel:
    """Learn from the presses (not the rods) in labelled logs.

    Raises
    ------
    InputError
        The logs are of another array, do not say where they were touched, or hold too few presses.
    RefusedError
        The presses are not explained by any skin: their labels are not those of these readings.

    Examples
    --------
    >>> from skinfab.fingertip.array.logs import of_recording
    >>> from skinfab.fingertip.array.protocols import presses
    >>> from skinfab.fingertip.array.simulator import Device
    >>> device = Device(seed=3)
    >>> model = learn([of_recording(presses(device, 200), name="a")], device.geometry)
    >>> bool(np.std(model.gains / model.gains.mean() / device.skin.gains) < 0.02), round(model.geometry.skin, 1)
    (True, 3.8)
    """
    from scipy.optimize import minimize

    Z, places, forces = _presses(logs, geometry)
    held = float(np.sqrt(np.nansum(Z**2)))

    def left(parameters: FloatArray) -> float:
        depth, ratio = parameters
        U = _unit(places, geometry, float(depth), float(ratio)) * forces[:, None, None]
        _, _, residual = _gains(Z, U)
        return residual / held

    start = np.array([geometry.skin, 0.45])
    found = minimize(
        left,
        start,
        method="Nelder-Mead",
        bounds=[(_DEPTHS[0] * geometry.skin, _DEPTHS[1] * geometry.skin), (0.0, 0.5)],
        options={"xatol": 2e-3, "fatol": 1e-6, "maxfev": 120},
    )
    if found.fun > 0.5:
        raise RefusedError(
            f"no skin explains the presses: {100 * found.fun:.0f} % of their readings are left; are the columns axial_mm (from ring 0) and "
            "angle_deg (from stripe 0) those of this array?"
        )
    depth, ratio = (float(value) for value in found.x)
    scale, gains, _ = _gains(Z, _unit(places, geometry, depth, ratio) * forces[:, None, None])
    drawn = asdict(geometry)
    # The depth is that of the model alone: the electrodes stay where they are, on the core.
    core = geometry.core_radius
    fitted = Geometry(**(drawn | {"skin": depth, "finger_radius": core + depth}))
    return ArrayModel(fitted, Rubber(1 / scale, ratio), gains)


def _presses(logs: Sequence[ArrayLog], geometry: Geometry) -> tuple[FloatArray, FloatArray, FloatArray]:
    readings, places, forces = [], [], []
    for log in logs:
        if log.shape != geometry.shape:
            raise InputError(
                f"{log.name} is of an array of {log.shape[0]} x {log.shape[1]} tactels, not of {geometry.rings} x {geometry.stripes}"
            )
        line = log.truth.get("line_deg", np.full(len(log.time), np.nan))
        for k in log.touched():
            if np.isnan(line[k]):
                readings.append(log.Z[k])
                places.append((log.truth["axial_mm"][k], np.radians(log.truth["angle_deg"][k]) * geometry.core_radius))
                forces.append(log.truth["force_n"][k])
    if len(readings) < LEAST_PRESSES:
        raise InputError(f"the logs hold {len(readings)} frames of presses on points; give at least {LEAST_PRESSES}, all over the array")
    return np.array(readings), np.array(places), np.array(forces)


def _unit(places: FloatArray, geometry: Geometry, depth: float, ratio: float) -> FloatArray:
    """Readings times E of 1 N at each place; what was pressed several times running is computed once."""
    out = np.zeros((len(places), *geometry.shape))
    for k, (x, s) in enumerate(places):
        if k and (places[k] == places[k - 1]).all():
            out[k] = out[k - 1]
        else:
            add_force(out[k], (1.0, 0.0, 0.0), (float(x), float(s)), geometry.pitch, geometry.half, depth, ratio)
    return out


def _gains(Z: FloatArray, U: FloatArray) -> tuple[float, FloatArray, float]:
    """1/E and the gains that leave least of Z = gain U / E, and the square root of the sum of squares that is left."""
    known = np.isfinite(Z)
    z, u = np.where(known, Z, 0.0), np.where(known, U, 0.0)
    scale = float((z * u).sum() / max(float((u * u).sum()), 1e-300))
    rough = float(((z - scale * u) ** 2).sum() / max(int(known.sum()), 1))
    v = scale * u
    # A gain's prior counts as much as readings whose noise is what the common gain leaves.
    weight = rough / GAIN_PRIOR**2
    gains = ((z * v).sum(axis=0) + weight) / ((v * v).sum(axis=0) + weight)
    return scale, gains, float(np.sqrt(((z - gains * v) ** 2).sum()))


def save_array(path: str | Path, model: ArrayModel, facts: dict[str, Any]) -> None:
    """Write a model without pickle, whole or not at all."""
    known = {"geometry": asdict(model.geometry), "rubber": asdict(model.rubber)}
    save_model(path, kind=KIND, facts=known | facts, arrays={"gains": model.gains})


def load_array(path: str | Path) -> tuple[ArrayModel, dict[str, Any]]:
    """Read a model and what is known of it.

    Raises
    ------
    InputError
        As `skinfab.fingertip.saved.load_model`, or it is damaged.
    """
    saved = load_model(path, kind=KIND)
    facts = dict(saved.facts)
    try:
        geometry, rubber = Geometry(**facts.pop("geometry")), Rubber(**facts.pop("rubber"))
        gains = np.asarray(saved.arrays["gains"], dtype=float)
    except (KeyError, TypeError) as fault:
        raise InputError(f"{path} is not a whole model of an array ({fault}); train it again") from fault
    if gains.shape != geometry.shape or not rubber.young > 0 or not 0 <= rubber.poisson <= 0.5:
        raise InputError(f"{path}: gains of {gains.shape} on {geometry.shape} tactels, E {rubber.young}, are no array; train it again")
    return ArrayModel(geometry, rubber, gains), facts
