"""Where the camera sits now: one image of the untouched fingertip shifts and turns the learned pins as a whole."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from skinfab.errors import InputError
from skinfab.fingertip.optical.picture import read_picture
from skinfab.fingertip.optical.pins import Image, Pins
from skinfab.tolerances import PIN_KEPT, PIN_SEATED


@dataclass(frozen=True)
class Seat:
    """The same pins where the camera now sees them.

    Parameters
    ----------
    pins : Pins
    shift_px : float
        How far their middle has gone.
    turn_rad : float
        From columns towards rows.
    left_px : float
        How far they still lie from where they are seen (root mean square).
    pitch_px : float
        How far apart pins lie.
    """

    pins: Pins
    shift_px: float
    turn_rad: float
    left_px: float
    pitch_px: float

    @property
    def fits(self) -> bool:
        """Shift and turn explain what is seen."""
        return self.left_px <= PIN_SEATED * self.pitch_px


def seat(pins: Pins, image: Image) -> Seat:
    """Find the pins in an image of the untouched fingertip, and shift and turn them there (Kabsch 1976).

    Parameters
    ----------
    pins : Pins
    image : (h, w) uint8
        Shifted by less than half the distance between neighbours.

    Raises
    ------
    InputError
        The image has another size, or a tenth of the pins is not found in it.

    Examples
    --------
    >>> from skinfab.fingertip.optical.simulator import Fingertip
    >>> tip = Fingertip()
    >>> rest = tip.image(tip.rest)
    >>> found = seat(Pins.of_rest(rest), np.roll(rest, 3, axis=1))
    >>> round(found.shift_px, 6), round(found.left_px, 6), found.fits
    (3.0, 0.0, True)
    """
    found = pins.track(image)
    if found.missing.mean() > 1 - PIN_KEPT:
        raise InputError(
            f"{int(found.missing.sum())} of {len(pins.rest)} pins are not found in the image at rest; give one of the untouched "
            "fingertip by the camera of the training, or train again where it has moved farther than half a pin's pitch"
        )
    before = pins.rest[~found.missing]
    now = before + found.moved[~found.missing]
    middle, there = before.mean(axis=0), now.mean(axis=0)
    left, _, right = np.linalg.svd((before - middle).T @ (now - there))
    turn = left @ np.diag([1.0, np.sign(np.linalg.det(left @ right))]) @ right
    off = (before - middle) @ turn + there - now
    seated = Pins((pins.rest - middle) @ turn + there, pins.shape, pins.level)
    return Seat(
        seated,
        float(np.hypot(*(there - middle))),
        math.atan2(turn[0, 1], turn[0, 0]),
        float(np.sqrt((off**2).sum(axis=1).mean())),
        pins.pitch_px,
    )


def read_rest(path: Path, shape: tuple[int, ...]) -> Image:
    """An image of the untouched fingertip, (h, w) uint8, of the `shape` that the learned images have.

    Raises
    ------
    InputError
        It cannot be read, or has another size.
    """
    image, _ = read_picture(path)
    if image.shape != shape:
        raise InputError(
            f"{path}, of the untouched fingertip (--rest), is of {image.shape[1]} x {image.shape[0]} pixels, and the images that are "
            f"learned from are of {shape[1]} x {shape[0]}; give one by the same camera with the same settings"
        )
    return image
