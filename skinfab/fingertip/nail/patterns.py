"""What the finger touches in the paper's three tests: four edges, six pins, and twelve edges in three rows.

x runs across the finger (to the right, as one looks on the nail of a right hand), y from the joint to the tip, and the middle of
the pad is the origin. Classes are numbered from 1, as in the paper's figures; 0 is no contact at all.

The paper prints two places of the twelve edges: the longitudinal one of the upper row lies 4.5 mm to the right, the last one of the
lower row 7.5 mm below. The others follow from these: longitudinal edges are shifted by 4.5 mm, all others by 7.5 mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Pattern:
    """An edge or a pin.

    Parameters
    ----------
    name : str
    x_mm, y_mm : float
        Its middle.
    angle_rad : float
        Of an edge: its direction, from x towards y, in [0, pi). NaN for a pin.

    Examples
    --------
    >>> Pattern("pin 1", -3.0, 6.0).is_pin, Pattern("lateral", 0.0, 0.0, 0.0).is_pin
    (True, False)
    """

    name: str
    x_mm: float
    y_mm: float
    angle_rad: float = math.nan

    @property
    def is_pin(self) -> bool:
        """Is it a point rather than a line?"""
        return math.isnan(self.angle_rad)


#: In the paper's order: patterns 1 to 4 of its figure 7.
_DIRECTIONS = (("longitudinal", math.pi / 2), ("lateral", 0.0), ("diagonal \\", 3 * math.pi / 4), ("diagonal /", math.pi / 4))
_ASIDE_MM, _AHEAD_MM = 4.5, 7.5
#: Half the pins' pitch across, and the pitch along.
_PIN_X_MM, _PIN_Y_MM = 3.0, 6.0


def _edge(name: str, angle: float, row: int) -> Pattern:
    aside = name == "longitudinal"
    return Pattern(name, row * _ASIDE_MM if aside else 0.0, 0.0 if aside else row * _AHEAD_MM, angle)


EDGES4 = tuple(_edge(name, angle, 0) for name, angle in _DIRECTIONS)
PINS6 = tuple(
    Pattern(f"{row} {side}", x * _PIN_X_MM, y * _PIN_Y_MM)
    for side, x in (("left", -1), ("right", 1))
    for row, y in (("upper", 1), ("middle", 0), ("lower", -1))
)
EDGES12 = tuple(
    Pattern(f"{where} {edge.name}", edge.x_mm, edge.y_mm, edge.angle_rad)
    for where, row in (("upper", 1), ("middle", 0), ("lower", -1))
    for edge in (_edge(name, angle, row) for name, angle in _DIRECTIONS)
)

#: The paper's tests by name.
TESTS: dict[str, tuple[Pattern, ...]] = {"edges4": EDGES4, "pins6": PINS6, "edges12": EDGES12}
