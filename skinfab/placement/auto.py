"""The first placement, without anyone's help: contact spirals on faces, a strain sensor along a finger.

No other tool has it; the paper names manual placement as a limitation. Everything chosen here can be edited after.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.material import Material
from skinfab.mesh.model import Mesh
from skinfab.patterns.base import Pattern
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.registry import PATTERNS
from skinfab.patterns.strain_lines import StrainLines
from skinfab.pieces import Piece
from skinfab.placement.finger import is_finger, place_strain, strain_sizes
from skinfab.placement.raster import Raster
from skinfab.placement.search import Footprint, Poses, Space, first_fit, need_of, nudged_fit, poses_in
from skinfab.placement.sensor import Sensor

#: Sizes of the paper's contact sensors, table II, mm.
SEED_SIZES = (45.0, 38.0, 32.0, 22.0, 20.0, 15.0, 10.0)
#: A second sensor beside another is at least this large, mm: smaller ones are for places where nothing else fits.
_FILL_SIZE = 15.0
#: Channels of the paper's readout: two 16-channel multiplexers.
CHANNELS = 32
#: Terminals point in so many directions, evenly spread from the direction of the piece's longest edge on.
_DIRECTIONS = 24


@dataclass(frozen=True)
class AutoOptions:
    """What automatic placement should do.

    Parameters
    ----------
    kinds : tuple of str
        Kinds of pattern it may use.
    sizes : tuple of float, mm
        Outer diameters of contact spirals, in any order.
    per_piece : int
        At most so many contact sensors on a piece; but a piece with more faces between creases gets one on each.
    """

    kinds: tuple[str, ...] = (ContactSpiral.kind, StrainLines.kind)
    sizes: tuple[float, ...] = SEED_SIZES
    per_piece: int = 4

    def __post_init__(self) -> None:
        for kind in self.kinds:
            if kind not in PATTERNS:
                raise InputError(f"automatic placement knows no kind {kind!r}; there are {', '.join(sorted(PATTERNS))}")
        if not self.sizes or not all(np.isfinite(s) and s > 0 for s in self.sizes):
            raise InputError(f"automatic placement: sizes are {list(self.sizes)}; give one or more diameters above 0 mm")
        if self.per_piece < 1:
            raise InputError(f"automatic placement: per_piece is {self.per_piece}; it must be at least 1")


def spiral_of_size(s: float, material: Material) -> ContactSpiral:
    """A contact spiral of diameter `s` with the paper's proportions.

    Pitch, lead separation and lead length grow over the paper's ranges (1.7-3.2, 1.5-8, 3-8 mm) from s = 15 to
    s = 45, as far as the material's bead and gap allow; half-turns are as many as fit, six at most.

    Raises
    ------
    PatternError
        Not even one half-turn fits.
    """
    bead, gap = material.ink.bead_width, material.gap
    t = float(np.clip((s - 15) / 30, 0, 1))
    x, b, l = (max(round(low + t * (high - low), 2), bead + gap) for low, high in ((1.7, 3.2), (1.5, 8.0), (3.0, 8.0)))  # noqa: E741
    n = max(min(ContactSpiral.half_turns_max(s=s, x=x, pitch_min=bead + gap), 6), 1)
    return ContactSpiral(n=n, x=x, b=b, l=l, s=s, bead=bead, gap=gap, pad=material.pad)


def place(
    mesh: Mesh,
    pieces: Sequence[Piece],
    *,
    material: Material,
    seed: int = 0,
    options: AutoOptions | None = None,
    spaces: Sequence[Space] | None = None,
) -> tuple[tuple[Sensor, ...], list[str]]:
    """Place sensors on every piece; the same input and seed give the same sensors.

    A finger (`finger.is_finger`) gets one strain sensor across its middle; then every piece gets contact
    spirals, as large as fit: one on each face between creases, up to ``options.per_piece`` where there are
    fewer faces. Creases count for nothing on a piece where otherwise nothing fits.

    Parameters
    ----------
    mesh : Mesh
    pieces : sequence of Piece
    material : Material
    seed : int
        Which of many places on a large piece are looked at.
    options : AutoOptions, optional
    spaces : sequence of Space, optional
        The pieces with sensors that are there already; these stay, and come first in what is returned.

    Returns
    -------
    sensors : tuple of Sensor
        Ids "C1".. and "S1".., channels counted from 0.
    warnings : list of str
        Pieces that stay without a sensor and why; channels beyond the readout's.
    """
    options = options or AutoOptions()
    rng = np.random.default_rng(seed)
    spaces = list(spaces) if spaces is not None else [Space(mesh, piece, material) for piece in pieces]
    namer = Namer(spaces)
    warnings: list[str] = []
    if StrainLines.kind in options.kinds and is_finger(mesh):
        _strain(mesh, spaces, namer, warnings, material=material, rng=rng)
    if ContactSpiral.kind in options.kinds:
        spirals = [spiral_of_size(s, material) for s in sorted(set(options.sizes), reverse=True)]
        for space in spaces:
            _contacts(space, spirals, namer, options.per_piece, rng)
            if not space.sensors:
                warnings.append(_why_empty(space, spirals[-1]))
    if len(namer.sensors) > CHANNELS:
        warnings.append(f"{len(namer.sensors)} sensors need more than the {CHANNELS} channels of two 16-channel multiplexer boards")
    return tuple(namer.sensors), warnings


class Namer:
    """Numbers sensors as they come and keeps them in order."""

    def __init__(self, spaces: Sequence[Space]) -> None:
        self.sensors = sorted((s for space in spaces for s in space.sensors), key=lambda s: s.channel)

    def add(self, space: Space, sensor: Sensor) -> Sensor:
        """Give a sensor the next free id of its kind and the next free channel, and put it on its piece."""
        letter = "S" if sensor.pattern.kind == StrainLines.kind else "C"
        ids, channels = {s.id for s in self.sensors}, {s.channel for s in self.sensors}
        id = next(f"{letter}{k}" for k in range(1, len(ids) + 2) if f"{letter}{k}" not in ids)
        channel = next(k for k in range(len(channels) + 1) if k not in channels)
        named = dataclasses.replace(sensor, id=id, channel=channel)
        self.sensors.append(named)
        space.add(named)
        return named


def _strain(
    mesh: Mesh, spaces: Sequence[Space], namer: Namer, warnings: list[str], *, material: Material, rng: np.random.Generator
) -> None:
    sizes = list(strain_sizes(material))
    sensor = place_strain(mesh, spaces, sizes, material=material, rng=rng)
    if sensor is None:
        smallest = f"even {sizes[-1].l1:g} x {sizes[-1].b:g} mm does not fit along it" if sizes else "the bead is too wide for it"
        warnings.append(f"{mesh.name} looks like a finger, but there is no strain sensor across its middle: {smallest}")
        return
    namer.add(next(s for s in spaces if s.piece.id == sensor.piece), sensor)


def _contacts(space: Space, spirals: Sequence[ContactSpiral], namer: Namer, per_piece: int, rng: np.random.Generator) -> None:
    """Fill the faces between creases; where that gives nothing, the piece as a whole."""
    for raster, between_creases in ((space.facets, True), (space.raster, False)) if len(space.creases) else ((space.raster, False),):
        count, label = raster.regions()
        smallest = Footprint.of(spirals[-1])
        least = smallest.reach + need_of(spirals[-1], space.material) - raster.step
        room = np.array([raster.clearance[label == k].max(initial=0.0) for k in range(1, count + 1)])
        wide = [k + 1 for k in np.argsort(-room, kind="stable") if room[k] >= least]
        if not wide:
            continue
        placed = 0
        for k in wide:
            region = Region(space, raster, label == k, between_creases)
            placed += _fill(region, spirals, namer, max(per_piece // len(wide), 1), rng)
        if placed:
            return


def _fill(region: Region, spirals: Sequence[ContactSpiral], namer: Namer, limit: int, rng: np.random.Generator) -> int:
    """Spirals from the largest down: spread out where as large ones fit so, else packed from one end."""
    found = _series(region, spirals, limit, rng, packed=False)
    if 1 < limit:
        packed = _series(region, spirals, limit, rng, packed=True)
        if _covered(packed) > _covered(found):
            found = packed
    for sensor in found:
        namer.add(region.space, sensor)
    return len(found)


def _series(region: Region, spirals: Sequence[ContactSpiral], limit: int, rng: np.random.Generator, *, packed: bool) -> list[Sensor]:
    """One sensor after the other on a copy of the region, up to `limit`."""
    found: list[Sensor] = []
    trial = _copy(region) if limit > 1 else region
    k = 0
    while k < len(spirals) and len(found) < limit:
        sensor = None if found and spirals[k].s < _FILL_SIZE else best_in(trial, spirals[k], rng, packed=packed)
        if sensor is None:
            k += 1
            continue
        found.append(dataclasses.replace(sensor, id=f"trial {len(found)}"))
        if limit > 1:
            trial.space.add(found[-1])
    return found


def _covered(sensors: Sequence[Sensor]) -> float:
    """Area of their discs, but for the factor pi/4, mm^2."""
    return float(sum(s.pattern.s**2 for s in sensors if isinstance(s.pattern, ContactSpiral)))


@dataclass(frozen=True, eq=False)
class Region:
    """A part of a piece that is filled by itself."""

    space: Space
    raster: Raster
    cells: NDArray[np.bool_]
    between_creases: bool


def _copy(region: Region) -> Region:
    """The same region on a copy of its piece, to try on."""
    space = Space(region.space.mesh, region.space.piece, region.space.material, list(region.space.sensors))
    # Share what does not change; the two rasters are made anew from the sensors.
    for name in ("edges", "locator", "creases", "main_direction"):
        setattr(space, name, getattr(region.space, name))
    return Region(space, space.facets if region.between_creases else space.raster, region.cells, region.between_creases)


def best_in(region: Region, pattern: Pattern, rng: np.random.Generator, *, packed: bool) -> Sensor | None:
    """Where a pattern fits in a region: in the roomiest place, or `packed` towards one end; None where it does not fit."""
    footprint = Footprint.of(pattern)
    turns = region.space.main_direction + np.arange(_DIRECTIONS) * 2 * np.pi / _DIRECTIONS
    poses = poses_in(region.raster, region.cells, footprint, turns, need=need_of(pattern, region.space.material), rng=rng)
    if not len(poses.slack):
        return None
    space, between_creases = region.space, region.between_creases
    roomiest = np.argsort(-np.round(poses.slack, 2), kind="stable")
    for order in (_from_one_end(region, poses), roomiest) if packed else (roomiest,):
        sensor = first_fit(space, pattern, footprint, poses, order, between_creases=between_creases)
        if sensor:
            return sensor
    return nudged_fit(space, pattern, footprint, poses, int(roomiest[0]), between_creases=between_creases)


def _from_one_end(region: Region, poses: Poses) -> NDArray[np.int64]:
    """Poses with some room to spare, those nearest to one end of the region first."""
    ok = np.flatnonzero(poses.slack >= region.raster.step / 2)
    if not len(ok):
        return ok
    places = region.raster.centres(region.cells)
    middle = places.mean(axis=0)
    _, axes = np.linalg.eigh(np.cov((places - middle).T))
    from_end, across = ((poses.places[ok] - middle) @ axes[:, ::-1]).T
    # Whole millimetres, so that the second direction has a say too.
    return ok[np.lexsort((-poses.slack[ok], np.round(across), np.round(from_end)))]


def _why_empty(space: Space, smallest: ContactSpiral) -> str:
    raster = space.raster
    needed = 2 * (Footprint.of(smallest).radius + need_of(smallest, space.material))
    widest = 2 * raster.clearance.max(initial=0.0)
    return (
        f"piece {space.piece.id} has no sensor: its largest inscribed circle is {widest:.1f} mm across, "
        f"and the smallest sensor (s = {smallest.s:g} mm) fits into one of {needed:.1f} mm"
    )
