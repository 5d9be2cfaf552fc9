"""What quantising keeps: ink, continuity, the radius of every arc, and itself."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcode.geometry import Curve, Straight
from gcode.program import Clean, Comment, Dwell, Extrude, Prime, Program, Retract, Travel, quantised, speed_on_grid
from skinfab.errors import InputError
from skinfab.tolerances import ARC_RADIUS_MM

E_PER_MM3 = 8.2644628
HALF_E_MM3 = 0.5e-5 / E_PER_MM3


@given(data=st.data())
def test_quantising_twice_changes_nothing(any_program: st.SearchStrategy[Program], data: st.DataObject) -> None:
    once = quantised(data.draw(any_program), e_per_mm3=E_PER_MM3)
    assert quantised(once, e_per_mm3=E_PER_MM3) == once


@given(data=st.data())
@settings(max_examples=300)
def test_arcs_keep_their_radius_anywhere_on_the_bed(any_program: st.SearchStrategy[Program], data: st.DataObject) -> None:
    program = data.draw(any_program)
    curves = [s.shape for s in quantised(program, e_per_mm3=E_PER_MM3).steps if isinstance(s, Extrude) and isinstance(s.shape, Curve)]
    for curve in curves:
        assert curve.radius_error <= ARC_RADIUS_MM
        assert curve.start != curve.end
        assert abs(curve.sweep) <= math.pi + 2e-3 / curve.radius  # a half turn, but for its own rounding


@given(data=st.data())
def test_ink_never_drifts(any_program: st.SearchStrategy[Program], data: st.DataObject) -> None:
    program = data.draw(any_program)
    done = quantised(program, e_per_mm3=E_PER_MM3)
    # The longest stretch that may go missing is one shorter than the grid, at the very end.
    assert done.ink == pytest.approx(program.ink, abs=2 * HALF_E_MM3 + 0.484 * 1e-4)
    length = math.fsum(s.shape.length for s in program.steps if isinstance(s, Extrude))
    assert program.ink == pytest.approx(0.484 * length)


@given(data=st.data())
def test_the_path_moves_by_no_more_than_the_grid(any_program: st.SearchStrategy[Program], data: st.DataObject) -> None:
    program = data.draw(any_program)
    before = [s.shape.length for s in program.steps if isinstance(s, Extrude)]
    after = [s.shape.length for s in quantised(program, e_per_mm3=E_PER_MM3).steps if isinstance(s, Extrude)]
    # Each end and centre moves by up to 0.00007 mm; an arc of a full turn then changes by 2 pi times that, twice.
    assert math.fsum(after) == pytest.approx(math.fsum(before), abs=2e-3 * len(before))


@given(st.floats(1e-3, 1e4))
def test_speeds_round_down_and_stay(speed: float) -> None:
    once = speed_on_grid(speed)
    assert speed_on_grid(once) == once
    assert speed - 0.1 / 60 - 1e-9 <= once <= max(speed * (1 + 1e-9) + 1e-8, 0.1 / 60)


def test_empty_steps_vanish_and_comments_become_one_line_of_ascii() -> None:
    steps = (Travel(speed=1.0), Prime(0.0, 1.0), Retract(1e-9, 1.0), Comment("Düse\n" + 200 * "x"), Dwell(0.12345))
    assert quantised(Program("P\n1", steps), e_per_mm3=1.0) == Program("P 1", (Comment("D?se " + 75 * "x"), Dwell(0.123)))


@pytest.mark.parametrize("bead", [0.0, -1.0, math.nan, math.inf])
def test_a_bead_is_positive(bead: float) -> None:
    with pytest.raises(InputError, match="the bead of program P1"):
        Program("P1", (), bead)


START = Travel(x=0.0, y=0.0, speed=1.0)


@pytest.mark.parametrize(
    ("steps", "says"),
    [
        ((Extrude(Straight((0.0, 0.0), (1.0, 0.0)), 1.0, 1.0),), "unknown place"),
        ((START, Extrude(Straight((0.1, 0.0), (1.0, 0.0)), 1.0, 1.0)), "starts at"),
        ((START, Extrude(Straight((0.0, 0.0), (1.0, 0.0)), -1.0, 1.0)), "volume"),
        ((START, Extrude(Straight((0.0, 0.0), (1.0, 0.0)), 1.0, 0.0)), "speed"),
        ((START, Extrude(Straight((0.0, 0.0), (math.nan, 0.0)), 1.0, 1.0)), "finite"),
        ((Travel(x=math.inf, speed=1.0),), "finite"),
        ((Travel(x=1.0),), "speed"),
        ((Prime(1.0, math.nan),), "speed"),
        ((Retract(math.inf, 1.0),), "volume"),
        ((Dwell(-1.0),), "time"),
        ((Clean(math.nan),), "time"),
    ],
)
def test_impossible_programs_say_why(steps: tuple, says: str) -> None:
    with pytest.raises(InputError, match=rf"step \d .*{says}"):
        Program("P1", steps)
