"""docs/extending.md: its way to flatten is one like the others as soon as it has a name, its source is read as a port."""

import importlib
import re
import runpy
import sys
from pathlib import Path
from typing import Any

import pytest

import skinfab.flatten
from skinfab.flatten.methods import METHODS

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs/extending.md").read_text()
MODULE, *EXAMPLES = re.findall(r"^```python\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)


@pytest.fixture
def added(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """The page's file beside the other ways, and its line in their table; the name."""
    (tmp_path / "mean_value.py").write_text(MODULE)
    monkeypatch.setattr(skinfab.flatten, "__path__", [*skinfab.flatten.__path__, str(tmp_path)])
    name, place = re.search(r'^    "(.+)": "(.+:.+)",$', PAGE, re.MULTILINE).groups()  # type: ignore[union-attr]
    assert name not in METHODS
    monkeypatch.setitem(METHODS, name, place)
    importlib.invalidate_caches()
    monkeypatch.setitem(sys.modules, place.split(":")[0], importlib.import_module(place.split(":")[0]))
    return str(name)


def all_of(varied: dict[str, Any]) -> list[dict[str, Any]]:
    """Every choice of what a test is asked of, by argument."""
    choices: list[dict[str, Any]] = [{}]
    for names, values in varied.items():
        keys = [names] if isinstance(names, str) else list(names)
        choices = [c | dict(zip(keys, [v] if len(keys) == 1 else v, strict=True)) for c in choices for v in values]
    return choices


def test_it_is_asked_what_all_are_asked(added: str) -> None:
    asked, count = runpy.run_path(str(ROOT / "tests/flatten/test_methods.py")), 0
    for name, function in asked.items():
        varied = {mark.args[0]: mark.args[1] for mark in getattr(function, "pytestmark", [])}
        if name.startswith("test_") and "name" in varied:
            assert added in varied.pop("name")
            for others in all_of(varied):
                function(added, **others)
                count += 1
    assert count > 15


def test_the_examples_run(added: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(ROOT)
    exec(compile("\n".join(EXAMPLES), "docs/extending.md", "exec"), {"__name__": "extending"})
    said = capsys.readouterr().out.split()
    assert said == ["isometric", said[1], "0", added, said[1], "0"] and f"both come to {said[1]}" in PAGE
