"""The sensors of a skin, automatic or as a file says."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from skinfab.material import Material
from skinfab.placement.auto import place
from skinfab.placement.check import validate
from skinfab.placement.requested import place_from_file
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin


def place_sensors(skin: Skin, material: Material, file: Path | None = None) -> tuple[tuple[Sensor, ...], list[str]]:
    """Sensors in place of those that a skin has, checked, and what the user should be told.

    Parameters
    ----------
    skin : Skin
    material : Material
        With the margin that the printer needs.
    file : path, optional
        Says which sensors, and where (docs/sensors.md); without it they are placed automatically.

    Raises
    ------
    InputError
        The file cannot be used.
    RefusedError
        What the file asks for does not fit.
    """
    if file is None:
        sensors, warnings = place(skin.object, skin.pieces, material=material, seed=skin.seed)
    else:
        sensors, warnings = place_from_file(file, skin.object, skin.pieces, material=material, seed=skin.seed)
    validate(replace(skin, sensors=tuple(sensors)), material)
    return tuple(sensors), list(warnings)
