"""Where the pins of an optical fingertip stand in an image, and how far each has moved from its place at rest.

One pass of connected components finds the bright tips; each is given to the pin at rest that it lies nearest to, at most one to a
pin and none farther than half the distance to that pin's neighbours. A pin that finds no tip so is looked for where its neighbours
have gone, and one that is not there either (hidden, or run together with another) is put where they say and counted as missing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.tolerances import PIN_AREA, PIN_KEPT, PIN_NEIGHBOURS, PIN_REACH, PIN_ROUNDS

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]
Image = NDArray[np.uint8]

#: Fewer pins tell no edge.
LEAST_PINS = 12
#: Images that a pattern at rest is averaged of, and how often.
_IMAGES, _ROUNDS = 200, 3


def require_image(image: NDArray[np.generic], where: str) -> Image:
    """Refuse what is no grey image of bytes.

    Raises
    ------
    InputError
        It has colours, another type, or hardly a pixel.
    """
    if image.ndim != 2 or image.dtype != np.uint8 or min(image.shape) < 16:
        raise InputError(
            f"{where}: an image of shape {image.shape} and type {image.dtype}; grey bytes of 16 x 16 pixels or more are needed"
        )
    return image  # type: ignore[return-value]


def level_of(images: Sequence[Image]) -> int:
    """The grey that parts tips from what is dark, from 1 to 254: midway between the means of what Otsu's (1979) lies between.

    Otsu's own is the lowest of those that part alike: of images of two greys the darker one, and their JPEGs are full of specks at it.

    Examples
    --------
    >>> image = np.full((32, 32), 20, np.uint8)
    >>> image[::4, ::4] = 220
    >>> level_of([image])
    120
    """
    grey = np.concatenate([image.ravel() for image in images[:: max(len(images) // 8, 1)]])
    found, _ = cv2.threshold(grey, 0, 255, cv2.THRESH_OTSU)
    bright = grey > found
    if bright.any() and not bright.all():
        found = (float(grey[bright].mean()) + float(grey[~bright].mean())) / 2
    return int(min(max(found, 1), 254))


def label_type(lit: NDArray[Any]) -> int:
    """OpenCV's type for labels of components: short ones are written three times as fast, and there are no more than lit pixels."""
    return cv2.CV_16U if cv2.countNonZero(lit) < 1 << 16 else cv2.CV_32S


def find_tips(image: Image, level: int) -> FloatArray:
    """Middles of the bright spots of an image, (k, 2) px (column, row), weighted by how far each pixel is above `level`.

    Specks and what is much larger than most spots (the rim, reflections) are left out.

    Parameters
    ----------
    image : (h, w) uint8
    level : int

    Examples
    --------
    >>> image = np.zeros((32, 32), np.uint8)
    >>> image[10:12, 20:23] = 255
    >>> find_tips(image, 100).tolist()
    [[21.0, 10.5]]
    """
    lit = cv2.threshold(image, level, 1, cv2.THRESH_BINARY)[1]
    # Statistics by OpenCV visit every pixel again; those of the tips are few.
    count, label = cv2.connectedComponents(lit, connectivity=4, ltype=label_type(lit))
    if count == 1:
        return np.empty((0, 2))
    at = np.flatnonzero(lit.view(np.bool_))  # of bools it is several times faster than of bytes
    of = label.ravel()[at]
    area = np.bincount(of, minlength=count)
    usual = float(np.partition(area[1:], (count - 1) // 2)[(count - 1) // 2])
    right = (area >= PIN_AREA[0] * usual) & (area <= PIN_AREA[1] * usual)
    right[0] = False
    weight = image.ravel()[at].astype(float) - level
    row, column = np.divmod(at, image.shape[1])
    mass = np.bincount(of, weight, count)
    mass[0] = 1.0
    middle = np.c_[np.bincount(of, weight * column, count) / mass, np.bincount(of, weight * row, count) / mass]
    out: FloatArray = middle[right]
    return out


@dataclass(frozen=True, eq=False)
class Tracked:
    """The pins in one image.

    Parameters
    ----------
    moved : (k, 2) float, px
        From rest; of a missing pin, what its neighbours say.
    missing : (k,) bool
    spare : int
        Tips that are no pin's.
    """

    moved: FloatArray
    missing: BoolArray
    spare: int


@dataclass(frozen=True, eq=False)
class Pins:
    """Pins at rest, and how they are found again.

    Parameters
    ----------
    rest : (k, 2) float, px
        Column and row of each tip of the untouched fingertip, or its usual place.
    shape : (int, int)
        Of the images: height and width.
    level : int
        Grey above which a pixel is a tip's.

    Raises
    ------
    InputError
        There are fewer than twelve pins.

    Examples
    --------
    >>> from skinfab.fingertip.optical.plates import HalfPlane
    >>> from skinfab.fingertip.optical.simulator import Fingertip
    >>> tip = Fingertip()
    >>> pins = Pins.of_rest(tip.image(tip.rest))
    >>> found = pins.track(tip.image(tip.pressed(HalfPlane(0.0, 0.0))))
    >>> len(pins.rest), int(found.missing.sum()), float(found.moved[:, 0].max().round(1))
    (127, 0, 7.1)
    """

    rest: FloatArray
    shape: tuple[int, int]
    level: int

    def __post_init__(self) -> None:
        if len(self.rest) < LEAST_PINS:
            raise InputError(
                f"{len(self.rest)} pins were found, and {LEAST_PINS} or more are needed; give images of bright tips on dark, in focus"
            )

    @classmethod
    def of_rest(cls, image: Image) -> Pins:
        """From an image of the untouched fingertip."""
        level = level_of([image])
        return cls(find_tips(image, level), image.shape, level)

    @classmethod
    def of_images(cls, images: Sequence[Image]) -> Pins:
        """From images of contacts, where there is none of the untouched fingertip: each pin's usual place.

        Raises
        ------
        InputError
            The images have no pattern in common.
        """
        level = level_of(images)
        some = images[:: max(len(images) // _IMAGES, 1)]
        tips = [find_tips(image, level) for image in some]
        counts = np.array([len(each) for each in tips])
        rest = tips[int(np.abs(counts - np.median(counts)).argmin())]
        for _ in range(_ROUNDS):
            pins = cls(rest, some[0].shape, level)
            found = [pins.match(each) for each in tips]
            rest = pins.rest + np.mean([each.moved for each in found], axis=0)
        # Only now: by the first image's places, which are moved themselves, a pin may be missed that its usual place finds.
        missing = np.mean([each.missing for each in found], axis=0)
        return cls(rest[missing < 1 - PIN_KEPT], some[0].shape, level)

    @cached_property
    def _near(self) -> tuple[IntArray, FloatArray]:
        """Each pin's neighbours (k, n), and how far it may move, (k,) px."""
        from scipy.spatial import cKDTree

        distance, near = cKDTree(self.rest).query(self.rest, k=1 + PIN_NEIGHBOURS)
        return near[:, 1:], PIN_REACH * distance[:, 1]

    @property
    def pitch_px(self) -> float:
        """How far apart neighbours usually lie, px."""
        return float(np.median(self._near[1])) / PIN_REACH

    @cached_property
    def _owner(self) -> NDArray[np.int32]:
        """Of each pixel, the pin that it is nearest to."""
        from scipy.spatial import cKDTree

        row, column = np.indices(self.shape)
        out: NDArray[np.int32] = cKDTree(self.rest).query(np.stack([column, row], axis=-1))[1].astype(np.int32)
        return out

    def track(self, image: Image) -> Tracked:
        """Find the pins in an image.

        Raises
        ------
        InputError
            The image has another size than the pattern's.
        """
        if image.shape != self.shape:
            raise InputError(
                f"an image of {image.shape[1]} x {image.shape[0]} pixels, and the pins are known in {self.shape[1]} x {self.shape[0]}; "
                "use the camera's settings of the training"
            )
        return self.match(find_tips(image, self.level))

    def match(self, tips: FloatArray) -> Tracked:
        """Give tips (m, 2) px to pins."""
        from scipy.spatial import cKDTree

        near, reach = self._near
        moved, missing = np.zeros_like(self.rest), np.ones(len(self.rest), dtype=bool)
        free = np.ones(len(tips), dtype=bool)
        if len(tips):
            at = np.rint(tips).astype(np.intp)
            owner = self._owner[at[:, 1], at[:, 0]]
            self._give(tips, np.arange(len(tips)), owner, self.rest[owner], reach, moved, missing, free)
        left = -1
        for _ in range(PIN_ROUNDS):
            if not missing.any() or missing.all() or free.sum() == left:
                break
            left = int(free.sum())
            self._fill(near, moved, missing)
            lost, which = np.flatnonzero(missing), np.flatnonzero(free)
            if len(which):
                expected = self.rest + moved
                owner = lost[cKDTree(expected[lost]).query(tips[which])[1]]
                self._give(tips, which, owner, expected[owner], reach, moved, missing, free)
        return Tracked(moved, missing, int(free.sum()))

    def _give(
        self,
        tips: FloatArray,
        which: IntArray,
        owner: NDArray[np.integer],
        expected: FloatArray,
        reach: FloatArray,
        moved: FloatArray,
        missing: BoolArray,
        free: BoolArray,
    ) -> None:
        """Each pin takes the nearest of the tips that are said to be its own and lie in reach of where it is expected."""
        off = np.hypot(*(tips[which] - expected).T)
        order = np.argsort(-off, kind="stable")  # the nearest is written last, and stays
        order = order[(off < reach[owner])[order]]
        chosen = np.full(len(self.rest), -1)
        chosen[owner[order]] = which[order]
        pin = np.flatnonzero(chosen >= 0)
        moved[pin] = tips[chosen[pin]] - self.rest[pin]
        missing[pin] = False
        free[chosen[pin]] = False

    def _fill(self, near: IntArray, moved: FloatArray, missing: BoolArray) -> None:
        """Put missing pins where their neighbours went; those without any stay at rest."""
        lost = np.flatnonzero(missing)
        seen = ~missing[near[lost]]
        count = seen.sum(axis=1, keepdims=True)
        moved[lost] = (moved[near[lost]] * seen[:, :, None]).sum(axis=1) / np.maximum(count, 1)
