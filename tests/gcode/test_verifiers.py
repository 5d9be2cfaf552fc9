"""Other people's readers of G-code agree with ours, and each is seen to notice a planted fault."""

import math
import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from gcodeparser import parse_gcode_lines

from gcode.emit import emit
from gcode.plan import Plan
from gcode.printer import Printer
from gcode.program import Extrude, Prime

ROOT = Path(__file__).parents[2]
OCTOPRINT = ROOT / ".venv-octoprint/bin/octoprint"
needs_octoprint = pytest.mark.skipif(not OCTOPRINT.exists(), reason="OctoPrint is not installed: run tests/setup_octoprint.sh")


def token_faults(text: str, *, bed: float = 350.0) -> list[str]:
    """What gcodeparser's tokens alone show: radii, ends on the bed, sign of E, order of modes."""
    faults, at, relative_e = [], (0.0, 0.0), False
    for line in parse_gcode_lines(text):
        p = line.params
        if line.command in (("M", 83), ("G", 90)):
            relative_e = line.command == ("M", 83)
        if line.command[0] != "G" or line.command[1] not in (0, 1, 2, 3):
            continue
        end = (p.get("X", at[0]), p.get("Y", at[1]))
        if line.command[1] in (2, 3):
            radius = math.hypot(p["I"], p["J"])
            centre = at[0] + p["I"], at[1] + p["J"]
            if abs(math.dist(end, centre) - radius) > 0.002:
                faults.append("radius")
            middle = math.atan2(at[1] - centre[1], at[0] - centre[0])
            turn = (math.atan2(end[1] - centre[1], end[0] - centre[0]) - middle) % math.tau
            angle = middle + (turn if line.command[1] == 3 else turn - math.tau) / 2
            end_x, end_y = centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)
            if not (0 <= end_x <= bed and 0 <= end_y <= bed):
                faults.append("bed")
        if not (0 <= end[0] <= bed and 0 <= end[1] <= bed):
            faults.append("bed")
        if "E" in p and not relative_e:
            faults.append("mode")
        if p.get("E", 0) < 0 and "X" in p:
            faults.append("sign")
        at = end
    return faults


@pytest.mark.parametrize("arcs", ["native", "lines"])
def test_gcodeparser_reads_the_same_ink_and_finds_no_fault(planned: Plan, printer: Printer, arcs: str) -> None:
    text = emit(planned.program, printer, arcs=arcs)  # type: ignore[arg-type]
    assert token_faults(text) == []
    ink = sum(line.params["E"] for line in parse_gcode_lines(text) if "E" in line.params and "X" in line.params)
    assert ink / printer.pump.e_per_mm3 == pytest.approx(planned.program.ink, abs=1e-5)


@pytest.mark.parametrize(
    ("fault", "seen"),
    [("an arc off the bed", "bed"), ("a wrong radius", "radius"), ("a wrong sign of E", "sign"), ("G90 after M83", "mode")],
)
def test_gcodeparser_shows_planted_faults(faulty: Callable[[str], str], fault: str, seen: str) -> None:
    assert seen in token_faults(faulty(fault))


def test_gcodeparser_shows_the_peers_faulty_spiral(peers_spiral: str) -> None:
    assert token_faults(peers_spiral) == ["radius"]


def octoprint_analysis(text: str, folder: Path, *options: str) -> tuple[float, dict[str, float]]:
    """Its sum of E, and its numbers of the printing area; zero and none where it finds no extrusion."""
    file = folder / "a.gcode"
    file.write_text(text)
    run = subprocess.run([OCTOPRINT, "analysis", "gcode", *options, file], capture_output=True, text=True, check=True, timeout=120)
    e = re.search(r"extrusion_length:\n- (\S+)", run.stdout)
    area = re.search(r"printing_area:\n((?:  \w+: \S+\n)+)", run.stdout)
    return (float(e[1]) if e else 0.0), dict((k, float(v)) for k, v in re.findall(r"(\w+): (\S+)", area[1] if area else ""))


@needs_octoprint
@pytest.mark.parametrize("arcs", ["native", "lines"])
def test_octoprint_sums_our_ink(planned: Plan, printer: Printer, tmp_path: Path, arcs: str) -> None:
    e, area = octoprint_analysis(emit(planned.program, printer, arcs=arcs), tmp_path, "--g90-extruder")  # type: ignore[arg-type]
    # It reports the highest sum reached: the ink and the prime of the last pattern, before that is drawn back.
    prime = next(s.volume for s in planned.program.steps if isinstance(s, Prime))
    assert e / printer.pump.e_per_mm3 == pytest.approx(planned.program.ink, rel=0.01)
    assert e / printer.pump.e_per_mm3 == pytest.approx(planned.program.ink + prime, rel=1e-5)
    if arcs == "lines":  # its bounds of arcs are known to be wrong
        boxes = [s.shape.bbox for s in planned.program.steps if isinstance(s, Extrude)]
        assert area["maxX"] == pytest.approx(max(b[1][0] for b in boxes), abs=0.01)
        assert area["minY"] == pytest.approx(min(b[0][1] for b in boxes), abs=0.01)
        assert area["maxZ"] == 1.6


@needs_octoprint
@pytest.mark.parametrize(
    ("pattern", "replacement"),
    [
        (r"^(G1 X\S+ Y\S+) E", r"\1 E-"),  # the wrong sign
        (r"^M83.*$", "M83\nG90"),  # E absolute again
    ],
)
def test_octoprint_misses_the_ink_of_planted_faults(
    planned: Plan, printer: Printer, tmp_path: Path, pattern: str, replacement: str
) -> None:
    text = re.sub(pattern, replacement, emit(planned.program, printer), flags=re.MULTILINE)
    e, _ = octoprint_analysis(text, tmp_path, "--g90-extruder")
    assert e / printer.pump.e_per_mm3 < 0.9 * planned.program.ink


@needs_octoprint
def test_octoprint_sees_the_way_off_the_bed(planned: Plan, printer: Printer, tmp_path: Path) -> None:
    text = emit(planned.program, printer, arcs="lines")
    moved = re.sub(r"^(G1) X\S+", r"\1 X351.0000", text, count=1, flags=re.MULTILINE)
    assert octoprint_analysis(text, tmp_path)[1]["maxX"] < 350
    assert octoprint_analysis(moved, tmp_path)[1]["maxX"] > 350
