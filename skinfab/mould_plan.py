"""The casting mould seen from above: cavity, adhesive lips, wall, plate, registration marks and wire slots.

All regions are shapely polygons in the piece frame (mm), on a grid fine enough for the printer and
coarse enough for the single precision of an STL file.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon, box
from shapely.geometry.base import BaseGeometry

from skinfab.errors import InputError, RefusedError
from skinfab.material import Mould
from skinfab.pieces import Piece
from skinfab.tolerances import CAVITY_FRACTION, MOULD_GRID_MM, MOULD_SLIT_MM, OVERLAP_FRACTION, PRINTABLE_WALL_MM
from skinfab.wire_exits import WirePad, WireSlot, exit_warnings, plan_exits, slot_region, through_wall

#: A lip is planned from what lies within so many walls of it: one to keep away, and two and a half (the longest mitre of half
#: a wall) from where the rest is cut off.
_NEAR_WALLS = 4
#: How often wires whose ways out end at lips are planned anew.
_EXIT_TRIES = 5


@dataclass(frozen=True, eq=False)
class MouldPlan:
    """What stands where, from above.

    Parameters
    ----------
    cavity : MultiPolygon
        Where silicone is cast: the piece, and the cavity's section at half the silicone's depth.
    bottom, top : MultiPolygon
        The cavity's section at its floor and at the wall's top: with a draft, narrower and wider than the piece.
    lip : MultiPolygon
        Strips beside the cavity that only the top layer flows into.
    lip_cut : MultiPolygon
        The lip as cut: a little wider, so that no film of plastic is left between lip and cavity.
    wall : MultiPolygon
        Round the cavity, and in its darts, and under the lip.
    block : MultiPolygon
        The cavity and the inner half of its wall, without the lip: what is measured.
    plate : Polygon
        The rectangular floor.
    marks : (3, 2) float, mm
        Corner points of the L marks: lower left, lower right, upper left.
    grooves : MultiPolygon
        The L marks as cut.
    slots : MultiPolygon
        The wire exits as cut.
    wire_slots : tuple of WireSlot
        Which pad has which of them.
    warnings : tuple of str
        Places the printer or the silicone will not follow the outline.
    """

    cavity: MultiPolygon
    bottom: MultiPolygon
    top: MultiPolygon
    lip: MultiPolygon
    lip_cut: MultiPolygon
    wall: MultiPolygon
    block: MultiPolygon
    plate: Polygon
    marks: NDArray[np.float64]
    grooves: MultiPolygon
    slots: MultiPolygon
    wire_slots: tuple[WireSlot, ...]
    warnings: tuple[str, ...]


def mould_plan(
    piece: Piece,
    *,
    mould: Mould,
    depth: float,
    freeboard: float = 0.0,
    pads: Sequence[WirePad] = (),
    lips: Sequence[NDArray[np.float64]] = (),
) -> MouldPlan:
    """Plan a piece's mould.

    Walls with a draft lean about the piece's outline at half the silicone's depth, or a little inside where it is
    jagged: what the cast gains above it loses below, so that its volume stays the piece's area times its depth.

    Parameters
    ----------
    piece : Piece
    mould : Mould
        Its dimensions, from the material profile.
    depth, freeboard : float, mm
        Of the silicone, and how far the wall stands above it.
    pads : sequence of WirePad
        The contact pads on this piece; each gets a slot for its wire, see `skinfab.wire_exits.plan_exits`.
    lips : sequence of (k, 2) float, mm
        Runs of the outline, in its direction, that get an adhesive lip where there is room; a lip is broken
        where a slot crosses it.

    Raises
    ------
    InputError
        A mould dimension that cannot be printed, or the piece has no area.
    RefusedError
        The piece is narrower than its walls lean.
    """
    for name in ("wall", "floor"):
        if getattr(mould, name) < PRINTABLE_WALL_MM:
            raise InputError(
                f"mould.{name} is {getattr(mould, name):g} mm; a printer needs at least {PRINTABLE_WALL_MM:g} mm, "
                "so raise it in the material profile"
            )
    if not mould.mark > 0:
        raise InputError("mould.mark is 0 mm; the G-code origin is found by the marks, so give their arm a length in the material profile")
    if len(pads) and not mould.wire_exit > 0:
        raise InputError("mould.wire_exit is 0 mm but the piece has terminals; give the slot a width in the material profile")
    cavity = cavity_region(piece)
    if cavity.is_empty:
        raise InputError(f"piece {piece.id} has no area to cast; flatten it again")
    bottom, brim, top, brim_at = _sections(cavity, mould, depth, freeboard)
    if bottom.is_empty:
        raise RefusedError(f"piece {piece.id} is too narrow for walls with mould.draft_deg = {mould.draft_deg:g}; lower it in the profile")
    exits = _exits_and_lip(piece, cavity, brim, pads, lips, mould)
    wire_slots = tuple(slot for slot in exits.slots if slot is not None)
    notes = exit_warnings(pads, exits.slots, piece=piece.id, blocked=exits.blocked)
    lip, outer = exits.lip, exits.outer
    lip_cut = _on_grid(lip.buffer(5 * MOULD_SLIT_MM + brim_at, join_style="mitre"))
    # Past either end by as much as the end of an oblique slot is skewed.
    cuts = [slot_region(slot, mould.wire_exit, longer=mould.wire_exit) for slot in wire_slots if not slot.shared]
    wall = _on_grid(outer - cavity)
    xmin, ymin, xmax, ymax = outer.bounds
    plate = box(xmin - mould.mark, ymin - mould.mark, xmax + mould.mark, ymax + mould.mark)
    inset = mould.mark / 2
    low, high = np.array([xmin, ymin]) - inset, np.array([xmax, ymax]) + inset
    marks = np.array([low, [high[0], low[1]], [low[0], high[1]]])
    grooves = [_l_mark(corner, inward, mould) for corner, inward in zip(marks, [(1, 1), (-1, 1), (1, -1)], strict=True)]
    return MouldPlan(
        cavity=cavity,
        bottom=bottom,
        top=top,
        lip=lip,
        lip_cut=lip_cut,
        wall=wall,
        block=_on_grid(cavity.buffer(mould.wall / 2) - lip),
        plate=plate,
        marks=marks,
        grooves=_on_grid(shapely.union_all(grooves)),
        slots=_on_grid(shapely.union_all(cuts)),
        wire_slots=wire_slots,
        warnings=(
            *notes,
            *_narrow_places(piece, cavity, _on_grid(wall - lip_cut), mould),
            *_short_lips(piece, lip.buffer(brim_at), lips),
        ),
    )


def mould_fits(outline: NDArray[np.float64], *, mould: Mould, bed: tuple[float, float]) -> bool:
    """Whether the mould of a piece lies on the bed, wherever it gets lips: known from its outline, before it has seams or sensors.

    Parameters
    ----------
    outline : (b, 2) float, mm
        Of the piece, as `skinfab.flatten.orient.orient` lays it.
    mould : Mould
    bed : (float, float), mm
        Its width and depth.

    Examples
    --------
    A square of 50 mm with a lip of 4, a wall of 1.6 and marks of 6 mm all round needs 73.2 mm, and half a mm is allowed for.

    >>> from skinfab.material import load_material
    >>> square = np.array([[0.0, 0], [50, 0], [50, 50], [0, 50]])
    >>> mould = load_material().mould
    >>> mould_fits(square, mould=mould, bed=(73.7, 73.7)), mould_fits(square, mould=mould, bed=(73.7, 73.1))
    (True, False)
    """
    size = np.ptp(outline, axis=0)
    # Where a lip ends, its wall goes round a square corner, which reaches a little past the wall along the next side.
    reach = math.hypot(mould.lip + mould.wall, mould.wall) - mould.wall if mould.lip else 0.0
    # Corners of lips and walls reach up to twice as far as their sides.
    if (size + 2 * mould.mark + 4 * (mould.wall + reach) <= bed).all():
        return True
    if (size + 2 * (mould.mark + mould.wall) > bed).any():
        return False
    lip = shapely.LinearRing(outline).buffer(reach, join_style="mitre", mitre_limit=2) if reach else Polygon(outline)
    xmin, ymin, xmax, ymax = _outer(lip, mould).bounds
    return xmax - xmin + 2 * mould.mark <= bed[0] and ymax - ymin + 2 * mould.mark <= bed[1]


def cavity_region(piece: Piece) -> MultiPolygon:
    """The flat piece as a valid region, darts that close to nothing healed.

    An exact net touches itself and a dart may close, so the outline need not be a valid polygon; the
    union of the flat triangles always is the piece. Slits under ``tolerances.MOULD_SLIT_MM`` are healed:
    in an STL their two sides would be one edge with four faces.
    """
    outline: BaseGeometry = Polygon(piece.outline)
    if not (outline.is_valid and abs(outline.area - _triangle_area(piece)) <= OVERLAP_FRACTION * outline.area):
        outline = shapely.union_all(shapely.polygons(piece.UV[piece.F]), grid_size=MOULD_GRID_MM)
    return _healed(outline)


def _sections(cavity: MultiPolygon, mould: Mould, depth: float, freeboard: float) -> tuple[MultiPolygon, MultiPolygon, MultiPolygon, float]:
    """The cavity's sections at its floor, at the silicone's surface and at the wall's top, and how far the middle one stands out, mm.

    Raises
    ------
    InputError
        The wall would be thinner than half of itself at its top.
    """
    if mould.draft_deg >= 90:
        raise InputError(f"mould.draft_deg is {mould.draft_deg:g}; it counts from upright and must be below 90")
    slope = math.tan(math.radians(mould.draft_deg))
    if (depth + freeboard) * slope < MOULD_SLIT_MM:
        return cavity, cavity, cavity, 0.0
    half, top = depth / 2 * slope, (depth / 2 + freeboard) * slope
    if top > mould.wall / 2:
        most = math.floor(math.degrees(math.atan(mould.wall / (depth + 2 * freeboard))))
        raise InputError(
            f"mould.draft_deg is {mould.draft_deg:g}, which takes {top:.2f} mm off the top of a wall of {mould.wall:g} mm; "
            f"lower it to {most:d} or make the wall thicker"
        )
    middle, shift = cavity, 0.0
    for _ in range(3):
        bottom, brim = (_offset(cavity, shift + by) for by in (-half, half))
        # Simpson's rule is exact while corners move in straight lines. A jagged outline gains more above than it loses below.
        excess = (bottom.area + 4 * middle.area + brim.area) / 6 - cavity.area
        if abs(excess) <= CAVITY_FRACTION / 10 * cavity.area:
            break
        shift -= excess / middle.length
        middle = _offset(cavity, shift)
    return bottom, brim, _offset(cavity, shift + top), max(shift + half, 0.0)


def _offset(region: MultiPolygon, by: float) -> MultiPolygon:
    """Grown by so much, or shrunk; corners stay sharp."""
    return _healed(region.buffer(by, join_style="mitre"))


def _healed(region: BaseGeometry) -> MultiPolygon:
    """Without slits and corner contacts.

    Growing square and shrinking round leaves every convex corner sharp and widens a corner contact to a neck,
    which an STL can hold.
    """
    half = MOULD_SLIT_MM / 2
    return _on_grid(region.buffer(half, join_style="mitre", mitre_limit=5).buffer(-half, join_style="round", quad_segs=1))


def _outer(inside: BaseGeometry, mould: Mould) -> MultiPolygon:
    """What the walls round `inside` enclose."""
    # Gaps between two outer walls that are narrower than half a wall are filled: nothing cleans them.
    fill = mould.wall / 2
    grown = inside.buffer(mould.wall + fill, join_style="mitre", mitre_limit=2)
    return _on_grid(grown.buffer(-fill, join_style="mitre", mitre_limit=2))


@dataclass(frozen=True, eq=False)
class _Exits:
    """Slots and lips, which make room for each other: a slot for each pad, or None, and which pads' ways ended at lips."""

    slots: list[WireSlot | None]
    blocked: frozenset[int]
    lip: MultiPolygon
    outer: MultiPolygon


def _exits_and_lip(
    piece: Piece,
    cavity: MultiPolygon,
    brim: MultiPolygon,
    pads: Sequence[WirePad],
    lips: Sequence[NDArray[np.float64]],
    mould: Mould,
) -> _Exits:
    bare = _outer(cavity, mould)
    barred: list[tuple[int, NDArray[np.float64]]] = []
    for tries_left in reversed(range(_EXIT_TRIES)):
        slots = plan_exits(pads, cavity=cavity, outer=bare, mould=mould, barred=barred) if len(pads) else []
        # Either side of a slot a wall stays towards the lip; the way out is free as far as a lip of this seam reaches.
        free = [slot_region(s, mould.wire_exit + 2 * mould.wall, longer=mould.lip + mould.wall) for s in slots if s is not None]
        lip = _lip_region(piece, brim, lips, shapely.union_all(free), mould)
        outer = _outer(cavity | lip, mould)
        through = [s and through_wall(s, cavity=cavity, outer=outer) for s in slots]
        blocked = [(k, s.at) for k, (s, t) in enumerate(zip(slots, through, strict=True)) if s is not None and t is None]
        if not (blocked and tries_left):
            break
        # Lips of other seams are in the way: these wires look for another place, and the lips grow anew.
        barred += blocked
    return _Exits(through, frozenset(k for k, _ in (*barred, *blocked)), lip, outer)


def _lip_region(
    piece: Piece, brim: MultiPolygon, lips: Sequence[NDArray[np.float64]], ways_out: BaseGeometry, mould: Mould
) -> MultiPolygon:
    """Strips of the lip's width outside the given runs and the silicone's surface `brim`, a wall away from every other
    edge and lip, broken by the wires' ways out."""
    boundary = shapely.LinearRing(piece.outline)
    strips: list[BaseGeometry] = []
    for points in lips:
        run = shapely.LineString(points)
        # The outline is counter-clockwise: the outside is on the right, which shapely calls negative.
        strip: BaseGeometry = run.buffer(-mould.lip, single_sided=True, join_style="mitre", mitre_limit=2)
        # Only what is near is looked at: each of hundreds of lips sees a few edges of thousands.
        near = box(*(shapely.total_bounds([run, strip]) + _NEAR_WALLS * mould.wall * np.array([-1, -1, 1, 1])))
        silicone = brim & near
        others = (boundary & near) - run.buffer(MOULD_SLIT_MM)
        before = [other for other in strips if other.intersects(near)]
        # On one grid GEOS cannot lose its way: in floating point a thousand-edged outline made it give up.
        strip = _on_grid(_on_grid(strip) - silicone - shapely.union_all([others, *before]).buffer(mould.wall) - ways_out)
        # What is left between two darts may be a splinter that tears off with the skin: it goes. The chinks
        # that this leaves towards the cavity would be films of plastic: they are filled again.
        half = mould.wall / 2
        broad = strip.buffer(-half, join_style="mitre").buffer(half, join_style="mitre")
        joined = (broad | silicone).buffer(half, join_style="mitre").buffer(-half, join_style="mitre")
        parts = _on_grid(shapely.intersection(_on_grid(broad | (joined - silicone)), strip, grid_size=MOULD_GRID_MM)).geoms
        strips.append(MultiPolygon([part for part in parts if (part & broad).area > half**2 and part.distance(silicone) < MOULD_SLIT_MM]))
    return _on_grid(shapely.union_all(strips) - brim)


def _short_lips(piece: Piece, lip: BaseGeometry, lips: Sequence[NDArray[np.float64]]) -> tuple[str, ...]:
    """Says so where most of the wanted lip has no room."""
    runs = [shapely.LineString(points) for points in lips]
    wanted = sum(run.length for run in runs)
    got = sum((run & lip.buffer(2 * MOULD_SLIT_MM)).length for run in runs)
    if got >= wanted / 2:
        return ()
    return (f"piece {piece.id}: the adhesive lip has room along {got:.0f} of {wanted:.0f} mm of seam; bond the rest edge to edge",)


def _triangle_area(piece: Piece) -> float:
    a, b, c = (piece.UV[piece.F[:, k]] for k in range(3))
    u, v = b - a, c - a
    return float(np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum()) / 2


def _on_grid(region: BaseGeometry) -> MultiPolygon:
    """On the mould's grid, as a MultiPolygon of what has area."""
    snapped = shapely.set_precision(region, MOULD_GRID_MM)
    return MultiPolygon([part for part in shapely.get_parts(snapped) if isinstance(part, Polygon) and part.area > 0])


def _l_mark(corner: NDArray[np.float64], inward: tuple[int, int], mould: Mould) -> BaseGeometry:
    """Two grooves whose centre lines meet at `corner`."""
    half = mould.wall / 4
    along, up = mould.mark * np.array(inward)
    x, y = corner
    across_x = box(min(x - half, x + along), y - half, max(x + half, x + along), y + half)
    across_y = box(x - half, min(y - half, y + up), x + half, max(y + half, y + up))
    return across_x | across_y


def _narrow_places(piece: Piece, cavity: MultiPolygon, wall: MultiPolygon, mould: Mould) -> tuple[str, ...]:
    """Darts the printer cannot make: too thin a wall, or none at all."""
    notes = []
    half = PRINTABLE_WALL_MM / 2
    opened = wall.buffer(-half, join_style="mitre").buffer(half * 1.01)
    # Every dart is thin at its tip; it matters once it is longer than the wall is wide.
    long = [part for part in _on_grid(wall - opened).geoms if _extent(part) > mould.wall]
    if long:
        first = max(long, key=_extent)
        notes.append(
            f"piece {piece.id}: {len(long)} dart{'s' * (len(long) > 1)} narrower than {PRINTABLE_WALL_MM:g} mm over "
            f"{sum(_extent(p) for p in long):.1f} mm, the longest near ({first.centroid.x:.1f}, {first.centroid.y:.1f}) mm; "
            "the printer may leave out the wall there: cut the silicone along it after curing"
        )
    closed = shapely.LinearRing(piece.outline) - cavity.boundary.buffer(2 * MOULD_SLIT_MM)
    # Its two sides lie on each other or nearly so: a ribbon round both is counted once.
    length = closed.buffer(half, cap_style="flat").area / (2 * half)
    if length > mould.wall:
        x, y = closed.centroid.x, closed.centroid.y
        notes.append(
            f"piece {piece.id}: the outline touches itself over {length:.1f} mm near ({x:.1f}, {y:.1f}) mm; "
            "the silicone is cast in one piece there: cut it along the drawing after curing"
        )
    return tuple(notes)


def _extent(part: Polygon) -> float:
    """Diagonal of the bounding box, mm: the length of something long and thin."""
    xmin, ymin, xmax, ymax = part.bounds
    return float(np.hypot(xmax - xmin, ymax - ymin))
