"""Emit and parse are each other's inverse, and a changed file is told from ours."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcode.emit import emit
from gcode.parse import parse
from gcode.plan import Plan
from gcode.printer import Printer, load_printer
from gcode.program import Clean, Comment, Dwell, Prime, Program, Retract, Travel, quantised
from skinfab.errors import InputError

positive = st.floats(1e-6, 1e4)
place = st.none() | st.floats(-400, 400)
loose_steps = st.one_of(
    st.builds(Travel, x=place, y=place, z=place, speed=positive),
    st.builds(Prime, positive, positive),
    st.builds(Retract, positive, positive),
    st.builds(Dwell, st.floats(0, 100)),
    st.builds(Clean, st.floats(0, 100)),
    st.builds(Comment, st.text() | st.sampled_from(["begin", "end", "clean", "; G1 X1", "pattern C1"])),
)


@given(data=st.data())
@settings(max_examples=300)
def test_parse_undoes_emit(any_program: st.SearchStrategy[Program], data: st.DataObject) -> None:
    printer = load_printer(data.draw(st.sampled_from(["ender5plus-vipro", "generic-marlin"])))
    program = quantised(data.draw(any_program), e_per_mm3=printer.pump.e_per_mm3)
    text = emit(program, printer)
    assert parse(text) == program
    assert emit(parse(text), printer) == text


@given(st.lists(loose_steps, max_size=12), st.text())
def test_parse_undoes_emit_for_any_steps(steps: list, name: str) -> None:
    printer = load_printer()
    program = quantised(Program(name, tuple(steps)), e_per_mm3=printer.pump.e_per_mm3)
    assert parse(emit(program, printer)) == program


def test_a_planned_program_comes_back(planned: Plan, printer: Printer) -> None:
    text = emit(planned.program, printer)
    assert parse(text) == parse(text.replace("\n", "\r\n")) == planned.program


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("; skinfab print program", "; another", "line 1"),
        ("; begin\n", "", "cut off"),
        ("; end\n", "", "cut off"),
        ("; ink 8.2644628", "; ink x", "line 4"),
        ("; ink 8.2644628", "; ink nan", "line 4"),
        ("; bead 0.484", "; bead x", "line 5"),
        ("; bead 0.484", "; bead -1", "line 5"),
        (" I", " R", "not what skinfab writes"),
        ("; begin\n", "; begin\nG1 X3 Y3 E1\n", "line 19: no speed"),
        ("; begin\n", "; begin\nG1 X3 Y3 E1 F6\n", "line 19: it extrudes from an unknown place"),
        ("; begin\n", "; begin\nM104 S200\nG0 F6\n", "not what skinfab writes|no speed"),
        ("; begin\n", "; begin\nG4 P\n", "line 19: a word has no number"),
    ],
)
def test_changed_files_say_which_line(planned: Plan, printer: Printer, old: str, new: str, says: str) -> None:
    text = emit(planned.program, printer)
    assert old in text
    with pytest.raises(InputError, match=says):
        parse(text.replace(old, new, 1))


@given(st.text() | st.binary().map(lambda b: b.decode("latin-1")))
def test_garbage_is_refused_in_one_sentence(text: str) -> None:
    with pytest.raises(InputError, match="skinfab's own"):
        parse(text)
