"""Several sensors at a time: copy, mirror, align, spread evenly.

As in `edit`, each function takes all sensors of a skin and gives them back; whether they fit is for `check.validate` to say.
Places are those of the patterns' middles, the spots they are for; sensors on different pieces have different frames, so all
that are arranged together lie on one piece.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.placement.edit import Sensors, find, middle_of
from skinfab.placement.sensor import Sensor

#: What sensors are aligned by: a side of the box round their beads, or their middle.
Side = Literal["left", "right", "top", "bottom", "middle-x", "middle-y"]
SIDES: tuple[Side, ...] = ("left", "right", "top", "bottom", "middle-x", "middle-y")

Axis = Literal["x", "y"]


def copy(
    sensors: Sequence[Sensor], ids: Sequence[str], *, dx: float = 0.0, dy: float = 0.0, reserved: Sequence[Sensor] = ()
) -> tuple[Sensors, tuple[str, ...]]:
    """Add a copy of each of some sensors, (dx, dy) mm from it, with the next free id of its letter and the next free channel.

    Ids and channels of those that are `reserved` stay free: they lie nowhere for now.

    Returns
    -------
    sensors : tuple of Sensor
    new : tuple of str
        Ids of the copies.

    Examples
    --------
    >>> from skinfab.patterns.registry import make_pattern
    >>> one = Sensor("S1", "P1", make_pattern("strain-lines", {"l1": 53, "l2": 43, "b": 6}), 5.0, 5.0, 0.0, 0)
    >>> both, new = copy([one], ["S1"], dy=12.0)
    >>> new, both[1].y, both[1].channel
    (('S2',), 17.0, 1)
    """
    result, new = list(sensors), []
    for id in ids:
        sensor = find(sensors, id)
        taken = [*result, *reserved]
        added = dataclasses.replace(
            sensor, id=_free_id(id, taken), x=sensor.x + dx, y=sensor.y + dy, channel=_free_channel([s.channel for s in taken])
        )
        result.append(added)
        new.append(added.id)
    return tuple(result), tuple(new)


def mirror(sensors: Sequence[Sensor], ids: Sequence[str], *, axis: Axis, at: float | None = None) -> Sensors:
    """Put sensors where a mirror shows them: `axis` "x" changes left and right, "y" changes up and down.

    A pattern is printed one way round and has no mirror image of its own, so that its middle goes where the mirror shows it and
    its leads point where the mirror's do.

    Parameters
    ----------
    sensors : sequence of Sensor
    ids : sequence of str
        On one piece.
    axis : "x" or "y"
        The coordinate that changes.
    at : float, mm, optional
        Where the mirror stands; the centre between the outermost middles unless given.
    """
    chosen = _on_one_piece(sensors, ids)
    k = _axis(axis)
    middles = np.array([middle_of(s) for s in chosen])
    centre = float(middles[:, k].min() + middles[:, k].max()) / 2 if at is None else float(at)
    middles[:, k] = 2 * centre - middles[:, k]
    turned = [((np.pi - s.angle) if axis == "x" else -s.angle) % (2 * np.pi) for s in chosen]
    return _placed(sensors, [dataclasses.replace(s, angle=float(a)) for s, a in zip(chosen, turned, strict=True)], middles)


def align(sensors: Sequence[Sensor], ids: Sequence[str], *, side: Side) -> Sensors:
    """Move sensors so that one side of each, or its middle, lies where that of the first does; "middle-x": one x for all middles.

    Raises
    ------
    InputError
        Another side, a sensor that is not there, or sensors of several pieces.
    """
    if side not in SIDES:
        raise InputError(f"sensors cannot be aligned by {side!r}; choose one of {', '.join(SIDES)}")
    chosen = _on_one_piece(sensors, ids)
    k = 0 if side in ("left", "right", "middle-x") else 1
    places = [_place(s, side, k) for s in chosen]
    middles = np.array([middle_of(s) for s in chosen])
    middles[:, k] += places[0] - np.array(places)
    return _placed(sensors, chosen, middles)


def distribute(sensors: Sequence[Sensor], ids: Sequence[str], *, axis: Axis) -> Sensors:
    """Spread the middles of three sensors or more evenly along an axis; the outermost two stay."""
    chosen = _on_one_piece(sensors, ids)
    if len(chosen) < 3:
        raise InputError(f"{len(chosen)} sensors have nothing between them to spread; choose three or more")
    k = _axis(axis)
    middles = np.array([middle_of(s) for s in chosen])
    order = np.argsort(middles[:, k], kind="stable")
    middles[order, k] = np.linspace(middles[order[0], k], middles[order[-1], k], len(order))
    return _placed(sensors, chosen, middles)


def _on_one_piece(sensors: Sequence[Sensor], ids: Sequence[str]) -> list[Sensor]:
    chosen = [find(sensors, id) for id in ids]
    if not chosen:
        raise InputError("no sensors to arrange; choose some")
    if len({s.id for s in chosen}) < len(chosen):
        raise InputError(f"a sensor is named twice in {', '.join(ids)}; name each once")
    other = next((s for s in chosen if s.piece != chosen[0].piece), None)
    if other is not None:
        raise InputError(f"{chosen[0].id} is on {chosen[0].piece} and {other.id} on {other.piece}; arrange sensors of one piece at a time")
    return chosen


def _axis(axis: str) -> int:
    if axis not in ("x", "y"):
        raise InputError(f"there is no axis {axis!r}; choose x or y")
    return 0 if axis == "x" else 1


def _place(sensor: Sensor, side: Side, k: int) -> float:
    """Where that side of a sensor lies along axis k, mm."""
    if side.startswith("middle"):
        return float(middle_of(sensor)[k])
    low, high = sensor.printed_path.bbox[:, k]
    return float(low - sensor.pattern.bead / 2 if side in ("left", "bottom") else high + sensor.pattern.bead / 2)


def _placed(sensors: Sequence[Sensor], chosen: Sequence[Sensor], middles: NDArray[np.float64]) -> Sensors:
    moved = {}
    for sensor, goal in zip(chosen, middles, strict=True):
        dx, dy = goal - middle_of(sensor)
        moved[sensor.id] = dataclasses.replace(sensor, x=float(sensor.x + dx), y=float(sensor.y + dy))
    return tuple(moved.get(s.id, s) for s in sensors)


def _free_id(id: str, sensors: Sequence[Sensor]) -> str:
    stem = re.sub(r"\d+$", "", id) or id
    used = {s.id for s in sensors}
    return next(name for k in range(1, len(sensors) + 2) if (name := f"{stem}{k}") not in used)


def _free_channel(used: Sequence[int]) -> int:
    return next(k for k in range(len(used) + 1) if k not in used)
