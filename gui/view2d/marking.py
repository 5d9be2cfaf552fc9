"""The moving part of the flat view: what is hovered, selected, dragged or measured, drawn over the still part."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gui.state.selection import Target
from gui.theme import Theme
from gui.view2d.lines import Lines
from gui.view2d.live import Findings, words
from gui.view2d.pen import Box, Pen
from gui.view2d.plane import Plane
from gui.view2d.sheet import Sheet
from skinfab.placement.sensor import Sensor

Float = NDArray[np.float64]

#: Pixels from a sensor's far end to the handle that turns it, and the handle's radius.
HANDLE_PX, HANDLE_RADIUS_PX = 22.0, 6.0
#: A bead thinner than this would not be seen.
_LEAST_BEAD_PX = 1.3
#: Names would hide sensors that are smaller than this on the screen, and stand beside them; of still smaller ones there are none.
WRITTEN_OVER_PX, LEAST_NAMED_PX = 46.0, 16.0


@dataclass(frozen=True)
class Shown:
    """Lines that a tool has put on the view.

    Parameters
    ----------
    lines : tuple of (k, 2) float, mm of the sheet
    colour : str
    width : float, pixels
    words : str
        Written beside the end of the last line.
    """

    lines: tuple[Float, ...]
    colour: str
    width: float
    words: str = ""


@dataclass(frozen=True, eq=False)
class Marker:
    """Draws with one pen on one plane.

    Parameters
    ----------
    pen : Pen
    plane : Plane
    sheet : Sheet
    theme : Theme
    lines : Lines
    cased : bool
        Conductors have a seam of the view's own colour: they would not stand out from the faces.
    """

    pen: Pen
    plane: Plane
    sheet: Sheet
    theme: Theme
    lines: Lines
    cased: bool = False

    def sensors(self, sensors: Iterable[Sensor], findings: Findings) -> list[Box]:
        """Conductors as wide as their beads, in the colour of whether they fit, with their names; where the names are."""
        names = []
        for sensor in sensors:
            px = self.plane.to_px(self.lines.of(sensor, self.sheet))
            width = max(sensor.pattern.bead * self.plane.scale / self.pen.ratio, _LEAST_BEAD_PX)
            colour = self.theme.error if sensor.id in findings else self.theme.ink
            if self.cased:
                self.pen.line(px, self.theme.view, width + 2.5)
            self.pen.line(px, colour, width)
            if np.ptp(px, axis=0).max() >= WRITTEN_OVER_PX * self.pen.ratio:
                middle = self.plane.to_px(self.lines.middle(sensor, self.sheet))
                names.append(self.pen.text(middle, sensor.id, colour, size=11, ground=self.theme.view, bold=True))
        return names

    def small(self, sensors: Iterable[Sensor], findings: Findings) -> Iterator[tuple[str, str, Float]]:
        """Name, colour and line, pixels, of each sensor whose name stands beside it."""
        for sensor in sensors:
            px = self.plane.to_px(self.lines.of(sensor, self.sheet))
            if LEAST_NAMED_PX <= np.ptp(px, axis=0).max() / self.pen.ratio < WRITTEN_OVER_PX:
                yield sensor.id, self.theme.error if sensor.id in findings else self.theme.ink, px

    def selected(self, target: Target, sensors: Mapping[str, Sensor], *, handle: bool) -> None:
        """What is selected; one sensor alone has a handle."""
        chosen = [sensors[id] for id in (target.sensor, *target.also) if id in sensors]
        for sensor in chosen:
            self._round(sensor, self.theme.select)
        if handle and len(chosen) == 1:
            self._handle(chosen[0])
        if not chosen and target.seam >= 0:
            self._seam(target.seam, self.theme.select)
        elif not chosen and target.piece:
            self._outline(target.piece, self.theme.select, 3.0)

    def hovered(self, target: Target, sensors: Mapping[str, Sensor]) -> None:
        """What is under the pointer, here or in the other view."""
        if target.sensor in sensors:
            self._round(sensors[target.sensor], self.theme.hover)
        elif target.seam >= 0:
            self._seam(target.seam, self.theme.hover)
        elif target.piece:
            self._outline(target.piece, self.theme.hover, 2.0)
        if target.face >= 0 and target.seam < 0 and not target.sensor:
            for t in np.flatnonzero(self.sheet.face == target.face):
                corners = self.plane.to_px(self.sheet.UV[self.sheet.F[t]])
                self.pen.line(corners, self.theme.hover, 1.5, closed=True)

    def guides(self, lines: Float) -> None:
        """To what a dragged sensor is in line with."""
        for line in lines:
            self.pen.line(self.plane.to_px(line), self.theme.accent, 1.0, dashed=True)

    def beside(self, at: Float, findings: Findings, sensors: Iterable[Sensor]) -> None:
        """What is wrong with the dragged sensors, beside the pointer (pixels)."""
        said = [line for sensor in sensors for line in words(findings.get(sensor.id, ()))][:3]
        colour = self.theme.error if said else self.theme.good
        # Away from the border that is near, so that nothing is cut off.
        right, top = at[0] > self.pen.width * 0.6, at[1] > self.pen.height - 90 * self.pen.ratio
        for k, line in enumerate(said or ["fits"]):
            shift = np.array([-16.0 if right else 16.0, -18.0 - 21 * k if top else 18.0 + 21 * k]) * self.pen.ratio
            self.pen.text(at + shift, line, colour, size=12, anchor=(float(right), 0.5), ground=self.theme.panel, edge=colour, inside=True)

    def shown(self, overlay: Shown) -> None:
        """A tool's lines."""
        parts = [self.plane.to_px(line) for line in overlay.lines if len(line)]
        self.pen.lines(parts, overlay.colour, overlay.width)
        for px in parts:
            for end in (px[0], px[-1]):
                self.pen.disk(end, 3.0, self.theme.view, overlay.colour)
        if overlay.words and parts:
            end, right = parts[-1][-1], bool(parts[-1][-1][0] > self.pen.width * 0.6)
            for k, line in enumerate(overlay.words.split("\n")):
                at = end + np.array([-12.0 if right else 12.0, 14.0 - 20 * k]) * self.pen.ratio
                self.pen.text(
                    at,
                    line,
                    self.theme.text,
                    size=12,
                    anchor=(float(right), 0.5),
                    ground=self.theme.panel,
                    edge=overlay.colour,
                    inside=True,
                )

    def rectangle(self, one: Float, two: Float) -> None:
        """What is being selected, pixels."""
        (left, low), (right, high) = np.minimum(one, two), np.maximum(one, two)
        self.pen.box((left, low, right, high), self.theme.accent, alpha=0.15)
        self.pen.line([[left, low], [right, low], [right, high], [left, high]], self.theme.accent, 1.0, closed=True)

    def place(self, hovered_words: str) -> None:
        """Where the pointer is, in the upper right corner."""
        if hovered_words:
            corner = np.array([self.pen.width, self.pen.height]) - 6 * self.pen.ratio
            self.pen.text(corner, hovered_words, self.theme.text, size=11, anchor=(1.0, 1.0), ground=self.theme.panel)

    def _handle(self, sensor: Sensor) -> None:
        middle = self.plane.to_px(self.lines.middle(sensor, self.sheet))
        at = self.plane.to_px(self.lines.handle(sensor, self.sheet, beyond=HANDLE_PX * self.pen.ratio / self.plane.scale))
        self.pen.line([middle, at], self.theme.select, 1.2, dashed=True)
        self.pen.disk(at, HANDLE_RADIUS_PX, self.theme.view, self.theme.select, 2.0)

    def _round(self, sensor: Sensor, colour: str) -> None:
        px = self.plane.to_px(self.lines.of(sensor, self.sheet))
        low, high = px.min(axis=0) - 6 * self.pen.ratio, px.max(axis=0) + 6 * self.pen.ratio
        self.pen.line([low, (high[0], low[1]), high, (low[0], high[1])], colour, 1.6, closed=True)

    def _seam(self, edge: int, colour: str) -> None:
        self.pen.lines([self.plane.to_px(line) for line in self.sheet.seam_lines(edge)], colour, 4.0)

    def _outline(self, piece: str, colour: str, width: float) -> None:
        k = self.sheet.index(piece)
        if k >= 0:
            sides = [side for side in self.sheet.sides if side.piece == k]
            self.pen.lines([self.plane.to_px(side.points + self.sheet.offset[k]) for side in sides], colour, width)
