"""docs/printers.md: its tables are what the code is."""

import math
import re
import sys
from dataclasses import MISSING, fields, is_dataclass
from pathlib import Path
from types import NoneType
from typing import Any, get_args, get_type_hints

sys.path.insert(0, str(Path(__file__).parent))
from findings_in_source import MODULES, findings, modules_with_findings

from gcode.check import check_text
from gcode.printer import Printer, load_printer

DOCS = Path(__file__).parents[2] / "docs/printers.md"


def rows(heading: str) -> list[list[str]]:
    """Cells of the first table under a heading."""
    section = DOCS.read_text(encoding="utf-8").partition(f"## {heading}\n")[2].partition("\n## ")[0]
    lines = re.search(r"(?:^\|.*\n)+", section, re.MULTILINE)
    assert lines, heading
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[0].splitlines()[2:]]


def declared(kind: Any, above: str = "") -> dict[str, Any]:
    """Every field of a profile and its default, in order."""
    found: dict[str, Any] = {}
    for field in fields(kind):
        hint = get_type_hints(kind)[field.name]
        hint = get_args(hint)[0] if NoneType in get_args(hint) else hint
        if is_dataclass(hint):
            found |= declared(hint, f"{above}{field.name}.")
        else:
            found[above + field.name] = field.default
    return found


def shown(value: Any) -> str:
    """A value as the table has it."""
    if value is MISSING:
        return ""
    if value is None:
        return "none"
    if isinstance(value, tuple):
        return " x ".join(map(shown, value))
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return "inf" if math.isinf(value) else f"{value:g}"
    return str(value)


def bundled(field: str) -> Any:
    found: Any = load_printer("generic-grbl") if field.startswith("spindle.") else load_printer()
    for key in field.split("."):
        found = None if found is None else getattr(found, key)
    return "its own" if field == "name" else found


def test_the_table_has_every_field_with_its_default() -> None:
    table = {row[0].strip("`"): row for row in rows("Every field")}
    expected = {"extends": None} | declared(Printer)
    assert list(table) == list(expected)
    assert {name: row[2] for name, row in table.items()} == {name: shown(default) for name, default in expected.items()}


def test_the_table_has_what_the_bundled_profiles_say() -> None:
    table = {row[0].strip("`"): row[3] for row in rows("Every field") if row[0] != "`extends`"}
    assert table == {name: shown(bundled(name)) for name in table}


def test_each_length_speed_and_flow_has_its_unit() -> None:
    units = {row[0].strip("`"): row[1] for row in rows("Every field")}
    assert [name for name, unit in units.items() if not unit] == ["extends", "name", "arcs", "home"]
    assert {units[name] for name in units if name.endswith("speed")} == {"mm/s"}
    assert {units[name] for name in units if "flow_" in name} == {"mm^3/s"}


def test_the_table_has_every_finding_with_its_remedy() -> None:
    wanted = [list(finding) for finding in findings()]
    table = "\n".join(f"| {' | '.join(row)} |" for row in wanted)
    assert rows("Checking a file") == wanted, f"under 'Every finding' in docs/printers.md should be:\n{table}"
    assert modules_with_findings() == set(MODULES)
    assert len(wanted) > 60


def test_what_is_found_is_in_the_table() -> None:
    """Read from the source, a finding is what a file is really told."""
    text = (
        "G28\nM92 X3\nM83\nG0 X400 Y10 F600\nG0 Z1.6\nG1 X300 E900\nG2 X300 Y20 I5 J0 E1\nG1 X250 E-3\nM3 P1\nM104 S200\nG38.2 Z0\nT1\nG90"
    )
    rules = [
        re.compile(".+".join(map(re.escape, re.split("…|raises/lowers|more/less|bed/machine", row[1])))) for row in rows("Checking a file")
    ]
    for name in ("ender5plus-vipro", "generic-grbl"):
        found = check_text(text, load_printer(name))
        assert len({f.kind for f in found}) > 8
        assert [f.what for f in found if not any(rule.fullmatch(f.what) for rule in rules)] == []
