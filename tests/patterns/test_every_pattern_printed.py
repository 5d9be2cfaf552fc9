"""Every pattern as G-code, over random parameters, angles and places: true arcs, the right ink, nothing left in the nozzle."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from random_patterns import patterns

from gcode.emit import emit
from gcode.geometry import Curve
from gcode.parse import parse
from gcode.plan import plan
from gcode.printer import load_printer
from gcode.program import Extrude, Prime, Retract
from skinfab.material import load_material
from skinfab.patterns.registry import PATTERNS
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.tolerances import ARC_RADIUS_MM

MATERIAL, PRINTER = load_material(), load_printer()
SIDE = 300.0
#: The bed: where the pattern lies on it is drawn at random.
UV = np.array([[0.0, 0.0], [SIDE, 0.0], [SIDE, SIDE], [0.0, SIDE]])
PIECE = Piece("P1", np.arange(2), np.arange(4), np.array([[0, 1, 2], [0, 2, 3]]), UV)


@pytest.mark.parametrize("kind", PATTERNS)
@settings(max_examples=120, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(data=st.data(), x=st.floats(0, SIDE), y=st.floats(0, SIDE), angle=st.floats(-7, 7))
def test_arcs_ink_balance_and_text(kind: str, data: st.DataObject, x: float, y: float, angle: float) -> None:
    sensor = Sensor("C1", "P1", data.draw(patterns(kind)), x, y, angle, 0)
    program = plan(PIECE, [sensor], printer=PRINTER, material=MATERIAL).program

    laid = [step for step in program.steps if isinstance(step, Extrude)]
    curves = [step.shape for step in laid if isinstance(step.shape, Curve)]
    assert curves and max(curve.radius_error for curve in curves) <= ARC_RADIUS_MM

    # Rounding is carried on from command to command: all of them together miss by less than the last digit of E.
    volume, digit = MATERIAL.ink.bead_area_mm2 * sensor.printed_path.length, 1e-5 / PRINTER.pump.e_per_mm3
    assert program.ink == pytest.approx(volume, rel=1e-12, abs=digit)

    primed, retracted = (sum(s.volume for s in program.steps if isinstance(s, what)) for what in (Prime, Retract))
    assert primed == retracted > 0

    assert parse(emit(program, PRINTER)) == program
