"""The plan of the rooms holds: imports run one way, files stay readable, and the library does not print."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("skinfab", "gcode", "gui", "calibration")
MAX_LINES = 400

#: Who may import whom among the four packages.
ALLOWED = {
    "skinfab": {"skinfab"},
    "gcode": {"skinfab", "gcode"},
    "calibration": {"skinfab", "calibration"},
    "gui": {"skinfab", "gcode", "calibration", "gui"},
}

#: Inside skinfab, ground floor first. A room imports its own floor and those below; `skinfab/cli` is the roof.
FLOORS = (
    ("errors", "tolerances", "__init__"),
    ("files", "toml_file", "decimals", "linalg", "paths", "material", "progress", "staging", "archive", "spreadsheet", "rates"),
    ("mesh", "patterns", "electrical", "readout", "strip_fit", "strip_table"),
    ("pieces", "flatten", "fingertip"),
    ("seams", "placement", "skin"),  # edits of seams and sensors take a skin and give one
    (
        *("document", "document_parts"),
        *("mould", "mould_plan", "mould_taper", "strip_plate", "wiring", "wired", "wire_exits", "wire_ways", "wire_choice"),
        *("recipe", "work_order", "drawings", "report"),
    ),
    ("cli", "bench", "batch", "__main__"),
)
FLOOR_OF = {room: k for k, rooms in enumerate(FLOORS) for room in rooms}


def sources() -> list[Path]:
    return sorted(p for package in PACKAGES for p in (ROOT / package).rglob("*.py"))


def imported(tree: ast.Module) -> Iterator[tuple[str, bool]]:
    """Every module a file imports, and whether it does so when it is itself imported."""
    for node, at_import in statements(tree.body):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name, at_import
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "imports are absolute here"
            for alias in node.names:
                yield f"{node.module}.{alias.name}", at_import


def statements(body: list[ast.stmt], at_import: bool = True) -> Iterator[tuple[ast.stmt, bool]]:
    """Each statement, those inside others too, and whether it is run when the file is imported."""
    for node in body:
        yield node, at_import
        inside = at_import and not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and not is_type_checking(node)
        for held in (node, *getattr(node, "handlers", ()), *getattr(node, "cases", ())):
            for part in ("body", "orelse", "finalbody"):
                yield from statements(getattr(held, part, []), inside)


def is_type_checking(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING")


def room_of(parts: tuple[str, ...]) -> str:
    """The room of a file or module below skinfab: its folder, or its own name."""
    return parts[1].removesuffix(".py") if len(parts) > 1 else "__init__"


def backward_imports(path: Path, text: str) -> list[str]:
    """What is wrong with a file's imports, in words."""
    parts = path.parts
    package, in_cli = parts[0], parts[:2] == ("skinfab", "cli")
    wrong = []
    for name, at_import in imported(ast.parse(text)):
        target = tuple(name.split("."))
        if target[0] not in PACKAGES:
            continue
        if target[0] not in ALLOWED[package]:
            if not in_cli:
                wrong.append(f"{package} imports {name}")
            elif at_import:
                wrong.append(f"the command line imports {name} at once; import it inside the function")
        elif package == target[0] == "skinfab":
            here, there = room_of(parts), room_of(target) if len(target) > 1 and target[1] in FLOOR_OF else "__init__"
            if FLOOR_OF[there] > FLOOR_OF[here]:
                wrong.append(f"{here} imports {there}, which is a floor above")
    return wrong


def printing(text: str) -> list[int]:
    """Lines of a file that print."""
    if "print" not in text:
        return []
    calls = (n for n in ast.walk(ast.parse(text)) if isinstance(n, ast.Call))
    return [n.lineno for n in calls if isinstance(n.func, ast.Name) and n.func.id == "print"]


@pytest.mark.parametrize("path", sources(), ids=lambda p: str(p.relative_to(ROOT)))
def test_file_keeps_to_the_plan(path: Path) -> None:
    text, relative = path.read_text(encoding="utf-8"), path.relative_to(ROOT)
    assert backward_imports(relative, text) == []
    assert text.count("\n") <= MAX_LINES
    if relative.parts[:2] != ("skinfab", "cli"):
        assert printing(text) == []


def test_every_room_has_its_floor() -> None:
    rooms = {room_of(p.relative_to(ROOT).parts) for p in (ROOT / "skinfab").rglob("*.py")}
    assert rooms <= set(FLOOR_OF)


@pytest.mark.parametrize(
    ("path", "text", "says"),
    [
        ("skinfab/skin.py", "import gcode", "skinfab imports gcode"),
        ("skinfab/mesh/io.py", "def f():\n    from gui.window import Window", "skinfab imports gui.window.Window"),
        ("skinfab/cli/make.py", "from gcode import marlin", "at once"),
        ("skinfab/cli/make.py", "try:\n    pass\nexcept OSError:\n    import gcode", "at once"),
        (
            "skinfab/skin.py",
            "def f(x):\n    with x:\n        match x:\n            case 1:\n                import gcode",
            "skinfab imports gcode",
        ),
        ("gcode/marlin.py", "from calibration import mocap", "gcode imports calibration.mocap"),
        ("calibration/mocap/angle.py", "import gcode.program", "calibration imports gcode.program"),
        ("skinfab/paths.py", "from skinfab.mesh.model import Mesh", "a floor above"),
        ("skinfab/mesh/model.py", "from skinfab import skin", "a floor above"),
    ],
)
def test_an_arrow_that_runs_backwards_is_found(path: str, text: str, says: str) -> None:
    assert any(says in wrong for wrong in backward_imports(Path(path), text))


def test_arrows_that_run_forwards_are_free() -> None:
    assert backward_imports(Path("skinfab/cli/make.py"), "def run(args):\n    from gcode.marlin import emit\n    return emit") == []
    assert backward_imports(Path("gui/window.py"), "import numpy, gcode.program\nfrom skinfab.skin import Skin") == []
    assert (
        backward_imports(Path("skinfab/cli/make.py"), "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import gcode.program") == []
    )


def test_a_print_is_found() -> None:
    assert printing("x = 1\nprint(x)\n") == [2] and printing("reprint(1)\n") == []
