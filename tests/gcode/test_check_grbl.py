"""Commands that GRBL takes but a print in a wet mould does not."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcode.check import check_text, judge
from gcode.printer import load_printer
from gcode.trace import trace

INK = "M3 S242\nG1 X{0} F300\nM5\nG1 Z10\n"
HEAD = "G21\nG90\nG1 Z10 F300\nG1 X50 Y50\nG1 Z1.6\n"
BETWEEN = "G1 X50 Y60\nG1 Z1.6\n"


def found(between: str, after: str = "", before: str = "") -> list[tuple[int, str]]:
    text = before + HEAD + INK.format(60) + between + BETWEEN + INK.format(60) + after
    return [(f.line, f.what) for f in check_text(text, load_printer("generic-grbl"))]


def test_the_sound_file_is_sound() -> None:
    assert not found("", after="M0\nM2\n", before="G54\nG17\nG94\nM0\n")


def test_a_foreign_file_of_modal_lines_is_judged_as_its_long_form() -> None:
    modal = "G21\nG90\nF300\nG1 Z10\nX50 Y50\nZ1.6\nS242\nM3\nX60\nY{0}\nM5\nZ10\n"
    spelt = "G21\nG90\nG1 Z10 F300\nG1 Z10\nG1 X50 Y50\nG1 Z1.6\nM5\nM3 S242\nG1 X60\nG1 Y{0}\nM5\nG1 Z10\n"
    grbl = load_printer("generic-grbl")
    assert not check_text(modal.format(60), grbl)
    assert check_text(modal.format(900), grbl) == check_text(spelt.format(900), grbl) != ()


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("M0", "M0 waits for a click in the midst of the ink"),
        ("M1", "M1 waits for a click in the midst of the ink"),
        ("G53 G0 X10", "G53 moves in the machine's own places"),
        ("G55", "G55 moves the origin"),
        ("G28", "G28 goes to a place stored"),
        ("G38.2 Z-5", "G38.2 probes"),
        ("M6", "GRBL does not know M6"),
        ("M84", "GRBL does not know M84"),
        ("G93", "G93 reads F as one over a time"),
    ],
)
def test_planted_faults(line: str, says: str) -> None:
    # After G28 nobody knows the height, which is told at the next travel.
    (at, what), *more = found(line + "\n")
    assert at == 10 and says in what and ["unknown height" in told for _, told in more] == [True] * (line == "G28")


RAPID = "G21 G17 G90 G94\nM5\nG0 Z10\nG0 X50 Y50\nG0 Z1.6\nM3 S100\nG1 X60 F200\nM5\nG0 Z10\nM2\n"


def told(text: str) -> list[tuple[int, str]]:
    return [(f.line, f.what) for f in check_text(text, load_printer("generic-grbl"))]


def test_g0_needs_no_f() -> None:
    assert told(RAPID) == []
    assert told(RAPID.replace("G0 Z1.6", "G0 Z1.6 F200").replace("X60 F200", "X60")) == []  # F of a G0 line is kept
    assert told(RAPID.replace("G0 Z10\nG0 X50", "G0 Z10 F99999\nG0 X50")) == []  # and is not the G0's
    assert (7, "no speed F was given yet") in told(RAPID.replace("X60 F200", "X60"))


def test_the_pump_rests_during_g0() -> None:
    found = told(RAPID.replace("M5\nG0 Z10\nM2", "G0 X70\nM5\nG0 Z10\nM2"))
    assert (8, "the pump runs while G0 moves as fast as the machine can, whatever F says") in found
    assert not [what for _, what in found if "limit of" in what or "no speed" in what]
    assert told(RAPID.replace("M5\nG0 Z10\nM2", "S0\nG0 Z10\nM2")) == []


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("G4", "G4 has no P, and GRBL halts there"),
        ("G4 P", "G4 has no P, and GRBL halts there"),
        ("G4 P-1", "G4 P-1 is negative, and GRBL halts there"),
        ("M3 S-5", "S-5 is negative, and GRBL halts there"),
        ("M3 S1001", "S1001 is not within 0 and the spindle's 1000"),
        ("G1 X50 A3 F300 M5", "GRBL does not know A on G1 and halts there"),
        ("G90 A1", "GRBL does not know A on G90 and halts there"),
        ("G90 G0 B1", "GRBL does not know B on G0 and halts there"),
        ("G4 P901", "G4 waits 901 s in the midst of the ink"),
    ],
)
def test_words_that_grbl_refuses(line: str, says: str) -> None:
    assert (10, says) in [(at, what.partition(", where")[0]) for at, what in found(line + "\n")]


@pytest.mark.parametrize("line", ["G4 P0", "G4 P0.5", "G04 P900", "M3 S0", "M5 S0"])
def test_words_that_grbl_takes(line: str) -> None:
    assert not found(line + "\n")


@pytest.mark.parametrize(("zeros", "faults"), [(67, 0), (68, 1), (90, 1)])
def test_grbl_counts_what_it_keeps_of_a_line_once(zeros: int, faults: int) -> None:
    line = f"G1 Z10.{zeros * '0'}" + 40 * " " + f"G21 G90 (a {'note' * 20}) ; {'note' * 20}"
    assert len(line.partition("(")[0].replace(" ", "")) == 79 + zeros - 67
    assert [at for at, what in found(line + "\n") if "characters long" in what] == [10] * faults


def test_a_stop_on_a_line_acts_behind_its_move() -> None:
    text = RAPID.replace("G1 X60 F200", "G1 X60 F200{first}\nG1 Y60{last}")
    assert told(text.format(first="", last="")) == told(text.format(first="", last=" M0")) == []
    for stop in ("M0", "M1"):
        waits = f"{stop} waits for a click in the midst of the ink, and the silicone sets meanwhile"
        assert told(text.format(first=f" {stop}", last="")) == [(7, waits)]
    assert told(text.replace("M3 S100", "M3 S100 M0").format(first="", last="")) == []  # before the ink


@pytest.mark.parametrize("end", ["M2", "M30"])
def test_nothing_moves_behind_the_end(end: str) -> None:
    behind = RAPID.replace("M2\n", f"G91\n{end}\n%\n")
    assert told(behind) == []
    (at, what), *more = told(behind + "X50 F300\nX40 Y40\nG0 Z20\n")
    assert at == 13 and what == f"it moves behind the {end} of line 11, where many senders stop" and not more
    moves = trace(behind + "X50 F300\n", spindle=load_printer("generic-grbl").spindle).moves
    assert moves[-1].end == (50.0, 50.0, 10.0) and not moves[-1].rapid  # G90 and G1 are back


def test_findings_speak_of_s_and_the_pump() -> None:
    back = told(RAPID.replace("M3 S100", "M4 S100"))
    assert (7, "the pump runs backwards while the head moves, for M4 turns it") in back
    assert not [what for _, what in back if "E-" in what or "make E" in what]


@pytest.mark.parametrize("note", ["(left open", "(a (b) ", "(x; y)", "/", " / ", "(one) (two", "; a ( b"])
def test_what_grbl_leaves_out_of_a_line(note: str) -> None:
    """It obeys the rest: no bracket and no slash hides a move that it makes."""
    text = HEAD + INK.format(60)
    front, behind = (f"G1 X900{note}" if note[0] in ";(" else f"{note}G1 X900"), "G1 X50"
    said = told(text + f"{front}\n{behind}\n")
    assert [(at, what.partition(",")[0]) for at, what in said] == [(10, "it reaches X900.0000")]


def test_a_semicolon_within_brackets_ends_no_line() -> None:
    assert [at for at, what in told(HEAD + INK.format(60) + "(a; b) G1 X900\nG1 X50\n")] == [10]
    assert not told(HEAD + INK.format(60) + "; (a) G1 X900\n(b G1 X900\nG1 X50 ; ) G1 X900\n")


def test_the_number_of_a_program_is_refused_by_grbl_and_read_past() -> None:
    sound = HEAD + INK.format(60)
    assert told("O1000 (a skin)\n" + sound) == [(1, "GRBL does not know O1000 and halts there")]
    assert judge("O1000\n" + sound, load_printer()).broken_off.startswith("line 1: cannot read 'O1000'")


def test_an_e_is_told_once_and_by_its_cause() -> None:
    said = [what for _, what in told(HEAD + "G90\nM3 S242\nG1 X60 E20 F300\nM5\nG1 Z10\n")]
    assert said == ["GRBL has no E axis and halts at G1 E"]


def test_f0_on_a_rapid_takes_the_speed_away() -> None:
    assert told(RAPID.replace("G0 Z1.6", "G0 Z1.6 F0")) == []
    assert (7, "no speed F was given yet") in told(RAPID.replace("G0 Z1.6", "G0 Z1.6 F0").replace("X60 F200", "X60"))
    assert judge(RAPID.replace("X60 F200", "X60 F0"), load_printer("generic-grbl")).broken_off.startswith("line 7: F is 0")
    assert judge(RAPID.replace("G0 Z1.6", "G0 Z1.6 F-1"), load_printer("generic-grbl")).broken_off.startswith("line 5: F is -1")


CODES = ["G0", "G1", "G2", "G3", "G4", "G20", "G28", "G90", "G91", "G92", "M0", "M2", "M3", "M4", "M5", "M30", ""]
WORDS = st.builds("{}{}".format, st.sampled_from("XYZIJRFSPAN"), st.sampled_from(["", "0", "1", "-1", "50", "1.5", "99999999", "-.0001"]))
LINES = st.lists(st.one_of(st.sampled_from(CODES), WORDS), min_size=1, max_size=6).map(" ".join)


@given(st.lists(LINES, max_size=12))
def test_hostile_blocks_are_judged_or_told_in_one_sentence(lines: list[str]) -> None:
    for start in ("", HEAD + "M3 S242\nG1 X60 F300\n"):
        judged = judge(start + "\n".join(lines), load_printer("generic-grbl"))
        assert "\n" not in judged.broken_off and (not judged.broken_off or judged.broken_off.startswith("line "))
        assert all(finding.what and finding.remedy for finding in judged.findings)
