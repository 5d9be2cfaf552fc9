"""Ink volume, resistance and its scatter, and what strain does to it.

A printed line is a conductor of length L and cross-section A: R = rho L / A + 2 R_contact. Prints of the
same pattern scatter widely (the starting resistances in table II of "Soft Sensing Skins for Arbitrary
Objects" spread by more than ten times on one object), so a resistance is always given as an interval.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from skinfab.errors import InputError
from skinfab.material import Ink

#: Standard normal quantile of 95 %.
_Z95 = 1.6448536269514722
#: Millimetres in a centimetre and ohms in a kilohm: ohm cm = 0.01 kohm mm.
KOHM_MM_PER_OHM_CM = 0.01


@dataclass(frozen=True)
class Resistance:
    """A log-normal resistance by its quantiles, kohm.

    Parameters
    ----------
    low, median, high : float, kohm
        The 5 %, 50 % and 95 % quantiles: nine prints out of ten lie between `low` and `high`.
    """

    low: float
    median: float
    high: float


def ink_volume(length: float, ink: Ink) -> float:
    """Ink in a bead of `length` mm: V = A L, mm^3.

    Examples
    --------
    >>> from skinfab.material import load_material
    >>> round(ink_volume(100.0, load_material().ink), 6)
    48.4
    """
    return ink.bead_area_mm2 * length


def resistance(length: float, ink: Ink) -> Resistance:
    """Resistance of a printed line of `length` mm between its two terminals.

    The median is rho L / A + 2 R_contact, with A what conducts (`Ink.conducting_area_mm2`); ln R scatters with the ink's `log_sigma`.

    Raises
    ------
    InputError
        The length is not positive, or the ink's bead has no cross-section.

    Examples
    --------
    >>> from skinfab.material import load_material
    >>> r = resistance(110.6, load_material().ink)
    >>> round(r.low), round(r.median), round(r.high)
    (49, 154, 487)
    """
    if not length > 0:
        raise InputError(f"a conductor of length {length:g} mm has no resistance; it must be longer than 0")
    if not ink.bead_area_mm2 > 0:
        raise InputError(f"ink {ink.name}: bead_area_mm2 is {ink.bead_area_mm2:g}; it must be more than 0")
    line = KOHM_MM_PER_OHM_CM * ink.resistivity_ohm_cm * length / ink.conducting_area_mm2
    median = line + 2 * ink.contact_resistance_kohm
    spread = math.exp(_Z95 * ink.log_sigma)
    return Resistance(low=median / spread, median=median, high=median * spread)
