"""Whatever the process fields say, on any dialect: what is planned passes the check, native and as chords, and comes back."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcode.check import check_program
from gcode.check_wall import wall_of
from gcode.emit import emit, on_grid_of, with_chords
from gcode.parse import parse
from gcode.plan import bed_offset, plan
from gcode.printer import Cleaning, Printer, load_printer
from gcode.program import Extrude, Prime, Retract
from skinfab.material import Material
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.strain_lines import StrainLines
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor

LENGTH = st.one_of(st.just(0.0), st.floats(1e-3, 0.1), st.floats(0.5, 8.0))


@st.composite
def printers(draw: st.DrawFn) -> Printer:
    """Any dialect, overruns of up to 8 mm, speeds from steady flow to far beyond each limit, with and without cleaning."""
    printer = load_printer(draw(st.sampled_from(("ender5plus-vipro", "generic-marlin", "generic-grbl"))))
    speed = st.floats(1.2, 400.0)
    height = draw(st.sampled_from((None, 0.0, 2.0, 10.0)))
    cleaning = Cleaning(2.0, 3.0, 1.0, draw(st.floats(0.0, 60.0)), height, 0.0 if height is None else draw(st.floats(0.0, 4.0)))
    return replace(
        printer,
        process=replace(
            printer.process,
            overrun_start=draw(LENGTH),
            overrun_end=draw(LENGTH),
            print_overrun=draw(LENGTH),
            print_overrun_end=draw(LENGTH),
        ),
        motion=replace(printer.motion, straight_speed=draw(speed), curve_speed=draw(speed), travel_speed=draw(speed)),
        cleaning=draw(st.sampled_from((None, cleaning))),
    )


@st.composite
def sensors(draw: st.DrawFn) -> list[Sensor]:
    """A spiral and a strain gauge, turned anyhow, each in a half of the piece that it cannot leave."""
    pad, turn = draw(st.sampled_from((0.0, 2.0, 3.0))), st.floats(-3.1, 3.1)
    spiral = ContactSpiral(n=draw(st.integers(1, 3)), x=2.0, b=3.0, l=6.0, s=draw(st.floats(21.0, 26.0)), pad=pad)
    strain = StrainLines(l1=draw(st.floats(30.0, 45.0)), l2=28.0, b=6.0, pad=pad)
    return [Sensor("C1", "P1", spiral, 45.0, 85.0, draw(turn), 0), Sensor("S1", "P1", strain, 130.0, 85.0, draw(turn), 1)]


@given(printer=printers(), placed=sensors())
@settings(max_examples=60, deadline=None)
def test_a_plan_passes_its_check(make_piece: Callable[..., Piece], material: Material, printer: Printer, placed: list[Sensor]) -> None:
    piece = make_piece(195, 170)
    offset = bed_offset(piece, printer)
    planned = plan(piece, placed, printer=printer, material=material, offset=offset)
    wall = wall_of(piece, material, offset)
    chords = on_grid_of(with_chords(planned.program, tolerance=printer.process.chord_tolerance), printer)
    for program in (planned.program, chords):
        assert check_program(program, printer, wall=wall) == ()
        assert parse(emit(program, printer)) == program
        pushed = [s.volume if isinstance(s, Prime) else -s.volume for s in program.steps if isinstance(s, Prime | Retract)]
        begun = printer.cleaning.initial_extrude if printer.cleaning else 0.0
        assert sum(pushed) == pytest.approx(begun, abs=1e-3)
    laid = [s for s in planned.program.steps if isinstance(s, Extrude)]
    assert planned.program.ink == pytest.approx(material.ink.bead_area_mm2 * sum(s.shape.length for s in laid), rel=1e-4)
