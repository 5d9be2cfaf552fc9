"""What an empty hand reads, learned from weighings of it in several poses.

All ten numbers of a `gravity_model.HandModel` follow from them, and gravity's direction of each pose with them (least squares, Gauss
and Newton).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.gravity import GRAVITY, checked, cross_matrices
from skinfab.fingertip.force.gravity_model import HandModel
from skinfab.fingertip.force.mass import fit_mass
from skinfab.fingertip.force.poses import Poses
from skinfab.fingertip.splits import leave_one_out

FloatArray = NDArray[np.float64]

#: Forces that differ by more than their noise explains, by a chance of less than this, are of a weight that turns.
_WEIGHT_CHANCE = 1e-4
_STEPS, _SETTLED = 100, 1e-7
#: Below this part of the largest singular value, a number is not determined by the poses.
_DETERMINED = 1e-9
#: A weight that is known no better than to this part of itself is none.
_WORST_PART = 0.5
#: A drift's variance is looked for over these parts of what offsets differ by at all: both ends hold next to none of the chance.
_DRIFT_RANGE, _DRIFT_STEPS = (1e-6, 1e5), 300


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
