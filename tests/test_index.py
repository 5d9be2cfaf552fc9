"""docs/index.md knows every page, and every link of the docs leads somewhere: to a file, and to a heading of it."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", ROOT / "benchmarks/README.md", *sorted(DOCS.glob("*.md"))]


def links(page: str) -> list[str]:
    """Where the links of a page lead that are no addresses; what is code is none."""
    text = re.sub(r"^```.*?^```|`[^`\n]*`", "", page, flags=re.DOTALL | re.MULTILINE)
    return [link for link in re.findall(r"\]\(([^)\s]+)\)", text) if "://" not in link]


def headings(page: str) -> set[str]:
    """The anchors of a page's headings, as its viewer makes them: lower case, spaces to hyphens, other signs gone."""
    text = re.sub(r"^```.*?^```", "", page, flags=re.DOTALL | re.MULTILINE)
    titles = (re.sub(r"\[(.*?)\]\(.*?\)", r"\1", title) for title in re.findall(r"^#+ (.+)$", text, re.MULTILINE))
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def astray(page: Path, text: str) -> list[str]:
    """Links of a page that lead nowhere."""
    found = []
    for link in links(text):
        path, _, anchor = link.partition("#")
        target = page.parent / path if path else page
        there = target.exists() and (not anchor or anchor in headings(target.read_text() if path else text))
        found += [link] * (not there)
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_link_leads_somewhere(page: Path) -> None:
    assert astray(page, page.read_text()) == []


def test_the_index_knows_every_page() -> None:
    listed = {link.partition("#")[0] for link in links((DOCS / "index.md").read_text())}
    assert {page.name for page in DOCS.glob("*.md")} - listed == {"index.md"}


def test_what_leads_nowhere_is_found() -> None:
    text = "# A b: `c`\n[x](#a-b-c) [y](#gone) [z](gone.md) [u](https://a.b/c) `[v](code.md)` [w](seams.md#gone) ![p](pictures/gone.png)\n"
    assert astray(DOCS / "index.md", text) == ["#gone", "gone.md", "seams.md#gone", "pictures/gone.png"]
