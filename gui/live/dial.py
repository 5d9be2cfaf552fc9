"""The joint's angle as a needle and a number."""

from __future__ import annotations

import math
import tkinter as tk

from gui.theme import Theme

#: Size, pixels at 96 dots an inch.
_WIDTH, _HEIGHT, _RADIUS = 150, 92, 62
#: The dial's ends, deg.
_LEAST, _MOST = 0.0, 120.0


class Dial(tk.Canvas):
    """Half a clock: 0 degrees at the left end, 120 at the right.

    Parameters
    ----------
    master : widget
    theme : Theme
    """

    def __init__(self, master: tk.Misc, theme: Theme) -> None:
        self._dpi = master.winfo_fpixels("1i") / 96
        super().__init__(master, name="dial", width=self._px(_WIDTH), height=self._px(_HEIGHT), highlightthickness=0, borderwidth=0)
        self._theme = theme
        self._shown = math.nan, "", 0.0, 0.0, False
        self.restyle(theme)

    def restyle(self, theme: Theme) -> None:
        """Other colours."""
        self._theme = theme
        self.configure(background=theme.panel)
        self._draw()

    def show(self, angle: float, words: str, low: float, high: float, *, doubtful: bool = False) -> None:
        """Show an angle, NaN for none, in deg, on a dial whose range from `low` to `high` is known; `words` stand below it."""
        shown = angle, words, low, high, doubtful
        if shown == self._shown:
            return
        self._shown = shown
        self._draw()

    def _draw(self) -> None:
        angle, words, low, high, doubtful = self._shown
        theme, r = self._theme, self._px(_RADIUS)
        x, y = self._px(_WIDTH) / 2, self._px(_RADIUS) + self._px(6)
        box = (x - r, y - r, x + r, y + r)
        self.delete("all")
        wide = self._px(7)
        self.create_arc(*box, start=0, extent=180, style="arc", outline=theme.border, width=wide)
        if high > low:
            first, last = _turn(low), _turn(high)
            self.create_arc(*box, start=last, extent=first - last, style="arc", outline=theme.accent, width=wide)
        colour = theme.warning if doubtful else theme.text
        if not math.isnan(angle):
            turn = math.radians(_turn(min(max(angle, _LEAST), _MOST)))
            near, far = 0.62 * r, 1.06 * r  # beside the number, across the dial
            ends = (x + near * math.cos(turn), y - near * math.sin(turn), x + far * math.cos(turn), y - far * math.sin(turn))
            self.create_line(*ends, fill=theme.select, width=self._px(4))
        number = "-" if math.isnan(angle) else f"{angle:.1f}\N{DEGREE SIGN}"
        self.create_text(x, y - r * 0.2, text=number, fill=colour, font=("TkDefaultFont", -self._px(20), "bold"))
        self.create_text(x, y + self._px(13), text=words, fill=colour if doubtful else theme.faint, font=("TkDefaultFont", -self._px(11)))

    def _px(self, pixels: float) -> int:
        return round(pixels * self._dpi)


def _turn(angle: float) -> float:
    """Direction of an angle on the dial, deg from its right end up.

    Examples
    --------
    >>> _turn(0.0), _turn(60.0), _turn(120.0)
    (180.0, 90.0, 0.0)
    """
    return 180.0 * (1 - (angle - _LEAST) / (_MOST - _LEAST))
