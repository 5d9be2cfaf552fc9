"""What wearing does to every conductor of a skin, for the tables and the picture alike."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from skinfab.electrical import resistance
from skinfab.flatten.locate import Locator
from skinfab.material import Material
from skinfab.placement.sensor import Sensor
from skinfab.placement.wrap_strain import StrainAlong, strain_along, summary, worn_skin
from skinfab.skin import Skin


@dataclass(frozen=True, eq=False)
class SensorStrains:
    """Strain along all conductors, and what it was reckoned with.

    Parameters
    ----------
    along : tuple of StrainAlong
        One a sensor, in the order of ``skin.sensors``.
    neutral_mm, conductor_mm : float
        How far from the skin's inner side the neutral surface and the conductors lie.
    even : float, mm
        Length of path over which extremes are averaged: the skin's thickness.
    """

    along: tuple[StrainAlong, ...]
    neutral_mm: float
    conductor_mm: float
    even: float


def sensor_strains(skin: Skin, material: Material, *, conductor_mm: float | None = None) -> SensorStrains:
    """Strain along all conductors of a worn skin.

    Parameters
    ----------
    skin : Skin
    material : Material
        Its layers make the skin's thickness: that is what is cast, whatever thickness was flattened for.
    conductor_mm : float, optional
        The printer's print height: the skin's inner side lies on the mould's floor. Without it the conductors are taken to lie
        in the neutral surface, where nothing bends.
    """
    neutral = skin.neutral * material.depth
    conductor = neutral if conductor_mm is None else conductor_mm
    worn = worn_skin(
        skin.object, skin.mesh, flattened_at=skin.flattened_at, neutral_at=neutral, conductor_at=conductor, even=material.depth
    )
    used = {sensor.piece for sensor in skin.sensors}
    locators = {piece.id: Locator(piece.UV, piece.F) for piece in skin.pieces if piece.id in used}
    along = tuple(strain_along(worn, skin.piece(s.piece), s.path, locator=locators[s.piece]) for s in skin.sensors)
    return SensorStrains(along, neutral, conductor, material.depth)


def strain_facts(sensor: Sensor, along: StrainAlong, material: Material, *, even: float) -> dict[str, Any]:
    """The report's ``wrap_strain`` of a sensor; its resistance is the median, its contacts are not stretched."""
    strain = summary(along, even=even)
    contacts = 2 * material.ink.contact_resistance_kohm
    line = resistance(sensor.path.length, material.ink).median - contacts
    return {
        "mean": strain.mean,
        "max": strain.max,
        "membrane": {"mean": strain.membrane.mean, "max": strain.membrane.max},
        "bending": {"mean": strain.bending.mean, "max": strain.bending.max},
        "worn_length_mm": strain.worn_length,
        "resistance_factor": strain.resistance_factor,
        "worn_resistance_kohm": line * strain.resistance_factor + contacts,
    }
