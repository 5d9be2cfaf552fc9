"""Which unit a mesh file is in, guessed from its size and said aloud."""

from __future__ import annotations

from dataclasses import dataclass

from skinfab.errors import InputError

#: Millimetres in one of each unit.
MM_PER_UNIT = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}

# Things one puts a skin on: from a fingertip to a forearm. Millimetres are tried first and up to a
# whole limb, because most files are in mm; robot meshes in metres are the usual other case.
_SMALLEST_MM = 15.0
_LARGEST_AS_MM = 1000.0
_LARGEST_OTHERWISE_MM = 500.0


@dataclass(frozen=True)
class UnitGuess:
    """A unit and why.

    Parameters
    ----------
    units : str
        "mm", "cm", "m" or "in".
    reason : str
        One sentence for the user.
    sure : bool
        False when no unit gives a size one would expect.
    """

    units: str
    reason: str
    sure: bool


def guess_units(extent: float) -> UnitGuess:
    """Guess the unit of a mesh whose largest extent is `extent` file units.

    Examples
    --------
    >>> [guess_units(extent).units for extent in (55, 0.19, 1.99, 0.989)]
    ['mm', 'm', 'cm', 'in']
    >>> guess_units(0.19).reason
    'units taken as m: the largest extent is 0.19, so 190 mm; set --units if that is wrong'
    """
    if _SMALLEST_MM <= extent <= _LARGEST_AS_MM:
        return UnitGuess("mm", f"units taken as mm: the largest extent is {extent:.4g} mm", True)
    for units in ("m", "cm", "in"):
        size = extent * MM_PER_UNIT[units]
        if _SMALLEST_MM <= size <= _LARGEST_OTHERWISE_MM:
            reason = f"units taken as {units}: the largest extent is {extent:.4g}, so {size:.4g} mm; set --units if that is wrong"
            return UnitGuess(units, reason, True)
    reason = (
        f"units unclear: the largest extent is {extent:.4g}, which is no usual size in mm, cm, m or in; "
        f"taken as mm; set --units (and --scale) to say otherwise"
    )
    return UnitGuess("mm", reason, False)


def odd_size(extent_mm: float) -> str:
    """A sentence where an object of this size is hardly what one puts a skin on; empty otherwise.

    Examples
    --------
    >>> odd_size(90.0), odd_size(1411.0)
    ('', 'the object is 1411 mm long; check --units and --scale')
    """
    if 1 <= extent_mm <= _LARGEST_AS_MM:
        return ""
    size = f"{extent_mm:.0f}" if extent_mm > 1 else f"{extent_mm:.3g}"
    return f"the object is {size} mm long; check --units and --scale"


def mm_per(units: str) -> float:
    """Millimetres in one `units`; InputError for an unknown unit."""
    if units not in MM_PER_UNIT:
        raise InputError(f"unit {units!r} is not known; use one of {', '.join(MM_PER_UNIT)}")
    return MM_PER_UNIT[units]
