"""Do weighings of one empty hand agree? Offsets drift from one to the next; what turns with the hand weighs the same every time."""

from __future__ import annotations

import math
from collections.abc import Sequence

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.gravity_model import learn_hand
from skinfab.fingertip.force.poses import Poses

#: Weights that differ by so many standard deviations, and by this part of themselves, are not one: gains of sensors differ by less.
_APART_SD, _APART_PART = 5.0, 0.05


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
    told = [(name, *each) for name, each in zip(names, weights_of(weighings), strict=True) if each is not None]
    if len(told) < 2:
        return
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
