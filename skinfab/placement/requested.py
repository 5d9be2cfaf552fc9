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
from skinfab.patterns.strain_lines import StrainLines
from skinfab.pieces import Piece
from skinfab.placement.auto import Region, best_in, place
from skinfab.placement.check import describe, find_faults
from skinfab.placement.finger import is_finger, place_strain
from skinfab.placement.search import Footprint, Space, need_of, poses_around, sensor_at
from skinfab.placement.sensor import Sensor
from skinfab.placement.sensors_file import FlatPose, OnObject, Request, read_sensors_file

#: Directions tried for a sensor at a point of the object.
_DIRECTIONS = 72


def place_from_file(
    path: str | Path, mesh: Mesh, pieces: Sequence[Piece], *, material: Material, seed: int = 0
) -> tuple[tuple[Sensor, ...], list[str]]:
    """Read a file of sensors and place them: first those with a pose, then the others, last the automatic ones.

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
    wanted = read_sensors_file(path, material=material)
    spaces = [Space(mesh, piece, material) for piece in pieces]
    rng = np.random.default_rng(seed)
    order = {FlatPose: 0, OnObject: 1, type(None): 2}
    for request in sorted(wanted.requests, key=lambda r: order[type(r.pose)]):
        space, sensor = _placed(request, mesh, spaces, material, rng)
        faults = find_faults(space.piece, sensor, space.sensors, material=material)
        if faults:
            raise RefusedError(describe(faults))
        space.add(sensor)
    if wanted.auto is not None:
        return place(mesh, pieces, material=material, seed=seed, options=wanted.auto, spaces=spaces)
    return tuple(sorted((s for space in spaces for s in space.sensors), key=lambda s: s.channel)), []


def nearest_on_pieces(mesh: Mesh, pieces: Sequence[Piece], point: NDArray[np.float64]) -> tuple[int, NDArray[np.float64]]:
    """Index of the piece and place on it (2,) mm of the surface point nearest to `point` (3,) mm."""
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
    return best[1], best[2]


def _placed(request: Request, mesh: Mesh, spaces: Sequence[Space], material: Material, rng: np.random.Generator) -> tuple[Space, Sensor]:
    pose, pattern = request.pose, request.pattern
    if isinstance(pose, FlatPose):
        space = next((s for s in spaces if s.piece.id == pose.piece), None)
        if space is None:
            raise InputError(f"{request.id}: no piece {pose.piece!r}; there are {', '.join(s.piece.id for s in spaces)}")
        return space, Sensor(request.id, pose.piece, pattern, pose.x, pose.y, pose.angle, request.channel)
    if isinstance(pose, OnObject):
        which, place_on_piece = nearest_on_pieces(mesh, [s.piece for s in spaces], np.array(pose.point))
        space, footprint = spaces[which], Footprint.of(pattern)
        turns = space.main_direction + np.arange(_DIRECTIONS) * 2 * np.pi / _DIRECTIONS if pose.angle is None else np.array([pose.angle])
        places = np.broadcast_to(place_on_piece, (len(turns), 2))
        poses = poses_around(space.raster, footprint, places, turns, need=need_of(pattern, material))
        angle = float(turns[np.argmax(np.round(poses.slack, 2))])
        return space, _named(sensor_at(space, pattern, footprint, place_on_piece, angle), request)
    found = None
    if isinstance(pattern, StrainLines) and is_finger(mesh):
        found = place_strain(mesh, spaces, [pattern], material=material, rng=rng)
    if found is None:
        found = _anywhere(pattern, spaces, rng)
    if found is None:
        widest = max((2 * s.raster.clearance.max(initial=0.0) for s in spaces), default=0.0)
        raise RefusedError(
            f"{request.id} ({pattern.kind}) fits on no piece: the largest free circle is {widest:.1f} mm across; "
            "make the sensor smaller or the pieces larger"
        )
    return next(s for s in spaces if s.piece.id == found.piece), _named(found, request)


def _anywhere(pattern: Pattern, spaces: Sequence[Space], rng: np.random.Generator) -> Sensor | None:
    """Between creases if it fits there on some piece, else across them; pieces with the widest room first."""
    for between_creases in (True, False):
        rasters = [(space, space.facets if between_creases and len(space.creases) else space.raster) for space in spaces]
        for space, raster in sorted(rasters, key=lambda r: -r[1].clearance.max(initial=0.0)):
            found = best_in(Region(space, raster, raster.free, between_creases), pattern, rng, packed=False)
            if found:
                return found
    return None


def _named(sensor: Sensor, request: Request) -> Sensor:
    return dataclasses.replace(sensor, id=request.id, channel=request.channel)
