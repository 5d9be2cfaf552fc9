"""How many contact sensors each part of a skin gets."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

#: Channels of the paper's readout: two 16-channel multiplexers.
CHANNELS = 32
#: A piece gets one sensor for so much area, mm^2; its largest, 45 mm across with leads and margins, takes about 30 cm^2.
AREA_PER_SENSOR = 4000.0
#: But at least so many where they fit.
LEAST_PER_PIECE = 4


def default_number(area: float, faces: int) -> int:
    """Contact sensors for a piece of `area` mm^2: one on each of its faces, and one for every 40 cm^2, but at least 4.

    Examples
    --------
    >>> default_number(9600, 6), default_number(45600, 3), default_number(2000, 1)
    (6, 11, 4)
    """
    return max(faces, round(area / AREA_PER_SENSOR), LEAST_PER_PIECE)


def share(areas: ArrayLike, *, most: int, caps: Sequence[int] | None = None) -> NDArray[np.int64]:
    """Split `most` sensors among parts: one each, the largest part first; what is left by area (d'Hondt's method).

    Parameters
    ----------
    areas : (n,) float
    most : int
    caps : sequence of int, optional
        No part gets more than its cap.

    Returns
    -------
    (n,) int

    Examples
    --------
    >>> share([10, 50, 20], most=2), share([10, 50, 20], most=8), share([10, 50, 20], most=8, caps=[4, 2, 4])
    (array([0, 1, 1]), array([1, 5, 2]), array([2, 2, 4]))
    """
    size = np.asarray(areas, dtype=float)
    cap = np.full(len(size), most) if caps is None else np.asarray(caps)
    counts = np.zeros(len(size), dtype=np.int64)
    order = np.argsort(-size, kind="stable")
    counts[order[cap[order] > 0][: max(most, 0)]] = 1
    for _ in range(most - int(counts.sum())):
        wish = np.where(counts < cap, size / (counts + 1), -1.0)
        if not len(wish) or wish.max() < 0:
            break
        counts[np.argmax(wish)] += 1
    return counts
