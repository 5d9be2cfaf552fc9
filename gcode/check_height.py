"""Ink is laid at the print height, the head travels above the walls, and nothing is dragged through wet ink."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import islice

from gcode.clearance import Laid
from gcode.geometry import Shape, Straight
from gcode.moves import Finding, Move, Trace
from gcode.printer import Printer
from gcode.program import XY_DECIMALS
from skinfab.tolerances import PREVIEW_CHORD_MM

STEP_XY = 10**-XY_DECIMALS


def height_findings(judged: Trace, printer: Printer) -> Iterator[Finding]:
    """Findings about heights, in the order of the moves.

    A low travel is accepted as an overrun only: straight into or out of an extrusion, no longer than the profile's
    own, and clear of all ink but the bead it leaves; or along the wiping of the cleaning place, at its height. Homing
    leaves an axis unknown, and so does a file that does not say it: what leads over an unknown place must be high.
    """
    yield from _homed_low(judged, printer)
    laid = Laid()
    for k, move in enumerate(judged.moves):
        shape = move.shape
        if move.is_planar and move.e <= 0 and move.start[2] is None:
            yield _blind(move, printer)
        elif move.is_planar and move.e <= 0 and shape is None:
            yield from _from_nowhere(move, printer)
        if shape is None:
            continue
        if move.e > 0:
            yield from _print_height(move, printer)
            laid.add(shape)
        elif (low := _lowest(move)) is not None and low < printer.heights.travel - STEP_XY:
            before = judged.moves[k - 1] if k else None
            yield from _low_travel(move, low, _last_inked(before, judged, k), _next_inked(judged, k), laid, printer)


def _blind(move: Move, printer: Printer) -> Finding:
    what = "it travels at an unknown height: the nozzle may stand below the mould's wall or in wet ink"
    return Finding(move.line, what, f"lift to Z{printer.heights.travel:g} first, by a move in Z alone", move.pattern)


def _from_nowhere(move: Move, printer: Printer) -> Iterator[Finding]:
    if (low := _lowest(move)) is not None and low < printer.heights.travel - STEP_XY:
        what = f"it travels from or to an unknown place at Z{low:.4f}, below the travel height"
        yield Finding(move.line, what, f"lift to Z{printer.heights.travel:g} first, by a move in Z alone", move.pattern)


def _homed_low(judged: Trace, printer: Printer) -> Iterator[Finding]:
    wet = min((m.line for m in judged.moves if m.e > 0 and m.is_planar), default=math.inf)
    for home in judged.homes:
        axes = " and ".join(home.axes.replace("Z", ""))
        if axes and home.line > wet and home.z is not None and home.z < printer.heights.travel - STEP_XY:
            what = f"it homes {axes} at Z{home.z:.4f}, below the travel height: the nozzle runs through what lies in its way"
            yield Finding(home.line, what, f"lift to Z{printer.heights.travel:g} first, by a move in Z alone", home.pattern)


def _print_height(move: Move, printer: Printer) -> Iterator[Finding]:
    h = printer.heights
    remedy = f"print between {h.print_min:g} and {h.print_max:g} mm, or change the heights in the printer profile"
    if move.start[2] is None or move.end[2] is None:
        yield Finding(move.line, "it extrudes at an unknown height", "set Z before the first ink", move.pattern)
    elif min(move.start[2], move.end[2]) < h.print_min - STEP_XY:
        yield Finding(
            move.line, f"it extrudes at Z{min(move.start[2], move.end[2]):.4f}, below the least print height", remedy, move.pattern
        )
    elif max(move.start[2], move.end[2]) > h.print_max + STEP_XY:
        yield Finding(
            move.line, f"it extrudes at Z{max(move.start[2], move.end[2]):.4f}, above the greatest print height", remedy, move.pattern
        )


def _lowest(move: Move) -> float | None:
    heights = [z for z in (move.start[2], move.end[2]) if z is not None]
    return min(heights) if heights else None


def _last_inked(before: Move | None, judged: Trace, k: int) -> Move | None:
    """The extrusion a travel leaves from, past a retract at standstill."""
    while before is not None and before.e and not before.is_planar:
        k -= 1
        before = judged.moves[k - 1] if k else None
    return before if before is not None and before.e > 0 else None


def _next_inked(judged: Trace, k: int) -> Move | None:
    """The extrusion a travel leads to, past what is pushed or drawn at standstill."""
    for after in islice(judged.moves, k + 1, None):
        if after.is_planar or not after.e:
            return after if after.e > 0 else None
    return None


def _low_travel(move: Move, low: float, before: Move | None, after: Move | None, laid: Laid, printer: Printer) -> Iterator[Finding]:
    shape = move.shape
    process = printer.process
    allowed = process.overrun_end if before is not None else process.overrun_start if after is not None else 0.0
    if shape is None or at_cleaning_place(move, low, printer):
        return
    remedy = f"lift to Z{printer.heights.travel:g} before moving on"
    if shape.length > allowed + 2 * STEP_XY:
        yield Finding(move.line, f"it travels {shape.length:.3f} mm at Z{low:.4f}, below the travel height", remedy, move.pattern)
        return
    if crosses_ink(shape, laid, bead_radius(before or after, printer), leaves=before is not None):
        yield Finding(move.line, f"it drags the nozzle through wet ink at Z{low:.4f}", "shorten the overrun, or " + remedy, move.pattern)


def at_cleaning_place(move: Move, low: float, printer: Printer) -> bool:
    """Is it a wipe at the cleaning place, not below its height? `low` is the move's lowest place, mm."""
    place, (x, y) = printer.cleaning, printer.bed.origin
    if place is None or place.height is None or low < place.height - STEP_XY:
        return False
    return all(
        end[0] is not None
        and end[1] is not None
        and -STEP_XY <= end[0] - x - place.x <= place.wipe + STEP_XY
        and abs(end[1] - y - place.y) <= STEP_XY
        for end in (move.start, move.end)
    )


def bead_radius(move: Move | None, printer: Printer) -> float:
    """Half the width of a round bead of this extrusion, mm."""
    if move is None or move.shape is None:
        return 0.0
    return math.sqrt(max(move.e, 0.0) / printer.pump.e_per_mm3 / move.shape.length / math.pi)


def crosses_ink(run: Shape, laid: Laid, radius: float, *, leaves: bool, spare: float = 0.0) -> bool:
    """Does a straight run come within a bead's `radius` and some `spare` (mm) of laid ink?

    Where it `leaves` the end of that ink, its first part, one radius long, lies on the bead by necessity.
    """
    start = run.start
    if leaves:
        if run.length <= radius:
            return False
        start = run.point_at(radius / run.length)
    # The chords may lie inside an arc by their tolerance, and places are rounded.
    return laid.distance((start, run.end), within=radius + spare) < radius + spare - PREVIEW_CHORD_MM - STEP_XY


def free_length(
    start: tuple[float, float], direction: tuple[float, float], wanted: float, laid: Laid, radius: float, *, leaves: bool
) -> float:
    """The longest run from `start`, up to `wanted` mm, in tenths of it, that stays clear of `laid` ink."""
    for tenths in range(10, 0, -1):
        length = wanted * tenths / 10
        run = Straight(start, (start[0] + direction[0] * length, start[1] + direction[1] * length))
        # Arcs may be emitted as other chords than they are judged by here: what is planned keeps that much more room.
        if not crosses_ink(run, laid, radius, leaves=leaves, spare=PREVIEW_CHORD_MM):
            return length
    return 0.0
