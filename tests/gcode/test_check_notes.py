"""Notes on files for another printer or dialect, and what is said of a file that breaks off."""

import pytest

from gcode.check import check_text, judge
from gcode.emit import emit
from gcode.plan import Plan
from gcode.printer import load_printer
from skinfab.errors import InputError

PRINTERS = ["ender5plus-vipro", "generic-marlin", "generic-grbl"]


@pytest.mark.parametrize("judged_for", PRINTERS)
@pytest.mark.parametrize("made_for", PRINTERS)
def test_the_head_and_the_dialect(planned: Plan, made_for: str, judged_for: str) -> None:
    made, judged = load_printer(made_for), load_printer(judged_for)
    said = judge(emit(planned.program, made), judged).notes
    assert any(note.startswith(f"its head says it is for {made.name}, it is judged for {judged.name}") for note in said) is (made != judged)
    looks = [note for note in said if "looks like a file for" in note]
    assert len(looks) == (bool(made.spindle) != bool(judged.spindle))
    assert all(("for GRBL (M3" if made.spindle else "for Marlin (M83 in line 13") in note or "(G1 E in line" in note for note in looks)


def test_foreign_files() -> None:
    marlin, grbl = load_printer("generic-marlin"), load_printer("generic-grbl")
    assert not judge("G28\nG1 X10 E1 F300\n", marlin).notes
    assert not judge("M3 S255 ; a laser\nG1 X10 E1 F300\n", marlin).notes
    assert not judge("M3 S200\nG1 X10 F300\n", grbl).notes
    assert "(M104 in line 1)" in judge("M104 S0\nG1 X10 F300\n", grbl).notes[0]
    assert "(G1 E in line 2)" in judge("G21\nG1 X10 E1 F300\n", grbl).notes[0]


def test_a_wait_before_the_ink_is_a_note() -> None:
    text = "G28 X Y\nM83\nM302 P1\nM0 Pour now\nG0 Z10 F300\nG0 X1 Y1\nG0 Z1.6\nG1 X5 E16 F240\nG0 Z10 F300\nM0\n"
    judgement = judge(text, load_printer())
    assert judgement.notes == ("line 4: M0 waits for a click before the first ink; pour only after it",) and not judgement.findings


@pytest.mark.parametrize("bad", ["G5 X1 Y1", "G1 XNaN", "hello", "G1 X1 X2", "$H"])
def test_faults_before_a_line_that_cannot_be_followed_are_told(bad: str) -> None:
    text = f"G28 X Y\nM83\nG0 Z10 F300\nG0 X400 F600\nM104 S200\n{bad}\nG0 X900\n"
    judgement = judge(text, load_printer())
    assert [f.line for f in judgement.findings] == [4, 5]  # and not that it ends too low, or is cut off
    assert judgement.broken_off.startswith("line 6: ")
    with pytest.raises(InputError, match=r"^line 6: "):
        check_text(text, load_printer())


def test_a_dollar_line_is_told_to_be_grbls() -> None:
    assert judge("$H\n", load_printer("generic-grbl")).broken_off == (
        "line 1: cannot read '$H'; what begins with $ is told to GRBL before, not in a file"
    )
