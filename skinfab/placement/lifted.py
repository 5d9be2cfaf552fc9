"""Sensors that a cut took off, until their spots on the object lie flat again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor


@dataclass(frozen=True, eq=False)
class Lifted:
    """A sensor that lies nowhere for now, and the spot on the object that it is to come back to.

    Parameters
    ----------
    sensor : Sensor
        As it was last.
    piece : Piece
        The flat piece that it lay on, as that was: the two together say where on the object.
    why : str
        What keeps it off though its spot lies flat: "overlaps C9"; "" where its spot does not.
    place : int
        How many were ahead of it in the list of sensors, those included that were off by then.
    """

    sensor: Sensor
    piece: Piece
    why: str = ""
    place: int = 0


def in_line(sensors: Sequence[Sensor], lifted: Sequence[Lifted]) -> list[Sensor | Lifted]:
    """Those that lie there and those that are off, in the order of one list.

    Examples
    --------
    >>> in_line([], [])
    []
    """
    line: list[Sensor | Lifted] = list(sensors)
    for each in sorted(lifted, key=lambda one: one.place):
        line.insert(each.place, each)
    return line


def off_words(lifted: Sequence[Lifted]) -> list[str]:
    """What one should know before a skin is made without some of its sensors: no sentence, or one.

    Examples
    --------
    >>> off_words([])
    []
    """
    if not lifted:
        return []
    ids, one = ", ".join(each.sensor.id for each in lifted), len(lifted) == 1
    return [
        f"{'1 sensor is' if one else f'{len(lifted)} sensors are'} off ({ids}) and {'is' if one else 'are'} not printed: a cut took "
        f"{'its spot' if one else 'their spots'}; in the window, cut so that {'it lies' if one else 'they lie'} flat again, "
        "or place sensors anew"
    ]
