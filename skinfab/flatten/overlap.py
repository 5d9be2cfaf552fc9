"""Area of a flat piece that is covered more than once.

A map of a disk without flips is one-to-one just when its boundary curve does not cross itself. Where
it does (or only touches itself, as a net of a cube may), the plane is parted along the boundary and each
part's winding number says how many times it is covered.
"""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from skinfab.mesh.topology import Topology


def overlap_area(F: NDArray[np.int64], UV: NDArray[np.float64], *, topology: Topology | None = None) -> float:
    """Area covered twice counts once, three times twice, and so on; mm^2.

    Parameters
    ----------
    F : (m, 3) int64
    UV : (n, 2) float64, mm
    topology : Topology, optional
        Of `F`, where it is at hand.

    Returns
    -------
    float
        NaN where a coordinate is not finite.

    Examples
    --------
    >>> fan = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]])
    >>> turn = np.radians([0, 110, 220, 330, 440])
    >>> UV = np.vstack([[0, 0], np.c_[np.cos(turn), np.sin(turn)]])
    >>> round(overlap_area(fan, UV), 3)  # the last 80 degrees lie on the first triangle
    0.242
    """
    topology = topology or Topology(F)
    if not np.isfinite(UV).all():
        return float("nan")
    loops = [UV[loop] for loop in topology.boundary_loops if len(loop) >= 3]
    rings = [shapely.LinearRing(loop) for loop in loops]
    if not rings or (len(rings) == 1 and rings[0].is_simple):
        return 0.0
    # One orientation for both sides of every segment, so that coincident sides of a seam node identically.
    start, end = np.vstack(loops), np.vstack([np.roll(loop, -1, axis=0) for loop in loops])
    whole = float(np.sum(start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]) / 2)
    parts = shapely.get_parts(shapely.polygonize([shapely.union_all(np.array(rings, dtype=object))]))
    areas = shapely.area(parts)
    # A sliver between two sides of a closed seam is rounding, not overlap.
    real = areas > np.finfo(float).eps * 64 * abs(whole)
    inside = shapely.get_coordinates(shapely.point_on_surface(parts[real]))
    times = np.array([_winding(point, start, end) for point in inside]) * np.sign(whole)
    return float(np.sum(areas[real] * np.where(times > 1, times - 1, np.where(times < 0, -times, 0)), initial=0.0))


def _winding(point: NDArray[np.float64], start: NDArray[np.float64], end: NDArray[np.float64]) -> int:
    x, y = point
    side = (end[:, 0] - start[:, 0]) * (y - start[:, 1]) - (x - start[:, 0]) * (end[:, 1] - start[:, 1])
    up = (start[:, 1] <= y) & (end[:, 1] > y) & (side > 0)
    down = (start[:, 1] > y) & (end[:, 1] <= y) & (side < 0)
    return int(up.sum() - down.sum())
