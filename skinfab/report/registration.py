"""How to bring mould and printer together: where the marks of each mould must lie, in the printer's own coordinates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

_HOMING = {
    "xyz": "Home all axes with the bed empty, before the mould lies on it.",
    "xy": "Home X and Y only (G28 X Y): a probe for Z would dip into the wet mould.",
    "none": "The program does not home: bring the printer to its own zero first.",
}
_MARKS = ("lower left", "lower right", "upper left")


@dataclass(frozen=True, eq=False)
class MouldPlace:
    """Where one mould must lie.

    Parameters
    ----------
    piece : str
    gcode : str
        The file that is printed into it.
    marks : (3, 2) float, mm
        Corner points of its L marks in machine coordinates: lower left, lower right, upper left.
    """

    piece: str
    gcode: str
    marks: NDArray[np.float64]


def registration_steps(places: Sequence[MouldPlace], *, home: str, glass_z: float = 0.0) -> list[str]:
    """What to do before a program is started, a sentence or two each, in order.

    Parameters
    ----------
    places : sequence of MouldPlace
        One a G-code file; none gives no steps.
    home : "xyz", "xy" or "none"
        What the program homes.
    glass_z : float, mm
        The Z that the program has where the nozzle touches the glass: 0 where its heights count from the glass,
        minus the mould's floor where they count from the floor of the cavity.

    Raises
    ------
    InputError
        Another word for `home`.

    Examples
    --------
    >>> place = MouldPlace("P1", "gcode/P1.gcode", np.array([[130.0, 140], [220, 140], [130, 210]]))
    >>> registration_steps([place], home="xy")[1]
    'P1: lay the mould so that its lower left L mark is at X130.00 Y140.00, lower right at X220.00 Y140.00, upper left at X130.00 Y210.00.'
    """
    if home not in _HOMING:
        raise InputError(f"home is {home!r}; it must be one of {', '.join(_HOMING)}")
    if not places:
        return []
    steps = [_HOMING[home]]
    for place in places:
        corners = (
            f"{name} {'L mark is ' * (k == 0)}at X{x:.2f} Y{y:.2f}"
            for k, (name, (x, y)) in enumerate(zip(_MARKS, place.marks, strict=True))
        )
        steps.append(f"{place.piece}: lay the mould so that its {', '.join(corners)}.")
    steps += [
        "Jog the nozzle to the lower left mark and move the mould under it; jog to the lower right mark and turn the mould until it "
        "agrees; the upper left mark is the check. Then tape the mould down.",
        f"Beside the mould, lower the nozzle until it holds a sheet of paper on the glass, and set this height as "
        f"Z {glass_z:.2f} (G92 Z{glass_z:.2f}).",
        "Raise the nozzle clear of the mould's wall and start " + ", ".join(f"{p.gcode} for {p.piece}" for p in places) + ".",
    ]
    return steps
