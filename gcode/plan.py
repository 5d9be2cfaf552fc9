"""From sensors on a flat piece to the steps that print them."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from gcode.check_height import free_length
from gcode.check_wall import Wall, needed_room, wall_of
from gcode.clearance import Laid
from gcode.emit import on_grid_of
from gcode.geometry import Curve, Point, Shape, Straight, shape_of
from gcode.order import short_order
from gcode.printer import Cleaning, Park, Printer
from gcode.program import PRINT_OVERRUN, Clean, Comment, Dwell, Extrude, Prime, Program, Retract, Step, Travel, on_grid
from skinfab.errors import InputError, RefusedError
from skinfab.material import Material
from skinfab.paths import Path, Segment
from skinfab.pieces import Piece
from skinfab.placement.distance import Curves, distance
from skinfab.placement.sensor import Sensor


@dataclass(frozen=True)
class Plan:
    """What is printed on one piece.

    Parameters
    ----------
    program : Program
        Quantised, in machine coordinates.
    offset : (x, y), mm
        Added to the piece frame.
    warnings : tuple of str
        Where a speed was lowered or an overrun cut short, one sentence for each pattern and reason.
    """

    program: Program
    offset: Point
    warnings: tuple[str, ...]


def bed_offset(piece: Piece, printer: Printer) -> Point:
    """Machine coordinates of the piece frame's origin, mm: the piece's bounding box is centred on the bed.

    Raises
    ------
    RefusedError
        The piece is larger than the bed.
    """
    for k, axis in enumerate(("wide", "deep")):
        if piece.size[k] > printer.bed.size[k]:
            raise RefusedError(
                f"piece {piece.id} is {piece.size[k]:.1f} mm {axis}, the bed of {printer.name} is {printer.bed.size[k]:g} mm; "
                "cut the piece smaller or choose a larger printer"
            )
    low, high = piece.UV.min(axis=0), piece.UV.max(axis=0)
    x, y = (printer.bed.origin[k] + printer.bed.size[k] / 2 - float(low[k] + high[k]) / 2 for k in range(2))
    return on_grid(x), on_grid(y)


def plan(piece: Piece, sensors: Sequence[Sensor], *, printer: Printer, material: Material, offset: Point | None = None) -> Plan:
    """The program that prints all `sensors` of one piece.

    Patterns are printed in an order of short travel (`gcode.order`), each from either of its ends, above the mould's
    walls in between. Each is entered and left along its tangent, and ends with as much ink in the nozzle as it began.
    At last the head parks, where the profile names a place for it.

    Parameters
    ----------
    piece : Piece
    sensors : sequence of Sensor
        All on this piece.
    printer : Printer
    material : Material
        Its bead's cross-section times the path's length is the volume laid.
    offset : (x, y), mm, optional
        Machine coordinates of the piece frame's origin; `bed_offset` if not given.

    Raises
    ------
    InputError
        No sensor, or one of another piece.
    RefusedError
        The piece does not fit the bed.
    """
    if not sensors:
        raise InputError(f"piece {piece.id} has no sensor; place one before making G-code")
    for sensor in sensors:
        if sensor.piece != piece.id:
            raise InputError(f"sensor {sensor.id} lies on piece {sensor.piece}, not on {piece.id}")
    offset = bed_offset(piece, printer) if offset is None else offset
    paths = {s.id: s.printed_path.transformed(angle=0.0, shift=offset) for s in sensors}
    pad_rows = {s.id: (len(s.printed_path.segments) - len(s.path.segments)) // 2 for s in sensors}
    planner = _Planner(printer, material, wall_of(piece, material, offset), paths, pad_rows)
    planner.begin()
    for name, path in short_order(paths, start=(printer.bed.origin[0], printer.bed.origin[1])):
        planner.pattern(name, path)
    planner.end()
    program = on_grid_of(Program(piece.id, tuple(planner.steps), float(planner.area)), printer)
    return Plan(program, offset, tuple(planner.warnings))


class _Planner:
    """Appends the steps of pattern after pattern and remembers the ink that is laid."""

    def __init__(self, printer: Printer, material: Material, wall: Wall, paths: dict[str, Path], pad_rows: dict[str, int]) -> None:
        self.printer, self.material = printer, material
        self.area = material.ink.bead_area_mm2
        self.wall = wall
        self.laid = Laid()
        self.paths = paths
        self.pad_rows = pad_rows  # how many segments of a path, at either end, are its pad
        self.beyond: list[tuple[str, Straight]] = []  # ink beyond the ends of paths, and of which
        self.lowered: Counter[tuple[str, float, float]] = Counter()  # speeds of the pattern at hand: why, from, to
        self.steps: list[Step] = []
        self.warnings: list[str] = []

    def begin(self) -> None:
        self._lift()
        if (place := self.printer.cleaning) and place.initial_extrude:
            # In portions, for no command may ask for more E than the firmware accepts.
            count = max(math.ceil(place.initial_extrude * self.printer.pump.e_per_mm3 / self.printer.pump.max_e), 1)
            self._clean(place, "first ink, at the cleaning place", [self._prime(place.initial_extrude / count)] * count)

    def pattern(self, name: str, path: Path) -> None:
        motion, process, pump = self.printer.motion, self.printer.process, self.printer.pump
        shapes = [shape_of(s) for s in path.segments if s.length > 0]
        (dx, dy), out = shapes[0].directions[0], shapes[-1].directions[1]
        first, last = shapes[0].start, shapes[-1].end
        inked = self._run(name, "print-overrun", first, (-dx, -dy), process.print_overrun, leaves=False)
        entry = self._run(name, "start overrun", inked, (-dx, -dy), process.overrun_start, leaves=False)
        slow = min(motion.straight_speed, motion.max_speed)
        self.steps += [
            Comment(f"pattern {name}"),
            Travel(*entry, speed=min(motion.travel_speed, motion.max_speed)),
            Travel(z=self.printer.heights.print, speed=motion.z_speed),
        ]
        if entry != inked:
            self.steps.append(Travel(*inked, speed=slow))
        if pump.prime:
            self.steps.append(self._prime(pump.prime))
        if inked != first:
            self._beyond(name, Straight(inked, first))
            self.steps.append(Comment("path"))
        self._extrude(shapes)
        past = self._run(name, "print-overrun past the end", last, out, process.print_overrun_end, leaves=True)
        if past != last:
            self._beyond(name, Straight(last, past))
        if pump.retract:
            self.steps.append(Retract(pump.retract, self._pump_rate()))
        exit_ = self._run(name, "end overrun", past, out, process.overrun_end, leaves=True)
        if exit_ != past:
            self.steps.append(Travel(*exit_, speed=slow))
        self._lift()
        if process.pause:
            self.steps.append(Dwell(process.pause))
        if place := self.printer.cleaning:
            self._clean(place, "cleaning")
        self._say_lowered(name)

    def _clean(self, place: Cleaning, why: str, first: Sequence[Prime] = ()) -> None:
        """To the place above the walls, down to its height, wait, wipe to and fro along x, and up again."""
        x, y = place.x + self.printer.bed.origin[0], place.y + self.printer.bed.origin[1]
        self.steps.append(Comment(why))
        self._go_to(place)
        low = place.height is not None and place.height < self.printer.heights.travel
        if low:
            self.steps.append(Travel(z=place.height, speed=self.printer.motion.z_speed))
        self.steps += [*first, Clean(place.seconds)]
        if place.wipe:
            slow = min(self.printer.motion.straight_speed, self.printer.motion.max_speed)
            self.steps += [Travel(x + place.wipe, y, speed=slow), Travel(x, y, speed=slow)]
        if low:
            self._lift()

    def end(self) -> None:
        # Every pattern ends with a lift, so this goes above the walls.
        if place := self.printer.park:
            self.steps.append(Comment("park"))
            self._go_to(place)

    def _lift(self) -> None:
        self.steps.append(Travel(z=self.printer.heights.travel, speed=self.printer.motion.z_speed))

    def _go_to(self, place: Cleaning | Park) -> None:
        origin, motion = self.printer.bed.origin, self.printer.motion
        self.steps.append(Travel(place.x + origin[0], place.y + origin[1], speed=min(motion.travel_speed, motion.max_speed)))

    def _pump_rate(self) -> float:
        pump = self.printer.pump
        return min(pump.prime_rate, pump.max_e_speed / pump.e_per_mm3)

    def _prime(self, volume: float) -> Prime:
        return Prime(volume, self._pump_rate())

    def _run(self, name: str, kind: str, at: Point, direction: Point, wanted: float, *, leaves: bool) -> Point:
        """Where a run along the tangent ends: short of wet ink, of the mould's wall by all of the nozzle, and with ink of what comes."""
        if not wanted:
            return at
        radius = math.sqrt(self.area / math.pi)
        need = max(radius, needed_room(self.wall, self.printer.nozzle, self.printer.heights.print))
        length = free_length(at, direction, wanted, self.laid, radius, leaves=leaves)
        obstacle = "wet ink"
        for tenths in range(round(10 * length / wanted), -1, -1):
            length = wanted * tenths / 10
            end = (at[0] + direction[0] * length, at[1] + direction[1] * length)
            run = Straight(at, end)
            if not length:
                break
            if self.wall.room([run.segment]) < need:
                obstacle = "the mould's wall"
            elif met := self._met_by_ink(name, run) if kind.startswith("print-overrun") else None:
                obstacle = "its own path" if met == name else f"pattern {met}"
            else:
                break
        if length < wanted * (1 - 1e-9):
            self.warnings.append(f"{name}: {kind} cut from {wanted:g} to {length:.2g} mm, for {obstacle} is near")
        return end if length else at

    def _met_by_ink(self, name: str, run: Straight) -> str | None:
        """Which pattern ink along `run`, before or past the path of that name, would come too near to; or itself."""
        room = self.material.ink.bead_width + self.material.gap
        inks: list[tuple[str, Sequence[Segment]]] = [(other, [shape.segment]) for other, shape in self.beyond]
        for other, path in self.paths.items():
            inks.append((other, self._beyond_pad(path, self.pad_rows[name], run.start) if other == name else path.segments))
        for other, segments in inks:
            if segments and distance(Curves.of_segments([run.segment]), Curves.of_segments(segments)) < room:
                return other
        return None

    def _beyond_pad(self, path: Path, rows: int, start: Point) -> Sequence[Segment]:
        """A path without the pad at the end where the run's `start` is, and without what touches that."""
        begins = shape_of(path.segments[0]).start == start
        own = path.segments[rows:] if begins else path.segments[: len(path.segments) - rows]
        # The rows of a pad are one area of ink, closer than two beads may be; the run goes on along the first of them.
        return [s for s in own if start not in (shape_of(s).start, shape_of(s).end)]

    def _beyond(self, name: str, run: Straight) -> None:
        """Ink beyond an end of the path of that name."""
        self.steps.append(Comment(PRINT_OVERRUN))
        self._extrude([run])
        self.beyond.append((name, run))

    def _extrude(self, shapes: Sequence[Shape]) -> None:
        for shape in shapes:
            nominal = self.printer.motion.curve_speed if isinstance(shape, Curve) else self.printer.motion.straight_speed
            speed, why = allowed_speed(shape, self.area, self.printer)
            if speed < nominal:
                self.lowered[why, nominal, round(speed, 3)] += 1
            # No command may ask for more E than the firmware accepts.
            count = max(math.ceil(shape.length * self.area * self.printer.pump.e_per_mm3 / self.printer.pump.max_e * (1 + 1e-9)), 1)
            self.steps += [Extrude(part, self.area * part.length, speed) for part in shape.split(count)]
            self.laid.add(shape)

    def _say_lowered(self, name: str) -> None:
        for (why, nominal, speed), times in sorted(self.lowered.items()):
            self.warnings.append(
                f"{name}: speed lowered from {nominal:.4g} to {speed:.4g} mm/s on {times} segment{'s' * (times > 1)} by {why}"
            )
        self.lowered.clear()


def allowed_speed(shape: Shape, area: float, printer: Printer) -> tuple[float, str]:
    """The profile's speed for a line or an arc, lowered to what flow, E axis and acceleration allow, and the reason.

    Parameters
    ----------
    shape : Straight or Curve
    area : float, mm^2
        The bead's cross-section.
    printer : Printer

    Returns
    -------
    speed : float, mm/s
    reason : str
        What bounds it.
    """
    motion, pump = printer.motion, printer.pump
    limits = [
        (motion.curve_speed if isinstance(shape, Curve) else motion.straight_speed, "the profile"),
        (pump.flow_max / area, f"the flow limit of {pump.flow_max:g} mm^3/s"),
        (pump.max_e_speed / (area * pump.e_per_mm3), f"the E axis limit of {pump.max_e_speed:g} mm/s"),
        (motion.max_speed, f"the printer's limit of {motion.max_speed:g} mm/s"),
    ]
    if isinstance(shape, Curve):
        limits.append((math.sqrt(motion.acceleration * shape.radius), f"v^2 <= a R at a = {motion.acceleration:g} mm/s^2"))
    return min(limits, key=lambda limit: limit[0])
