"""The plan of the rooms holds: imports run one way, files stay readable, and the library does not print."""

import ast
import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parent.parent
MAX_LINES = 400


def tool() -> ModuleType:
    spec = importlib.util.spec_from_file_location("rooms", ROOT / "tools/rooms.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


ROOMS = tool()

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
    ("files", "toml_file", "strict_json", "decimals", "linalg", "paths", "material"),
    ("progress", "staging", "archive", "spreadsheet", "rates"),
    ("mesh", "patterns", "electrical", "readout", "strip_fit", "strip_table"),
    ("pieces", "flatten", "fingertip"),
    ("seams", "placement", "skin"),  # edits of seams and sensors take a skin and give one
    (
        *("document", "document_parts"),
        *("mould", "mould_plan", "mould_taper", "strip_plate", "wiring", "wired", "wire_exits", "wire_ways", "wire_choice"),
        *("recipe", "work_order", "drawings", "report", "bench"),
    ),
    ("cli", "batch", "__main__"),
)
FLOOR_OF = {room: k for k, rooms in enumerate(FLOORS) for room in rooms}


def sources() -> list[Path]:
    return sorted(p for package in ROOMS.PACKAGES for p in (ROOT / package).rglob("*.py"))


def room_of(parts: tuple[str, ...]) -> str:
    """The room of a file or module below skinfab: its folder, or its own name."""
    return parts[1].removesuffix(".py") if len(parts) > 1 else "__init__"


def backward_imports(path: Path, text: str) -> list[str]:
    """What is wrong with a file's imports, in words."""
    parts = path.parts
    package, in_cli = parts[0], parts[:2] == ("skinfab", "cli")
    wrong = []
    for target, when in ROOMS.imports(text):
        name = ".".join(target)
        if target[0] not in ALLOWED[package]:
            if not in_cli:
                wrong.append(f"{package} imports {name}")
            elif when == ROOMS.AT_ONCE:
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


def test_the_table_of_the_rooms_is_as_the_code_is() -> None:
    page = ROOMS.PAGE.read_text(encoding="utf-8")
    assert page == ROOMS.written(page), "run tools/rooms.py --write"
    rows = dict(line.strip("| ").split(" | ") for line in ROOMS.table().splitlines()[2:])
    assert rows["mesh"] == "nothing but the ground" and "gcode" in rows["gui/state"]
    assert "gcode" not in rows["cli"].split("(")[0] and "gcode" in rows["cli"], "only inside functions"


def test_when_an_import_is_done() -> None:
    text = "import gcode\nif TYPE_CHECKING:\n    import gui\nclass A:\n    import skinfab.mesh\n    def f():\n        import calibration\n"
    found = {parts[0]: when for parts, when in ROOMS.imports(text + "import numpy")}
    assert found == {"gcode": "at once", "gui": "types", "skinfab": "at once", "calibration": "later"}


def test_a_print_is_found() -> None:
    assert printing("x = 1\nprint(x)\n") == [2] and printing("reprint(1)\n") == []
