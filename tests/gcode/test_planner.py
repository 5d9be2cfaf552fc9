"""Our time of a program beside that of pyGCodeDecode, another author's planner, on ten programs of the seed's sensors."""

import json
import math
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from gcode.emit import emit
from gcode.estimate import print_time
from gcode.plan import plan
from gcode.printer import Printer, load_printer
from gcode.program import Clean, Dwell, Extrude, Prime, Program, Retract, Travel
from skinfab.material import Material
from skinfab.patterns.base import Pattern
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.strain_lines import StrainLines
from skinfab.placement.sensor import Sensor

HOME = Path(__file__).parents[2] / ".venv-printrun"
pytestmark = pytest.mark.skipif(not (HOME / ".stamp").exists(), reason="pyGCodeDecode is not here: run tests/setup_printrun.sh")

ROBOT, HUMAN = StrainLines(l1=60.0, l2=54.0, b=6.0), StrainLines(l1=53.0, l2=43.0, b=6.0)


def spiral(s: float, n: int) -> ContactSpiral:
    return ContactSpiral(n=n, x=1.7 if s < 15 else 2.0, b=1.5 if s < 12 else 3.0, l=5.0, s=s)


def unhindered(printer: Printer) -> Printer:
    """The paper's 100 and 200 mm/s, with a pump that keeps up: acceleration and corners decide."""
    pump = replace(printer.pump, flow_max=200.0, max_e_speed=2000.0)
    return replace(printer, motion=replace(printer.motion, straight_speed=100.0, curve_speed=200.0), pump=pump)


PAPERS, GENERIC = load_printer(), load_printer("generic-marlin")
PROGRAMS: dict[str, tuple[Printer, list[Pattern]]] = {
    "cube, s = 10": (PAPERS, [spiral(10, 1)]),
    "cube, s = 15": (PAPERS, [spiral(15, 2)]),
    "dodecahedron, s = 22": (PAPERS, [spiral(22, 3)]),
    "cup, s = 30": (PAPERS, [spiral(30, 4)]),
    "cylinder, s = 45": (PAPERS, [spiral(45, 6)]),
    "robot finger": (PAPERS, [ROBOT]),
    "human finger": (PAPERS, [HUMAN]),
    "spiral and finger on another printer": (GENERIC, [spiral(22, 3), ROBOT]),
    "cylinder at the paper's speeds": (unhindered(PAPERS), [spiral(45, 6)]),
    "robot finger at the paper's speeds": (unhindered(PAPERS), [ROBOT]),
}


def planned_by_other(program: Program, printer: Printer, folder: Path) -> float:
    """What pyGCodeDecode says, from where the head is after its first way there."""
    motion = printer.motion
    travels = [s for s in program.steps if isinstance(s, Travel)]
    place = {axis: next(v for t in travels if (v := getattr(t, axis.lower())) is not None) for axis in "XYZ"}
    presets = {
        "p_vel": motion.travel_speed,
        "p_acc": motion.acceleration,
        "jerk": math.sqrt(motion.junction_deviation * motion.acceleration / 0.414),  # its own way from jerk to deviation
        **{f"v{axis}": 1e4 for axis in "XYZE"},
        "firmware": "junction_deviation",
        "initial_position": place | {"E": 0.0},
    }
    (folder / "presets.yaml").write_text(json.dumps({"ours": presets}))  # JSON is YAML too
    (folder / "a.gcode").write_text(emit(program, printer, arcs="lines"))
    command: list[Any] = [
        HOME / "bin/python",
        Path(__file__).with_name("with_printrun.py"),
        "time",
        folder / "a.gcode",
        folder / "presets.yaml",
    ]
    return float(json.loads(subprocess.run(command, capture_output=True, text=True, check=True, timeout=90).stdout)["seconds"])


def naive_time(program: Program) -> float:
    """Length by speed, which knows no acceleration."""
    total = 0.0
    place: list[float | None] = [None, None, None]
    for step in program.steps:
        if isinstance(step, Extrude):
            total += step.shape.length / step.speed
            place[:2] = step.shape.end
        elif isinstance(step, Travel):
            to = [old if new is None else new for old, new in zip(place, (step.x, step.y, step.z), strict=True)]
            total += math.hypot(*(0.0 if a is None or b is None else b - a for a, b in zip(place, to, strict=True))) / step.speed
            place = to
        elif isinstance(step, (Dwell, Clean)):
            total += step.seconds
        elif isinstance(step, (Prime, Retract)):
            total += step.volume / step.rate
    return total


@pytest.mark.parametrize("name", PROGRAMS)
def test_within_a_hundredth_of_another_planner(make_piece: Callable, material: Material, tmp_path: Path, name: str) -> None:
    printer, patterns = PROGRAMS[name]
    sensors = [Sensor(f"X{k}", "P1", p, 50 + 60 * k, 60 + 40 * k, 0.3, k) for k, p in enumerate(patterns)]
    program = plan(make_piece(190, 180), sensors, printer=printer, material=material).program
    theirs = planned_by_other(program, printer, tmp_path)
    assert print_time(program, printer) == pytest.approx(theirs, rel=0.01)
    if "paper's" in name:  # there the simple estimate is no estimate
        assert naive_time(program) < 0.97 * theirs
