"""docs/where-it-fails.md knows every file of tests/stability, and every test that it names is there."""

import ast
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs/where-it-fails.md"


def named(page: str) -> dict[str, list[list[str]]]:
    """The rows under each file's heading: for each row the tests that its last cell names."""
    found: dict[str, list[list[str]]] = {}
    for section in re.split(r"^##+ ", page, flags=re.MULTILINE)[1:]:
        if heading := re.fullmatch(r".*: `(test_\w+\.py)`", section.partition("\n")[0]):
            rows = [line for line in section.splitlines() if line.startswith("| ")][1:]
            found[heading[1]] = [re.findall(r"`(test_\w+)`", row.split("|")[-2]) for row in rows]
    return found


def faults(page: str, there: dict[str, set[str]]) -> list[str]:
    """What the page lacks of the files there, and what it names that is not there."""
    rows = named(page)
    lacks = [f"{file} has no row" for file in there if not rows.get(file)]
    for file, tests in rows.items():
        lacks += [f"row {k + 1} of {file} names no test" for k, row in enumerate(tests) if not row]
        lacks += [f"{file} has no {test}" for row in tests for test in row if test not in there.get(file, set())]
    return lacks


@cache
def stability() -> dict[str, set[str]]:
    return {
        path.name: {node.name for node in ast.parse(path.read_text()).body if isinstance(node, ast.FunctionDef)}
        for path in sorted((ROOT / "tests/stability").glob("test_*.py"))
    }


def test_every_file_has_rows_and_every_test_is_there() -> None:
    assert faults(PAGE.read_text(), stability()) == []


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda page: page.replace(": `test_angle_fails.py`", ""), "test_angle_fails.py has no row"),
        (lambda page: page.replace("`test_ramp_of_720_degrees`", "`test_ramp`"), "test_seams_fail.py has no test_ramp"),
        (lambda page: page.replace("`test_ramp_of_720_degrees`", ""), "row 1 of test_seams_fail.py names no test"),
        (lambda page: page + "\n### Gone: `test_gone.py`\n\n| a |\n|---|\n| `test_one` |\n", "test_gone.py has no test_one"),
    ],
)
def test_what_is_missing_is_named(change: Callable[[str], str], says: str) -> None:
    assert says in faults(change(PAGE.read_text()), stability())
