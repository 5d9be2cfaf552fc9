"""Draws every pattern into docs/pictures and writes the catalogue in docs/patterns.md anew: `make pictures` runs it."""

from __future__ import annotations

from pathlib import Path

from skinfab.drawings.catalogue import as_markdown
from skinfab.drawings.pattern_picture import pattern_svg
from skinfab.files import atomic_write
from skinfab.patterns.registry import PATTERNS, make_pattern

DOCS = Path(__file__).resolve().parent.parent / "docs"
BEGIN, END = "<!-- catalogue: written by tools/draw_patterns.py -->\n", "<!-- end of catalogue -->"


def main() -> None:
    for kind, cls in PATTERNS.items():
        atomic_write(DOCS / "pictures" / f"pattern-{kind}.svg", pattern_svg(make_pattern(kind, cls.example)))
    page = DOCS / "patterns.md"
    before, rest = page.read_text(encoding="utf-8").split(BEGIN)
    atomic_write(page, f"{before}{BEGIN}\n{as_markdown(pictures='pictures')}\n{END}{rest.split(END)[1]}")


if __name__ == "__main__":
    main()
