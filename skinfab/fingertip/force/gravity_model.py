"""The empty hand: what its sensors read with nothing in it, taken off what a held object adds.

A hand whose fingers stay where they are reads F = b_F + w g and M = b_M + P x g in a pose in which gravity comes along g: the
offsets b, the weight w of what lies beyond the sensors, and its moment P = w r (`gravity_fit` learns them). Of a held object the
offset is then known and need not be fitted beside the centre, which few poses or narrow ones tell badly; how exact it is known, and
how far it drifts from weighing to weighing, goes into the centre's uncertainty.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.gravity import GRAVITY, Centre, checked, cross_matrices, explained, lines, require_regular
from skinfab.fingertip.force.mass import Mass
from skinfab.fingertip.force.poses import Poses
from skinfab.fingertip.saved import load_model, save_model

FloatArray = NDArray[np.float64]

KIND = "force hand"
_STEPS, _SETTLED = 100, 1e-7
#: Numbers of the model: three offsets of the force and of the moment, a weight, and its moment.
_NUMBERS = 10
#: A covariance that is off by no more than this part of its largest number is that of a file that was written and read.
_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class HandModel:
    """What an empty hand reads.

    Parameters
    ----------
    offset : (6,) float, N and N mm
    weight_n : float, N
        Of what turns with the hand beyond its sensors; 0 where nothing was felt.
    moment_nmm : (3,) float, N mm
        The weight by its place.
    covariance : (10, 10) float
        Of all of these, and of what the offset drifts until the next time.
    weighings : int
        That it was learned from; a single one shows no drift.
    """

    offset: FloatArray
    weight_n: float
    moment_nmm: FloatArray
    covariance: FloatArray
    weighings: int

    def less(self, force: FloatArray, moment: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Force and moment (n, 3) of what is held, and the direction of gravity (n, 3) in each pose.

        Raises
        ------
        InputError
            A pose feels no more than the empty hand: nothing is held.
        """
        whole = force - self.offset[:3]
        size = np.linalg.norm(whole, axis=1)
        noise = 3 * math.sqrt(np.trace(self.covariance[:3, :3]))
        if empty := np.flatnonzero(size <= self.weight_n + noise).tolist():
            raise InputError(
                f"pose {empty[0] + 1} feels {size[empty[0]]:.2g} N, no more than the empty hand; hold something, or leave it out"
            )
        g = whole / size[:, None]
        return whole - self.weight_n * g, moment - self.offset[3:] - np.cross(self.moment_nmm, g), g


def centre_with(model: HandModel, poses: Poses) -> Centre:
    """The centre of gravity of what is held in poses from two on, by a hand that was weighed empty.

    Raises
    ------
    InputError
        There is one pose, or nothing is held.
    RefusedError
        Gravity comes from one direction in all poses.

    Examples
    --------
    Two poses, which tell no offset by themselves:

    >>> from skinfab.fingertip.force.gravity_fit import learn_hand
    >>> from skinfab.fingertip.force.gravity_simulator import HandScene, hold
    >>> from skinfab.fingertip.force.poses import poses_of
    >>> two = HandScene(poses=2)
    >>> model = learn_hand([poses_of(hold(seed=3, weighing=0).log)])
    >>> held = hold(seed=3, scene=two)
    >>> found = centre_with(model, poses_of(held.log))
    >>> bool(np.linalg.norm(found.point - held.centre) < 3 * found.sd_mm)
    True
    """
    bare_force, bare_moment, g = model.less(poses.force, poses.moment)
    F, M, S, scaled = checked(bare_force, bare_moment, poses.covariance, least=2)
    n, unit = len(F), np.eye(3)
    q, _ = lines(F, M)
    across = unit - g[:, :, None] * g[:, None, :]
    eigenvalue = require_regular(across.sum(axis=0), n)
    t = np.linalg.solve(across.sum(axis=0), np.einsum("nij,nj->i", across, q))
    turned = cross_matrices(g)
    for _ in range(_STEPS):
        arm = cross_matrices(t[None])[0]
        of_noise = np.concatenate([np.broadcast_to(-arm, (n, 3, 3)), np.broadcast_to(unit, (n, 3, 3))], axis=2)
        gain = S @ of_noise.transpose(0, 2, 1)
        # What the model is off by: the offsets alike in all poses, the weight and its moment as gravity turns.
        shared = np.concatenate(
            [np.broadcast_to(arm, (n, 3, 3)), np.broadcast_to(-unit, (n, 3, 3)), np.cross(t, g)[:, :, None], turned], axis=2
        ).reshape(3 * n, _NUMBERS)
        noise = shared @ model.covariance @ shared.T
        for k, own in enumerate(of_noise @ gain):
            noise[3 * k : 3 * k + 3, 3 * k : 3 * k + 3] += own
        residual = (M - np.cross(t, F)).ravel()
        weighed = np.linalg.solve(noise, residual)
        likely = F - np.einsum("nij,nj->ni", gain, weighed.reshape(n, 3))[:, :3]
        design = cross_matrices(likely).reshape(3 * n, 3)
        information = design.T @ np.linalg.solve(noise, design)
        step = -np.linalg.solve(information, design.T @ weighed)
        t = t + step
        if np.abs(step).max() < _SETTLED * (1 + np.abs(t).max()):
            break
    else:
        raise RefusedError(f"the {n} poses do not tell the centre of gravity; turn the hand farther between them")
    misfit, chance, factor = explained(float(residual @ weighed), 3 * n - 3, scaled, poses.freedom)
    # What is left of the offsets, as these poses show it.
    left = -model.covariance @ shared.T @ weighed
    offset = left[3:6] - np.cross(t, left[:3])
    q, g = lines(F, M - offset)
    away = q - t
    distance = np.linalg.norm(away - np.einsum("ni,ni->n", away, g)[:, None] * g, axis=1)
    return Centre(np.asarray(t), np.asarray(factor * np.linalg.inv(information)), offset, eigenvalue, distance, misfit, chance)


def mass_with(model: HandModel, poses: Poses) -> Mass:
    """The mass of what is held, by a hand that was weighed empty: no sphere need be fitted to the forces.

    Raises
    ------
    InputError
        Nothing is held.
    """
    F, _, g = model.less(poses.force, poses.moment)
    size = np.linalg.norm(F, axis=1)
    own = 0.0 if poses.covariance is None else float(np.einsum("ni,nij,nj->", g, poses.covariance[:, :3, :3], g)) / len(g) ** 2
    towards = np.concatenate([-g.mean(axis=0), np.zeros(3), [-1.0], np.zeros(3)])
    sd = math.sqrt(own + float(towards @ model.covariance @ towards))
    if poses.covariance is None and len(g) > 1:
        sd = math.hypot(sd, float(size.std(ddof=1)) / math.sqrt(len(g)))
    return Mass(float(size.mean()) / GRAVITY, sd / GRAVITY, model.offset[:3].copy())


def save_hand(model: HandModel, path: str | Path, *, facts: dict[str, Any]) -> None:
    """Write a model with what it was made from; `facts` says whether that was simulated."""
    arrays = {"offset": model.offset, "weight": np.array([model.weight_n]), "moment": model.moment_nmm, "covariance": model.covariance}
    save_model(path, kind=KIND, facts=facts | {"weighings": model.weighings}, arrays=arrays)


def load_hand(path: str | Path) -> tuple[HandModel, bool]:
    """Read a model; and whether it was made from simulated logs.

    Raises
    ------
    InputError
        As `skinfab.fingertip.saved.load_model`, or its parts are none.
    """
    saved = load_model(path, kind=KIND)
    shapes = {"offset": (6,), "weight": (1,), "moment": (3,), "covariance": (_NUMBERS, _NUMBERS)}
    a = saved.arrays
    if wrong := next((name for name, shape in shapes.items() if name not in a or a[name].shape != shape), None):
        raise InputError(f"{path}: {wrong} is missing or has another shape than {shapes[wrong]}; train it again")
    if not isinstance(count := saved.facts.get("weighings"), int):
        raise InputError(f"{path} does not say how many weighings it is of; train it again")
    model = HandModel(a["offset"], float(a["weight"][0]), a["moment"], a["covariance"], count)
    c = model.covariance
    if model.weight_n < 0 or np.abs(c - c.T).max() > _ROUNDING * np.abs(c).max() or np.linalg.eigvalsh(c)[0] < -_ROUNDING * np.abs(c).max():
        raise InputError(f"{path}: its weight or its covariance is none; train it again")
    return model, bool(saved.facts.get("simulated"))
