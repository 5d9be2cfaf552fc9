"""Placing the sensors that `--sensors FILE.toml` asks for; `sensors_file` says how it is written."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.material import Material
from skinfab.mesh.model import Mesh
from skinfab.patterns.base import Pattern
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.pieces import Piece
from skinfab.placement.auto import place
from skinfab.placement.check import describe, find_faults
from skinfab.placement.fill import Region, best_in
from skinfab.placement.finger import Joint, facing_faces, is_finger, long_axis, place_strain
from skinfab.placement.raster import Raster
from skinfab.placement.search import poses_around, sensor_at
from skinfab.placement.sensor import Sensor
from skinfab.placement.sensors_file import Anywhere, FlatPose, OnObject, Request, read_sensors_file
from skinfab.placement.space import Footprint, Space, need_of
from skinfab.tolerances import JOINT_FRACTION, POINT_FRACTION

#: Directions tried for a sensor at a point of the object.
_DIRECTIONS = 72
#: Step in which the largest diameter that fits is named, mm.
_SIZE_STEP = 0.5


def place_from_file(
    path: str | Path, mesh: Mesh, pieces: Sequence[Piece], *, material: Material, seed: int = 0, present: Sequence[Sensor] = ()
) -> tuple[tuple[Sensor, ...], list[str]]:
    """Read a file of sensors and place them: first those with a pose, then the others, last the automatic ones.

    Parameters
    ----------
    path : path
    mesh : Mesh
    pieces : sequence of Piece
    material : Material
    seed : int
    present : sequence of Sensor
        Sensors that are there already: they stay, the others keep off them, and their ids and channels are taken.

    Returns
    -------
    sensors : tuple of Sensor
        By channel.
    warnings : list of str

    Raises
    ------
    InputError
        The file cannot be used, or names a piece that does not exist.
    RefusedError
        A sensor does not fit: names it and what is wrong.
    """
    wanted = read_sensors_file(path, material=material, present=present)
    spaces = [Space(mesh, piece, material, [s for s in present if s.piece == piece.id]) for piece in pieces]
    rng = np.random.default_rng(seed)
    order = {FlatPose: 0, OnObject: 1, Anywhere: 2}
    for request in sorted(wanted.requests, key=lambda r: order[type(r.pose)]):
        space, sensor = _placed(request, mesh, spaces, material, rng)
        faults = find_faults(space.piece, sensor, space.sensors, material=material)
        if faults:
            raise RefusedError(f"{request.where}: {describe(faults)}")
        space.add(sensor)
    if wanted.auto is not None:
        return place(mesh, pieces, material=material, seed=seed, options=wanted.auto, spaces=spaces)
    return tuple(sorted((s for space in spaces for s in space.sensors), key=lambda s: s.channel)), []


def nearest_on_pieces(mesh: Mesh, pieces: Sequence[Piece], point: NDArray[np.float64]) -> tuple[int, NDArray[np.float64], float]:
    """The surface point nearest to `point` (3,) mm: index of its piece, place on that piece (2,) mm, and how far it is, mm."""
    from trimesh.triangles import closest_point, points_to_barycentric

    best: tuple[float, int, NDArray[np.float64]] | None = None
    for k, piece in enumerate(pieces):
        triangles = piece.V(mesh)[piece.F]
        nearest = closest_point(triangles, np.broadcast_to(point, (len(triangles), 3)))
        apart = np.linalg.norm(nearest - point, axis=1)
        f = int(np.argmin(apart))
        if best is None or apart[f] < best[0]:
            weights = points_to_barycentric(triangles[f : f + 1], nearest[f : f + 1])[0]
            best = (float(apart[f]), k, weights @ piece.UV[piece.F[f]])
    if best is None:
        raise InputError("there is no piece to put a sensor on")
    return best[1], best[2], best[0]


def _placed(request: Request, mesh: Mesh, spaces: Sequence[Space], material: Material, rng: np.random.Generator) -> tuple[Space, Sensor]:
    pose, pattern = request.pose, request.pattern
    if isinstance(pose, FlatPose):
        space = next((s for s in spaces if s.piece.id == pose.piece), None)
        if space is None:
            raise InputError(f"{request.where}: no piece {pose.piece!r}; there are {', '.join(s.piece.id for s in spaces)}")
        return space, Sensor(request.id, pose.piece, pattern, pose.x, pose.y, pose.angle, request.channel)
    if isinstance(pose, OnObject):
        which, place_on_piece, away = nearest_on_pieces(mesh, [s.piece for s in spaces], np.array(pose.point))
        _near_enough(request.where, mesh, away)
        space, footprint = spaces[which], Footprint.of(pattern)
        turns = space.main_direction + np.arange(_DIRECTIONS) * 2 * np.pi / _DIRECTIONS if pose.angle is None else np.array([pose.angle])
        places = np.broadcast_to(place_on_piece, (len(turns), 2))
        poses = poses_around(space.raster, footprint, places, turns, need=need_of(pattern, material))
        angle = float(turns[np.argmax(np.round(poses.slack, 2))])
        return space, _named(sensor_at(space, pattern, footprint, place_on_piece, angle), request)
    found = _somewhere(request, pose, mesh, spaces, material, rng)
    return next(s for s in spaces if s.piece.id == found.piece), _named(found, request)


def _somewhere(
    request: Request, pose: Anywhere, mesh: Mesh, spaces: Sequence[Space], material: Material, rng: np.random.Generator
) -> Sensor:
    """The best place that there is, across a joint for strain sensors; its id and channel are still open."""
    pattern, facing = request.pattern, None if pose.facing is None else np.array(pose.facing)
    if pose.joint is not None:
        at = np.array(pose.joint)
        _near_enough(request.where, mesh, nearest_on_pieces(mesh, [s.piece for s in spaces], at)[2], fraction=JOINT_FRACTION)
        along = long_axis(mesh)[0][0] if pose.along is None else np.array(pose.along)
        found = place_strain(mesh, spaces, [pattern], material=material, rng=rng, joint=Joint(at, along, facing))
        if found is None:
            side = "" if facing is None else " on the side that it is to face"
            raise RefusedError(f"{request.where}: it does not fit across the joint{side}; make it smaller, or give it another pose")
        return found
    found = None
    if pattern.senses == "strain" and is_finger(mesh):
        found = place_strain(mesh, spaces, [pattern], material=material, rng=rng, joint=Joint.middle_of(mesh, facing=facing))
    if found is None:
        found = _anywhere(pattern, spaces, rng, facing=facing)
    if found is None and facing is not None and _anywhere(pattern, spaces, rng):
        raise RefusedError(
            f"{request.where}: it fits, but not where the surface faces {list(pose.facing or ())} to 45 degrees; make it smaller"
        )
    if found is None:
        raise RefusedError(f"{request.where}: {_too_large(pattern, spaces, rng)}")
    return found


def _anywhere(
    pattern: Pattern, spaces: Sequence[Space], rng: np.random.Generator, *, facing: NDArray[np.float64] | None = None
) -> Sensor | None:
    """Between creases if it fits there on some piece, else across them; pieces with the widest room first."""
    for between_creases in (True, False):
        rasters = [(space, space.facets if between_creases and len(space.creases) else space.raster) for space in spaces]
        for space, raster in sorted(rasters, key=lambda r: -r[1].clearance.max(initial=0.0)):
            cells = raster.free if facing is None else _facing_cells(space, raster, facing)
            found = best_in(Region(space, cells, between_creases), pattern, rng, packed=False) if cells.any() else None
            if found:
                return found
    return None


def _facing_cells(space: Space, raster: Raster, facing: NDArray[np.float64]) -> NDArray[np.bool_]:
    """The free cells of a raster whose place on the object faces a direction."""
    cells = raster.free.copy()
    face = space.locator.faces(raster.centres(cells))
    cells[raster.free] = (face >= 0) & facing_faces(space.mesh, space, facing)[face]
    return cells


def _near_enough(where: str, mesh: Mesh, away: float, *, fraction: float = POINT_FRACTION) -> None:
    """Refuse a point far from the object: it is of another scale, unit or origin."""
    low, high = mesh.V[mesh.F].min(axis=(0, 1)), mesh.V[mesh.F].max(axis=(0, 1))
    if away > fraction * np.linalg.norm(high - low):
        spans = ", ".join(f"{name} {a:.4g} to {b:.4g}" for name, a, b in zip("xyz", low, high, strict=True))
        raise InputError(
            f"{where}: the point is {away:.3g} mm from the object; coordinates are mm of the object as scaled, which spans {spans}"
        )


def _too_large(pattern: Pattern, spaces: Sequence[Space], rng: np.random.Generator) -> str:
    """Why a pattern fits on no piece, and the largest of a contact sensor's kind that does."""
    widest = max((2 * s.raster.clearance.max(initial=0.0) for s in spaces), default=0.0)
    refusal = f"it fits on no piece, whose largest free circle is {widest:.1f} mm across"
    if not isinstance(pattern, ContactSpiral):
        return f"{refusal}; make the sensor smaller or the pieces larger"
    # Bisection from the smallest that can be drawn: what fits, fits smaller too, but for the odd angle.
    low = int((4 * pattern.x + pattern.pitch_min) / _SIZE_STEP)
    high, best = int(min(pattern.s, widest) / _SIZE_STEP) + 1, None
    while high - low > 1:
        middle = (low + high) // 2
        smaller = _shrunk(pattern, middle * _SIZE_STEP)
        found = _anywhere(smaller, spaces, rng)
        if found:
            low, best = middle, (smaller, found.piece)
        else:
            high = middle
    if best is None:
        return f"{refusal}, and with x = {pattern.x:g}, b = {pattern.b:g} and l = {pattern.l:g} no smaller s fits either"
    fitting, piece = best
    return f"{refusal}; the largest that fits with this x and l is s = {fitting.s:g} with n = {fitting.n} and b = {fitting.b:g}, on {piece}"


def _shrunk(pattern: ContactSpiral, s: float) -> ContactSpiral:
    """The same spiral with diameter `s`, and with as many half-turns and as wide a pair of leads as that leaves."""
    n = min(pattern.n, ContactSpiral.half_turns_max(s=s, x=pattern.x, pitch_min=pattern.pitch_min))
    return dataclasses.replace(pattern, s=s, n=n, b=min(pattern.b, s - 2 * pattern.x))


def _named(sensor: Sensor, request: Request) -> Sensor:
    return dataclasses.replace(sensor, id=request.id, channel=request.channel)
