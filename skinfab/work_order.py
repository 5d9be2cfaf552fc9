"""The order of work: one list from the empty mould to the worn skin, in the order in which hands do it.

The process is that of "Soft Sensing Skins for Arbitrary Objects", section II.C; the numbers are the results' and
the profiles'.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.material import Material
from skinfab.recipe import Recipe
from skinfab.wire_exits import WireSlot

_HOMING = {
    "xyz": "home all axes with the bed empty, before the mould lies on it: a probe would dip into wet silicone",
    "xy": "with the nozzle clear of the bed, home X and Y only (G28 X Y): a probe for Z would dip into the wet mould",
    "none": "the program does not home: bring the printer to its own zero first",
}
_MARKS = ("lower left", "lower right", "upper left")


@dataclass(frozen=True, eq=False)
class PrintJob:
    """One piece whose conductors are printed.

    Parameters
    ----------
    piece : str
    gcode : str
        The file that is printed into its mould.
    slots : sequence of WireSlot
        Which pad's wire leaves its mould where.
    marks : (3, 2) float, mm, optional
        Corner points of its mould's L marks in machine coordinates: lower left, lower right, upper left. Without
        them one step says where to read how to register it.
    time_s : float, optional
        How long the program runs.
    """

    piece: str
    gcode: str
    slots: Sequence[WireSlot] = ()
    marks: NDArray[np.float64] | None = None
    time_s: float | None = None


def work_steps(
    recipe: Recipe,
    material: Material,
    *,
    jobs: Sequence[PrintJob] = (),
    home: str = "xy",
    bed_corner: tuple[float, float] | None = None,
) -> list[str]:
    """What to do, a step each, in order.

    All pieces are printed at one place, the bed's centre, and silicone and ink must be laid before the silicone
    sets: so piece by piece is registered, poured, printed and left to cure. Pieces without sensors are only cast.

    Parameters
    ----------
    recipe : Recipe
        Its batches name every piece that is cast.
    material : Material
    jobs : sequence of PrintJob
        The pieces with sensors, in the order to print them.
    home : "xyz", "xy" or "none"
        What the programs home.
    bed_corner : (2,) float, mm, optional
        Where the bed begins, for a machine (GRBL) that is homed by hand and told its places by work offsets.

    Raises
    ------
    InputError
        Another word for `home`, or a job for a piece that is not cast.

    Examples
    --------
    >>> from skinfab.material import load_material
    >>> from skinfab.recipe import recipe
    >>> steps = work_steps(recipe({"P1": 10.0}, load_material()), load_material())
    >>> steps[0], steps[1][:36]
    ('Print the mould of P1, floor down and without supports.', 'P1 has no sensors and is only cast, ')
    """
    if home not in _HOMING:
        raise InputError(f"home is {home!r}; it must be one of {', '.join(_HOMING)}")
    pieces = list(recipe.batches[0].pour_g)
    for job in jobs:
        if job.piece not in pieces:
            raise InputError(f"piece {job.piece} is printed but has no mould; cast {', '.join(pieces)} or make its mould too")
    printed = {job.piece for job in jobs}
    bare = [piece for piece in pieces if piece not in printed]
    steps = [f"Print the mould{'s' * (len(pieces) > 1)} of {', '.join(pieces)}, floor down and without supports."]
    if len(jobs) > 1:
        steps.append(
            f"Take the pieces with sensors one after the other ({', '.join(job.piece for job in jobs)}): all are printed at the same "
            "place, the middle of the bed. Mix the silicone for each piece anew, by the table: it has to be poured and printed into "
            "within its working time, which its label tells."
        )
    for k, job in enumerate(jobs):
        homing = _HOMING[home] if bed_corner is None else _by_hand(bed_corner, first=k == 0)
        zero = "G92" if bed_corner is None else "G10 L20 P1"
        steps += [*_register(job, material, home, homing, zero), *_fill(job.piece, recipe), *_print(job, recipe, material)]
    if bare:
        layers = ", then ".join(f"the {b.layer} layer ({b.depth:g} mm)" for b in recipe.batches)
        no_sensors = "has no sensors and is" if len(bare) == 1 else "have no sensors and are"
        steps.append(
            f"{', '.join(bare)} {no_sensors} only cast, on any level place: mix by the table, what is too little to weigh "
            f"together with another piece, degas, pour and spread {layers}; "
            f"cure for {recipe.cure_h:g} h."
        )
    return [*steps, *(_wire(job, recipe) for job in jobs if job.slots), *_finish(recipe, material)]


def _by_hand(corner: tuple[float, float], *, first: bool) -> str:
    """GRBL's way: homed while nothing can be hit, and the bed's corner told. What G10 stored outlasts the power, homing does not."""
    if not first:
        return (
            "while the bed is still empty, home with $H once more if the controller was switched off, reset or bumped; the places that G10 "
            "stored for the first piece still hold"
        )
    x, y = corner
    return (
        "home with $H while the bed is empty, for it moves Z too. Jog the nozzle over the bed's front left corner and send "
        f"G10 L20 P1 X{x:g} Y{y:g}: from then on the controller shows the places named here (a reset forgets G92, not G10). $1=255 "
        "keeps the motors on, so that no touch shifts the head"
    )


def _register(job: PrintJob, material: Material, home: str, homing: str, zero: str) -> list[str]:
    """Bring the empty mould and the printer together."""
    if job.marks is None:
        return [f"{job.piece}: lay the empty mould on the level bed, home, register it and set Z as the report of skinfab make says."]
    corners = ", ".join(
        f"{name} {'L mark is ' * (k == 0)}at X{x:.2f} Y{y:.2f}" for k, (name, (x, y)) in enumerate(zip(_MARKS, job.marks, strict=True))
    )
    # The program counts its heights from the floor of the cavity, which lies above the glass.
    z = -material.mould.floor
    set_z = f"set this height as Z {z:.2f} ({zero} Z{z:.2f})"
    if home == "xyz":
        set_z = f"see that the display shows Z {z:.2f} there; if not, shift the home position (M206 Z{z:.2f}) and home again before pouring"
    return [
        f"{job.piece}: {homing}.",
        f"{job.piece}: lay the empty mould on the level bed so that its {corners}. Jog the nozzle to the lower left mark and move "
        "the mould under it; jog to the lower right mark and turn the mould until it "
        "agrees; the upper left mark is the check. Then tape it down. (The sheet of flat.pdf, printed "
        "at 100 % and laid under the glass with its marks at the same places, shows where the mould goes.)",
        f"{job.piece}: beside the mould, lower the nozzle until it holds a sheet of paper on the glass, and {set_z}. "
        "Raise the nozzle clear of the mould's wall.",
    ]


def _fill(piece: str, recipe: Recipe) -> list[str]:
    steps, height = [], 0.0
    for batch in recipe.batches:
        height += batch.depth
        portion = batch.portions[piece]
        weigh = ", then ".join(f"{grams:.2f} g {name}" for name, grams in portion.weigh_g.items())
        steps.append(
            f"{piece}: mix the {batch.layer} layer, {portion.mass_g:.2f} g with {recipe.waste_percent:g} % for waste: {weigh}. Stir, then "
            f"degas under vacuum. Pour {batch.pour_g[piece]:.2f} g and spread it until it is level, {height:g} mm above the mould's floor."
        )
    return steps


def _print(job: PrintJob, recipe: Recipe, material: Material) -> list[str]:
    runs = "" if job.time_s is None else f" It runs {max(job.time_s / 60, 0.1):.1f} min."
    return [
        f"{job.piece}: at once, while the silicone is liquid, print the conductors ({material.ink.name}) into it with {job.gcode}.{runs}",
        f"{job.piece}: leave the mould taped down and level for {recipe.cure_h:g} h, until the silicone has cured. If the bed is needed "
        "sooner, slide the mould onto a stiff board and carry it level, without a jolt, to a level place: both silicone and ink are wet.",
    ]


def _wire(job: PrintJob, recipe: Recipe) -> str:
    places = (s.at.round(1) + 0.0 for s in job.slots)  # no minus before a zero
    slots = ", ".join(f"{s.sensor}-{s.terminal} by ({x:.1f}, {y:.1f})" for s, (x, y) in zip(job.slots, places, strict=True))
    return (
        f"{job.piece}: once cured and still in the mould, pierce a wire stripped at its end into each pad, lay it straight to its slot and "
        f"out through it: {slots} (wire by slot, x and y in mm from the piece's origin in flat.svg). "
        f"Seal each pad with a drop of {recipe.bond}. Measure each sensor between its two wires: wiring.csv of skinfab make has "
        "the interval for nine prints in ten, and the multiplexer board and input that each signal wire goes to; return wires all go to "
        "the line that the bridges share."
    )


def _finish(recipe: Recipe, material: Material) -> list[str]:
    glue = f" Where it must not slip, hold it on the object with {material.adhesive}." if material.adhesive else ""
    return [
        "Take the skin out of its moulds. Which side is out: the face that was up while pouring, the one that the drawing shows, is the "
        "OUTSIDE of the skin; the face that lay on the mould's floor goes onto the object.",
        "Wrap the skin round the object, seam by seam, equal numbers in flat.svg to each other; lay each lip over the outside of its other "
        f"side and bond it with {recipe.bond}.{glue}",
    ]
