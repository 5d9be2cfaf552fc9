"""Looking for a place for a pattern: on the raster first, then verified exactly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinfab.material import Material
from skinfab.mesh.model import Mesh
from skinfab.patterns.base import Pattern
from skinfab.pieces import Piece
from skinfab.placement.check import edge_curves, find_misfits
from skinfab.placement.distance import Curves, distance
from skinfab.placement.locate import Locator
from skinfab.placement.raster import Raster
from skinfab.placement.sensor import Sensor
from skinfab.tolerances import CREASE_LENGTH_MM, CREASE_RAD, PREVIEW_CHORD_MM

Array = NDArray[np.float64]

#: Places tried on the raster at each angle, and of these the best that are verified exactly.
_PLACES = 1200
_VERIFIED = 12
#: Distance of the points by which a pattern's rim is compared with the raster, mm.
_RIM_STEP = 1.5
#: A pose that lacks more than so many steps of the raster is not nudged: small moves will not free it.
_HOPELESS = 4.0
#: Moves of a pose that is nudged.
_NUDGES = 15


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
    """

    hull: Array
    rim: Array
    anchor: Array
    reach: float

    @staticmethod
    def of(pattern: Pattern) -> Footprint:
        """Of pads and all, about the pattern's middle."""
        import shapely

        points = pattern.printed_path().to_polyline(tolerance=PREVIEW_CHORD_MM)
        hull = shapely.Polygon(points).convex_hull
        assert isinstance(hull, shapely.Polygon)  # pads and turns are never all on one line
        anchor = pattern.middle
        return Footprint(
            hull=shapely.get_coordinates(hull.exterior)[:-1],
            rim=shapely.get_coordinates(shapely.segmentize(hull.exterior, _RIM_STEP))[:-1],
            anchor=anchor,
            reach=float(hull.exterior.distance(shapely.Point(anchor))),
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

    def add(self, sensor: Sensor) -> None:
        """Put a sensor on the piece; others keep off its whole convex hull."""
        self.sensors.append(sensor)
        hull = sensor_hull(sensor)
        self.raster.block_polygon(hull)
        if len(self.creases):
            self.facets.block_polygon(hull)

    def fits(self, sensor: Sensor, *, between_creases: bool) -> bool:
        """Exactly: on the piece, off its edges and the other sensors, and across no crease if so asked."""
        # Most that do not fit are told here, without the words for it.
        if distance(_curves(sensor), self.edges) < sensor.pattern.bead / 2 + self.material.margin:
            return False
        if find_misfits(self.piece, sensor, self.sensors, material=self.material, edges=self.edges, locator=self.locator):
            return False
        if not between_creases:
            return True
        return distance(_curves(sensor), self.creases) >= sensor.pattern.bead / 2

    def _raster(self, creases: Array) -> Raster:
        raster = Raster(_ends(self.edges), creases)
        for sensor in self.sensors:
            raster.block_polygon(sensor_hull(sensor))
        return raster


@dataclass(frozen=True, eq=False)
class Poses:
    """Where a pattern could lie: the anchor's place (n, 2) mm, the angle (n,) rad, room to spare (n,) mm."""

    places: Array
    angles: Array
    slack: Array

    def take(self, index: NDArray[np.int64]) -> Poses:
        return Poses(self.places[index], self.angles[index], self.slack[index])


def sensor_hull(sensor: Sensor) -> Array:
    """Convex hull of a sensor's printed centre line in the piece frame, (h, 2) mm."""
    c, s = np.cos(sensor.angle), np.sin(sensor.angle)
    return Footprint.of(sensor.pattern).hull @ np.array([[c, s], [-s, c]]) + [sensor.x, sensor.y]


def crease_lines(mesh: Mesh, piece: Piece) -> Array:
    """Interior edges of a piece that are sharp on the object, (n, 2, 2) mm in the plane.

    Sharp edges that are joined to less than `tolerances.CREASE_LENGTH_MM` of their like are noise and left out.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    topology = piece.topology
    inner = np.flatnonzero(topology.edge_count == 2)
    normals = mesh.face_normals[piece.faces][topology.EF[inner]]
    cosine = np.einsum("ij,ij->i", normals[:, 0], normals[:, 1])
    sharp = topology.E[inner[cosine < np.cos(CREASE_RAD)]]
    if not len(sharp):
        return np.zeros((0, 2, 2))
    n = len(piece.UV)
    _, label = connected_components(coo_array((np.ones(len(sharp)), (sharp[:, 0], sharp[:, 1])), shape=(n, n)), directed=False)
    lines = piece.UV[sharp]
    length = np.hypot(*(lines[:, 1] - lines[:, 0]).T)
    together = np.bincount(label[sharp[:, 0]], weights=length, minlength=n)
    return lines[together[label[sharp[:, 0]]] >= CREASE_LENGTH_MM]


def poses_around(raster: Raster, footprint: Footprint, places: Array, angles: Array, *, need: float) -> Poses:
    """Every place (n, 2) with the angle of its own (n,): how much room each pose leaves, less `need`."""
    turned = footprint.rim - footprint.anchor
    c, s = np.cos(angles)[:, None], np.sin(angles)[:, None]
    x = places[:, :1] + c * turned[:, 0] - s * turned[:, 1]
    y = places[:, 1:] + s * turned[:, 0] + c * turned[:, 1]
    slack = raster.clearance_at(np.stack([x, y], axis=2)).min(axis=1) - need
    return Poses(places, angles, slack)


def poses_in(
    raster: Raster, cells: NDArray[np.bool_], footprint: Footprint, angles: Array, *, need: float, rng: np.random.Generator
) -> Poses:
    """Poses with the anchor on a free cell of `cells` that the raster does not rule out, in no order."""
    possible = cells & (raster.clearance >= footprint.reach + need - raster.step)
    places = raster.centres(possible)
    if len(places) > _PLACES:
        # One half where there is most room, for what only just fits; the other anywhere, for packing.
        by_room = np.argsort(-np.round(raster.clearance_at(places), 6), kind="stable")
        anywhere = rng.choice(by_room[_PLACES // 2 :], _PLACES // 2, replace=False)
        places = places[np.sort(np.concatenate([by_room[: _PLACES // 2], anywhere]))]
    if not len(places):
        return Poses(np.zeros((0, 2)), np.zeros(0), np.zeros(0))
    each = [poses_around(raster, footprint, places, np.full(len(places), a), need=need) for a in angles]
    poses = Poses(*(np.concatenate([getattr(p, name) for p in each]) for name in ("places", "angles", "slack")))
    return poses.take(np.flatnonzero(poses.slack > -raster.step))


def first_fit(
    space: Space, pattern: Pattern, footprint: Footprint, poses: Poses, order: Sequence[int] | NDArray[np.int64], *, between_creases: bool
) -> Sensor | None:
    """The first of the poses, taken in `order`, at which the pattern fits exactly; its id and channel are still open."""
    for k in order[:_VERIFIED]:
        sensor = sensor_at(space, pattern, footprint, poses.places[k], float(poses.angles[k]))
        if space.fits(sensor, between_creases=between_creases):
            return sensor
    return None


def nudged_fit(space: Space, pattern: Pattern, footprint: Footprint, poses: Poses, start: int, *, between_creases: bool) -> Sensor | None:
    """A fit near one pose that the raster is too coarse to find: small moves and turns, each to where there is more room."""

    pattern_curves = Curves.of_segments(pattern.printed_path().segments)
    neighbours = [(_curves(other), space.material.gap + (pattern.bead + other.pattern.bead) / 2) for other in space.sensors]
    obstacles = [(space.edges, pattern.bead / 2 + space.material.margin), *neighbours]
    if between_creases:
        obstacles.append((space.creases, pattern.bead / 2))

    def room(place: Array, angle: float) -> float:
        here = pattern_curves.moved(angle=angle, shift=_origin(footprint, place, angle))
        return min(distance(here, obstacle) - need for obstacle, need in obstacles)

    place, angle = poses.places[start], float(poses.angles[start])
    best, step = room(place, angle), space.raster.step
    if best < -_HOPELESS * step:
        return None
    for _ in range(_NUDGES):
        if best >= 0:
            break
        turn = step / footprint.radius
        moves = [(place + step * np.array([np.cos(a), np.sin(a)]), angle) for a in np.arange(8) * np.pi / 4]
        moves += [(place, angle + turn), (place, angle - turn)]
        rooms = [room(*move) for move in moves]
        k = int(np.argmax(rooms))
        if rooms[k] > best:
            best, (place, angle) = rooms[k], moves[k]
        else:
            step /= 2
    sensor = sensor_at(space, pattern, footprint, place, angle)
    return sensor if best >= 0 and space.fits(sensor, between_creases=between_creases) else None


def sensor_at(space: Space, pattern: Pattern, footprint: Footprint, place: Array, angle: float) -> Sensor:
    """The pattern with its anchor at `place` (2,) mm, not checked; its id and channel are still open."""
    x, y = _origin(footprint, place, angle)
    return Sensor("new", space.piece.id, pattern, float(x), float(y), angle, -1)


def _origin(footprint: Footprint, place: Array, angle: float) -> Array:
    """Where the pattern's origin lies when its anchor is at `place`, (2,) mm."""
    c, s = np.cos(angle), np.sin(angle)
    origin: Array = place - np.array([[c, -s], [s, c]]) @ footprint.anchor
    return origin


def _curves(sensor: Sensor) -> Curves:
    return Curves.of_segments(sensor.printed_path.segments)


def need_of(pattern: Pattern, material: Material) -> float:
    """Centre line to anything else, mm: half a bead and the margin, or a bead and the gap to a neighbour, whichever is more."""
    return max(pattern.bead / 2 + material.margin, pattern.bead + material.gap)


def _ends(curves: Curves) -> Array:
    return np.stack([curves.p0, curves.p1], axis=1)
