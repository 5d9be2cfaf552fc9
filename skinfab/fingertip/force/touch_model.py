"""A fingertip's sensor as it is mounted, learned from touches at known places.

A sensor sits a millimetre beside the dome's centre, is turned by a degree or two, and each of its axes reads a little of the others.
All of that is a matrix between what is read and what acts, C w, and every touch at a place p says three things of it: M = p x F.
The matrix that departs least from "as the drawing says" and fits best is a linear least-squares problem (ridge regression, or
the most likely matrix where its departures and the errors of the marked places are Gaussian; Hoerl and Kennard 1970). What touches
cannot tell, above all the forces' common scale, stays as the maker calibrated it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.contact import LEAST_FORCE_N, Hemisphere, locate
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.tare import tared
from skinfab.fingertip.force.touch_fit import Touch, fit_matrix, found_at, held_out, touch_of, touches_apart
from skinfab.fingertip.force.wrench import SensorNoise
from skinfab.fingertip.saved import load_model, save_model
from skinfab.spreadsheet import read_csv_rows

if TYPE_CHECKING:
    from skinfab.fingertip.force.contact_mesh import TipMesh

FloatArray = NDArray[np.float64]

KIND = "force contact"
HEAD = ("log", "x_mm", "y_mm", "z_mm")
#: Fewer places than this leave most of the matrix to what is believed beforehand.
LEAST_PLACES = 6
#: Samples are taken together over this time, s.
_BLOCK_S = 0.05
#: Contacts that are farther off than this after all, mm (median, places held out), were not made where they are said to be.
_WORST_MM = 3.0
#: More of the touches than this part may not be left out: it is no longer clear who is right.
_MOST_APART = 0.25
#: Steps of force (N) and moment (N mm) by which points are moved to see how much: below what is felt, far above rounding.
_STEPS = (1e-3,) * 3 + (1e-2,) * 3
_MAX_BYTES = 10_000_000


@dataclass(frozen=True, eq=False)
class TouchModel:
    """What was learned of a sensor.

    Parameters
    ----------
    matrix : (6, 6) float
        From force (N) and moment (N mm) as they are read to as they act in the fingertip's frame; the unit matrix where touches
        held out are found no better by one.
    noise : SensorNoise
        As the sensor rests.
    surface : str
        The fingertip that was touched, see `named`.
    spread : (36, 36) float
        Covariance of the matrix's numbers, row by row.
    """

    matrix: FloatArray
    noise: SensorNoise
    surface: str
    spread: FloatArray

    def corrected(self, log: WrenchLog) -> WrenchLog:
        """The log as it acts on the fingertip; its offset must be off."""
        wrench = np.hstack([log.force, log.moment]) @ self.matrix.T
        return replace(log, force=np.ascontiguousarray(wrench[:, :3]), moment=np.ascontiguousarray(wrench[:, 3:]))

    def own_error(self, log: WrenchLog, surface: Hemisphere | TipMesh) -> FloatArray:
        """How far the matrix's own error moves each point of a log that was corrected by it, (n,) mm, to first order."""
        acts = np.hstack([log.force, log.moment])
        read = acts @ np.linalg.inv(self.matrix).T
        moved = np.zeros((len(acts), 6, 3))
        for axis, step in enumerate(_STEPS):
            ahead, behind = (np.ascontiguousarray(acts + sign * step * np.eye(6)[axis]) for sign in (0.5, -0.5))
            points = [locate(each[:, :3], each[:, 3:], surface, least_force=0.0).point for each in (ahead, behind)]
            moved[:, axis] = (points[0] - points[1]) / step
        # Along the principal axes of the matrix's error, each of which changes a wrench w by E w.
        variance, axes = np.linalg.eigh(self.spread)
        total = np.zeros(len(acts))
        for own, axis_of in zip(np.maximum(variance, 0.0), axes.T, strict=True):
            total += own * (np.einsum("nik,ni->nk", moved, read @ axis_of.reshape(6, 6).T) ** 2).sum(axis=1)
        return np.sqrt(total)

    def require_surface(self, surface: Hemisphere | TipMesh) -> None:
        """Refuse another fingertip than the one that was touched.

        Raises
        ------
        InputError
        """
        if named(surface) != self.surface:
            raise InputError(f"the model is of another fingertip, {self.surface}, and this one is {named(surface)}; train one of its own")


@dataclass(frozen=True)
class Trained:
    """A model, and how far off touches are found: by a sensor as it is, and by models that have not seen the place.

    Parameters
    ----------
    model : TouchModel
    before_mm, after_mm : float, mm
        Median over places, of each its median over samples.
    worst_before_mm, worst_after_mm : float, mm
    places : int
        That were learned from.
    left_out : tuple of str
        Touches that are not where they are said to be, in words; they were not learned from and are not in these figures.
    """

    model: TouchModel
    before_mm: float
    after_mm: float
    worst_before_mm: float
    worst_after_mm: float
    places: int
    left_out: tuple[str, ...] = ()

    @property
    def helps(self) -> bool:
        """Is the matrix another one than the unit matrix?"""
        return self.after_mm < self.before_mm


def named(surface: Hemisphere | TipMesh) -> str:
    """What tells a fingertip from another one, in a model.

    Examples
    --------
    >>> named(Hemisphere(20.0))
    'a dome of 20 mm'
    """
    if isinstance(surface, Hemisphere):
        return f"a dome of {surface.radius:g} mm"
    size = surface.mesh.bbox[1] - surface.mesh.bbox[0]
    return f"a mesh of {len(surface.mesh.F)} triangles, {' x '.join(f'{x:.2f}' for x in size)} mm"


def learn_touches(
    logs: Sequence[WrenchLog], places: Mapping[str, FloatArray], surface: Hemisphere | TipMesh, *, rest_s: float = 0.5
) -> Trained:
    """Learn from logs of one touch each, pushed from several sides, whose places are known.

    Parameters
    ----------
    logs : sequence of WrenchLog
        Each begins untouched.
    places : mapping of str to (3,) float, mm
        Of each log by its name, in the fingertip's frame.
    surface : Hemisphere or TipMesh
    rest_s : float
        For which they are untouched.

    Raises
    ------
    InputError
        A log has no place, a place is not on the fingertip, too few places or a log without a touch.
    RefusedError
        Touches held out are found far from their places all the same, or more than a quarter of them is not where it is said to be.

    Examples
    --------
    >>> from skinfab.fingertip.force.touch_simulator import simulate_touches
    >>> trained = learn_touches(*simulate_touches(8, seed=1), Hemisphere())
    >>> trained.helps, trained.model.matrix.shape
    (True, (6, 6))
    """
    if missing := next((log.name for log in logs if log.name not in places), None):
        raise InputError(f"the table of places has no row for {missing}; add one: {missing},X,Y,Z")
    if len({tuple(np.round(places[log.name], 3)) for log in logs}) < LEAST_PLACES:
        raise InputError(f"{len(logs)} touches are at fewer than {LEAST_PLACES} different places; touch the fingertip all over")
    touches, noise = touches_of(logs, places, surface, rest_s=rest_s)
    apart = touches_apart(touches, surface)
    kept = [touch for k, touch in enumerate(touches) if k not in apart]
    before = [found_at(np.eye(6), touch, surface)[1] for touch in kept]
    after = held_out(kept, surface)
    middle = (float(np.median(before)), float(np.median(after)))
    if not min(middle) <= _WORST_MM:
        raise RefusedError(
            f"touches held out are found {middle[1]:.1f} mm from their places (as read: {middle[0]:.1f} mm), so one does not belong to the "
            "other; are the places in the sensor's frame and in mm, and is the force's sign that of the force on the fingertip?"
        )
    matrix, spread = fit_matrix(kept)
    out = tuple(_elsewhere(touches[k], matrix, places, surface) for k in apart)
    if len(apart) > _MOST_APART * len(touches) or len({tuple(np.round(touch.place, 3)) for touch in kept}) < LEAST_PLACES:
        raise RefusedError(
            f"{len(apart)} of {len(touches)} touches are not where the table says: {'; '.join(out)}; mend the table, or touch again"
        )
    helps = middle[1] < middle[0]
    model = TouchModel(matrix if helps else np.eye(6), noise, named(surface), spread)
    return Trained(model, *middle, max(before), max(after), len(kept), out)


def touches_of(
    logs: Sequence[WrenchLog], places: Mapping[str, FloatArray], surface: Hemisphere | TipMesh, *, rest_s: float = 0.5
) -> tuple[list[Touch], SensorNoise]:
    """What each log says, its offset off, and how noisy the sensor is while it rests."""
    rests, read = [], []
    for log in logs:
        _require_on(np.asarray(places[log.name], dtype=float), surface, log.name)
        clean = tared(log, seconds=rest_s)
        rest = log.time < log.time[0] + rest_s
        rests.append(np.hstack([clean.force[rest], clean.moment[rest]]))
        read.append(_blocks(clean))
    own = np.sqrt(np.vstack([each - each.mean(axis=0) for each in rests]).var(axis=0))
    noise = SensorNoise(float(np.sqrt((own[:3] ** 2).mean())), float(np.sqrt((own[3:] ** 2).mean())))
    return [touch_of(log.name, np.asarray(places[log.name], dtype=float), w, noise) for log, w in zip(logs, read, strict=True)], noise


def _elsewhere(touch: Touch, matrix: FloatArray, places: Mapping[str, FloatArray], surface: Hemisphere | TipMesh) -> str:
    """How far a touch is from its place, and at whose it is instead."""
    point, off = found_at(matrix, touch, surface)
    near, name = min((float(np.linalg.norm(place - point)), name) for name, place in places.items())
    at = f"the place of {name}" if near <= _WORST_MM and name != touch.name else ", ".join(f"{x:.1f}" for x in point)
    return f"{touch.name} is {off:.1f} mm off, at {at}"


def _require_on(place: FloatArray, surface: Hemisphere | TipMesh, name: str) -> None:
    if isinstance(surface, Hemisphere):
        off = abs(float(np.linalg.norm(place)) - surface.radius)
    else:
        from trimesh.triangles import closest_point

        triangles = surface.mesh.V[surface.mesh.F]
        nearest = closest_point(triangles, np.broadcast_to(place, (len(triangles), 3)))
        off = float(np.linalg.norm(nearest - place, axis=1).min())
    if not off <= _WORST_MM:
        raise InputError(f"the place of {name} lies {off:.1f} mm off {named(surface)}; give it in mm, in the fingertip's frame")


def _blocks(log: WrenchLog) -> FloatArray:
    """Means (n, 6) over short times in which something pushes."""
    width = max(round(_BLOCK_S * log.rate_hz), 1)
    count = len(log) // width
    blocks = np.hstack([log.force, log.moment])[: count * width].reshape(count, width, 6)
    # All of a block: at its beginning a touch is no steady one.
    pushed = np.linalg.norm(blocks[:, :, :3], axis=2).min(axis=1) >= LEAST_FORCE_N
    if not pushed.any():
        raise InputError(f"{log.name}: nothing pushes with {LEAST_FORCE_N:g} N or more after its rest; touch the fingertip there")
    means: FloatArray = blocks[pushed].mean(axis=1)
    return means


def read_places(path: str | Path) -> dict[str, FloatArray]:
    """A table of log, x_mm, y_mm, z_mm.

    Raises
    ------
    InputError
        It cannot be read, lacks a heading, names a log twice, or a place is no number.
    """
    path = Path(path)
    rows = read_csv_rows(path, max_bytes=_MAX_BYTES, wanted=f"a table of {','.join(HEAD)} as a CSV file")
    if not rows or any(name not in rows[0] for name in HEAD):
        raise InputError(f"{path} is no table of places; give it the headings {','.join(HEAD)} and a row a log")
    out: dict[str, FloatArray] = {}
    for k, row in enumerate(rows):
        try:
            place = np.array([float(row[name]) for name in HEAD[1:]])
        except (TypeError, ValueError):
            place = np.full(3, math.nan)
        name = (row["log"] or "").strip()
        if not np.isfinite(place).all() or name in out:
            raise InputError(f"{path}, row {k + 1}: {name!r} has no place of three numbers, or has one already; mend the row")
        out[name] = place
    return out


def save_touches(trained: Trained, path: str | Path, *, made_from: Sequence[dict[str, Any]]) -> None:
    """Write a model with how good it is and what it was made from; the file says whether that was simulated."""
    m = trained.model
    facts = {
        "surface": m.surface,
        "held_out_mm": {"before": trained.before_mm, "after": trained.after_mm},
        "simulated": any(each["simulated"] for each in made_from),
        "made_from": list(made_from),
    }
    arrays = {"matrix": m.matrix, "spread": m.spread, "noise": np.array([m.noise.force_n, m.noise.moment_nmm])}
    save_model(path, kind=KIND, facts=facts, arrays=arrays)


def load_touches(path: str | Path) -> tuple[TouchModel, bool]:
    """Read a model; and whether it was made from simulated logs.

    Raises
    ------
    InputError
        As `skinfab.fingertip.saved.load_model`, or its parts are none.
    """
    saved = load_model(path, kind=KIND)
    try:
        matrix, spread = saved.arrays["matrix"], saved.arrays["spread"]
        (force, moment) = saved.arrays["noise"].tolist()
        surface, simulated = str(saved.facts["surface"]), bool(saved.facts["simulated"])
    except (KeyError, TypeError, ValueError) as fault:
        raise InputError(f"{path}: a part of the model is missing or wrong ({fault!r}); train it again") from fault
    if matrix.shape != (6, 6) or spread.shape != (36, 36) or not np.linalg.det(matrix) > 0:
        raise InputError(f"{path}: its matrix is none of a sensor; train it again")
    return TouchModel(matrix, SensorNoise(force, moment), surface, spread), simulated
