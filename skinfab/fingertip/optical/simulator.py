"""A simulated optical fingertip: the pins of a soft dome that is pressed on a plate, as a camera sees them.

The dome's skin is pushed in where the plate is higher than it, and drapes over the plate's edge: what is pushed in is smoothed over a
millimetre or two. Each pin stands upright on the skin, so its tip moves against the skin's slope by its own length. Skin that
touches may be dragged sideways (shear). The tips are drawn as bright spots, with noise.

What it leaves out is in docs/optical.md, and so is what each term of it changes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.optical.plates import Moved, Plate

FloatArray = NDArray[np.float64]
Image = NDArray[np.uint8]

#: The plates' thickness (seed, section 2), mm: pressed deeper, the dome would touch the table beside them.
PLATE_MM = 3.0
#: How deep the dome is pressed where nothing else is said, mm.
DEPTH_MM = 2.0
#: Spacing of the grid on which the skin is smoothed, mm.
_GRID_MM = 0.5
#: Fraction bits of a drawn spot's place: a 16th of a pixel.
_SHIFT = 4


@dataclass(frozen=True)
class Dome:
    """How the fingertip is built.

    Parameters
    ----------
    radius_mm : float
        Of the dome (seed: a hemisphere of 40 mm across).
    rings : int
        Of pins round the middle one, in a hexagon: 6 make 127 pins.
    pitch_mm : float
        Between pins.
    pin_mm : float
        Length of a pin: how far its tip goes for a slope of 1. Assumed, so that tips keep nearer to their own place than to others'.
    drape_mm : float
        Standard deviation of the smoothing. Assumed: some times the skin's thickness.
    spot_mm : float
        Radius of a white tip.
    size_px : int
        Of the square image, which shows the whole dome.
    """

    radius_mm: float = 20.0
    rings: int = 6
    pitch_mm: float = 3.0
    pin_mm: float = 2.5
    drape_mm: float = 1.5
    spot_mm: float = 0.6
    size_px: int = 240

    @property
    def px_per_mm(self) -> float:
        """Scale of the image."""
        return self.size_px / (2 * self.radius_mm)

    @cached_property
    def pins(self) -> FloatArray:
        """Where the pins stand, (k, 2) mm from the middle."""
        k = np.arange(-self.rings, self.rings + 1)
        a, b = (each.ravel() for each in np.meshgrid(k, k))
        inside = np.abs(a + b) <= self.rings
        return self.pitch_mm * np.c_[a + b / 2, b * math.sqrt(3) / 2][inside]

    @cached_property
    def stamps(self) -> tuple[Image, int]:
        """A tip's spot at every part of a pixel, (rows, columns, h, h), and its pixels beside the middle one."""
        scale = 1 << _SHIFT
        radius = round(self.spot_mm * self.px_per_mm * scale)
        reach = radius // scale + 2
        out = np.zeros((scale, scale, 2 * reach + 1, 2 * reach + 1), np.uint8)
        for y in range(scale):
            for x in range(scale):
                middle = (reach * scale + x, reach * scale + y)
                cv2.circle(out[y, x], middle, radius, 255, cv2.FILLED, cv2.LINE_AA, _SHIFT)
        return out, reach

    def to_px(self, P: FloatArray) -> FloatArray:
        """Places (..., 2) mm as pixels (column, row); whole numbers are the pixels' middles."""
        return P * self.px_per_mm + (self.size_px - 1) / 2

    def to_mm(self, P: FloatArray) -> FloatArray:
        """The way back."""
        return (P - (self.size_px - 1) / 2) / self.px_per_mm


@dataclass(frozen=True)
class Errors:
    """What no real fingertip is free of.

    Parameters
    ----------
    pin_mm : float
        Standard deviation of each tip's place, anew in every frame.
    scatter_mm : float
        The same for where a tip stands at rest: it stays.
    grey : float
        Standard deviation of a pixel, of 255.
    """

    pin_mm: float = 0.05
    scatter_mm: float = 0.1
    grey: float = 4.0


NO_ERRORS = Errors(0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Fingertip:
    """One simulated fingertip.

    Parameters
    ----------
    dome : Dome
    errors : Errors
    seed : int
        Of where its tips stand at rest.

    Examples
    --------
    >>> from skinfab.fingertip.optical.plates import HalfPlane
    >>> tip = Fingertip(errors=NO_ERRORS)
    >>> image = tip.image(tip.pressed(HalfPlane(0.0, 0.0)))
    >>> image.shape, str(image.dtype), len(tip.rest)
    ((240, 240), 'uint8', 127)

    Over the edge the tips lean off the plate, and those far from it do not move:

    >>> moved = tip.pressed(HalfPlane(0.0, 0.0)) - tip.rest
    >>> float(moved[:, 0].max().round(2)), float(abs(moved[np.abs(tip.rest[:, 0]) > 15]).max().round(2))
    (1.18, 0.0)
    """

    dome: Dome = field(default_factory=Dome)
    errors: Errors = Errors()
    seed: int = 0

    @cached_property
    def rest(self) -> FloatArray:
        """Where this fingertip's tips stand untouched, (k, 2) mm."""
        rng = np.random.default_rng((self.seed, 1))
        return self.dome.pins + self.errors.scatter_mm * rng.standard_normal(self.dome.pins.shape)

    @cached_property
    def _grid(self) -> tuple[FloatArray, FloatArray]:
        """Points of the grid, (n, n, 2) mm, and the dome's height over them."""
        r = self.dome.radius_mm
        x = np.arange(-r, r + _GRID_MM / 2, _GRID_MM)
        X = np.stack(np.meshgrid(x, x), axis=-1)
        return X, r - np.sqrt(np.maximum(r * r - (X * X).sum(axis=-1), 0.0))

    @cached_property
    def _grain(self) -> NDArray[np.float32]:
        """Noise of pixels, twice as wide and high as an image."""
        n = 2 * self.dome.size_px
        return self.errors.grey * np.random.default_rng((self.seed, 2)).standard_normal((n, n), dtype=np.float32)

    def pressed(
        self,
        plate: Plate,
        *,
        at: tuple[float, float] | FloatArray = (0.0, 0.0),
        turn_rad: float = 0.0,
        depth_mm: float = DEPTH_MM,
        shear_mm: tuple[float, float] | FloatArray = (0.0, 0.0),
        rng: np.random.Generator | None = None,
    ) -> FloatArray:
        """Where the tips stand when the dome is pressed on a plate, (k, 2) mm in the fingertip's frame.

        Parameters
        ----------
        plate : Plate
        at : (2,) float, mm
            The fingertip's centre.
        turn_rad : float
            How far the fingertip is turned about its axis.
        depth_mm : float
            Of the dome's lowest point below the plate's top.
        shear_mm : (2,) float
            How far the skin that touches is dragged, in the fingertip's frame.
        rng : Generator, optional
            Of the frame's noise; without one there is none.

        Raises
        ------
        InputError
            The depth is none, or more than the plate's thickness.
        """
        if not 0 <= depth_mm <= PLATE_MM:
            raise InputError(f"a depth of {depth_mm:g} mm; between 0 and the plate's {PLATE_MM:g} mm the table beside it is not touched")
        X, height = self._grid
        on = np.clip(0.5 - Moved(plate, np.asarray(at, dtype=float), turn_rad).distance(X) / _GRID_MM, 0, 1)
        pushed = np.maximum(depth_mm - height, 0) * on
        sigma = self.dome.drape_mm / _GRID_MM
        skin = cv2.GaussianBlur(pushed, (0, 0), sigma, borderType=cv2.BORDER_CONSTANT)
        slope_y, slope_x = np.gradient(skin, _GRID_MM)
        out = self.rest - self.dome.pin_mm * np.c_[self._at_pins(slope_x), self._at_pins(slope_y)]
        if np.any(np.asarray(shear_mm)):
            touching = cv2.GaussianBlur(np.where(pushed > 0, 1.0, 0.0), (0, 0), sigma, borderType=cv2.BORDER_CONSTANT)
            out += self._at_pins(touching)[:, None] * np.asarray(shear_mm, dtype=float)
        if rng is not None:
            out += self.errors.pin_mm * rng.standard_normal(out.shape)
        return out

    def _at_pins(self, field_: NDArray[Any]) -> FloatArray:
        """A field on the grid, at the pins: between its points on straight lines."""
        at = ((self.rest + self.dome.radius_mm) / _GRID_MM).astype(np.float32)
        out: FloatArray = cv2.remap(field_, at[None], None, cv2.INTER_LINEAR).reshape(-1)  # type: ignore[call-overload]
        return out

    def image(self, P: FloatArray, *, rng: np.random.Generator | None = None) -> Image:
        """What the camera sees of tips at `P` (k, 2) mm, (size, size) of grey; with `rng`, noisy."""
        n, (stamps, reach) = self.dome.size_px, self.dome.stamps
        at = np.rint(self.dome.to_px(P) * (1 << _SHIFT)).astype(np.int64)
        whole, part = at >> _SHIFT, at & ((1 << _SHIFT) - 1)
        across = np.arange(-reach, reach + 1)
        # With a rim all round, so that no spot that is seen in part or not at all needs a case of its own.
        wide = n + 2 * (2 * reach + 1)
        corner = np.clip(whole, -reach - 1, n + reach) + (2 * reach + 1)
        place = (corner[:, 1, None, None] + across[:, None]) * wide + corner[:, 0, None, None] + across
        rimmed = np.zeros(wide * wide, np.uint8)
        np.maximum.at(rimmed, place.ravel(), stamps[part[:, 1], part[:, 0]].ravel())
        inner = slice(2 * reach + 1, 2 * reach + 1 + n)
        drawn: Image = np.ascontiguousarray(rimmed.reshape(wide, wide)[inner, inner])
        if rng is None or not self.errors.grey:
            return drawn
        # One grain, elsewhere in every frame: drawing it anew took half of the time.
        down, right = rng.integers(0, n, 2)
        return cv2.add(drawn, self._grain[down : down + n, right : right + n], dtype=cv2.CV_8U)  # type: ignore[return-value]

    def frame(
        self,
        plate: Plate,
        *,
        rng: np.random.Generator,
        at: tuple[float, float] | FloatArray = (0.0, 0.0),
        turn_rad: float = 0.0,
        depth_mm: float = DEPTH_MM,
        shear_mm: tuple[float, float] | FloatArray = (0.0, 0.0),
    ) -> Image:
        """A noisy image of the dome pressed on a plate: `pressed`, then `image`."""
        return self.image(self.pressed(plate, at=at, turn_rad=turn_rad, depth_mm=depth_mm, shear_mm=shear_mm, rng=rng), rng=rng)

    def without(self, **terms: float) -> Fingertip:
        """The same with other errors, for ablations."""
        return replace(self, errors=replace(self.errors, **terms))


def paper_fingertip(seed: int = 0) -> Fingertip:
    """The seed's, as its method needs it: pins so dense that five dilations merge those that lean together, and no others.

    Examples
    --------
    >>> tip = paper_fingertip()
    >>> len(tip.rest), tip.dome.size_px
    (271, 440)
    """
    dome = Dome(rings=9, pitch_mm=2.0, pin_mm=1.7, drape_mm=1.0, spot_mm=0.4, size_px=440)
    return Fingertip(dome, Errors(pin_mm=0.03, scatter_mm=0.05), seed)
