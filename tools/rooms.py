"""Print which rooms of the code import which (`python tools/rooms.py`), the table of docs/architecture.md; `--write` puts it there.

A room is a folder of a package, or what stands in a package itself; modules of `skinfab` that belong together are one. What is imported
only inside functions, so that it costs nothing until it is used, is in brackets; what only the types need is left out.
"""

from __future__ import annotations

import ast
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "architecture.md"
PACKAGES = ("skinfab", "gcode", "calibration", "gui")
#: When an import is done: with the file's own, when a function is called, never.
AT_ONCE, LATER, TYPES = "at once", "later", "types"
BEGIN, END = "<!-- rooms: tools/rooms.py --write -->\n", "<!-- end of rooms -->\n"

#: Everything may import these, so no row names them.
GROUND = "ground"
#: Modules of skinfab that are one room, from the ground up; others are a room of their own name.
TOGETHER = {
    GROUND: (
        *("__init__", "errors", "tolerances", "files", "toml_file", "strict_json", "decimals", "linalg", "paths", "material", "progress"),
        *("staging", "archive", "spreadsheet", "rates"),
    ),
    "strips": ("strip_fit", "strip_table", "strip_plate"),
    "skin": ("skin", "document", "document_parts"),
    "wires": ("wiring", "wired", "wire_exits", "wire_ways", "wire_choice"),
    "mould": ("mould", "mould_plan", "mould_taper"),
    "recipe": ("recipe", "work_order"),
    "cli": ("cli", "__main__"),
}
#: What makes the window of all the other rooms of gui; the rest of what stands in gui itself is what they share.
WINDOW = ("app", "desk")
_ROOM = {module: room for room, modules in TOGETHER.items() for module in modules}


def room_of(parts: tuple[str, ...]) -> str:
    """The room of a module, by the parts of its name.

    Examples
    --------
    >>> room_of(("skinfab", "mesh", "io")), room_of(("skinfab", "wire_ways")), room_of(("calibration", "strain", "lag"))
    ('mesh', 'wires', 'calibration/strain')
    >>> room_of(("gcode", "emit")), room_of(("gui", "app")), room_of(("gui", "theme"))
    ('gcode', 'gui/app', 'gui')
    """
    package, module = parts[0], (*parts, "__init__")[1]
    folder = (ROOT / package / module).is_dir()
    if package != "skinfab":
        return f"{package}/{module}" if folder else "gui/app" if package == "gui" and module in WINDOW else package
    is_module = folder or (ROOT / package / f"{module}.py").exists()  # and no name that the package itself holds
    return _ROOM.get(module, module) if is_module else GROUND


def imports(text: str) -> Iterator[tuple[tuple[str, ...], str]]:
    """The project's modules that a file imports, as parts of their names, and when: AT_ONCE, LATER or for TYPES."""
    for node, when in _statements(ast.parse(text).body, AT_ONCE):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [each.name for each in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [f"{node.module}.{each.name}" for each in node.names]
        for name in names:
            if (parts := tuple(name.split(".")))[0] in PACKAGES:
                yield parts, when


def _statements(body: list[ast.stmt], when: str) -> Iterator[tuple[ast.stmt, str]]:
    """Each statement, those inside others too, and when it is run."""
    for node in body:
        yield node, when
        inside = when
        if isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING"):
            inside = TYPES
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            inside = LATER
        for held in (node, *getattr(node, "handlers", ()), *getattr(node, "cases", ())):
            for part in ("body", "orelse", "finalbody"):
                yield from _statements(getattr(held, part, []), inside)


def rooms() -> dict[str, tuple[set[str], set[str]]]:
    """Of each room those it imports at once, and those it imports in functions only."""
    found: dict[str, tuple[set[str], set[str]]] = defaultdict(lambda: (set(), set()))
    for package in PACKAGES:
        for path in sorted((ROOT / package).rglob("*.py")):
            here = room_of(path.relative_to(ROOT).with_suffix("").parts)
            for parts, when in imports(path.read_text(encoding="utf-8")):
                if when != TYPES and (there := room_of(parts)) not in (here, GROUND):
                    found[here][(AT_ONCE, LATER).index(when)].add(there)
            if path.name != "__init__.py":
                found[here]  # a room that imports nothing is one too
    return {room: (at_once, later - at_once) for room, (at_once, later) in found.items()}


def table() -> str:
    """The rooms, those that import the fewest others, directly or not, first."""
    found = rooms()

    def below(room: str) -> set[str]:
        seen: set[str] = set()
        left = [room]
        while left:
            for there in set().union(*found[left.pop()]) - seen:
                seen.add(there)
                left.append(there)
        return seen

    height = {room: len(below(room)) for room in found}
    order = sorted((room for room in found if room != GROUND), key=lambda room: (height[room], room))
    rows = ["| room | imports (only inside functions) |", "|---|---|"]
    for room in order:
        at_once, later = ([each for each in order if each in some] for some in found[room])
        said = " · ".join(at_once) + (f" ({' · '.join(later)})" if later else "")
        rows.append(f"| {room} | {said.strip() or 'nothing but the ground'} |")
    return "\n".join(rows) + "\n"


def written(page: str) -> str:
    """The page with the table as it is now."""
    before, _, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not end:
        raise SystemExit(f"{PAGE.name} has no lines {BEGIN.strip()} and {END.strip()}; put them where the table is to be")
    return f"{before}{BEGIN}{table()}{END}{after}"


if __name__ == "__main__":
    if sys.argv[1:] == ["--write"]:
        PAGE.write_text(written(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
    else:
        sys.stdout.write(table())
