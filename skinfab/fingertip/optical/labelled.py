"""Images of a simulated fingertip on straight edges, each with the edge's true pose: to learn from and to judge by."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from skinfab.fingertip.optical.edge import Edge
from skinfab.fingertip.optical.plates import HalfPlane
from skinfab.fingertip.optical.simulator import Fingertip, Image

#: How far off an edge lies at most, and how far the skin is dragged each way at most, mm.
REACH_MM, SHEAR_MM = 8.0, 0.3
#: How deep the dome is pressed, mm: from a light touch on, as every contact begins with one; and by a robot that follows an edge at 2 mm.
DEPTHS_MM, FOLLOWED_MM = (0.3, 2.4), (1.6, 2.4)
#: An edge that lies so far beyond the rim of the contact, mm, is not felt: images of those that lie farther still would show the same.
_BEYOND_MM = 1.0


@dataclass(frozen=True, eq=False)
class Labelled:
    """An image and what is true.

    Parameters
    ----------
    image : (n, n) uint8
    edge : Edge
    shear_mm : (2,) float
    """

    image: Image
    edge: Edge
    shear_mm: tuple[float, float]


def labelled(
    tip: Fingertip,
    count: int,
    *,
    reach_mm: float = REACH_MM,
    depths_mm: tuple[float, float] = DEPTHS_MM,
    shear_mm: float = SHEAR_MM,
    seed: int = 0,
) -> Iterator[Labelled]:
    """Images of edges in every direction and at every place within reach, that the contact reaches or just does not.

    Parameters
    ----------
    tip : Fingertip
    count : int
    reach_mm : float
        Farthest that an edge lies from the middle. A light touch reaches less far.
    depths_mm : (2,) float
    shear_mm : float
        Most that the skin which touches is dragged, each way.
    seed : int

    Examples
    --------
    >>> [one] = labelled(Fingertip(), 1, seed=3)
    >>> one.image.shape, abs(one.edge.offset_mm) <= 8, 0.3 <= one.edge.depth_mm <= 2.4
    ((240, 240), True, True)
    """
    rng = np.random.default_rng((seed, 4))
    for _ in range(count):
        place, angle = float(rng.uniform(-1, 1)), float(rng.uniform(-math.pi, math.pi))
        depth = float(rng.uniform(*depths_mm))
        offset = place * min(reach_mm, math.sqrt(depth * (2 * tip.dome.radius_mm - depth)) + _BEYOND_MM)
        x, y = (float(rng.uniform(-shear_mm, shear_mm)) for _ in range(2))
        image = tip.frame(HalfPlane(offset, angle), rng=rng, depth_mm=depth, shear_mm=(x, y))
        yield Labelled(image, Edge(offset, angle, depth), (x, y))
