"""Scrolling curves, a strip a channel: a picture in one go, with names and values as words of the canvas beside it."""

from __future__ import annotations

import math
import time
import tkinter as tk
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from tkinter import ttk
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageTk

from gui.live.picture import Ink, strips
from gui.live.ring import Ring
from gui.live.scales import Scales
from gui.live.spans import Spans, spans
from gui.theme import Theme, rgb
from skinfab.readout.frame import Frame, Stream

#: Pixels at 96 dots an inch: of names, of values, of times below; the least height of a strip, and of the angle's.
_LEFT, _RIGHT, _BELOW, _LEAST, _ANGLE = 96, 116, 20, 11, 72
#: Values are written anew so often, s: digits that change faster cannot be read.
_WORDS_S = 0.2
#: A line is broken where frames are farther apart than this, s, or so many of the stream's steps.
_HOLE_S, _HOLE_STEPS = 0.25, 3.0
#: Lines of the grid, s: the first that leaves no more than six in the picture.
_STEPS = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0)


@dataclass(frozen=True)
class Now:
    """What is true at this moment, beside the curves.

    Parameters
    ----------
    time : float, s
        At the right end.
    range_s : float
        How much is shown.
    newest : Frame or None
    touched : mapping of str to float
        Signed change, by channel.
    angle : float, deg
    silent : bool
        The newest frame is of long ago.
    """

    time: float
    range_s: float
    newest: Frame | None
    touched: Mapping[str, float]
    angle: float
    silent: bool


class Plots(ttk.Frame):
    """The strips.

    A double click, or Enter, shows the strip under the pointer, or the chosen one, alone, and all again. The wheel moves on where
    there are more than fit.

    Parameters
    ----------
    master : widget
    theme : Theme
    chosen : callable
        Called with a channel's place where one is clicked.
    """

    def __init__(self, master: tk.Misc, theme: Theme, *, chosen: Callable[[int], object]) -> None:
        super().__init__(master, name="plots")
        self._theme, self._chosen = theme, chosen
        self._dpi = self.winfo_fpixels("1i") / 96
        self.canvas = tk.Canvas(self, name="canvas", highlightthickness=1, borderwidth=0, takefocus=True, width=300, height=200)
        self.canvas.pack(fill="both", expand=True)
        self._photo: ImageTk.PhotoImage | None = None
        self._picture = self.canvas.create_image(0, 0, anchor="nw")
        self._stream: Stream | None = None
        self._labels: tuple[str, ...] = ()
        self._with_angle = False
        self._scales = Scales(0)
        #: The channel that is shown alone, and the first of those that are shown.
        self.alone: int | None = None
        self.first = 0
        self._laid: tuple[object, ...] = ()
        self._words_at = 0.0
        #: How long the last picture took, s, and how many there were.
        self.last_picture, self.pictures = 0.0, 0
        self.canvas.bind("<Button-1>", self._click)
        self.canvas.bind("<Double-Button-1>", self._only)
        self.canvas.bind("<Return>", lambda event: self.show_alone(None if self.alone is not None else self.first))
        for event, by in (("<Button-4>", -1), ("<Button-5>", 1), ("<Up>", -1), ("<Down>", 1)):
            self.canvas.bind(event, lambda event, by=by: self._scroll(by))  # type: ignore[misc]
        self.restyle(theme)

    def restyle(self, theme: Theme) -> None:
        """Other colours."""
        self._theme = theme
        self.canvas.configure(background=theme.view, highlightbackground=theme.border, highlightcolor=theme.accent)
        self._laid = ()

    def begin(self, stream: Stream, labels: Sequence[str], *, angle: bool) -> None:
        """Show another stream, or the same one with other labels."""
        if self._stream is None or stream.names != self._stream.names:
            self._scales, self.alone, self.first = Scales(len(stream.channels) + 1), None, 0
        self._stream, self._labels, self._with_angle = stream, tuple(labels), angle
        self._laid = ()

    def show_alone(self, channel: int | None) -> None:
        """One channel in the whole height, or all."""
        self.alone = channel
        self._laid = ()

    def clear(self, words: str) -> None:
        """Nothing but words."""
        self._stream, self._laid = None, ()
        self.canvas.itemconfigure(self._picture, state="hidden")
        self.canvas.delete("words", "ticks")
        width, height = self.canvas.winfo_width(), self.canvas.winfo_height()
        self.canvas.create_text(
            width / 2, height / 2, text=words, fill=self._theme.faint, tags=("words",), width=width - 20, justify="center"
        )

    def draw(self, ring: Ring, now: Now) -> None:
        """Draw anew."""
        stream = self._stream
        width = self.canvas.winfo_width() - self._px(_LEFT) - self._px(_RIGHT)
        if stream is None or width < 20 or self.canvas.winfo_height() < 60:
            return
        began = time.perf_counter()
        shown, height, angle_height = self._rows()
        step = now.range_s / width
        start = (math.floor(now.time / step) + 1 - width) * step  # whole columns, so that peaks do not flicker
        hole = max(_HOLE_S, _HOLE_STEPS / stream.rate_hz if stream.rate_hz else 1.0)
        columns = [*shown, len(stream.channels)] if angle_height else shown
        at, rows = ring.since(start)
        found = spans(at, rows if len(columns) == rows.shape[1] else rows[:, columns], start=start, step=step, width=width, hole=hole)
        scales = self._scales
        least, most = np.full(len(scales.low), np.nan), np.full(len(scales.low), np.nan)
        least[columns], most[columns] = np.fmin.reduce(found.low, axis=0), np.fmax.reduce(found.high, axis=0)
        scales.fit(least, most)
        ticks = self._ticks(start, now, step)
        self._lay(shown, height, angle_height)
        self._paste(self._painted(found, columns, shown, (height, angle_height), [column for column, _ in ticks], now))
        self._write_ticks(ticks)
        if began - self._words_at > _WORDS_S:
            self._words_at = began
            self._write_values(shown, now, bool(angle_height))
        self.last_picture = time.perf_counter() - began
        self.pictures += 1

    # How it is laid out

    def _rows(self) -> tuple[list[int], int, int]:
        """Channels that are shown, the height of each strip, and of the angle's, pixels."""
        assert self._stream is not None
        count = len(self._stream.channels)
        room = self.canvas.winfo_height() - self._px(_BELOW)
        angle_height = min(self._px(_ANGLE), room // 3) if self._with_angle else 0
        room -= angle_height
        if self.alone is not None and self.alone < count:
            return [self.alone], room, angle_height
        fit = max(min(count, room // self._px(_LEAST)), 1)
        self.first = min(max(self.first, 0), count - fit)
        return list(range(self.first, self.first + fit)), room // fit, angle_height

    def _lay(self, shown: Sequence[int], height: int, angle_height: int) -> None:
        """Names, once for as long as nothing moves."""
        now = (tuple(shown), height, angle_height, self.canvas.winfo_width(), self._labels, self._theme.name)
        if now == self._laid:
            return
        self._laid, self._words_at = now, 0.0
        canvas, theme = self.canvas, self._theme
        canvas.delete("words", "ticks")
        canvas.coords(self._picture, self._px(_LEFT), 0)
        # Letters as high as they may be in the strips, and no higher than others.
        font = ("TkDefaultFont", -max(min(height - 2, self._px(12)), 7))
        right = canvas.winfo_width() - self._px(_RIGHT) + self._px(6)
        rows = [(j * height + height / 2, self._labels[k], k) for j, k in enumerate(shown)]
        if angle_height:
            rows.append((len(shown) * height + angle_height / 2, "angle", -1))
        for y, name, k in rows:
            canvas.create_text(self._px(_LEFT - 6), y, anchor="e", text=name, fill=theme.text, font=font, tags=("words", f"name{k}"))
            canvas.create_text(right, y, anchor="w", text="", fill=theme.text, font=font, tags=("words", f"value{k}"))
        if height >= self._px(40):
            self._name_limits(shown, height)
        if angle_height:
            self._limits(len(self._scales.low) - 1, len(shown) * height, angle_height)

    def _name_limits(self, shown: Sequence[int], height: int) -> None:
        for j, k in enumerate(shown):
            self._limits(k, j * height, height)

    def _limits(self, k: int, top: int, height: int) -> None:
        """Room for the range of a strip that is high enough for it."""
        place = self._px(_LEFT - 6)
        ends: tuple[tuple[int, Literal["ne", "se"], str], ...] = ((top + 2, "ne", "high"), (top + height - 3, "se", "low"))
        for y, anchor, end in ends:
            self.canvas.create_text(
                place, y, anchor=anchor, text="", fill=self._theme.faint, font=("TkDefaultFont", -self._px(10)), tags=("words", f"{end}{k}")
            )

    def _painted(
        self, found: Spans, columns: list[int], shown: list[int], heights: tuple[int, int], grid: list[int], now: Now
    ) -> NDArray[np.uint32]:
        assert self._stream is not None
        theme, names, c = self._theme, self._stream.names, len(shown)
        plain, touched = Ink(theme.view, theme.accent), Ink(_mixed(theme.view, theme.select, 0.18), theme.select)
        # One that has no reading looks neither touched nor well.
        lost, valid = Ink(_mixed(theme.view, theme.faint, 0.25), theme.faint), None if now.newest is None else now.newest.valid
        inks = [lost if valid is not None and not valid[k] else touched if names[k] in now.touched else plain for k in shown]
        low, high = self._scales.low[columns], self._scales.high[columns]
        strip = partial(strips, grid=grid, grid_colour=theme.border, width_px=1.3 * self._dpi)
        first = Spans(found.low[:, :c], found.high[:, :c])
        picture = strip(first, low[:c], high[:c], inks, height=heights[0])
        if heights[1]:
            last = Spans(found.low[:, c:], found.high[:, c:])
            ink = [Ink(theme.view, theme.good)]
            picture = np.vstack([picture, strip(last, low[c:], high[c:], ink, height=heights[1])])
        return picture

    def _paste(self, picture: NDArray[np.uint32]) -> None:
        height, width = picture.shape
        if self._photo is None or (self._photo.width(), self._photo.height()) != (width, height):
            self._photo = ImageTk.PhotoImage("RGBA", (width, height), master=self.canvas)
            self.canvas.itemconfigure(self._picture, image=self._photo)
        self._photo.paste(Image.frombuffer("RGBA", (width, height), picture, "raw", "RGBA", 0, 1))
        self.canvas.itemconfigure(self._picture, state="normal")

    def _ticks(self, start: float, now: Now, step: float) -> list[tuple[int, str]]:
        """Columns of the grid's lines, with their times."""
        apart = next((each for each in _STEPS if now.range_s / each <= 6), _STEPS[-1])
        first = math.ceil(max(start, 0.0) / apart)
        last = math.floor(now.time / apart)
        return [(min(int((k * apart - start) / step), round(now.range_s / step) - 1), f"{k * apart:g} s") for k in range(first, last + 1)]

    def _write_ticks(self, ticks: Sequence[tuple[int, str]]) -> None:
        canvas = self.canvas
        y = canvas.winfo_height() - self._px(_BELOW) / 2
        items = canvas.find_withtag("ticks")
        for k, (column, words) in enumerate(ticks):
            x = self._px(_LEFT) + column
            if k < len(items):
                canvas.coords(items[k], x, y)
                canvas.itemconfigure(items[k], text=words)
            else:
                canvas.create_text(x, y, text=words, fill=self._theme.faint, font=("TkDefaultFont", -self._px(11)), tags=("ticks",))
        for item in items[len(ticks) :]:
            canvas.itemconfigure(item, text="")

    def _write_values(self, shown: Sequence[int], now: Now, with_angle: bool) -> None:
        assert self._stream is not None
        for k in shown:
            words, colour = self._value(k, now)
            self.canvas.itemconfigure(f"value{k}", text=words, fill=colour)
        places = {k: k for k in shown} | ({len(self._scales.low) - 1: -1} if with_angle else {})
        for k in places:
            for end, value in (("low", self._scales.low[k]), ("high", self._scales.high[k])):
                self.canvas.itemconfigure(f"{end}{k}", text="" if math.isnan(value) else f"{value:.4g}")
        if with_angle:
            text = "-" if math.isnan(now.angle) else f"{now.angle:.1f} deg"
            self.canvas.itemconfigure("value-1", text=text, fill=self._theme.faint if now.silent else self._theme.text)

    def _value(self, k: int, now: Now) -> tuple[str, str]:
        """What a channel reads, in words, and their colour."""
        assert self._stream is not None
        channel, frame, theme = self._stream.channels[k], now.newest, self._theme
        if frame is None or not frame.valid[k]:
            return "no reading" if frame is not None else "", theme.error  # the colour of warnings is nearly that of a touch
        value = f"{frame.values[k]:.4g} {channel.unit}".rstrip()
        if now.silent:
            return value, theme.faint
        if frame.saturated[k]:
            return "at its end", theme.error
        if channel.name in now.touched:
            return f"touched, {100 * now.touched[channel.name]:+.0f} %", theme.select
        return value, theme.text

    # What clicks do

    def channel_at(self, y: int) -> int | None:
        """The channel of the strip at a height of the canvas."""
        if self._stream is None:
            return None
        shown, height, _ = self._rows()
        place = y // height
        return shown[place] if 0 <= place < len(shown) else None

    def _click(self, event: tk.Event) -> None:
        self.canvas.focus_set()
        if (channel := self.channel_at(event.y)) is not None:
            self._chosen(channel)

    def _only(self, event: tk.Event) -> None:
        self.show_alone(None if self.alone is not None else self.channel_at(event.y))

    def _scroll(self, by: int) -> None:
        self.first += by
        self._laid = ()

    def _px(self, pixels: float) -> int:
        return round(pixels * self._dpi)


def _mixed(ground: str, colour: str, part: float) -> str:
    """A colour between two.

    Examples
    --------
    >>> _mixed("#000000", "#ff8000", 0.5)
    '#804000'
    """
    return "#" + "".join(f"{round(a + (b - a) * part):02x}" for a, b in zip(rgb(ground), rgb(colour), strict=True))
