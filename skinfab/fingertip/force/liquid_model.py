"""What a rigid object looks like to this sensor in this hand: how unlikely a swing must be so that it is one.

The chance of `stirred` is that of noise alone, whatever its colour. A hand that trembles, a machine beside it or a sensor that
hums swings as water does, and is then taken for it far more often than stated. What no model of noise knows, recordings of
objects without a liquid do: cut into pieces, each is judged as a cup would be, and the limit is an order statistic of the
chances that come out (split conformal prediction; Vovk, Gammerman and Shafer 2005). With n pieces, one more of the same kind
falls below the k-th smallest with a probability of at most k / (n + 1), whatever their distribution is.
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
from skinfab.fingertip.force.liquid import FALSE_ALARM, LEAST_S, PART_OF_A_SAMPLE, PIECE_S, Stirred, stirred
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.saved import load_model, save_model
from skinfab.fingertip.splits import leave_one_out
from skinfab.rates import Rate, by_trial

FloatArray = NDArray[np.float64]

KIND = "force liquid"
#: What a log that holds a liquid may be labelled; to be learned from are those that hold none.
LIQUID = "liquid"
#: Labels by which somebody says of a log that it holds none, so that it is learned from however it swings.
DRY = ("empty", "solid")
#: A piece whose chance is smaller than those of all others explain, by this chance of one among them, is taken for a liquid's.
_STRANGE = 0.003
#: Logarithms (base 10) of hands that tremble by 0.2 m/s2 have a middle of 2.6 and fall off as an exponential of 1.5; more is no hand.
_MOST_MIDDLE, _MOST_SCALE = 3.0, 1.5
#: ... and of noise alone at least so much: few pieces must not seem to agree better than they can.
_LEAST_SCALE = 0.3
#: Rates of one device differ by less: its clock is good to a few parts in a thousand.
_RATE_FRACTION = 0.02
#: Below such a chance numbers end, and nothing could be more unlikely.
_LEAST_CHANCE = 1e-290


@dataclass(frozen=True)
class LiquidModel:
    """A limit that was learned.

    Parameters
    ----------
    limit : float
        A chance below it is a liquid.
    false_alarm : float
        That was wanted.
    seconds : float
        Of a piece; of a log so much is judged.
    rate_hz : float
    pieces : int
        That it was learned from.
    """

    limit: float
    false_alarm: float
    seconds: float
    rate_hz: float
    pieces: int

    def judge(self, log: WrenchLog) -> Stirred:
        """As `stirred`, by the learned limit, from the log's first `seconds`: the swing is strongest there.

        Raises
        ------
        InputError
            The log is shorter, or was taken at another rate.
        """
        if not abs(log.rate_hz / self.rate_hz - 1) <= _RATE_FRACTION:
            raise InputError(
                f"{log.name} has {log.rate_hz:.4g} samples a second and the model was learned at {self.rate_hz:.4g}; "
                "record at that rate, or train a model at this one"
            )
        parts = pieces(log, self.seconds)
        if not parts:
            raise InputError(
                f"{log.name} lasts for {len(log) / log.rate_hz:.3g} s and the model was learned from pieces of {self.seconds:g} s; "
                f"hold still for so long, or train a model with --seconds {max(math.floor(len(log) / log.rate_hz), LEAST_S):g}"
            )
        return stirred(parts[0], false_alarm=self.limit)


@dataclass(frozen=True)
class Trained:
    """A model, and how often it was wrong on recordings that it was not learned from.

    Parameters
    ----------
    model : LiquidModel
    held_out : Rate
        Pieces that were taken for a liquid, each recording judged by the others.
    plain : float
        The same by `stirred` alone, which has learned nothing, at the same false alarm.
    moving : int
        Pieces in which the hand was not still.
    logs : int
    strange : tuple of str
        Logs that say they hold no liquid, and swing as if they did.
    limit_log : str
        That the limit comes from.
    limit_mm, middle_mm : float, mm
        How far the line wanders there, and in the middle one of all pieces.
    """

    model: LiquidModel
    held_out: Rate
    plain: float
    moving: int
    logs: int
    strange: tuple[str, ...]
    limit_log: str
    limit_mm: float
    middle_mm: float


def pieces(log: WrenchLog, seconds: float) -> list[WrenchLog]:
    """The log in whole pieces of so many seconds.

    Examples
    --------
    >>> from skinfab.fingertip.force.liquid_simulator import stir
    >>> [len(each) for each in pieces(stir(water_kg=0.0, seconds=13), 6.0)]
    [1200, 1200]
    """
    width = math.ceil(seconds * log.rate_hz - PART_OF_A_SAMPLE)
    return [
        WrenchLog(log.name, log.time[k : k + width], log.force[k : k + width], log.moment[k : k + width], simulated=log.simulated)
        for k in range(0, len(log) - width + 1, width)
    ]


def limit_of(chances: FloatArray, false_alarm: float) -> float:
    """The limit below which one more chance of the same kind falls no oftener than `false_alarm`; 0 where they are too few.

    Examples
    --------
    >>> limit_of(np.arange(1, 100) / 100, 0.01), limit_of(np.arange(1, 99) / 100, 0.01)
    (0.01, 0.0)
    """
    # A little more than the product, which may be a whole number that rounding has made less.
    k = math.floor(false_alarm * (len(chances) + 1) * (1 + 1e-12))
    return float(np.sort(chances)[k - 1]) if k else 0.0


def stand_out(chances: FloatArray) -> NDArray[np.bool_]:
    """Which chances are decades below what the others explain.

    The logarithms of rigid objects fall off as an exponential, at a rate that the hand's trembling sets: it is taken from what lies
    between the middle one and the upper quartile, so that up to a quarter of full cups do not change it.

    Examples
    --------
    >>> stand_out(np.append(np.arange(1, 100) / 100, 1e-19)).nonzero()[0].tolist()
    [99]
    """
    size = -np.log10(np.maximum(chances, _LEAST_CHANCE))
    middle, upper = np.quantile(size, [0.5, 0.75])
    scale = np.clip((upper - middle) / math.log(2), _LEAST_SCALE, _MOST_SCALE)
    limit = min(middle, _MOST_MIDDLE) + scale * math.log(0.5 * len(size) / _STRANGE)
    return np.asarray(size > limit)


def train_liquid(logs: Sequence[WrenchLog], *, false_alarm: float = FALSE_ALARM, seconds: float = PIECE_S) -> Trained:
    """Learn the limit from recordings of objects without a liquid, held as a cup would be.

    Parameters
    ----------
    logs : sequence of WrenchLog
        Each a grasp of its own; as long as you like.
    false_alarm : float
    seconds : float
        Of a piece.

    Raises
    ------
    InputError
        A log says that it holds a liquid, rates differ, all are one grasp, or there are too few pieces for such a false alarm.
    RefusedError
        They swing as strongly as anything could, or one swings as no other does and does not say that it is empty or solid.
    """
    if wet := next((log.name for log in logs if log.label == LIQUID), None):
        raise InputError(f"{wet} says that it holds a liquid; learn from objects that hold none")
    rates = np.array([log.rate_hz for log in logs])
    if not (np.isfinite(rates).all() and np.ptp(rates) <= _RATE_FRACTION * rates.mean()):
        raise InputError(f"the logs have from {rates.min():.4g} to {rates.max():.4g} samples a second; record all at one rate")
    parts = [(k, part) for k, log in enumerate(logs) for part in pieces(log, seconds)]
    needed = math.ceil(1 / false_alarm - 1e-9) - 1
    if len(parts) < needed:
        raise InputError(
            f"{len(parts)} pieces of {seconds:g} s do not show what happens once in {1 / false_alarm:.3g}: {needed} are needed, which last "
            f"for {needed * seconds / 60:.2g} min; record more, or learn a false alarm of {_upwards(1 / (len(parts) + 1)):g} or more"
        )
    group = np.array([k for k, _ in parts])
    splits = leave_one_out(group.tolist())
    judged = [stirred(part) for _, part in parts]
    chance = np.array([each.chance for each in judged])
    limit = limit_of(chance, false_alarm)
    strange = [logs[k] for k in np.unique(group[stand_out(chance)]).tolist()]
    unsaid = [log.name for log in strange if log.label.lower() not in DRY]
    if unsaid:
        more = f" and {len(unsaid) - 3} more" if len(unsaid) > 3 else ""
        raise RefusedError(
            f"{', '.join(unsaid[:3])}{more} swing{'s' * (len(unsaid) == 1)} as the others cannot, and as a liquid does; leave out what "
            "holds one, and where nothing does, say so in the log: # label: empty"
        )
    if limit < _LEAST_CHANCE:
        raise RefusedError("these recordings swing so strongly that no liquid would stand out from them; hold still, on a steady table")
    wrong = np.zeros(len(parts), dtype=bool)
    for train, test in splits:
        wrong[test] = chance[test] < limit_of(chance[train], false_alarm)
    model = LiquidModel(limit, false_alarm, seconds, float(rates.mean()), len(parts))
    rate = by_trial([int(wrong[test].sum()) for _, test in splits], [len(test) for _, test in splits])
    wander = [each.wander_mm for each in judged]
    at = int(np.flatnonzero(chance == limit)[0])
    return Trained(
        model,
        rate,
        float((chance < false_alarm).mean()),
        sum(each.moves for each in judged),
        len(splits),
        tuple(log.name for log in strange),
        parts[at][1].name,
        wander[at],
        float(np.median(wander)),
    )


def _upwards(value: float) -> float:
    """With two digits, and no less."""
    step = 10 ** (math.floor(math.log10(value)) - 1)
    return math.ceil(value / step - 1e-9) * step


def save_liquid(trained: Trained, path: str | Path, *, made_from: Sequence[dict[str, Any]]) -> None:
    """Write a model with how good it is and what it was made from; the file says whether that was simulated."""
    m = trained.model
    facts = {
        "false_alarm": m.false_alarm,
        "seconds": m.seconds,
        "rate_hz": m.rate_hz,
        "pieces": m.pieces,
        "held_out": [trained.held_out.value, trained.held_out.low, trained.held_out.high],
        "simulated": any(each["simulated"] for each in made_from),
        "made_from": list(made_from),
    }
    save_model(path, kind=KIND, facts=facts, arrays={"limit": np.array([m.limit])})


def load_liquid(path: str | Path) -> tuple[LiquidModel, bool]:
    """Read a model; and whether it was made from simulated logs.

    Raises
    ------
    InputError
        As `skinfab.fingertip.saved.load_model`, or its parts are none.
    """
    saved = load_model(path, kind=KIND)
    facts = saved.facts
    try:
        (limit,) = saved.arrays["limit"].tolist()
        made = LiquidModel(
            float(limit), float(facts["false_alarm"]), float(facts["seconds"]), float(facts["rate_hz"]), int(facts["pieces"])
        )
        simulated = bool(facts["simulated"])
    except (KeyError, TypeError, ValueError) as fault:
        raise InputError(f"{path}: a part of the model is missing or wrong ({fault!r}); train it again") from fault
    if not (0 < made.limit <= 1 and 0 < made.false_alarm < 1 and made.seconds >= LEAST_S and made.rate_hz > 0):
        raise InputError(f"{path}: its limit or its length is none; train it again")
    return made, simulated
