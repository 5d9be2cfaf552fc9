"""The list of steps: each thing after what it needs, every number in its place."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.material import load_material
from skinfab.recipe import recipe
from skinfab.wire_exits import WireSlot
from skinfab.work_order import PrintJob, work_steps

MATERIAL = load_material()
WEIGHED = recipe({"P1": 10.0, "P2": 2.5, "P3": 1.0, "P4": 5.0}, MATERIAL)
CORNERS = np.array([[0.0, 0.0], [80, 0], [0, 50]])
SLOT = WireSlot("C1", 2, np.array([5.0, 8]), np.array([0.0, 8.25]), np.array([-1.6, 8.25]))
JOBS = [
    PrintJob(f"P{k}", f"gcode/P{k}.gcode", [SLOT] if k == 1 else [], CORNERS + np.array([100.125 * k, 40.25]), 150.0 * k) for k in (1, 2)
]


def test_the_whole_list_in_order() -> None:
    steps = work_steps(WEIGHED, MATERIAL, jobs=JOBS)
    each = [
        "with the nozzle clear",
        "lay the empty mould",
        "beside the mould",
        "mix the reservoir",
        "mix the filler",
        "at once",
        "leave the mould",
    ]
    order = [
        "Print the moulds of P1, P2, P3, P4",
        "Take the pieces with sensors one after the other (P1, P2)",
        *(f"{piece}: {word}" for piece in ("P1", "P2") for word in each),
        "P3, P4 have no sensors and are only cast",
        "P1: once cured and still in the mould, pierce",
        "Take the skin out",
        "Wrap the skin",
    ]
    assert [step[: len(word)] for step, word in zip(steps, order, strict=True)] == order


def test_every_mark_is_given_in_machine_coordinates() -> None:
    text = " ".join(work_steps(WEIGHED, MATERIAL, jobs=JOBS))
    found = [(float(x), float(y)) for x, y in re.findall(r"X(\d+\.\d\d) Y(\d+\.\d\d)", text)]
    np.testing.assert_allclose(found, np.vstack([job.marks for job in JOBS]), atol=0.005 + 1e-9)


def test_the_numbers_of_one_piece() -> None:
    _, _, register, height, reservoir, filler, printing, cure, wire, out, wrap = work_steps(
        recipe({"P1": 10.0}, MATERIAL), MATERIAL, jobs=JOBS[:1]
    )
    assert "lower left L mark is at X100.12 Y40.25, lower right at X180.12" in register and "tape" in register
    # 8 ml x 1.07 = 8.56 g into the mould; with 15 % 9.84 g, of which A is 9.844 / 1.03 / 2.
    assert "9.84 g with 15 % for waste: 4.78 g Ecoflex 00-30 A" in reservoir and "Pour 8.56 g" in reservoir
    assert "2 mm above the mould's floor" in reservoir and "2.5 mm above the mould's floor" in filler
    assert "gcode/P1.gcode" in printing and "2.5 min" in printing and "12 h" in cure and "carry it level" in cure
    assert "C1-2 by (0.0, 8.2)" in wire and "FAST Ecoflex 00-35" in wire and "FAST Ecoflex 00-35" in wrap
    assert "the face that was up while pouring" in out and "OUTSIDE" in out and "mould's floor goes onto the object" in out
    assert "G92 Z-1.60" in height


def test_where_each_wire_goes() -> None:
    """Signal wires to an input each, return wires together: the table gives both wires of a sensor the same input."""
    (step,) = (s for s in work_steps(WEIGHED, MATERIAL, jobs=JOBS) if "pierce" in s)
    assert "pierce a wire stripped at its end into each pad, lay it straight to its slot and out through it: " in step
    assert "input that each signal wire goes to; return wires all go to the line that the bridges share" in step


def test_z_is_set_once_for_each_print() -> None:
    steps = work_steps(WEIGHED, MATERIAL, jobs=JOBS)
    assert sum("G92" in step for step in steps) == len(JOBS)
    for first, then in ((r": beside the mould", r": mix the res"), (r": mix the filler", r": at once"), (r": lay the", r": beside")):
        for job in JOBS:
            at = [next(k for k, step in enumerate(steps) if re.match(job.piece + word, step)) for word in (first, then)]
            assert at[0] < at[1]


def test_grbl_is_homed_once_and_told_its_places_by_offsets() -> None:
    steps = work_steps(WEIGHED, MATERIAL, jobs=JOBS, home="none", bed_corner=(-5.0, 0.0))
    text = " ".join(steps)
    assert text.count("home with $H while the bed is empty") == 1 and "G10 L20 P1 X-5 Y0" in text
    assert text.count("home with $H once more if the controller was switched off") == len(JOBS) - 1 and "G92 Z" not in text
    assert text.count("G10 L20 P1 Z-") == len(JOBS)


@pytest.mark.parametrize(("home", "says"), [("xyz", "bed empty"), ("xy", "X and Y only"), ("none", "does not home")])
def test_homing(home: str, says: str) -> None:
    assert says in work_steps(WEIGHED, MATERIAL, jobs=JOBS, home=home)[2]
    # A program that homes Z itself forgets what G92 said.
    assert any("G92" in step for step in work_steps(WEIGHED, MATERIAL, jobs=JOBS, home=home)) == (home != "xyz")


def test_without_sensors_nothing_is_printed_or_registered() -> None:
    steps = work_steps(WEIGHED, MATERIAL)
    assert len(steps) == 4 and not any("nozzle" in step or "wire" in step for step in steps)
    assert steps[1].startswith("P1, P2, P3, P4 have no sensors")


def test_without_marks_the_report_is_named() -> None:
    steps = work_steps(WEIGHED, MATERIAL, jobs=[PrintJob("P1", "P1.gcode")])
    assert "report of skinfab make" in steps[1] and not any("G92" in step for step in steps)


def test_what_cannot_be() -> None:
    with pytest.raises(InputError, match="home is 'zyx'"):
        work_steps(WEIGHED, MATERIAL, jobs=JOBS, home="zyx")
    with pytest.raises(InputError, match="piece P9 is printed but has no mould"):
        work_steps(WEIGHED, MATERIAL, jobs=[PrintJob("P9", "P9.gcode")])


def test_glued_where_the_profile_names_a_glue() -> None:
    material = load_material()
    assert work_steps(recipe({"P1": 10.0}, material), material)[-1].endswith("hold it on the object with silicone sealant DOWSIL 744.")
    worn = replace(material, adhesive="")
    assert work_steps(recipe({"P1": 10.0}, worn), worn)[-1].endswith(f"bond it with {material.bond}.")


def test_no_place_is_minus_zero() -> None:
    slot = replace(SLOT, at=np.array([-0.04, 120.6]))
    (wire,) = (step for step in work_steps(WEIGHED, MATERIAL, jobs=[replace(JOBS[0], slots=[slot])]) if "pierce" in step)
    assert "C1-2 by (0.0, 120.6)" in wire
