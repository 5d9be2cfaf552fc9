"""docs/licences.md is what the locked packages state, and none of it keeps skinfab from being passed on."""

import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

#: What may stand in one work with GPL-3.0-or-later; a licence that is not here is read by somebody first.
COMBINES = {
    *("MIT", "MIT-CMU", "0BSD", "BSD", "BSD-2-Clause", "BSD-3-Clause", "Apache-2.0", "Apache-2.0 WITH LLVM-exception", "Zlib", "CC0-1.0"),
    *("PSF-2.0", "PSF-based (matplotlib)", "MPL-2.0", "GPL-3.0", "GPL-3.0-or-later"),
}


@pytest.fixture(scope="module")
def page() -> str:
    sys.path.insert(0, str(ROOT / "tools"))
    try:
        import licences

        return licences.table()
    finally:
        sys.path.remove(str(ROOT / "tools"))


def rows(text: str) -> list[tuple[str, str, str]]:
    cells = (line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| "))
    return [(re.sub(r"\[(.*?)\]\(.*", r"\1", cell[0]), cell[1], cell[2]) for cell in cells if cell[0] != "package"]


def test_the_page_is_what_the_packages_state(page: str) -> None:
    assert (ROOT / "docs/licences.md").read_text(encoding="utf-8") == page, "run make lock"


def test_every_locked_package_is_listed(page: str) -> None:
    lock = (ROOT / "requirements.lock").read_text(encoding="utf-8").splitlines()[1:]
    assert [f"{name}=={version}" for name, version, _ in rows(page)] == lock


def test_every_licence_combines_with_the_gpl(page: str) -> None:
    for name, _, licence in rows(page):
        assert set(re.split(r" AND | OR ", licence)) <= COMBINES, f"{name}: {licence}"
