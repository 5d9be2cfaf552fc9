"""Do weighings of one empty hand agree? Offsets drift from one to the next; what turns with the hand weighs the same every time."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.gravity_fit import learn_hand
from skinfab.fingertip.force.gravity_model import HandModel
from skinfab.fingertip.force.poses import Poses

#: Weights that differ by so many standard deviations, and by this part of themselves, are not one: gains of sensors differ by less.
_APART_SD, _APART_PART = 5.0, 0.05
#: Poses of one weighing that tell a weight no better than to this part of itself are narrow, and what they state of it is too small.
_KNOWN_PART = 0.2


def weights_of(weighings: Sequence[Poses]) -> list[tuple[float, float] | None]:
    """The weight that turns with the hand by each weighing alone, and its standard deviation, N; None where it is not told."""
    out: list[tuple[float, float] | None] = []
    for each in weighings:
        try:
            model = learn_hand([each])
        except RefusedError:  # turned too little by itself; together they may tell
            out.append(None)
            continue
        out.append((model.weight_n, math.sqrt(model.covariance[6, 6])))
    return out


def require_alike(weighings: Sequence[Poses], names: Sequence[str]) -> None:
    """Refuse weighings in which not the same weight turns with the hand: something was held.

    Parameters
    ----------
    weighings : sequence of n Poses
    names : sequence of n str

    Raises
    ------
    InputError
        Which one differs from the middle one is said.

    Examples
    --------
    >>> from skinfab.fingertip.force.gravity_simulator import HandScene, hold
    >>> from skinfab.fingertip.force.poses import poses_of
    >>> empty = [poses_of(hold(seed=3, scene=HandScene(tip_kg=0.01), weighing=k).log) for k in range(2)]
    >>> try:
    ...     require_alike([*empty, poses_of(hold(seed=3, scene=HandScene(tip_kg=0.01)).log)], ["a.csv", "b.csv", "c.csv"])
    ... except InputError as fault:
    ...     print(str(fault)[:23])
    c.csv feels a weight of
    """
    weights = weights_of(weighings)
    told = [(name, *each) for name, each in zip(names, weights, strict=True) if each is not None and each[1] <= _KNOWN_PART * each[0]]
    if len(told) > 1:
        _require_one_weight(told)
    # Poses too few or too narrow to tell a weight are judged by the offsets of those that do.
    for k, (name, each) in enumerate(zip(names, weighings, strict=True)):
        others = [other for j, other in enumerate(weighings) if j != k and weights[j]]
        felt = _felt_beyond(others, each)
        if felt:
            whole, own = felt
            raise InputError(
                f"{name} feels {whole:.3g} N less the offsets of the others, in which {own:.3g} N turn with the hand; was something held "
                "there? Leave it out, or weigh again"
            )


def _require_one_weight(told: Sequence[tuple[str, float, float]]) -> None:
    # The lower of two: an empty hand weighs less than one that holds.
    middle = sorted(weight for _, weight, _ in told)[(len(told) - 1) // 2]
    sd = max(sd for _, weight, sd in told if weight == middle)
    apart = [
        (name, weight)
        for name, weight, own in told
        if weight and abs(weight - middle) > max(_APART_SD * math.hypot(own, sd), _APART_PART * max(weight, middle))
    ]
    if apart:
        name, weight = max(apart, key=lambda each: abs(each[1] - middle))
        raise InputError(
            f"{name} feels a weight of {weight:.3g} N that turns with the hand, and the others{' about' * bool(middle)} "
            f"{f'{middle:.3g} N' if middle else 'none'}; was something held there? Leave it out, or weigh again"
        )


def _felt_beyond(others: Sequence[Poses], weighing: Poses) -> tuple[float, float] | None:
    """What a weighing feels less the others' offsets, and their weight, N, where it is more than twice that and than drift explains."""
    try:
        model = learn_hand(others)
    except (InputError, RefusedError):  # there are none, or they tell none together
        return None
    size = float(np.linalg.norm(weighing.force - model.offset[:3], axis=1).mean())
    sd = math.sqrt(model.covariance[6, 6] + np.linalg.eigvalsh(model.covariance[:3, :3])[-1])
    # A single weighing shows no drift: next to the hand's own weight it is small.
    beyond = size - model.weight_n > max(_APART_SD * sd, model.weight_n)
    return (size, model.weight_n) if model.weight_n and beyond else None


def learn_alike(weighings: Sequence[Poses], names: Sequence[str]) -> HandModel:
    """`learn_hand` of weighings that agree; where they tell no weight together, those that tell none by themselves are named.

    Raises
    ------
    InputError
        As `require_alike` and `learn_hand`.
    RefusedError
        As `learn_hand`.
    """
    require_alike(weighings, names)
    try:
        return learn_hand(weighings)
    except RefusedError as fault:
        narrow = [f"{name} ({len(each.force)} poses)" for name, each in zip(names, weighings, strict=True) if not weights_of([each])[0]]
        raise RefusedError(f"{', '.join(narrow)}: {fault}") if narrow else fault from None
