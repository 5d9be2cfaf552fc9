"""The recipe: what to weigh and in which order to do it, from the moulds' volumes and the material profile.

The process is that of "Soft Sensing Skins for Arbitrary Objects", section II.C; the numbers are the profile's.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from skinfab.errors import InputError
from skinfab.material import Layer, Material


@dataclass(frozen=True)
class Batch:
    """One layer's mix for all moulds together.

    Parameters
    ----------
    layer : str
    depth : float, mm
    volume_ml : float
        What ends in the moulds.
    mass_g : float
        What is mixed: the volume's mass and the waste allowance.
    weigh_g : dict
        Grams of each component of the base, then of each additive, in the order to add them.
    pour_g : dict
        Grams to pour into each piece's mould, waste left out.
    """

    layer: str
    depth: float
    volume_ml: float
    mass_g: float
    weigh_g: dict[str, float]
    pour_g: dict[str, float]


@dataclass(frozen=True)
class Recipe:
    """What to weigh, and the steps in words for the person at the printer."""

    material: str
    waste_percent: float
    cure_h: float
    bond: str
    batches: tuple[Batch, ...]
    steps: tuple[str, ...]

    def as_dict(self) -> dict[str, Any]:
        """Plain values for ``report.json``."""
        plain = asdict(self)
        return plain | {"batches": list(plain["batches"]), "steps": list(plain["steps"])}


def recipe(cavities_ml: Mapping[str, float], material: Material, *, lips_ml: Mapping[str, float] | None = None) -> Recipe:
    """Weigh out the silicone for a set of moulds.

    Parameters
    ----------
    cavities_ml : mapping of piece id to float
        Volume of each mould's cavity over the material's whole depth.
    material : Material
    lips_ml : mapping of piece id to float, optional
        Volume of each mould's adhesive lips, which the top layer fills.

    Raises
    ------
    InputError
        A volume that is not positive, no moulds, no layer, or a layer whose base has no parts.

    Notes
    -----
    Additives are given in percent of the base's weight, so a batch of mass M has the base
    M / (1 + sum of percents / 100).

    Examples
    --------
    >>> from skinfab.material import load_material
    >>> r = recipe({"P1": 10.0}, load_material())
    >>> {name: round(grams, 2) for name, grams in r.batches[1].weigh_g.items()}["Silicone Thinner"]
    0.22
    """
    if not cavities_ml:
        raise InputError("no moulds to pour; give the cavity of one piece or more")
    for piece, volume in cavities_ml.items():
        if not (np.isfinite(volume) and volume > 0):
            raise InputError(f"the mould of piece {piece} holds {volume:g} ml; it must be positive")
    if not material.depth > 0:
        raise InputError(f"material {material.name!r} has no layer with a depth; add its [[layers]] to the profile")
    volumes = [{piece: float(v) * layer.depth / material.depth for piece, v in cavities_ml.items()} for layer in material.layers]
    for piece, extra in (lips_ml or {}).items():
        volumes[-1][piece] += float(extra)
    batches = tuple(_batch(layer, each, material) for layer, each in zip(material.layers, volumes, strict=True))
    return Recipe(material.name, material.waste_percent, material.cure_h, material.bond, batches, _steps(batches, material))


def _batch(layer: Layer, volumes: Mapping[str, float], material: Material) -> Batch:
    parts = sum(layer.base.values())
    if not parts > 0:
        raise InputError(f"layer {layer.name!r} of the material has no base to weigh; give its parts in the profile")
    volume = sum(volumes.values())
    mass = volume * layer.density_g_ml * (1 + material.waste_percent / 100)
    base = mass / (1 + sum(layer.additives_wt_percent.values()) / 100)
    weigh = {name: base * part / parts for name, part in layer.base.items()}
    weigh |= {name: base * percent / 100 for name, percent in layer.additives_wt_percent.items()}
    pour = {piece: each * layer.density_g_ml for piece, each in volumes.items()}
    return Batch(layer.name, layer.depth, volume, mass, weigh, pour)


def _steps(batches: tuple[Batch, ...], material: Material) -> tuple[str, ...]:
    moulds = "mould" if len(batches[0].pour_g) == 1 else "moulds"
    steps = [f"Print the {moulds}; lay each on the level bed, its lower left L mark towards the printer's origin."]
    height = 0.0
    for batch in batches:
        height += batch.depth
        weigh = ", then ".join(f"{grams:.2f} g {name}" for name, grams in batch.weigh_g.items())
        pour = ", ".join(f"{grams:.2f} g into {piece}" for piece, grams in batch.pour_g.items())
        steps += [
            f"Mix the {batch.layer} layer, {batch.mass_g:.2f} g with {material.waste_percent:g} % for waste: {weigh}. "
            "Stir, then degas under vacuum.",
            f"Pour the {batch.layer} layer ({batch.depth:g} mm): {pour}. "
            f"Spread it until it is level, {height:g} mm above the mould's floor.",
        ]
    steps += [
        f"Print the conductors ({material.ink.name}) into the filled mould with the G-code of the same name: "
        "home XY, jog the nozzle to the lower left L mark, set Z on the glass.",
        f"Cure for {material.cure_h:g} h without moving the mould, then take the skin out.",
        f"Pierce a stripped wire into each contact pad and lead it out by its slot; seal each with a drop of {material.bond}.",
        f"Wrap the skin round the object, seam by seam; lay each lip over its other side and bond it with {material.bond}.",
    ]
    return tuple(steps)
