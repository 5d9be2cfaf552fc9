"""What lies over the picture on the canvas: labels, the cross of axes, the scale, the bar of colours."""

from __future__ import annotations

import tkinter as tk
from dataclasses import replace
from tkinter import font
from typing import Literal

import numpy as np

from gui.shades import CHECK_MM, HEAT_RANGE, heat
from gui.theme import Theme
from gui.view3d.camera import Camera
from gui.view3d.labels import Label, without_overlap

#: x, y and z, so that they can be told on light and on dark.
_AXES = (("x", "#d2404a"), ("y", "#2f9e4f"), ("z", "#3f7fe0"))

#: Length of the scale, pixels at 96 dots per inch: the roundest number of millimetres up to it.
_SCALE = 150

#: Height and number of steps of the bar of colours.
_BAR = (12, 40)


def round_length(most: float) -> float:
    """The largest of 1, 2, 5, 10, ... that is not larger.

    Examples
    --------
    >>> round_length(37.0), round_length(0.3), round_length(5.0)
    (20.0, 0.2, 5.0)
    """
    power = 10.0 ** np.floor(np.log10(most))
    return float(max(step for step in (1, 2, 5) if step * power <= most * (1 + 1e-12)) * power)


class Furniture:
    """Items of a canvas, kept and moved instead of made anew.

    Parameters
    ----------
    canvas : tk.Canvas
    dpi : float
        Multiplies sizes: 1 at 96 dots per inch.
    """

    def __init__(self, canvas: tk.Canvas, *, dpi: float) -> None:
        self._canvas, self._dpi = canvas, dpi
        self._font = font.nametofont("TkSmallCaptionFont", root=canvas).copy()
        self._bold = self._font.copy()
        self._bold.configure(weight="bold")
        self._pool: list[tuple[int, int]] = []
        self._looks: dict[int, tuple[Label, str] | None] = {}
        self._legend: tuple[str, str, int] | None = None
        self._sizes: dict[tuple[str, str], tuple[float, float]] = {}

    def labels(self, labels: list[Label], theme: Theme) -> None:
        """Show these, as many as find room."""
        width, height = self._canvas.winfo_width(), self._canvas.winfo_height()
        inside = [label for label in labels if 0 < label.x < width and 0 < label.y < height]
        shown = without_overlap(inside, self._size)
        while len(self._pool) < len(shown):
            self._pool.append((self._canvas.create_rectangle(0, 0, 0, 0), self._canvas.create_text(0, 0)))
        looks: list[tuple[Label, str] | None] = [(replace(label, x=0.0, y=0.0), theme.name) for label in shown]
        for k, (box, text) in enumerate(self._pool):
            look = looks[k] if k < len(shown) else None
            if look != self._looks.get(k):  # most labels only move
                self._looks[k] = look
                self._dress(box, text, look[0] if look else None, theme)
            if look is not None:
                w, h = self._size(look[0])
                # Along the border a label moves inward, so that nothing is cut off.
                x = min(max(shown[k].x, w / 2 + 2), max(width - w / 2 - 2, w / 2 + 2))
                y = min(max(shown[k].y, h / 2 + 2), max(height - h / 2 - 2, h / 2 + 2))
                self._canvas.coords(box, x - w / 2, y - h / 2, x + w / 2, y + h / 2)
                self._canvas.coords(text, x, y)

    def _dress(self, box: int, text: int, label: Label | None, theme: Theme) -> None:
        if label is None:
            for item in (box, text):
                self._canvas.itemconfigure(item, state="hidden", tags=())
            return
        seam = label.kind == "seam"
        used = self._bold if label.kind == "piece" else self._font
        self._canvas.itemconfigure(box, fill=theme.panel, outline=theme.seam if seam else theme.border, state="normal", tags=("label",))
        self._canvas.itemconfigure(
            text, text=label.text, fill=theme.seam if seam else theme.text, font=used, state="normal", tags=("label", label.kind)
        )

    def axes(self, camera: Camera, theme: Theme) -> None:
        """The cross of axes, lower left."""
        self._canvas.delete("axes")
        size = 26 * self._dpi
        x, y = size + 16 * self._dpi, self._canvas.winfo_height() - size - 16 * self._dpi
        for k in np.argsort(camera.turn[2]).tolist():  # what comes towards the viewer lies on top
            name, colour = _AXES[k]
            dx, dy = size * camera.turn[0, k], -size * camera.turn[1, k]
            self._canvas.create_line(x, y, x + dx, y + dy, fill=colour, width=2 * self._dpi, tags=("axes",))
            away = 1 + 9 * self._dpi / size
            self._canvas.create_text(x + away * dx, y + away * dy, text=name, fill=colour, font=self._bold, tags=("axes",))

    def scale(self, camera: Camera, theme: Theme) -> None:
        """A length across the view, lower right."""
        self._canvas.delete("scale")
        length = round_length(_SCALE * self._dpi / camera.scale)
        wide, margin = length * camera.scale, 16 * self._dpi
        right, y = self._canvas.winfo_width() - margin, self._canvas.winfo_height() - margin
        tick = 4 * self._dpi
        points = [right - wide, y - tick, right - wide, y, right, y, right, y - tick]
        self._canvas.create_line(points, fill=theme.faint, width=max(round(1.5 * self._dpi), 1), tags=("scale",))
        self._canvas.create_text(
            right - wide / 2, y - 2 * tick, text=f"{length:g} mm", fill=theme.faint, font=self._font, anchor="s", tags=("scale",)
        )

    def legend(self, shading: str, theme: Theme) -> None:
        """What colours mean, upper right; made anew only where it differs."""
        key = shading, theme.name, self._canvas.winfo_width()
        if key == self._legend:
            return
        self._legend = key
        self._canvas.delete("legend")
        margin = 14 * self._dpi
        right = self._canvas.winfo_width() - margin
        if shading == "distortion":
            self._bar(right, margin, theme)
        elif shading == "checker":
            self._words(right, margin, [(f"squares of {CHECK_MM:g} mm on the flat pieces", theme.faint)])
        elif shading == "preferences":
            self._words(right, margin, [("seams attracted", theme.good), ("seams avoided", theme.error)])

    def clear(self, theme: Theme) -> None:
        """Take all of it away."""
        self.labels([], theme)
        self._canvas.delete("axes", "scale", "legend")
        self._legend = None

    def notice(self, words: str, theme: Theme) -> None:
        """In the middle, where there is nothing else."""
        self._canvas.delete("notice")
        if words:
            x, y = self._canvas.winfo_width() / 2, self._canvas.winfo_height() / 2
            self._canvas.create_text(x, y, text=words, fill=theme.faint, width=max(2 * x - 40, 40), justify="center", tags=("notice",))

    def _bar(self, right: float, top: float, theme: Theme) -> None:
        height, steps = _BAR[0] * self._dpi, _BAR[1]
        wide = 200 * self._dpi
        colours = heat(np.linspace(*HEAT_RANGE, steps))
        low_edge = top + height + 2 * self._font.metrics("linespace") + 8
        # The object may reach up to here: words on its colours could not be read.
        self._canvas.create_rectangle(right - wide - 5, top - 4, right + 5, low_edge, fill=theme.view, outline="", tags=("legend",))
        self._canvas.create_text(right, top, text="distortion d", fill=theme.text, font=self._font, anchor="ne", tags=("legend",))
        top += self._font.metrics("linespace") + 3
        for k, (r, g, b) in enumerate(colours.tolist()):
            x = right - wide + wide * k / steps
            fill = f"#{r:02x}{g:02x}{b:02x}"
            self._canvas.create_rectangle(x, top, x + wide / steps + 1, top + height, fill=fill, outline="", tags=("legend",))
        self._canvas.create_rectangle(right - wide, top, right, top + height, outline=theme.border, tags=("legend",))
        low, high = HEAT_RANGE
        middle = (low + high) / 2
        marks: list[tuple[float, str, Literal["nw", "n", "ne"]]] = [(low, f"{low:.1f}", "nw"), (middle, f"{middle:.1f}", "n")]
        for d, word, anchor in [*marks, (high, f"≥ {high:.1f}", "ne")]:
            x = right - wide + wide * (d - low) / (high - low)
            self._canvas.create_text(x, top + height + 2, text=word, fill=theme.text, font=self._font, anchor=anchor, tags=("legend",))

    def _words(self, right: float, top: float, lines: list[tuple[str, str]]) -> None:
        for k, (words, colour) in enumerate(lines):
            y = top + k * self._font.metrics("linespace") * 1.2
            self._canvas.create_text(right, y, text=words, fill=colour, font=self._font, anchor="ne", tags=("legend",))

    def _size(self, label: Label) -> tuple[float, float]:
        key = label.text, label.kind
        if key not in self._sizes:
            used = self._bold if label.kind == "piece" else self._font
            self._sizes[key] = used.measure(label.text) + 8 * self._dpi, used.metrics("linespace") + 2 * self._dpi
        return self._sizes[key]
