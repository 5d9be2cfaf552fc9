"""What the skin is made of: ink, bead, silicone layers, mould and recipe, read from a TOML profile."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import MISSING, dataclass, fields
from importlib import resources
from pathlib import Path
from typing import Any

from skinfab.errors import InputError
from skinfab.tolerances import PARAMETER_ROUNDING_MM, PARAMETER_STEP_MM
from skinfab.toml_file import read_toml

#: The bundled profile of the paper's process.
DEFAULT_MATERIAL = "carbon-grease-ecoflex"


@dataclass(frozen=True)
class Ink:
    """The conductive ink and the bead it is laid in."""

    name: str
    resistivity_ohm_cm: float
    bead_area_mm2: float  # cross-section A of the printed bead
    bead_width: float  # mm, as seen from above
    contact_resistance_kohm: float  # of one terminal
    log_sigma: float  # sd of ln(R): the scatter from print to print
    effective_area_mm2: float = 0.0  # cross-section that conducts, as strips tell (skinfab.strip_fit); 0: all of the bead

    @property
    def conducting_area_mm2(self) -> float:
        """The cross-section that a resistance is computed with, mm^2."""
        return self.effective_area_mm2 or self.bead_area_mm2

    @property
    def least_width(self) -> float:
        """Width of a round bead of `bead_area_mm2`, mm, cut to a parameter's step: ink settles wider, and not narrower."""
        return math.floor(2 * math.sqrt(self.bead_area_mm2 / math.pi) / PARAMETER_STEP_MM) * PARAMETER_STEP_MM


@dataclass(frozen=True)
class Layer:
    """One pour: its depth and what is weighed for it (parts by mass; additives in wt % of the base)."""

    name: str
    depth: float  # mm
    density_g_ml: float
    base: dict[str, float]
    additives_wt_percent: dict[str, float]


@dataclass(frozen=True)
class Mould:
    """The printed mould's own dimensions, mm."""

    floor: float
    wall: float
    lip: float  # width of the adhesive lip along a seam
    mark: float  # length of a registration mark's arm
    wire_exit: float  # width of the slot a wire leaves by
    draft_deg: float = 0.0  # by which the walls lean outwards, so that the cast comes out


@dataclass(frozen=True)
class Material:
    """A whole profile. `margin` is from bead edge to skin edge, `gap` from bead edge to bead edge (mm)."""

    name: str
    margin: float
    gap: float
    pad: float
    neck: float
    cure_h: float
    waste_percent: float
    bond: str
    ink: Ink
    layers: tuple[Layer, ...]
    mould: Mould
    adhesive: str = ""  # what holds the skin on the object; empty where it is only worn

    @property
    def depth(self) -> float:
        """Thickness of the whole skin, mm."""
        return sum(layer.depth for layer in self.layers)


def load_material(name: str | Path = DEFAULT_MATERIAL) -> Material:
    """Read a bundled profile by name, or any TOML file by path.

    Raises
    ------
    InputError
        No such profile, not TOML, or a field missing, misspelt or of the wrong type.

    Examples
    --------
    >>> m = load_material()
    >>> m.ink.resistivity_ohm_cm, m.depth
    (63.0, 2.5)
    """
    bundled = resources.files("skinfab") / "materials"
    path = Path(name)
    if path.suffix == ".toml":
        source: Any = path
    else:
        source = bundled / f"{name}.toml"
        known = sorted(p.name[:-5] for p in bundled.iterdir() if p.name.endswith(".toml"))
        if str(name) not in known:
            raise InputError(f"no material profile named {str(name)!r}; there are {', '.join(known)}, or give a .toml file")
    try:
        data = read_toml(source, path)
    except FileNotFoundError:
        raise InputError(f"no material profile at {path}") from None
    except OSError as fault:
        raise InputError(f"cannot read the material profile {path}: {fault.strerror or fault}") from fault
    where = f"material profile {name}"
    described = data.pop("layers", [])
    if not isinstance(described, list):
        raise InputError(f"{where}: 'layers' must be a list of tables; write [[layers]] with two brackets")
    layers = tuple(_build(Layer, layer, f"{where}, layer") for layer in described)
    parts = {"ink": _build(Ink, data.pop("ink", {}), f"{where}, [ink]"), "mould": _build(Mould, data.pop("mould", {}), f"{where}, [mould]")}
    material: Material = _build(Material, {**data, **parts, "layers": layers}, where)
    if (ink := material.ink).bead_width < ink.least_width - PARAMETER_ROUNDING_MM:
        raise InputError(
            f"{where}, [ink]: bead_width is {ink.bead_width:g}, but a round bead of bead_area_mm2 = {ink.bead_area_mm2:g} is wider; "
            f"it must be at least {ink.least_width:g}"
        )
    return material


def _build(kind: type, data: Any, where: str) -> Any:
    if not isinstance(data, dict):
        raise InputError(f"{where} is {data!r}; it must be a table")
    expected = {f.name: f.type for f in fields(kind)}
    optional = {f.name for f in fields(kind) if f.default is not MISSING}
    if unknown := sorted(data.keys() - expected.keys()):
        raise InputError(f"{where}: unknown field {unknown[0]!r}; it knows {', '.join(sorted(expected))}")
    if missing := sorted(expected.keys() - data.keys() - optional):
        raise InputError(f"{where}: field {missing[0]!r} is missing")
    values = dict(data)
    for key, annotation in expected.items():
        if annotation == "str" and not isinstance(values.get(key, ""), str):
            raise InputError(f"{where}: {key} is {values[key]!r}; it must be a text in quotes")
        if annotation.startswith("dict") and key in values:
            _require_parts(values[key], f"{where}: {key}")
        if annotation == "float" and key in values:
            if isinstance(values[key], bool) or not isinstance(values[key], (int, float)) or not 0 <= values[key] < float("inf"):
                raise InputError(f"{where}: {key} is {values[key]!r}; it must be a number, zero or more")
            values[key] = float(values[key])
    return kind(**values)


def _require_parts(parts: Any, where: str) -> None:
    if not isinstance(parts, dict):
        raise InputError(f"{where} is {parts!r}; it must be a table of numbers")
    for name, part in parts.items():
        if isinstance(part, bool) or not isinstance(part, (int, float)) or not 0 <= part < float("inf"):
            raise InputError(f"{where}, {name!r} is {part!r}; it must be a number, zero or more")


def material_toml(material: Material, *, comments: Sequence[str] = ()) -> str:
    """The profile as the text of a TOML file that `load_material` reads as the same material.

    Examples
    --------
    >>> material_toml(load_material(), comments=["as bundled"]).splitlines()[:3]
    ['# as bundled', 'name = "carbon grease 846-1P in Ecoflex 00-30"', 'margin = 1.0']
    """
    lines = [f"# {' '.join(comment.split())}" for comment in comments]
    lines += [f"{key} = {_toml(value)}" for key, value in vars(material).items() if isinstance(value, str | float)]
    lines += ["", "[ink]", *(f"{key} = {_toml(value)}" for key, value in vars(material.ink).items())]
    for layer in material.layers:
        lines += ["", "[[layers]]", *(f"{key} = {_toml(value)}" for key, value in vars(layer).items())]
    return "\n".join([*lines, "", "[mould]", *(f"{key} = {_toml(value)}" for key, value in vars(material.mould).items()), ""])


def _toml(value: str | float | dict[str, float]) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_toml(key)} = {_toml(each)}" for key, each in value.items()) + " }"
    # A JSON string is a TOML string but for the one control character that JSON lets stand.
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f") if isinstance(value, str) else repr(value)
