"""The first placement, without anyone's help: contact spirals on faces, a strain sensor along a finger.

No other tool has it; the paper names manual placement as a limitation. Everything chosen here can be edited after.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from skinfab.errors import InputError
from skinfab.material import Material
from skinfab.mesh.model import Mesh
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.registry import make_pattern
from skinfab.patterns.strain_lines import StrainLines
from skinfab.pieces import Piece
from skinfab.placement.add import free_channel, free_id
from skinfab.placement.fill import Region, fill, regions_of
from skinfab.placement.finger import is_finger, place_strain, strain_sizes
from skinfab.placement.sensor import Sensor
from skinfab.placement.share import CHANNELS, default_number, share
from skinfab.placement.space import Footprint, Space, need_of

#: Sizes of the paper's contact sensors, table II, mm.
SEED_SIZES = (45.0, 38.0, 32.0, 22.0, 20.0, 15.0, 10.0)
#: Of these, a second sensor beside another is at least this large, mm: smaller ones are for places where nothing else fits.
_BESIDE_SIZE = 15.0
#: What it places by itself: it knows how to choose their sizes.
_KINDS = (ContactSpiral.kind, StrainLines.kind)


@dataclass(frozen=True)
class AutoOptions:
    """What automatic placement should do.

    Parameters
    ----------
    kinds : tuple of str
        Kinds of pattern it may use.
    sizes : tuple of float, mm
        Outer diameters of contact spirals, in any order.
    per_piece : int, optional
        So many contact sensors on each piece where they fit: with fewer than it has faces between creases, on its
        largest faces. Without it `share.default_number` decides, and there are no more than the readout has channels.
    """

    kinds: tuple[str, ...] = _KINDS
    sizes: tuple[float, ...] = SEED_SIZES
    per_piece: int | None = None

    def __post_init__(self) -> None:
        for kind in self.kinds:
            if kind not in _KINDS:
                raise InputError(f"automatic placement knows no kind {kind!r}; there are {', '.join(_KINDS)}; ask for others one by one")
        if not self.sizes or not all(np.isfinite(s) and s > 0 for s in self.sizes):
            raise InputError(f"automatic placement: sizes are {list(self.sizes)}; give one or more diameters above 0 mm")
        if self.per_piece is not None and self.per_piece < 1:
            raise InputError(f"automatic placement: per_piece is {self.per_piece}; it must be at least 1")


def spiral_of_size(s: float, material: Material) -> ContactSpiral:
    """A contact spiral of diameter `s` with the paper's proportions (`ContactSpiral.usual`), as far as bead and gap allow.

    Raises
    ------
    PatternError
        Not even one half-turn fits.
    """
    spiral = make_pattern(ContactSpiral.kind, {"s": s, "bead": material.ink.bead_width, "gap": material.gap, "pad": material.pad})
    assert isinstance(spiral, ContactSpiral)
    return spiral


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
    spirals, as large as fit: ``options.per_piece`` of them, the largest face between creases first and one on each
    before any gets a second, which goes by area. Creases count for nothing on a piece where otherwise nothing fits.

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
        Pieces that stay without a sensor and why; fewer sensors than asked for; channels beyond the readout's.
    """
    options = options or AutoOptions()
    rng = np.random.default_rng(seed)
    spaces = list(spaces) if spaces is not None else [Space(mesh, piece, material) for piece in pieces]
    namer = Namer(spaces)
    warnings: list[str] = []
    if StrainLines.kind in options.kinds and is_finger(mesh):
        _strain(mesh, spaces, namer, warnings, material=material, rng=rng)
    if ContactSpiral.kind in options.kinds:
        _contacts(spaces, namer, warnings, options=options, material=material, rng=rng)
    if len(namer.sensors) > CHANNELS:
        warnings.append(f"{len(namer.sensors)} sensors need more than the {CHANNELS} channels of two 16-channel multiplexer boards")
    return tuple(namer.sensors), warnings


class Namer:
    """Numbers sensors as they come and keeps them in order."""

    def __init__(self, spaces: Sequence[Space]) -> None:
        self.sensors = sorted((s for space in spaces for s in space.sensors), key=lambda s: s.channel)

    def add(self, space: Space, sensor: Sensor) -> Sensor:
        """Give a sensor the next free id of its kind and the next free channel, and put it on its piece."""
        named = dataclasses.replace(sensor, id=free_id(self.sensors, sensor.pattern), channel=free_channel(self.sensors))
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


def _contacts(
    spaces: Sequence[Space],
    namer: Namer,
    warnings: list[str],
    *,
    options: AutoOptions,
    material: Material,
    rng: np.random.Generator,
) -> None:
    """Contact spirals on all pieces."""
    spirals = [spiral_of_size(s, material) for s in sorted(set(options.sizes), reverse=True)]
    beside = _BESIDE_SIZE if options.sizes == SEED_SIZES else 0.0
    regions = [_regions(space, spirals[-1]) for space in spaces]
    limits = _limits(spaces, regions, options.per_piece, CHANNELS - len(namer.sensors))
    placed = []
    for space, parts, limit in zip(spaces, regions, limits, strict=True):
        placed.append(_fill_piece(parts, spirals, namer, limit, rng, beside=beside))
        if not placed[-1] and limit and parts and parts[0].between_creases:
            across = regions_of(space, spirals[-1], between_creases=False)
            placed[-1] = _fill_piece(across, spirals, namer, limit, rng, beside=beside)
    empty = [space for space in spaces if not space.sensors]
    left_out = [space for space, limit in zip(spaces, limits, strict=True) if not space.sensors and not limit]
    warnings += no_room([space for space in empty if space not in left_out], spirals[-1])
    warnings += _no_channel(left_out)
    if options.per_piece is not None:
        few = [f"{n} on {s.piece.id}" for s, n in zip(spaces, placed, strict=True) if n < options.per_piece and s not in empty]
        if few:
            warnings.append(f"fewer contact sensors fit than the {options.per_piece} that per_piece asks for: {_listed(few)}")


def _regions(space: Space, smallest: ContactSpiral) -> list[Region]:
    """Faces between creases with room for the smallest spiral; without any, the piece as a whole."""
    between = regions_of(space, smallest, between_creases=True) if len(space.creases) else []
    return between or regions_of(space, smallest, between_creases=False)


def _limits(spaces: Sequence[Space], regions: Sequence[Sequence[Region]], per_piece: int | None, channels: int) -> list[int]:
    """How many contact sensors each piece may have."""
    if per_piece is not None:
        return [per_piece] * len(regions)
    limits = [default_number(space.piece.area, len(parts)) if parts else 0 for space, parts in zip(spaces, regions, strict=True)]
    if sum(limits) > channels:
        # Pieces without room keep no channel from the others, and are told apart from those left out for want of one.
        shared = share([space.piece.area for space in spaces], most=max(channels, 0), caps=limits)
        return [int(n) if parts else 1 for n, parts in zip(shared, regions, strict=True)]
    return [limit or 1 for limit in limits]


def _fill_piece(
    regions: Sequence[Region], spirals: Sequence[ContactSpiral], namer: Namer, limit: int, rng: np.random.Generator, *, beside: float
) -> int:
    """Fill the parts of a piece, each with its share; what one has no room for goes to those without any, then to the others."""
    placed, roomy, without = 0, [], []
    for region, most in zip(regions, share([r.area for r in regions], most=limit), strict=True):
        if not most:
            without.append(region)
            continue
        sensors = fill(region, spirals, int(most), rng, beside=beside)
        for sensor in sensors:
            namer.add(region.space, sensor)
        placed += len(sensors)
        if len(sensors) == most:
            roomy.append(region)
    for region in sorted(without, key=lambda r: -r.area):
        if placed < limit:
            sensors = fill(region, spirals, 1, rng, beside=beside)
            for sensor in sensors:
                namer.add(region.space, sensor)
            placed += len(sensors)
    large = [s for s in spirals if s.s >= beside]
    for region in roomy:
        if placed < limit and len(large):
            sensors = fill(region, large, limit - placed, rng, beside=beside)
            for sensor in sensors:
                namer.add(region.space, sensor)
            placed += len(sensors)
    return placed


def no_room(spaces: Sequence[Space], smallest: ContactSpiral) -> list[str]:
    """One warning for all pieces that are too small for the smallest sensor."""
    if not spaces:
        return []
    material = spaces[0].material
    needed = 2 * (Footprint.of(smallest).radius + need_of(smallest, material))
    widest = sorted({round(2 * float(space.raster.clearance.max(initial=0.0)), 1) for space in spaces})
    across = f"{widest[0]:.1f} to {widest[-1]:.1f}" if len(widest) > 1 else f"{widest[0]:.1f}"
    its = "its largest inscribed circle is" if len(spaces) == 1 else "their largest inscribed circles are"
    return [f"{_pieces(spaces)} no sensor: {its} {across} mm across, and the smallest sensor (s = {smallest.s:g} mm) needs {needed:.1f} mm"]


def _no_channel(spaces: Sequence[Space]) -> list[str]:
    if not spaces:
        return []
    return [
        f"{_pieces(spaces)} no sensor: all {CHANNELS} channels of two 16-channel multiplexer boards are taken by larger pieces; "
        "per_piece in the [auto] table of a --sensors file asks for more"
    ]


def _pieces(spaces: Sequence[Space]) -> str:
    """ "piece P3 has", "pieces P3 and P4 have"."""
    ids = [space.piece.id for space in spaces]
    return f"piece {ids[0]} has" if len(ids) == 1 else f"pieces {_listed(ids)} have"


def _listed(words: Sequence[str]) -> str:
    return ", ".join(words[:-1]) + " and " + words[-1] if len(words) > 1 else words[0]
