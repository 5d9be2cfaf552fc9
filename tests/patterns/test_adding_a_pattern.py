"""docs/patterns.md: its example is a pattern as soon as its file is there, and the page is in step with the code."""

import os
import re
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from skinfab.drawings.catalogue import as_markdown
from skinfab.drawings.pattern_picture import pattern_svg
from skinfab.patterns.registry import PATTERNS, make_pattern

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/patterns.md").read_text(encoding="utf-8")

#: What stands for copying the file into the package: its folder is one more that patterns are found in.
DROP_IN = "import skinfab.patterns\nskinfab.patterns.__path__.append({folder!r})\n"


@pytest.fixture(scope="module")
def dropped(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The environment in which the page's file lies beside the other patterns, for Python started with ``-c "import drop_in"``."""
    folder = tmp_path_factory.mktemp("dropped")
    (folder / "patterns").mkdir()
    code = re.search(r"```python\n(.*?)```", PAGE, re.S)[1]
    assert code.count("\n") < 60
    (folder / "patterns/contact_ring.py").write_text(code)
    (folder / "drop_in.py").write_text(DROP_IN.format(folder=str(folder / "patterns")))
    return {**os.environ, "PYTHONPATH": str(folder)}


def run(environment: dict[str, str], *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, cwd=ROOT, env=environment, timeout=600)


def skinfab(environment: dict[str, str], *commands: Sequence[object]) -> subprocess.CompletedProcess[str]:
    """One `skinfab` after the other in one process, as long as they go well."""
    program = "import sys, drop_in; from skinfab.cli.main import main; sys.exit(next((bad for c in {!r} if (bad := main(c))), 0))"
    return run(environment, "-c", program.format([[str(word) for word in command] for command in commands]))


def test_without_the_file_there_is_no_such_pattern() -> None:
    assert "contact-ring" not in PATTERNS


def test_the_command_line_takes_it_as_far_as_the_gcode(
    dropped: dict[str, str], cut_once: Callable[[str, Path], Path], tmp_path: Path
) -> None:
    asked = next(text for text in re.findall(r"```toml\n(.*?)```", PAGE, re.S) if "contact-ring" in text)
    (tmp_path / "ring.toml").write_text(asked)
    document = cut_once("cube", tmp_path / "a.skin")
    made = skinfab(
        dropped,
        ["place", "--patterns"],
        ["place", document, "--sensors", tmp_path / "ring.toml"],
        ["place", document, "--list"],
        ["gcode", document, "-o", tmp_path / "out"],
    )
    assert made.returncode == 0, made.stderr
    said = made.stdout
    assert "\ncontact-spiral (contact)" in f"\n{said}" and "contact-ring (contact): One ring between two leads." in said
    assert re.search(r"^  d     mm      Diameter of the ring; at least 2 b\. Must be given\.$", said, re.M)
    assert "\nC1: contact-ring on P1 at " in said
    assert "G3 " in (tmp_path / "out/P1.gcode").read_text()


def test_the_property_tests_run_over_it(dropped: dict[str, str]) -> None:
    files = [str(path.relative_to(ROOT)) for path in sorted((ROOT / "tests/patterns").glob("test_every_pattern*.py"))]
    done = run(dropped, "-m", "pytest", "-q", "-p", "drop_in", "-p", "no:cacheprovider", "-p", "no:xdist", *files, "-k", "contact-ring")
    ran = re.search(r"(\d+) passed, \d+ deselected", done.stdout)
    assert done.returncode == 0 and ran and int(ran[1]) == 12, done.stdout


def test_two_of_one_kind_are_refused(dropped: dict[str, str], tmp_path: Path) -> None:
    twin = Path(dropped["PYTHONPATH"], "patterns/contact_ring.py").read_text()
    (tmp_path / "ring_again.py").write_text(twin)
    program = f"import drop_in, skinfab.patterns as p; p.__path__.append({str(tmp_path)!r}); import skinfab.patterns.registry"
    done = run(dropped, "-c", program)
    assert "two patterns are of kind 'contact-ring': in skinfab.patterns.contact_ring and in skinfab.patterns.ring_again" in done.stderr


def test_the_page_is_in_step_with_the_patterns() -> None:
    assert as_markdown(pictures="pictures") in PAGE, "run tools/draw_patterns.py"


@pytest.mark.parametrize("kind", PATTERNS)
def test_the_picture_is_in_step_with_the_pattern(kind: str) -> None:
    drawn = (ROOT / f"docs/pictures/pattern-{kind}.svg").read_text(encoding="utf-8")
    assert drawn == pattern_svg(make_pattern(kind, PATTERNS[kind].example)), "run tools/draw_patterns.py"
