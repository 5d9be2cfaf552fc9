"""The room there is: a piece with what lies on it, and the room that a pattern takes."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.locate import Locator
from skinfab.material import Material
from skinfab.mesh.joined import joined
from skinfab.mesh.model import Mesh
from skinfab.patterns.base import Pattern
from skinfab.pieces import Piece
from skinfab.placement.check import edge_curves
from skinfab.placement.distance import Curves, distance
from skinfab.placement.raster import Raster
from skinfab.placement.sensor import Sensor
from skinfab.tolerances import CREASE_LENGTH_MM, CREASE_RAD, PREVIEW_CHORD_MM

Array = NDArray[np.float64]

#: Distance of the points by which a pattern's rim is compared with the raster, mm.
_RIM_STEP = 1.5


@dataclass(frozen=True, eq=False)
class Footprint:
    """The room a pattern takes, about an anchor in its own frame.

    Parameters
    ----------
    hull : (h, 2) float, mm
        Convex hull of the printed centre line.
    rim : (k, 2) float, mm
        Points along the hull, at most 1.5 mm apart.
    anchor : (2,) float, mm
        The pattern's middle.
    reach : float, mm
        A circle of this radius about the anchor lies inside the hull.
    curves : Curves
        The printed centre line itself.
    """

    hull: Array
    rim: Array
    anchor: Array
    reach: float
    curves: Curves

    @staticmethod
    @lru_cache(maxsize=64)  # patterns are values, and the same few are asked for at every turn
    def of(pattern: Pattern) -> Footprint:
        """Of pads and all, about the pattern's middle."""
        import shapely

        path = pattern.printed_path()
        points = path.to_polyline(tolerance=PREVIEW_CHORD_MM)
        hull = shapely.Polygon(points).convex_hull
        assert isinstance(hull, shapely.Polygon)  # pads and turns are never all on one line
        anchor = pattern.middle
        return Footprint(
            hull=shapely.get_coordinates(hull.exterior)[:-1],
            rim=shapely.get_coordinates(shapely.segmentize(hull.exterior, _RIM_STEP))[:-1],
            anchor=anchor,
            reach=float(hull.exterior.distance(shapely.Point(anchor))),
            curves=Curves.of_segments(path.segments),
        )

    @property
    def radius(self) -> float:
        """Of the circle about the anchor that holds it all, mm."""
        return float(np.hypot(*(self.hull - self.anchor).T).max())


@dataclass(eq=False)
class Space:
    """One piece with what lies on it already.

    Parameters
    ----------
    mesh : Mesh
    piece : Piece
    material : Material
    sensors : list of Sensor
        Grows by `add`.
    """

    mesh: Mesh
    piece: Piece
    material: Material
    sensors: list[Sensor] = field(default_factory=list)

    @cached_property
    def edges(self) -> Curves:
        return edge_curves(self.piece)

    @cached_property
    def locator(self) -> Locator:
        return Locator(self.piece.UV, self.piece.F)

    @cached_property
    def creases(self) -> Curves:
        """Lines on the flat piece where the object is sharp."""
        return Curves.of_edges(crease_lines(self.mesh, self.piece))

    @cached_property
    def raster(self) -> Raster:
        """Free space with the creases crossed."""
        return self._raster(np.zeros((0, 2, 2)))

    @cached_property
    def facets(self) -> Raster:
        """Free space between the creases."""
        return self._raster(_ends(self.creases))

    @cached_property
    def main_direction(self) -> float:
        """Direction of the longest edge of the outline, rad: sensors that line up with it look at home."""
        ends = _ends(self.edges)
        along = ends[:, 1] - ends[:, 0]
        dx, dy = along[np.argmax(np.round(np.hypot(*along.T), 6))]
        return float(np.arctan2(dy, dx))

    @cached_property
    def taken(self) -> list[Curves]:
        """The centre lines of the sensors that are there, in their order."""
        return [sensor_curves(s) for s in self.sensors]

    def add(self, sensor: Sensor) -> None:
        """Put a sensor on the piece; others keep off its whole convex hull."""
        self.taken.append(sensor_curves(sensor))
        self.sensors.append(sensor)
        hull = sensor_hull(sensor)
        for name in ("raster", "facets"):
            # One that is not made yet will be made with it.
            if name in self.__dict__:
                self.__dict__[name].block_polygon(hull)

    def copy(self) -> Space:
        """The same piece with the same sensors, to try more on."""
        twin = Space(self.mesh, self.piece, self.material, list(self.sensors))
        for name in ("edges", "locator", "creases", "main_direction"):
            twin.__dict__[name] = getattr(self, name)
        for name in ("raster", "facets", "taken"):
            if name in self.__dict__:
                twin.__dict__[name] = self.__dict__[name].copy()
        return twin

    def fits(self, sensor: Sensor, *, between_creases: bool) -> bool:
        """Exactly: on the piece, off its edges and the other sensors, and across no crease if so asked."""
        curves, bead = sensor_curves(sensor), sensor.pattern.bead
        if distance(curves, self.edges) < bead / 2 + self.material.margin:
            return False
        # A path that meets no edge is inside or outside as a whole: one point decides.
        if self.locator.faces(curves.p0[:1])[0] < 0:
            return False
        for other, there in zip(self.sensors, self.taken, strict=True):
            if distance(curves, there) < self.material.gap + (bead + other.pattern.bead) / 2:
                return False
        return not between_creases or distance(curves, self.creases) >= bead / 2

    def _raster(self, creases: Array) -> Raster:
        raster = Raster(_ends(self.edges), creases)
        for sensor in self.sensors:
            raster.block_polygon(sensor_hull(sensor))
        return raster


def sensor_hull(sensor: Sensor) -> Array:
    """Convex hull of a sensor's printed centre line in the piece frame, (h, 2) mm."""
    c, s = np.cos(sensor.angle), np.sin(sensor.angle)
    return Footprint.of(sensor.pattern).hull @ np.array([[c, s], [-s, c]]) + [sensor.x, sensor.y]


def crease_lines(mesh: Mesh, piece: Piece) -> Array:
    """Interior edges of a piece that are sharp on the object, (n, 2, 2) mm in the plane.

    Sharp edges that are joined to less than `tolerances.CREASE_LENGTH_MM` of their like are noise and left out.
    """
    topology = piece.topology
    inner = np.flatnonzero(topology.edge_count == 2)
    normals = mesh.face_normals[piece.faces][topology.EF[inner]]
    cosine = np.einsum("ij,ij->i", normals[:, 0], normals[:, 1])
    sharp = topology.E[inner[cosine < np.cos(CREASE_RAD)]]
    if not len(sharp):
        return np.zeros((0, 2, 2))
    n = len(piece.UV)
    _, label = joined(sharp[:, 0], sharp[:, 1], n)
    lines = piece.UV[sharp]
    length = np.hypot(*(lines[:, 1] - lines[:, 0]).T)
    together = np.bincount(label[sharp[:, 0]], weights=length, minlength=n)
    return lines[together[label[sharp[:, 0]]] >= CREASE_LENGTH_MM]


def sensor_curves(sensor: Sensor) -> Curves:
    """A sensor's printed centre line in the piece frame."""
    return Footprint.of(sensor.pattern).curves.moved(angle=sensor.angle, shift=(sensor.x, sensor.y))


def need_of(pattern: Pattern, material: Material) -> float:
    """Centre line to anything else, mm: half a bead and the margin, or a bead and the gap to a neighbour, whichever is more."""
    return max(pattern.bead / 2 + material.margin, pattern.bead + material.gap)


def _ends(curves: Curves) -> Array:
    return np.stack([curves.p0, curves.p1], axis=1)
