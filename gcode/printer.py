"""What one printer is and how it is run, read from a TOML profile: printer facts live there, never in code."""

from __future__ import annotations

import math
from dataclasses import MISSING, dataclass, fields
from pathlib import Path
from types import NoneType
from typing import Any, get_args, get_type_hints

from gcode.profile import Profile, read_profile
from gcode.profile_check import check_values
from skinfab.errors import InputError

DEFAULT_PRINTER = "ender5plus-vipro"


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
    `print_overrun` and `print_overrun_end`: the same while extruding, before the path and past its end, mm;
    `pause`: s after each pattern; `chord_tolerance`: mm, where arcs must be emitted as lines.
    """

    overrun_start: float
    overrun_end: float
    print_overrun: float
    pause: float
    chord_tolerance: float
    print_overrun_end: float = 0.0


@dataclass(frozen=True)
class Cleaning:
    """Where the nozzle is cleaned after each pattern (bed frame, mm), for how long (s), and the ink pushed there at first (mm^3).

    `height`: how high the nozzle stands there over the floor of the mould's cavity, mm, that of travel if None, where a
    person or a brush comes to it; `wipe`: how far it then moves along +x and back at that height, mm.
    """

    x: float
    y: float
    seconds: float
    initial_extrude: float
    height: float | None = None
    wipe: float = 0.0


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
    profile = read_profile(name)
    printer: Printer = _build(Printer, profile.data, profile, ())
    check_values(printer, profile)
    return printer


def _build(kind: type, data: Any, profile: Profile, keys: tuple[str, ...]) -> Any:
    """A dataclass from a TOML table, field by field."""
    where, whose = profile.where(*keys), profile.taken_over(*keys)
    if not isinstance(data, dict):
        raise InputError(f"{where}: it is {data!r}{whose}; it must be a table of fields")
    expected = get_type_hints(kind)
    if unknown := sorted(data.keys() - expected.keys()):
        whose = profile.taken_over(*keys, unknown[0])
        raise InputError(f"{where}: unknown field {unknown[0]!r}{whose}; it knows {', '.join(sorted(expected))}")
    needed = {f.name for f in fields(kind) if f.default is MISSING}
    if missing := sorted(needed - data.keys()):
        raise InputError(f"{where}: field {missing[0]!r} is missing")
    return kind(**{key: _value(expected[key], value, profile, (*keys, key)) for key, value in data.items()})


def _value(wanted: Any, value: Any, profile: Profile, keys: tuple[str, ...]) -> Any:
    said = f"{profile.where(*keys)} is {value!r}{profile.taken_over(*keys)}"
    if wanted is float:
        return _number(value, said)
    if wanted == tuple[float, float]:
        if not isinstance(value, list) or len(value) != 2:
            raise InputError(f"{said}; it must be two numbers in brackets")
        return tuple(_number(v, said, signed=True) for v in value)
    if wanted in (bool, str):
        if not isinstance(value, wanted):
            raise InputError(f"{said}; it must be {'true or false' if wanted is bool else 'a text in quotes'}")
        return value
    if NoneType in get_args(wanted):  # what may be left out is a union with None
        return _value(get_args(wanted)[0], value, profile, keys)
    return _build(wanted, value, profile, keys)


def _number(value: Any, said: str, *, signed: bool = False) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value) or (value < 0 and not signed):
        raise InputError(f"{said}; it must be a number{'' if signed else ', zero or more'}")
    return float(value)
