"""A body whose walls lean: one outline below, a wider one above, slanted faces between."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon

from skinfab.errors import RefusedError


def tapered(narrow: MultiPolygon, wide: MultiPolygon, *, z: tuple[float, float, float, float]) -> Any:
    """The manifold3d solid with section `narrow` from z[0] to z[1] and `wide` from z[2] to z[3].

    Between z[1] and z[2] its wall is the ring between the two outlines, triangulated without new points and
    lifted: a terrain, which cannot cut itself however the outlines bend, or where a part of one has no like in the other.

    Parameters
    ----------
    narrow, wide : MultiPolygon, mm
        `narrow` lies inside `wide` and does not touch its edge.
    z : four floats, mm
        Ascending.

    Raises
    ------
    RefusedError
        The outlines touch or cross.

    Examples
    --------
    >>> inner, outer = (MultiPolygon([shapely.box(-r, -r, r, r)]) for r in (1.0, 2.0))
    >>> round(tapered(inner, outer, z=(0.0, 1.0, 2.0, 3.0)).volume(), 6)  # 4 + 28 / 3 + 16
    29.333333
    """
    from manifold3d import Manifold, Mesh64

    if not wide.contains_properly(narrow):
        raise RefusedError("a mould's walls meet where they lean outwards; lower mould.draft_deg in the material profile")
    narrow, wide = (shapely.orient_polygons(region) for region in (narrow, wide))
    low, high = (_Outline(region) for region in (narrow, wide))
    n, m = len(low.points), len(high.points)
    # Vertices: `narrow` at its two heights, then `wide` at its two.
    points = np.vstack([low.points, low.points, high.points, high.points])
    V = np.column_stack([points, np.repeat(z, [n, n, m, m])])
    ring = _lifted(shapely.difference(wide, narrow), low, high, n)
    F = np.vstack([low.cap()[:, ::-1], low.wall(n), ring[:, ::-1], high.wall(m) + 2 * n, high.cap() + 2 * n + m])
    solid = Manifold(Mesh64(V, F.astype(np.uint64)))
    if solid.is_empty():
        raise RefusedError("a mould's leaning walls do not close; lower mould.draft_deg in the material profile")
    return solid


class _Outline:
    """The rings of a region: their points one after the other, outer rings counter-clockwise."""

    def __init__(self, region: MultiPolygon) -> None:
        self.rings = [np.asarray(ring.coords)[:-1] for part in region.geoms for ring in (part.exterior, *part.interiors)]
        self.points: NDArray[np.float64] = np.vstack(self.rings)

    def cap(self) -> NDArray[np.int64]:
        """Triangles over the region, facing up."""
        from manifold3d import triangulate

        return np.asarray(triangulate(self.rings), dtype=np.int64)

    def wall(self, lift: int) -> NDArray[np.int64]:
        """Triangles between the rings and themselves `lift` vertices on, facing out."""
        here, start = [], 0
        for ring in self.rings:
            k = np.arange(len(ring))
            here.append(start + np.c_[k, np.roll(k, -1)])
            start += len(ring)
        a, b = np.vstack(here).T
        return np.vstack([np.c_[a, b, b + lift], np.c_[a, b + lift, a + lift]])


def _lifted(ring: shapely.Geometry, low: _Outline, high: _Outline, n: int) -> NDArray[np.int64]:
    """The ring's triangles by vertex, facing up: points of `low` at its upper height, of `high` at its lower."""
    triangles = shapely.get_parts(shapely.constrained_delaunay_triangles(ring))
    corners = shapely.get_coordinates(shapely.orient_polygons(triangles)).reshape(-1, 4, 2)[:, :3]
    known = np.vstack([low.points, high.points]) @ np.array([1, 1j])
    order = np.argsort(known, kind="stable")
    wanted = (corners @ np.array([1, 1j])).ravel()
    at = order[np.minimum(np.searchsorted(known, wanted, sorter=order), len(known) - 1)]
    if not np.array_equal(known[at], wanted):
        raise RefusedError("a mould's leaning walls cross each other; lower mould.draft_deg in the material profile")
    return at.reshape(-1, 3) + n
