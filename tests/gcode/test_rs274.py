"""LinuxCNC's strict interpreter draws what we meant, to a tenth of a micrometre, and refuses arcs that a printer would jump at."""

import math
import os
import re
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from gcode.check import check_text
from gcode.emit import emit
from gcode.geometry import Box, Curve, Shape, Straight
from gcode.plan import Plan, plan
from gcode.printer import Printer, load_printer
from gcode.program import Extrude, Travel
from skinfab.material import Material
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.strain_lines import StrainLines
from skinfab.placement.sensor import Sensor

HOME = Path(__file__).parents[2] / ".rs274"
pytestmark = pytest.mark.skipif(not (HOME / ".stamp").exists(), reason="LinuxCNC's rs274 is not here: run tests/setup_rs274.sh")


def stripped(text: str) -> str:
    """What of a Marlin file is RS-274 too: no E, no M-codes, no homing, and the dwell in seconds."""
    lines = []
    for line in text.splitlines():
        line = re.sub(r"\s*E-?[\d.]+", "", line.partition(";")[0]).strip()
        if match := re.fullmatch(r"G4 P(\d+)", line):
            line = f"G4 P{int(match[1]) / 1000:g}"
        elif re.fullmatch(r"G1( F\S+)?", line):  # ink at standstill: only its speed is left
            line = line[2:].strip()
        if line and not line.startswith(("M", "G28")):
            lines.append(line)
    return "\n".join([*lines, "M2", ""])


@dataclass(frozen=True)
class Drawn:
    """What the interpreter would have the machine do: feeds and traverses in the plane, and what it said of a fault."""

    shapes: tuple[Shape, ...]
    complaint: str

    @property
    def box(self) -> Box:
        boxes = [s.bbox for s in self.shapes]
        return (min(b[0][0] for b in boxes), min(b[0][1] for b in boxes)), (max(b[1][0] for b in boxes), max(b[1][1] for b in boxes))


def interpret(text: str, folder: Path) -> Drawn:
    # A file for GRBL is RS-274 as it stands.
    (folder / "a.ngc").write_text(text if "M83" not in text else stripped(text))
    libraries = [HOME / "usr/lib", *(HOME / "usr/lib").glob("*-linux-gnu")]
    environment = os.environ | {"LD_LIBRARY_PATH": ":".join(map(str, libraries)), "PYTHONHOME": str(HOME / "usr")}
    command = [str(HOME / "usr/bin/rs274"), "-g", "-t", "/dev/null", "-v", "a.var", "a.ngc"]
    run = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=60)
    at, shapes = (0.0, 0.0), []
    for name, numbers in re.findall(r"(STRAIGHT_FEED|STRAIGHT_TRAVERSE|ARC_FEED)\((.*)\)", run.stdout):
        v = [float(n) for n in numbers.split(",")]
        end = (v[0], v[1])
        if name == "ARC_FEED":
            shapes.append(Curve(at, end, (v[2], v[3]), clockwise=v[4] < 0))
        elif end != at:
            shapes.append(Straight(at, end))
        at = end
    return Drawn(tuple(shapes), "" if run.returncode == 0 else run.stderr)


@pytest.fixture(scope="module")
def real(make_piece: Callable, printer: Printer, material: Material) -> Plan:
    """Five contact spirals and a strain sensor, turned anyhow."""
    spiral = ContactSpiral(n=3, x=2.0, b=3.0, l=6.0, s=22.0)
    sensors = [Sensor(f"C{k}", "P1", spiral, 40 + 50 * (k % 3), 60 + 90 * (k // 3), 1.1 * k, k) for k in range(5)]
    sensors.append(Sensor("S1", "P1", StrainLines(l1=60.0, l2=54.0, b=6.0), 120, 200, 0.7, 5))
    return plan(make_piece(220, 240), sensors, printer=printer, material=material)


@pytest.mark.parametrize("arcs", ["native", "lines"])
def test_it_draws_every_shape_of_the_program(real: Plan, printer: Printer, tmp_path: Path, arcs: str) -> None:
    drawn = interpret(emit(real.program, printer, arcs=arcs), tmp_path)  # type: ignore[arg-type]
    assert drawn.complaint == ""
    box = drawn.box
    assert 0 <= box[0][0] and 0 <= box[0][1] and box[1][0] <= 350 and box[1][1] <= 350
    if arcs == "lines":
        return
    at, meant = (0.0, 0.0), []
    for step in real.program.steps:
        if isinstance(step, Extrude):
            meant.append(step.shape)
            at = step.shape.end
        elif isinstance(step, Travel):
            end = (at[0] if step.x is None else step.x, at[1] if step.y is None else step.y)
            if end != at:
                meant.append(Straight(at, end))
            at = end
    assert len(drawn.shapes) == len(meant)
    for there, ours in zip(drawn.shapes, meant, strict=True):
        assert type(there) is type(ours)
        for name in ("start", "end", "centre") if isinstance(ours, Curve) else ("start", "end"):
            assert math.dist(getattr(there, name), getattr(ours, name)) < 2e-4
        if isinstance(ours, Curve):
            assert isinstance(there, Curve) and there.clockwise is ours.clockwise


def test_it_refuses_a_wrong_radius(faulty: Callable[[str], str], tmp_path: Path) -> None:
    assert "Radius to end of arc differs from radius to start" in interpret(faulty("a wrong radius"), tmp_path).complaint


def test_its_arcs_show_the_way_off_the_bed(faulty: Callable[[str], str], tmp_path: Path) -> None:
    drawn = interpret(faulty("an arc off the bed"), tmp_path)
    assert drawn.box[0][0] < -500  # a sound arc, which the interpreter itself has no bed to refuse for


def test_the_peers_spiral_is_refused_by_both(peers_spiral: str, printer: Printer, tmp_path: Path) -> None:
    assert "Radius to end of arc differs from radius to start" in interpret(peers_spiral, tmp_path).complaint
    (finding,) = check_text(peers_spiral, printer)
    assert finding.line == 10 and "off the circle" in finding.what
    # Its lead drawn to where the circle is, the same spiral passes both.
    radius, b = 11.0, 3.0
    lead = 6.0 + radius - math.sqrt(radius**2 - b**2 / 4)
    mended = peers_spiral.replace("X106.0000", f"X{100 + lead:.4f}").replace("I11.0000", f"I{17 - lead:.4f}")
    assert interpret(mended, tmp_path).complaint == "" and check_text(mended, printer) == ()


def test_a_file_for_grbl_runs_as_it_stands(make_piece: Callable, material: Material, tmp_path: Path) -> None:
    grbl = load_printer("generic-grbl")
    planned = plan(
        make_piece(120, 120),
        [Sensor("C1", "P1", ContactSpiral(n=3, x=2.0, b=3.0, l=6.0, s=22.0), 40, 60, 1.1, 0)],
        printer=grbl,
        material=material,
    )
    drawn = interpret(emit(planned.program, grbl), tmp_path)
    meant = [s.shape for s in planned.program.steps if isinstance(s, Extrude)]
    arcs = [s for s in drawn.shapes if isinstance(s, Curve)]
    assert drawn.complaint == "" and len(arcs) == sum(isinstance(s, Curve) for s in meant)
    assert sum(a.length for a in arcs) == pytest.approx(sum(s.length for s in meant if isinstance(s, Curve)), abs=1e-3)
    assert interpret(emit(planned.program, grbl).replace(" J", " J1", 1), tmp_path).complaint != ""
