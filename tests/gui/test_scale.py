"""What is written down for an ordinary screen is as large on a fine one."""

import pytest

from gui.scale import fitting, measured, px


class Screen:
    """A screen of a size and fineness."""

    def __init__(self, wide, high, dpi):
        self.wide, self.high, self.dpi = wide, high, dpi

    def winfo_screenwidth(self):
        return self.wide

    def winfo_screenheight(self):
        return self.high

    def winfo_fpixels(self, length):
        assert length == "1i"
        return self.dpi


def test_lengths_grow_with_the_dots_an_inch():
    assert [px(Screen(1280, 800, dpi), 50) for dpi in (96, 144, 192)] == [50, 75, 100]


@pytest.mark.parametrize(
    ("screen", "size"),
    [
        (Screen(3840, 2160, 192.0), (2552, 1468)),
        (Screen(1280, 800, 96.0), (1276, 734)),
        (Screen(1280, 800, 100.04), (1276, 734)),
        (Screen(2560, 1600, 240.0), (2552, 1468)),
        (Screen(1920, 1080, 96.0), (1276, 734)),
    ],
)
def test_a_window_begins_as_large_on_a_fine_screen_and_fits_it(screen, size):
    assert fitting(screen, (1276, 734)) == size


def test_a_heading_has_room_for_its_words(root):
    assert measured(root, "size, mm") > measured(root, "mm") > 12
