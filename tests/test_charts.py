"""docs/charts.md: every chart of a benchmark, with the reason that its picture gives for the default, drawn by the code as it is."""

import re
from pathlib import Path

from PIL import Image

from skinfab.cli.bench import NAMES

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs/charts.md"
ROW = re.compile(r"^\| \[(.+?)\]\((pictures/\S+\.png)\) \| `(skinfab bench .+?)` \| (.+?) \| (.+) \|$", re.MULTILINE)
MARK = "The default is "


def described(picture: Path) -> str:
    with Image.open(picture) as opened:
        return str(opened.info.get("Description", ""))


def test_every_row_gives_the_reason_that_its_picture_gives() -> None:
    rows = ROW.findall(PAGE.read_text())
    assert len(rows) == sum(line.startswith("| [") for line in PAGE.read_text().splitlines())
    for chart, picture, _, _, why in rows:
        assert described(PAGE.parent / picture) == f"{MARK}{why}.", chart


def test_every_benchmark_has_a_chart_that_marks_its_default() -> None:
    assert {command.split()[2] for _, _, command, _, _ in ROW.findall(PAGE.read_text())} == set(NAMES)


def test_every_picture_that_marks_a_default_is_on_the_page() -> None:
    listed = [picture for _, picture, _, _, _ in ROW.findall(PAGE.read_text())]
    marking = {f"pictures/{each.name}" for each in (PAGE.parent / "pictures").glob("*.png") if described(each).startswith(MARK)}
    assert sorted(listed) == sorted(marking)


def test_the_pictures_are_shown_where_their_figures_are() -> None:
    """The page that a row points to shows the picture, or links to it."""
    for chart, picture, _, words, _ in ROW.findall(PAGE.read_text()):
        (page,) = re.findall(r"\]\((\w+\.md)(?:#[\w-]+)?\)", words)
        assert f"]({picture})" in (PAGE.parent / page).read_text(), chart
