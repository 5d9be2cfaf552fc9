"""What a printer profile says, field by field with its unit, to be read. Knows no widget."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path

from gcode.printer import Printer

#: Unit of each field, by its table and its name; "" for a plain number or word.
UNITS = {
    "arcs": "",
    "home": "",
    "bed.size": "mm",
    "bed.origin": "mm",
    "bed.height": "mm",
    "nozzle.outer_radius": "mm",
    "nozzle.clearance": "mm",
    "heights.print": "mm",
    "heights.print_min": "mm",
    "heights.print_max": "mm",
    "heights.travel": "mm",
    "motion.straight_speed": "mm/s",
    "motion.curve_speed": "mm/s",
    "motion.travel_speed": "mm/s",
    "motion.z_speed": "mm/s",
    "motion.max_speed": "mm/s",
    "motion.acceleration": "mm/s²",
    "motion.junction_deviation": "mm",
    "pump.flow_min": "mm³/s",
    "pump.flow_max": "mm³/s",
    "pump.prime": "mm³",
    "pump.retract": "mm³",
    "pump.prime_rate": "mm³/s",
    "pump.e_per_mm3": "mm of E/mm³",
    "pump.max_e": "mm of E",
    "pump.max_e_speed": "mm of E/s",
    "process.overrun_start": "mm",
    "process.overrun_end": "mm",
    "process.print_overrun": "mm",
    "process.print_overrun_end": "mm",
    "process.pause": "s",
    "process.chord_tolerance": "mm",
    "cleaning.x": "mm",
    "cleaning.y": "mm",
    "cleaning.seconds": "s",
    "cleaning.initial_extrude": "mm³",
    "cleaning.height": "mm",
    "cleaning.wipe": "mm",
    "park.x": "mm",
    "park.y": "mm",
    "spindle.s_per_flow": "S/(mm³/s)",
    "spindle.s_max": "S",
}

#: Titles of the tables, in the order in which they are read: what one tunes stands first.
GROUPS = {
    "process": "How a pattern is entered and left",
    "pump": "Pump",
    "spindle": "Spindle (drives the pump)",
    "motion": "Motion",
    "heights": "Heights over the mould's floor",
    "nozzle": "Nozzle",
    "cleaning": "Cleaning",
    "park": "Park",
    "bed": "Bed",
    "": "Firmware",
}


@dataclass(frozen=True)
class Setting:
    """One field: the table it is in ("" for none), its name, its value and its unit."""

    group: str
    name: str
    value: str
    unit: str


def settings(printer: Printer) -> tuple[Setting, ...]:
    """All that a profile says, what it leaves out said as "none".

    Examples
    --------
    >>> from gcode.printer import load_printer
    >>> settings(load_printer())[0]
    Setting(group='process', name='overrun start', value='1', unit='mm')
    """
    found = []
    for group in GROUPS:
        table = getattr(printer, group) if group else printer
        if table is None:
            continue
        for field in fields(table):
            value = getattr(table, field.name)
            if field.name == "name" or is_dataclass(value) or (not group and value is None):
                continue
            unit = UNITS[f"{group}.{field.name}" if group else field.name]
            found.append(Setting(group, field.name.replace("_", " "), _said(value), unit if value is not None else ""))
    return tuple(found)


def profile_name(named: str) -> str:
    """A profile as a document names it: the file of one's own, or the name of a bundled one.

    Examples
    --------
    >>> profile_name("generic-grbl"), profile_name("/home/me/own.toml")
    ('generic-grbl.toml (comes with skinfab)', '/home/me/own.toml')
    """
    return str(Path(named)) if named.endswith(".toml") else f"{named}.toml (comes with skinfab)"


def _said(value: object) -> str:
    if value is None:
        return "none"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        return " x ".join(map(_said, value))
    if isinstance(value, float):
        return "no limit" if math.isinf(value) else f"{value:g}"
    return str(value)
