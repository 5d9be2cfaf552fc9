"""The seed's way from an image to an edge: pins that have come close merge into one bright region, whose moments give the direction.

Denoise, stretch the contrast, dilate 3 x 3 five times, erode as often, threshold; the largest region is the feature. Which side of it
is the plate tells the white in two rectangles beside it. It follows no single pin (section 1.2 and figure 7 of the seed).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.optical.pins import Image, label_type

#: Dilations, and erosions after them (seed: n = 5, both with OpenCV's 3 x 3 kernel).
STEPS = 5
#: A stretched image is white above this.
WHITE = 128
#: A region is a feature when it holds as many pins.
PINS = 3
#: The part of the image, each way, in which the centroid of a good feature lies (seed: the central third).
CENTRAL = 1 / 3
#: Length and width of each of the two rectangles, as parts of the image; they lie against the feature's axis. Read off figure 7.
RECTANGLE = (0.4, 0.15)
#: An image whose brightest pixel is less above its middle one shows no pins.
LEAST_CONTRAST = 30


@dataclass(frozen=True)
class Feature:
    """A region of merged pins.

    Parameters
    ----------
    centroid : (2,) float
        Column and row, pixels from the image's middle.
    angle_rad : float
        Direction in which one leaves the plate, across the feature's long axis.
    elongation : float
        Long axis over short one.
    pins : float
        How many it is as large as.
    good : bool
        Whether its centroid lies in the central third.
    """

    centroid: tuple[float, float]
    angle_rad: float
    elongation: float
    pins: float
    good: bool


def stretched(image: Image) -> Image:
    """Without specks, and from black to white.

    Raises
    ------
    InputError
        The image is not one of grey, or shows nothing bright.
    """
    if image.ndim != 2 or image.dtype != np.uint8:
        raise InputError(f"an image of shape {image.shape} and {image.dtype}; one channel of 8 bits is needed: turn it to grey first")
    smooth = cv2.medianBlur(image, 3)
    low, high = float(np.median(smooth[::4, ::4])), float(smooth.max())
    if high - low < LEAST_CONTRAST:
        raise InputError(
            f"the image's brightest pixel is {high - low:.0f} of 255 above its middle one; no pins are seen: look at light and focus"
        )
    table = np.clip((np.arange(256) - low) * (255 / (high - low)), 0, 255).astype(np.uint8)
    return cv2.LUT(smooth, table)  # type: ignore[return-value]


def merged(image: Image) -> Image:
    """Where pins have come close, with the pins that stand alone: dilated, eroded, black and white."""
    kernel = np.ones((3, 3), np.uint8)
    return white(cv2.erode(cv2.dilate(image, kernel, iterations=STEPS), kernel, iterations=STEPS))


def white(image: NDArray[Any]) -> Image:
    """Black below `WHITE`, 255 from there."""
    return cv2.threshold(image, WHITE, 255, cv2.THRESH_BINARY)[1]  # type: ignore[return-value]


def feature(image: Image, *, plate_is_white: bool = False) -> Feature | None:
    """The edge in an image of the pins, as the seed finds it; none where no pins have merged.

    Parameters
    ----------
    image : (n, n) uint8
    plate_is_white : bool
        Whether pins crowd on the plate's side of the edge, as the seed says of its sensor, or beside the plate, as pins do that stand
        upright on the skin.

    Raises
    ------
    InputError
        The image is not one of grey, or shows no pins.

    Examples
    --------
    >>> from skinfab.fingertip.optical.plates import HalfPlane
    >>> from skinfab.fingertip.optical.simulator import NO_ERRORS, Fingertip
    >>> tip = Fingertip(errors=NO_ERRORS)
    >>> found = feature(tip.image(tip.pressed(HalfPlane(0.0, 0.0))))
    >>> found.good, abs(round(math.degrees(found.angle_rad))) < 20
    (True, True)
    """
    bright = stretched(image)
    pins = white(bright)
    regions = merged(bright)
    count, labels, stats, centres = cv2.connectedComponentsWithStats(regions, ltype=label_type(regions))
    if count < 2:
        return None
    # Most regions are pins alone: the middling one is as large as a pin.
    held = stats[:, cv2.CC_STAT_AREA] / float(np.median(stats[1:, cv2.CC_STAT_AREA]))
    held[0] = 0.0  # the background
    middle = (np.array(image.shape[::-1]) - 1) / 2
    central: NDArray[np.bool_] = np.all(np.abs(centres - middle) <= CENTRAL / 2 * np.array(image.shape[::-1]), axis=1)
    # Pins crowd at the rim of the contact as well: what lies in the middle is the edge, if anything does.
    chosen = int(np.where(central & (held >= PINS), held + held.max(), held).argmax())
    if held[chosen] < PINS:
        return None
    left, top, wide, high = (int(each) for each in stats[chosen, :4])
    region = np.equal(labels[top : top + high, left : left + wide], chosen).astype(np.uint8)
    m = cv2.moments(region, binaryImage=True)
    axis = 0.5 * math.atan2(2 * m["mu11"], m["mu20"] - m["mu02"])
    spread = math.hypot(2 * m["mu11"], m["mu20"] - m["mu02"])
    longer, shorter = m["mu20"] + m["mu02"] + spread, m["mu20"] + m["mu02"] - spread
    x, y = centres[chosen] - middle
    across = axis + math.pi / 2
    beside = [_white(pins, centres[chosen], axis, side) for side in (1, -1)]
    outward = across if (beside[0] < beside[1]) == plate_is_white else across + math.pi
    return Feature(
        centroid=(float(x), float(y)),
        angle_rad=math.remainder(outward, math.tau),
        elongation=math.sqrt(longer / max(shorter, 1e-9)),
        pins=float(held[chosen]),
        good=bool(central[chosen]),
    )


def _white(pins: Image, centre: NDArray[np.float64], axis: float, side: int) -> int:
    """How many pixels are white in the rectangle on one side of the feature's axis."""
    long, wide = RECTANGLE[0] * pins.shape[1], RECTANGLE[1] * pins.shape[1]
    t = np.array([math.cos(axis), math.sin(axis)])
    n = side * np.array([-t[1], t[0]])
    corners = np.array([centre + a * long / 2 * t + b * wide * n for a, b in ((-1, 0), (1, 0), (1, 1), (-1, 1))])
    inside = np.zeros_like(pins)
    cv2.fillConvexPoly(inside, np.rint(corners).astype(np.int32), 255)
    return int(cv2.countNonZero(cv2.bitwise_and(pins, inside)))
