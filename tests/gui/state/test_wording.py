"""The library's sentences in the window's words: every one of them that names an option is known."""

import re
from pathlib import Path

import pytest

from gui.state.wording import WORDING, in_window

ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize("said", [said for said, _ in WORDING])
def test_no_wording_is_about_a_sentence_that_is_gone(said):
    """What stands between the numbers is in the library word for word."""
    sources = " ".join(re.sub(r'"\s*f?"', "", p.read_text()) for p in (ROOT / "skinfab").rglob("*.py"))
    for part in re.split(r"\(\[.*?\]\+\)", said):
        assert part in sources, part


def test_options_become_words():
    by_itself = "which rounds it off by itself"
    assert in_window(f"--thickness 2: it folds, give --thickness 0.96 or less, or leave it to skinfab make, {by_itself}") == (
        "a skin 2 mm thick: it folds, give 0.96 mm or less, "
        "or the thickness that the material pours, with which it is rounded off by itself"
    )
    assert (
        in_window("--wrap 8: the ball is larger than the object")
        == "the outside alone, by a ball of 8 mm: the ball is larger than the object"
    )
    assert in_window("C1 overlaps C2") == "C1 overlaps C2"
