"""Every field of every profile is listed once, with a unit."""

from dataclasses import fields, is_dataclass

import pytest

from gcode.printer import Printer, load_printer
from gcode.profile import bundled_printers
from gui.toolpath.settings import GROUPS, UNITS, settings


def all_fields(printer: Printer) -> set[tuple[str, str]]:
    found = set()
    for field in fields(Printer):
        value = getattr(printer, field.name)
        if is_dataclass(value):
            found |= {(field.name, inner.name.replace("_", " ")) for inner in fields(value)}
        elif field.name != "name" and value is not None:
            found.add(("", field.name))
    return found


@pytest.mark.parametrize("name", bundled_printers())
def test_all_of_a_profile_is_listed_once(name: str) -> None:
    printer = load_printer(name)
    listed = [(s.group, s.name) for s in settings(printer)]
    assert len(set(listed)) == len(listed) and set(listed) == all_fields(printer)


def test_values_and_units_as_the_profile_has_them() -> None:
    said = {(s.group, s.name): (s.value, s.unit) for s in settings(load_printer())}
    assert said["bed", "size"] == ("350 x 350", "mm") and said["heights", "print"] == ("1.6", "mm")
    assert said["motion", "acceleration"] == ("500", "mm/s²") and said["", "arcs"] == ("yes", "")
    grbl = {(s.group, s.name): (s.value, s.unit) for s in settings(load_printer("generic-grbl"))}
    assert grbl["pump", "max e"] == ("no limit", "mm of E") and ("spindle", "s max") in grbl


def test_no_unit_is_of_a_field_that_is_gone() -> None:
    tables = {name: kind for name, kind in Printer.__annotations__.items() if name in GROUPS}
    assert set(GROUPS) - {""} == set(tables)
    assert all("." in key or key in Printer.__annotations__ for key in UNITS)
