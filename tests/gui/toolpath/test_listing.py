"""The text, its marked line, and clicks on lines."""

import pytest

from gui.theme import DARK, LIGHT, apply
from gui.toolpath.listing import Listing


@pytest.fixture
def listing(root):
    apply(root, LIGHT)
    heard = []
    made = Listing(root, LIGHT, on_line=heard.append)
    made.heard = heard
    made.pack(fill="both", expand=True)
    root.geometry("400x120+0+0")
    made.show([f"G1 X{k}" for k in range(1, 501)])
    root.update()
    return made


def test_the_marked_line_is_seen_with_what_comes_next(root, listing):
    for line in (1, 250, 500, 3):
        listing.mark(line)
        root.update()
        assert listing.text.get(*listing.text.tag_ranges("now")).strip() == f"{line}  G1 X{line}"
        assert all(listing.text.bbox(f"{min(near, 500)}.0") for near in (line, line + 1))


def test_a_click_asks_for_its_line(root, listing):
    listing.mark(100)
    root.update()
    x, y, _, height = listing.text.bbox("101.0")
    listing.text.event_generate("<ButtonPress-1>", x=x + 5, y=y + height // 2)
    listing.text.event_generate("<ButtonRelease-1>", x=x + 5, y=y + height // 2)
    assert listing.heard == [101]


def test_it_cannot_be_changed_but_replaced(root, listing):
    listing.text.focus_force()
    listing.text.event_generate("<Key-a>")
    assert listing.text.get("1.0", "1.end") == "  1  G1 X1"
    listing.mark(7)
    listing.show(["G28"])
    assert listing.text.get("1.0", "end").strip() == "1  G28" and listing.marked == 0
    listing.show([])
    assert listing.text.get("1.0", "end").strip() == ""
    listing.restyle(DARK)
    assert str(listing.text.cget("background")) == DARK.field
