"""What is written down for an ordinary screen is as large on a fine one."""

from gui.scale import px


class Screen:
    def __init__(self, dpi):
        self.dpi = dpi

    def winfo_fpixels(self, length):
        assert length == "1i"
        return self.dpi


def test_lengths_grow_with_the_dots_an_inch():
    assert [px(Screen(dpi), 50) for dpi in (96, 144, 192)] == [50, 75, 100]
