"""What a sensor will be once it is printed and worn: length, ink, resistance, strain."""

from __future__ import annotations

from dataclasses import dataclass

from gui.state.profiles import Profiles
from skinfab.electrical import Resistance, ink_volume, resistance
from skinfab.placement.sensor import Sensor
from skinfab.placement.wrap_strain import WornSkin, WrapStrain, strain_along, summary, worn_skin
from skinfab.skin import Skin


@dataclass(frozen=True)
class Prediction:
    """What is known without wearing it.

    Parameters
    ----------
    length : float, mm
        Of the conductor between its terminals.
    ink_mm3 : float
    resistance : Resistance
        In the flat state; nine prints in ten lie within.
    """

    length: float
    ink_mm3: float
    resistance: Resistance


def predict(sensor: Sensor, profiles: Profiles) -> Prediction:
    """Of a sensor lying flat.

    Examples
    --------
    >>> from gui.state.profiles import ProfileShelf
    >>> from skinfab.patterns.registry import make_pattern
    >>> used = ProfileShelf().get("ender5plus-vipro", "carbon-grease-ecoflex")
    >>> round(predict(Sensor("C1", "P1", make_pattern("contact-spiral", {"s": 20}), 0, 0, 0, 0), used).length)
    162
    """
    ink = profiles.material.ink
    return Prediction(sensor.path.length, ink_volume(sensor.printed_path.length, ink), resistance(sensor.path.length, ink))


def worn(skin: Skin, profiles: Profiles) -> WornSkin:
    """The surfaces that wearing is reckoned on, the same as in the report; some tenths of a second for 85,000 triangles."""
    depth = profiles.material.depth
    return worn_skin(
        skin.object,
        skin.mesh,
        flattened_at=skin.flattened_at,
        neutral_at=skin.neutral * depth,
        conductor_at=profiles.printer.heights.print,
        even=depth,
    )


def worn_strain(skin: Skin, sensor: Sensor, profiles: Profiles, surfaces: WornSkin) -> WrapStrain:
    """What wearing does to one sensor.

    Raises
    ------
    InputError
        A part of it lies outside its piece.
    """
    return summary(strain_along(surfaces, skin.piece(sensor.piece), sensor.path), even=profiles.material.depth)
