"""The recipe: what to weigh for each piece and for all, from the moulds' volumes and the material profile.

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
class Portion:
    """One layer's mix for one mould.

    Parameters
    ----------
    mass_g : float
        What is mixed, the waste allowance included.
    weigh_g : dict
        Grams of each component of the base, then of each additive, in the order to add them.
    """

    mass_g: float
    weigh_g: dict[str, float]


@dataclass(frozen=True)
class Batch:
    """One layer's silicone, for all moulds together and for each.

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
    portions : dict of Portion
        What to mix for each piece alone; together they are the whole.
    """

    layer: str
    depth: float
    volume_ml: float
    mass_g: float
    weigh_g: dict[str, float]
    pour_g: dict[str, float]
    portions: dict[str, Portion]


@dataclass(frozen=True)
class Recipe:
    """What to weigh; `skinfab.work_order` says when."""

    material: str
    waste_percent: float
    cure_h: float
    bond: str
    batches: tuple[Batch, ...]

    def as_dict(self) -> dict[str, Any]:
        """Plain values for ``report.json``."""
        plain = asdict(self)
        return plain | {"batches": list(plain["batches"])}


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
    return Recipe(material.name, material.waste_percent, material.cure_h, material.bond, batches)


def _batch(layer: Layer, volumes: Mapping[str, float], material: Material) -> Batch:
    if not sum(layer.base.values()) > 0:
        raise InputError(f"layer {layer.name!r} of the material has no base to weigh; give its parts in the profile")
    pour = {piece: each * layer.density_g_ml for piece, each in volumes.items()}
    portions = {piece: _portion(layer, grams * (1 + material.waste_percent / 100)) for piece, grams in pour.items()}
    whole = _portion(layer, sum(portion.mass_g for portion in portions.values()))
    return Batch(layer.name, layer.depth, sum(volumes.values()), whole.mass_g, whole.weigh_g, pour, portions)


def _portion(layer: Layer, mass: float) -> Portion:
    parts = sum(layer.base.values())
    base = mass / (1 + sum(layer.additives_wt_percent.values()) / 100)
    weigh = {name: base * part / parts for name, part in layer.base.items()}
    return Portion(mass, weigh | {name: base * percent / 100 for name, percent in layer.additives_wt_percent.items()})
