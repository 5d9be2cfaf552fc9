"""The empty hand: what its sensors read with nothing in it, learned once and taken off what a held object adds.

A hand whose fingers stay where they are reads F = b_F + w g and M = b_M + P x g in a pose in which gravity comes along g: the
offsets b, the weight w of what lies beyond the sensors, and its moment P = w r. Weighed empty in several poses all ten numbers
follow, g of each pose with them (least squares, Gauss and Newton). Of a held object the offset is then known and need not be
fitted beside the centre, which few poses or narrow ones tell badly; how exact it is known, and how far it drifts from weighing to
weighing, goes into the centre's uncertainty.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.gravity import GRAVITY, Centre, checked, cross_matrices, explained, lines, require_regular
from skinfab.fingertip.force.mass import Mass, fit_mass
from skinfab.fingertip.force.poses import Poses
from skinfab.fingertip.saved import load_model, save_model
from skinfab.fingertip.splits import leave_one_out

FloatArray = NDArray[np.float64]

KIND = "force hand"
#: Forces that differ by more than their noise explains, by a chance of less than this, are of a weight that turns.
_WEIGHT_CHANCE = 1e-4
_STEPS, _SETTLED = 100, 1e-7
#: Below this part of the largest singular value, a number is not determined by the poses.
_DETERMINED = 1e-9
#: A weight that is known no better than to this part of itself is none.
_WORST_PART = 0.5
#: A drift's variance is looked for over these parts of what offsets differ by at all: both ends hold next to none of the chance.
_DRIFT_RANGE, _DRIFT_STEPS = (1e-6, 1e5), 300
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


def learn_hand(weighings: Sequence[Poses]) -> HandModel:
    """Learn the empty hand from one weighing or more, each of several poses.

    Offsets are each weighing's own, and what they differ by beyond their noise is how far they drift; weight and moment are one.

    Raises
    ------
    InputError
        There is no weighing, or one has a single pose.
    RefusedError
        A weight is felt, and the hand is turned too little to tell it from an offset.
    """
    if not weighings:
        raise InputError("there is no weighing of the empty hand; give one or more")
    noises = [checked(each.force, each.moment, each.covariance, least=2)[2] for each in weighings]
    found, spread = _with_weight(weighings, noises) if _turns(weighings, noises) else _without_weight(weighings, noises)
    count = len(weighings)
    mean = np.vstack([np.hstack([np.tile(np.eye(6) / count, count), np.zeros((6, 4))]), np.eye(6 * count + 4)[6 * count :]])
    covariance = mean @ spread @ mean.T
    offsets = found[: 6 * count].reshape(count, 6)
    if count > 1:
        # What weighings differ by, and how much of that noise explains; an error that they share, such as that of the weight, is none.
        apart = np.linalg.svd(np.ones((1, count)))[2][1:]
        for part in (slice(0, 3), slice(3, 6)):
            contrast = np.kron(apart, np.eye(6)[part])
            own = contrast @ spread[: 6 * count, : 6 * count] @ contrast.T
            covariance[part, part] += (1 + 1 / count) * _drift(contrast @ offsets.ravel(), own) * np.eye(3)
    return HandModel(offsets.mean(axis=0), float(found[-4]), found[-3:].copy(), covariance, count)


def _drift(apart: FloatArray, own: FloatArray) -> float:
    """The variance by which offsets drift, so wide that 95 % stay 95 % although few weighings show it, and through noise.

    What is not known of it is integrated over, by Jeffreys' prior of a variance beside known ones (Tiao and Tan 1965); without
    noise that is Student's t. An estimate of its own is too small, often nothing, where noise alone makes offsets differ as much.
    """
    from scipy.optimize import brentq
    from scipy.stats import norm

    noise, axes = np.linalg.eigh(own)
    noise, square = np.maximum(noise, 0.0), (axes.T @ apart) ** 2
    scale = float((noise + square).mean())
    drift = scale * np.geomspace(*_DRIFT_RANGE, _DRIFT_STEPS)
    whole = noise[:, None] + drift
    logarithm = np.log(drift) + 0.5 * np.log((1 / whole**2).sum(axis=0)) - 0.5 * (np.log(whole) + square[:, None] / whole).sum(axis=0)
    likely = np.exp(logarithm - logarithm.max())
    likely /= likely.sum()
    inside = norm.ppf(0.975)
    low, high = (inside * math.sqrt(end) for end in drift[[0, -1]])
    limit = brentq(lambda far: float(likely @ norm.sf(far / np.sqrt(drift))) - 0.025, low, high, rtol=1e-4)
    return (limit / inside) ** 2


def left_over(weighings: Sequence[Poses]) -> tuple[tuple[float, float], tuple[float, float]]:
    """What an empty hand still reads: root mean squares of force (N) and moment (N mm) as they come, and after a model of the others.

    Each weighing is held out in turn.
    """
    before, after = [], []
    for train, (k,) in leave_one_out(list(range(len(weighings)))):
        model, held = learn_hand([weighings[j] for j in train]), weighings[k]
        whole = held.force - model.offset[:3]
        size = np.linalg.norm(whole, axis=1)
        moment = held.moment - model.offset[3:]
        if model.weight_n:
            moment = moment - np.cross(model.moment_nmm, whole / size[:, None])
        before.append([(held.force**2).sum(axis=1).mean(), (held.moment**2).sum(axis=1).mean()])
        after.append([((size - model.weight_n) ** 2).mean(), (moment**2).sum(axis=1).mean()])
    (a, b), (c, d) = (np.sqrt(np.mean(each, axis=0)).tolist() for each in (before, after))
    return (a, b), (c, d)


def _turns(weighings: Sequence[Poses], noises: Sequence[FloatArray]) -> bool:
    """Do the forces of a weighing differ by more than their noise?"""
    from scipy.stats import chi2

    square = freedom = 0.0
    for each, S in zip(weighings, noises, strict=True):
        weight = np.linalg.inv(S[:, :3, :3])
        mean = np.linalg.solve(weight.sum(axis=0), np.einsum("nij,nj->i", weight, each.force))
        square += float(np.einsum("ni,nij,nj->", each.force - mean, weight, each.force - mean))
        freedom += 3 * (len(each.force) - 1)
    return bool(chi2.sf(square, freedom) < _WEIGHT_CHANCE)


def _without_weight(weighings: Sequence[Poses], noises: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Offsets alone (6 a weighing, then four zeros), and their covariance."""
    size = 6 * len(weighings) + 4
    found, spread = np.zeros(size), np.zeros((size, size))
    for k, (each, S) in enumerate(zip(weighings, noises, strict=True)):
        weight = np.linalg.inv(S)
        own = np.linalg.inv(weight.sum(axis=0))
        found[6 * k : 6 * k + 6] = own @ np.einsum("nij,nj->i", weight, np.hstack([each.force, each.moment]))
        spread[6 * k : 6 * k + 6, 6 * k : 6 * k + 6] = own
    return found, spread


def _with_weight(weighings: Sequence[Poses], noises: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Offsets of each weighing, one weight and its moment, and their covariance: least squares with gravity's direction of each pose."""
    of = np.repeat(np.arange(len(weighings)), [len(each.force) for each in weighings])
    read = np.vstack([np.hstack([each.force, each.moment]) for each in weighings])
    whiten = np.linalg.inv(np.linalg.cholesky(np.vstack(noises)))
    n, count = len(read), 6 * len(weighings)
    x, g = _start(weighings, of, read)
    for _ in range(_STEPS):
        offset, weight, moment = x[:count].reshape(-1, 6), x[count], x[count + 1 :]
        off = np.einsum("nij,nj->ni", whiten, read - offset[of] - np.hstack([weight * g, np.cross(moment, g)]))
        design = np.zeros((n, 6, count + 4))
        for k in range(n):
            design[k, :, 6 * of[k] : 6 * of[k] + 6] = np.eye(6)
        design[:, :3, count] = g
        design[:, 3:, count + 1 :] = -cross_matrices(g)
        design = whiten @ design
        tangent = np.linalg.svd(g[:, None, :])[2][:, 1:].transpose(0, 2, 1)  # (n, 3, 2): gravity turns across itself alone
        lever = np.concatenate([np.broadcast_to(weight * np.eye(3), (n, 3, 3)), cross_matrices(np.tile(moment, (n, 1)))], axis=1)
        turn = whiten @ lever @ tangent
        # Each pose has a direction of its own: what that can explain is left out, and four numbers of six remain.
        apart = np.linalg.qr(turn, mode="complete")[0][:, :, 2:].transpose(0, 2, 1)
        rows, wanted = (apart @ design).reshape(4 * n, -1), np.einsum("nij,nj->ni", apart, off).ravel()
        scale = 1 / np.maximum(np.linalg.norm(rows, axis=0), np.finfo(float).tiny)
        step, _, rank, _ = np.linalg.lstsq(rows * scale, wanted, rcond=_DETERMINED)
        if rank < rows.shape[1]:
            raise _unturned()
        step = step * scale
        x = x + step
        left = off - design @ step
        g = g + np.einsum("nij,njk,nk->ni", tangent, np.linalg.pinv(turn), left)
        g /= np.linalg.norm(g, axis=1)[:, None]
        if np.abs(step[:-3]).max() < _SETTLED * (1 + np.abs(x[:-3]).max()):
            spread = np.linalg.inv((rows * scale).T @ (rows * scale)) * np.outer(scale, scale)
            if not math.sqrt(spread[count, count]) < _WORST_PART * x[count]:
                raise _unturned()
            return x, spread
    raise _unturned()


def _start(weighings: Sequence[Poses], of: NDArray[np.int64], read: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Offsets and a weight from a sphere through the forces of those weighings that tell one, moments by plain least squares."""
    spheres = []
    for each in weighings:
        try:
            of_force = None if each.covariance is None else each.covariance[:, :3, :3]
            spheres.append(fit_mass(each.force, of_force, worst_part=_WORST_PART))
        except (InputError, RefusedError):
            continue
    if not spheres:
        raise _unturned()
    best = min(spheres, key=lambda sphere: sphere.sd_kg)
    count = len(weighings)
    offset = np.tile(best.offset_n, (count, 1))
    g = read[:, :3] - offset[of]
    g /= np.linalg.norm(g, axis=1)[:, None]
    design = np.concatenate([np.kron(np.eye(count)[of], np.eye(3)).reshape(len(read), 3, 3 * count), -cross_matrices(g)], axis=2)
    solved = np.linalg.lstsq(design.reshape(3 * len(read), -1), read[:, 3:].ravel(), rcond=None)[0]
    both = np.hstack([offset, solved[: 3 * count].reshape(count, 3)])
    return np.concatenate([both.ravel(), [best.kg * GRAVITY], solved[3 * count :]]), g


def _unturned() -> RefusedError:
    return RefusedError(
        "the empty hand feels a weight that turns with it, and its poses do not tell that from an offset; weigh it in six poses or more, "
        "turned by 45 degrees about different axes"
    )


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
