"""What docs/papers.md names is there: each function can be imported, each test exists, each picture is a file."""

import ast
import importlib
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs/papers.md"


@cache
def defined_in(path: Path) -> frozenset[str]:
    nodes = ast.parse(path.read_text()).body if path.is_file() else []
    return frozenset(node.name for node in nodes if isinstance(node, ast.FunctionDef))


def is_there(name: str) -> bool:
    module, _, attribute = name.rpartition(".")
    try:
        return hasattr(importlib.import_module(module), attribute)
    except ModuleNotFoundError:
        return False


def faults(page: str) -> list[str]:
    """Every name of a row that leads nowhere, and every row that names no function or no test."""
    lacks = []
    for section in re.split(r"^## ", page, flags=re.MULTILINE)[1:]:
        rooms = re.search(r"Functions are in `(.+)`, tests in `(.+)`", section)
        package, folder = (rooms[1] + ".", rooms[2]) if rooms else ("", "tests")
        for row in [line for line in section.splitlines() if line.startswith("| ")][1:]:
            paper, _, functions, tests, figures = (cell.strip() for cell in row.strip("|").split("|"))
            named, held = re.findall(r"`([\w.]+)`", functions), re.findall(r"`([\w/.]+)::(\w+)`", tests)
            lacks += [f"{paper} names no function"] * (not named) + [f"{paper} names no test"] * (not held)
            lacks += [f"{paper}: no {package + name}" for name in named if not is_there(package + name)]
            lacks += [f"{paper}: no {file}::{test}" for file, test in held if test not in defined_in(ROOT / folder / file)]
            lacks += [f"{paper}: no {link}" for link in re.findall(r"\]\((.+?)\)", figures) if not (PAGE.parent / link).is_file()]
    return lacks


def test_all_that_is_named_is_there() -> None:
    assert faults(PAGE.read_text()) == []
    assert PAGE.read_text().count("::") > 80


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda page: page.replace("`published.histograms`", "`published.histogram`"), "no skinfab.fingertip.nail.published.histogram"),
        (lambda page: page.replace("`gcode.emit.emit`", "`gcode.emitted.emit`"), "II.B: no gcode.emitted.emit"),
        (lambda page: page.replace("::test_d_is_equation_1`", "::test_d`"), "eq. 1: no flatten/test_distortion.py::test_d"),
        (lambda page: page.replace("`skinfab.recipe.recipe`", ""), "II.C names no function"),
        (lambda page: page.replace("`test_fits.py::test_exact_contacts_give_the_exact_shape`", ""), "fig. 12 names no test"),
        (lambda page: page.replace("pictures/force_solids.png", "pictures/solids.png"), "section 6.2, fig. 16: no pictures/solids.png"),
    ],
)
def test_what_leads_nowhere_is_named(change: Callable[[str], str], says: str) -> None:
    assert any(says in fault for fault in faults(change(PAGE.read_text())))
