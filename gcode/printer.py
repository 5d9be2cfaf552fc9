"""What one printer is and how it is run, read from a TOML profile: printer facts live there, never in code."""

from __future__ import annotations

import math
from dataclasses import MISSING, dataclass, fields
from pathlib import Path
from types import NoneType
from typing import Any, get_args, get_type_hints

from gcode.profile import read_profile
from skinfab.errors import InputError

DEFAULT_PRINTER = "ender5plus-vipro"
HOME_POLICIES = ("xyz", "xy", "none")


@dataclass(frozen=True)
class Bed:
    """The reachable bed: `size` in x and y, `origin` = machine coordinates of its front left corner, `height` in z (mm)."""

    size: tuple[float, float]
    origin: tuple[float, float]
    height: float


@dataclass(frozen=True)
class Nozzle:
    """What reaches down into the mould: `outer_radius` of the widest part of the nozzle that comes below the wall's top,
    `clearance` kept between it and the wall (mm)."""

    outer_radius: float
    clearance: float


@dataclass(frozen=True)
class Heights:
    """Nozzle heights over the floor of the mould's cavity, mm: where ink is laid, the range that is accepted, where the head travels."""

    print: float
    print_min: float
    print_max: float
    travel: float


@dataclass(frozen=True)
class Motion:
    """Speeds mm/s, `acceleration` mm/s^2, `junction_deviation` mm; `max_speed` is the firmware's own limit in x and y."""

    straight_speed: float
    curve_speed: float
    travel_speed: float
    z_speed: float
    max_speed: float
    acceleration: float
    junction_deviation: float


@dataclass(frozen=True)
class Pump:
    """What drives the ink: `flow_min` and `flow_max` mm^3/s, `prime` and `retract` mm^3, `prime_rate` mm^3/s.

    Where it is an E axis: `e_per_mm3` is the factor (mm of E per mm^3), `max_e` the firmware's EXTRUDE_MAXLENGTH
    (mm of E in one command), `max_e_speed` mm/s of E. Where it is a spindle these have no meaning and are left out.
    """

    flow_min: float
    flow_max: float
    prime: float
    retract: float
    prime_rate: float
    e_per_mm3: float = 1.0
    max_e: float = math.inf
    max_e_speed: float = math.inf


@dataclass(frozen=True)
class Spindle:
    """A pump that GRBL drives as its spindle: `s_per_flow` is S for 1 mm^3/s, `s_max` the greatest S ($30)."""

    s_per_flow: float
    s_max: float


@dataclass(frozen=True)
class Process:
    """How a pattern is entered and left.

    `overrun_start` and `overrun_end`: the head moves in the ink's plane without extruding, mm;
    `print_overrun`: the same while extruding, before the path, mm; `pause`: s after each pattern;
    `chord_tolerance`: mm, where arcs must be emitted as lines.
    """

    overrun_start: float
    overrun_end: float
    print_overrun: float
    pause: float
    chord_tolerance: float


@dataclass(frozen=True)
class Cleaning:
    """Where the nozzle is wiped after each pattern (bed frame, mm), for how long (s), and the ink pushed there at first (mm^3)."""

    x: float
    y: float
    seconds: float
    initial_extrude: float


@dataclass(frozen=True)
class Park:
    """Where the head waits at travel height after the last pattern, away from the wet skin (bed frame, mm)."""

    x: float
    y: float


@dataclass(frozen=True)
class Printer:
    """A whole profile. `arcs`: the firmware draws G2 and G3; `home`: xyz, xy or none; `cleaning` and `park` are optional.

    With a `spindle` the printer speaks GRBL, without one Marlin.

    Examples
    --------
    >>> printer = load_printer()
    >>> printer.bed_size, printer.heights.print, printer.home
    ((350.0, 350.0), 1.6, 'xy')
    """

    name: str
    arcs: bool
    home: str
    bed: Bed
    nozzle: Nozzle
    heights: Heights
    motion: Motion
    pump: Pump
    process: Process
    cleaning: Cleaning | None = None
    park: Park | None = None
    spindle: Spindle | None = None

    @property
    def bed_size(self) -> tuple[float, float]:
        """Width and depth of the bed, mm."""
        return self.bed.size


def load_printer(name: str | Path = DEFAULT_PRINTER) -> Printer:
    """Read a bundled profile by name, or any TOML file by path.

    Raises
    ------
    InputError
        No such profile or parent, not TOML, a field missing, misspelt or of the wrong type, or values that contradict each other.

    Examples
    --------
    >>> load_printer("generic-marlin").bed.height
    200.0
    """
    data = read_profile(name)
    printer: Printer = _build(Printer, data, f"printer profile {name}")
    _check(printer, f"printer profile {name}")
    return printer


def _build(kind: type, data: Any, where: str) -> Any:
    """A dataclass from a TOML table, field by field."""
    if not isinstance(data, dict):
        raise InputError(f"{where}: it is {data!r}; it must be a table of fields")
    expected = get_type_hints(kind)
    if unknown := sorted(data.keys() - expected.keys()):
        raise InputError(f"{where}: unknown field {unknown[0]!r}; it knows {', '.join(sorted(expected))}")
    needed = {f.name for f in fields(kind) if f.default is MISSING}
    if missing := sorted(needed - data.keys()):
        raise InputError(f"{where}: field {missing[0]!r} is missing")
    return kind(**{key: _value(expected[key], value, f"{where}, {key}") for key, value in data.items()})


def _value(wanted: Any, value: Any, where: str) -> Any:
    if wanted is float:
        return _number(value, where)
    if wanted == tuple[float, float]:
        if not isinstance(value, list) or len(value) != 2:
            raise InputError(f"{where} is {value!r}; it must be two numbers in brackets")
        return tuple(_number(v, where, signed=True) for v in value)
    if wanted in (bool, str):
        if not isinstance(value, wanted):
            raise InputError(f"{where} is {value!r}; it must be {'true or false' if wanted is bool else 'a text in quotes'}")
        return value
    (table,) = [kind for kind in get_args(wanted) if kind is not NoneType] or [wanted]  # an optional table is a union with None
    return _build(table, value, where)


def _number(value: Any, where: str, *, signed: bool = False) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value) or (value < 0 and not signed):
        raise InputError(f"{where} is {value!r}; it must be a number{'' if signed else ', zero or more'}")
    return float(value)


def _check(printer: Printer, where: str) -> None:
    """Refuse values that contradict each other."""
    h, m, p = printer.heights, printer.motion, printer.pump
    positive = {
        "bed, size": min(printer.bed.size),
        "bed, height": printer.bed.height,
        "process, chord_tolerance": printer.process.chord_tolerance,
        **{f"motion, {f.name}": getattr(m, f.name) for f in fields(m)},
        **{f"pump, {k}": getattr(p, k) for k in ("e_per_mm3", "max_e", "max_e_speed", "flow_max", "prime_rate")},
        **({f"spindle, {f.name}": getattr(printer.spindle, f.name) for f in fields(printer.spindle)} if printer.spindle else {}),
    }
    for key, value in positive.items():
        if not value > 0:
            raise InputError(f"{where}, {key} is {value:g}; it must be more than zero")
    if printer.home not in HOME_POLICIES:
        raise InputError(f"{where}, home is {printer.home!r}; it must be one of {', '.join(HOME_POLICIES)}")
    for name, place in (("cleaning", printer.cleaning), ("park", printer.park)):
        if place and not (place.x <= printer.bed.size[0] and place.y <= printer.bed.size[1]):
            raise InputError(
                f"{where}, {name} is at {place.x:g}, {place.y:g}; the bed is {printer.bed.size[0]:g} x {printer.bed.size[1]:g} mm, "
                "name a place on it, beside the largest mould"
            )
    if not h.print_min <= h.print <= h.print_max < h.travel <= printer.bed.height:
        raise InputError(f"{where}, heights: print_min <= print <= print_max < travel <= bed height must hold, in mm")
    if not p.flow_min <= p.flow_max:
        raise InputError(f"{where}, pump: flow_min {p.flow_min:g} is above flow_max {p.flow_max:g} mm^3/s")
    if printer.spindle:
        _check_grbl(printer, printer.spindle, where)
    elif math.isinf(p.max_e) or math.isinf(p.max_e_speed):
        missing = "max_e" if math.isinf(p.max_e) else "max_e_speed"
        raise InputError(f"{where}, pump: field {missing!r} is missing; only a pump that is a [spindle] goes without")
    if p.prime != p.retract:
        raise InputError(
            f"{where}, pump: prime {p.prime:g} and retract {p.retract:g} mm^3 differ; a pattern must end as it began, make them equal"
        )


def _check_grbl(printer: Printer, spindle: Spindle, where: str) -> None:
    p = printer.pump
    if printer.home != "none":
        raise InputError(
            f"{where}, home is {printer.home!r}; GRBL homes by $H, which is no G-code: home before the start and say 'none' here"
        )
    if (p.e_per_mm3, p.max_e, p.max_e_speed) != (1.0, math.inf, math.inf):
        raise InputError(f"{where}, pump: a pump that is a spindle has no E axis; take out e_per_mm3, max_e and max_e_speed")
    if (fastest := max(p.flow_max, p.prime_rate)) * spindle.s_per_flow > spindle.s_max:
        raise InputError(
            f"{where}: {fastest:g} mm^3/s asks for S{fastest * spindle.s_per_flow:g}, above spindle, s_max {spindle.s_max:g}; "
            "lower pump, flow_max and prime_rate, or s_per_flow"
        )
