"""The straight ways out of one point of a mould: over silicone to a wall, and through it to the outside."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon
from shapely.geometry.base import BaseGeometry

from skinfab.material import Mould
from skinfab.tolerances import MOULD_GRID_MM

#: Directions tried from each pad, besides the one to the nearest wall: every 2 degrees.
_DIRECTIONS = 180

#: A way that begins over the sensor's own side of the pad counts this much longer: behind the pad nothing is in the way of the hands.
_AHEAD = 2.0

#: A slot may run this many times the wall's width through it; more obliquely it would be a notch along the wall.
_OBLIQUE = 2.0


@dataclass(frozen=True, eq=False)
class Ways:
    """Straight ways out of one point, in the piece frame (mm).

    Parameters
    ----------
    wire : (n, 2, 2) float
        From the point to where the wall begins.
    wall : (n, 2, 2) float
        From there to where it ends.
    narrow : (n,) bool
        Whether another wall stands so near outside that lips may close the gap.
    length : (n,) float
        Of the wire; ways that begin the wrong way count longer.
    """

    wire: NDArray[np.float64]
    wall: NDArray[np.float64]
    narrow: NDArray[np.bool_]
    length: NDArray[np.float64]

    def only(self, which: NDArray[np.bool_]) -> Ways:
        """Some of them."""
        return Ways(self.wire[which], self.wall[which], self.narrow[which], self.length[which])


@dataclass(frozen=True, eq=False)
class _Rays:
    """What each of some rays meets, in this order, mm from its start; infinite where it does not."""

    wall: NDArray[np.float64]  # where the silicone ends
    out: NDArray[np.float64]  # where the ray then comes out at the outside
    behind: NDArray[np.float64]  # where it meets the mould again
    again: NDArray[np.float64]  # where it meets silicone again


class Edges:
    """The edges of silicone and wall, to be met by rays.

    Parameters
    ----------
    cavity, outer : MultiPolygon
        The silicone, and what the walls enclose.
    """

    def __init__(self, cavity: MultiPolygon, outer: MultiPolygon) -> None:
        self.shore = shapely.MultiLineString([ring for part in cavity.geoms for ring in (part.exterior, *part.interiors)])
        self.cavity = _segments(list(self.shore.geoms))
        self.outer = _segments([part.exterior for part in outer.geoms])
        self.pits = _segments([ring for part in outer.geoms for ring in part.interiors])

    def ways(self, at: NDArray[np.float64], *, away: NDArray[np.float64], mould: Mould) -> Ways:
        """The ways that go through no dart and into no pit.

        Parameters
        ----------
        at : (2,) float
            In the silicone.
        away : (2,) float
            The direction to begin in, if that can be; zeros where all are alike.
        mould : Mould
        """
        angle = np.linspace(0, 2 * np.pi, _DIRECTIONS, endpoint=False)
        nearest = shapely.get_coordinates(shapely.shortest_line(shapely.Point(at), self.shore))[1] - at
        ways = np.vstack([unit(nearest), np.c_[np.cos(angle), np.sin(angle)]])
        rays = self._along(at, ways)
        # Each of these is false where the ray does not come out: infinity is not below infinity.
        fits = (rays.out < rays.again) & (rays.out <= rays.wall + _OBLIQUE * mould.wall) & (rays.behind >= rays.out + mould.wall)
        ways, wall, out = ways[fits], rays.wall[fits], rays.out[fits]
        # Lips grow into what is outside now: where they would close a notch, the wire had better not go.
        narrow = rays.behind[fits] < out + 2 * (mould.lip + mould.wall)
        begin, end = at + wall[:, None] * ways, at + out[:, None] * ways
        start = np.broadcast_to(at, begin.shape)
        length = (wall * np.where(ways @ away < 0, _AHEAD, 1.0)).round(6)
        return Ways(np.stack([start, begin], axis=1), np.stack([begin, end], axis=1), narrow, length)

    def out(self, at: NDArray[np.float64], way: NDArray[np.float64]) -> NDArray[np.float64] | None:
        """Where a ray from the silicone's edge comes out at the outside; None where silicone or a pit is on its way."""
        rays = self._along(at, way[None], wall=np.zeros(1))
        return at + rays.out[0] * way if rays.out[0] < rays.again[0] else None

    def _along(self, at: NDArray[np.float64], ways: NDArray[np.float64], *, wall: NDArray[np.float64] | None = None) -> _Rays:
        """Rays from a point in the silicone, or from its edge where `wall` (zeros) says so."""
        silicone, outside, pits = (_hits(at, ways, edges) for edges in (self.cavity, self.outer, self.pits))
        wall = _next(silicone, np.zeros(len(ways))) if wall is None else wall
        out = _next(outside, wall)
        out = np.where(_next(pits, wall) < out, np.inf, out)
        return _Rays(wall, out, _next(outside, out), _next(silicone, wall))


def unit(way: NDArray[np.float64]) -> NDArray[np.float64]:
    """A vector of length one in the same direction; zeros stay zeros."""
    return way / max(float(np.hypot(*way)), np.finfo(float).tiny)


def _hits(at: NDArray[np.float64], ways: NDArray[np.float64], edges: NDArray[np.float64]) -> NDArray[np.float64]:
    """How far along each ray each edge is met, (ways, edges); infinite where it is not."""
    along, to = edges[:, 1] - edges[:, 0], edges[:, 0] - at
    x, y = ways.T[:, :, None]
    with np.errstate(divide="ignore", invalid="ignore"):  # a ray beside an edge never meets it
        det = x * along[:, 1] - y * along[:, 0]
        t = (to[:, 0] * along[:, 1] - to[:, 1] * along[:, 0]) / det
        s = (to[:, 0] * y - to[:, 1] * x) / det
        return np.where((s >= 0) & (s <= 1) & (t > 0), t, np.inf)


def _next(hits: NDArray[np.float64], after: NDArray[np.float64]) -> NDArray[np.float64]:
    """The first hit of each ray that is not at its place `after` itself."""
    later: NDArray[np.float64] = np.where(hits > after[:, None] + MOULD_GRID_MM, hits, np.inf).min(axis=1, initial=np.inf)
    return later


def _segments(rings: Sequence[BaseGeometry]) -> NDArray[np.float64]:
    """(n, 2, 2): the edges of closed rings."""
    return np.concatenate([np.zeros((0, 2, 2)), *(np.stack([c[:-1], c[1:]], axis=1) for c in map(shapely.get_coordinates, rings))])
