"""Prime and retract: what is planned passes on every dialect, each planted fault is told at its line and by its cause."""

import re
from collections.abc import Callable
from dataclasses import replace

import pytest

from gcode.check import check_program, check_text
from gcode.emit import emit
from gcode.geometry import Straight
from gcode.plan import plan
from gcode.printer import Cleaning, Printer, load_printer
from gcode.program import Comment, Extrude, Prime, Program, Retract, Travel
from skinfab.material import Material
from skinfab.paths import Line, Path
from skinfab.pieces import Piece

MARLIN = ("ender5plus-vipro", "generic-marlin")
HEAD = "G28 X Y\nG90\nM83\nM302 P1\nG0 Z10 F300\nG0 X100 Y100 F6000\nG0 Z1.6 F300\n"
LINE = Path((Line((0, 0), (10, 0)),))


@pytest.fixture
def text_of(make_piece: Callable[..., Piece], make_sensor: Callable, material: Material) -> Callable[..., str]:
    """A file of so many lines."""

    def text(printer: Printer, names: str = "A") -> str:
        sensors = [make_sensor(name, LINE, 20, 20 + 10 * k) for k, name in enumerate(names)]
        return emit(plan(make_piece(60, 60), sensors, printer=printer, material=material).program, printer)

    return text


def changed(text: str, pattern: str, new: str, *, at: int = 0) -> tuple[str, int]:
    """The text with the match number `at` (from the end if negative) replaced, and its line there."""
    found = list(re.finditer(pattern, text, re.MULTILINE))[at]
    return text[: found.start()] + found.expand(new) + text[found.end() :], text.count("\n", 0, found.start()) + 1


def found(text: str, printer: Printer) -> list[tuple[int, str, str]]:
    return [(f.line, f.what, f.pattern) for f in check_text(text, printer)]


@pytest.mark.parametrize("names", ["A", "AB"])
@pytest.mark.parametrize("cleaning", [None, Cleaning(5.0, 6.0, 3.0, 30.0), Cleaning(5.0, 6.0, 3.0, 30.0, 2.0, 15.0)])
@pytest.mark.parametrize("name", [*MARLIN, "generic-grbl"])
@pytest.mark.parametrize("prime", [0.0, 0.2, 7.0])
def test_what_is_planned_passes(text_of: Callable[..., str], name: str, cleaning: Cleaning | None, names: str, prime: float) -> None:
    printer = load_printer(name)
    printer = replace(printer, cleaning=cleaning, pump=replace(printer.pump, prime=prime, retract=prime))
    assert found(text_of(printer, names), printer) == []


@pytest.mark.parametrize(
    ("pattern", "new", "lines_on", "says"),
    [
        (r"^G1 E-(.*)$", r"G1 E\1", 0, "is pushed out at standstill where no path follows: it leaves a blob"),
        (r"^G1 E-", "G1 E150 F495.8\nG1 E-", 0, "E150 is pushed out at standstill where no path follows"),
        (r"^G1 E(\d.*)$", r"G1 E-\1", 0, "draws ink back right before the path, where a prime pushes it"),
        (r"^G0 Z10.0000.*$", r"G1 Z10 E60 F300", 0, "E60 on a move in Z: the ink is drawn out to a thread"),
        (r"^G0 Z10.0000.*$", r"G1 Z10 E-6 F300", 0, "E-6 on a move in Z: part of the ink is drawn back only while the nozzle is away"),
        (r"^(G0 X5.0000 Y.*)$", r"G1 E190 F495.8\n\1", 0, "E190 is pushed out at standstill where no path follows"),
        (r"^; end$", "G1 E190 F495.8\n; end", 0, "E190 is pushed out at standstill where no path follows"),
        (r"^G1 E-.*\n", "", None, "and does not retract: the nozzle drips"),
        (r"^G1 E\d.*\n", "", None, "and does not prime: its path begins without ink"),
        (r"^G1 E-\S+", "G1 E-1", 0, "and retracts E-1".replace("E-", "E")),
    ],
)
@pytest.mark.parametrize("names", ["A", "AB"])
@pytest.mark.parametrize("name", MARLIN)
def test_planted_in_the_last_pattern(
    text_of: Callable[..., str], name: str, names: str, pattern: str, new: str, lines_on: int | None, says: str
) -> None:
    printer = load_printer(name)
    text, line = changed(text_of(printer, names), pattern, new, at=-1)
    ((at, what, where),) = found(text, printer)
    assert says in what and where
    assert lines_on is None or at == line


@pytest.mark.parametrize("name", MARLIN)
def test_neither_primed_nor_retracted(text_of: Callable[..., str], name: str) -> None:
    printer = load_printer(name)
    text = re.sub(r"^G1 E.*\n", "", text_of(printer), flags=re.MULTILINE)
    ((line, what, _),) = found(text, printer)
    assert what == "its path is neither primed nor retracted" and text.splitlines()[line - 1].startswith("G1 X")
    without = replace(printer, pump=replace(printer.pump, prime=0.0, retract=0.0))
    assert found(text, without) == []
    (fault,) = check_text(text, printer)
    assert f"prime E{printer.pump.prime * printer.pump.e_per_mm3:.6g} before it" in fault.remedy


@pytest.mark.parametrize(
    ("pattern", "new", "says"),
    [
        (r"^M3 S100.*\n", "", "and does not prime"),
        (r"^G4 P0.500\n", "", "and does not prime"),
        (r"^M4 S100.*\nG4.*\n", "", "and does not retract"),
        (r"^M4 S100.*\n", "", "1.21 mm^3 is pushed out at standstill where no path follows"),  # at the rate of the ink
        (r"^M4 ", "M3 ", "0.5 mm^3 is pushed out at standstill where no path follows"),
        (r"^M3 (S100.*\nG4)", r"M4 \1", "-0.5 mm^3 draws ink back right before the path"),
    ],
)
@pytest.mark.parametrize("names", ["A", "AB"])
def test_planted_on_grbl(text_of: Callable[..., str], names: str, pattern: str, new: str, says: str) -> None:
    printer = load_printer("generic-grbl")
    ((_, what, where),) = found(changed(text_of(printer, names), pattern, new)[0], printer)
    assert says in what and where


def test_a_pump_left_running_on_the_lift(text_of: Callable[..., str]) -> None:
    printer = load_printer("generic-grbl")
    text, line = changed(text_of(printer), r"^G1 Z10.0000.*$", "M3 S242\nG1 Z10 F300\nM5", at=-1)
    ((at, what, _),) = found(text, printer)
    assert at == line + 1 and "mm^3 on a move in Z" in what


def test_first_ink_belongs_to_the_cleaning_place(text_of: Callable[..., str]) -> None:
    printer = load_printer()
    begin, _ = changed(text_of(printer), "^; pattern", "G1 E150 F495.8\n; pattern")
    assert ["E150 is pushed out" in what for _, what, _ in found(begin, printer)] == [True]
    drawn, _ = changed(text_of(printer), "^; pattern", "G1 E-5 F495.8\n; pattern")
    assert ["it retracts E5 and does not prime" in what for _, what, _ in found(drawn, printer)] == [True]
    cleaned = replace(printer, cleaning=Cleaning(5.0, 6.0, 3.0, 30.0))
    text = text_of(cleaned)
    assert found(text, cleaned) == []
    # Known to a printer with that place alone.
    assert any("leaves a blob" in what for _, what, _ in found(text, printer))


def second_stroke(retract: float, prime: float, last: float = 4) -> str:
    return (
        "G1 E4 F400\nG1 X110 Y100 E40 F240\n"
        f"G1 E-{retract} F400\nG0 Z10 F300\nG0 X100 Y150 F6000\nG0 Z1.6 F300\n"
        f"G1 E{prime} F400\nG1 X110 Y150 E40 F240\nG1 E-{last} F400\nG0 Z10 F300\n"
    )


@pytest.mark.parametrize(
    ("retract", "prime", "last", "line", "says"),
    [
        (4, 3, 4, 14, "holds E1 less than at the first stroke's start"),
        (2, 4, 4, 14, "holds E2 more than at the first stroke's start"),
        (4, 4, 3, 16, "holds E1 more at the end than before the first prime"),
        (4, 4, 6, 16, "holds E2 less at the end than before the first prime"),
    ],
)
def test_a_file_of_anyones(retract: float, prime: float, last: float, line: int, says: str, printer: Printer) -> None:
    assert found(HEAD + second_stroke(4, 4), printer) == []
    ((at, what, _),) = found(HEAD + second_stroke(retract, prime, last), printer)
    assert at == line and says in what


def test_a_file_of_anyones_may_fill_its_nozzle_first(printer: Printer) -> None:
    fills = HEAD.replace("G0 X100", "G0 X5 Y5 F6000\nG0 Z1.6 F300\nG1 E60 F400\nG0 Z10 F300\nG0 X100")
    assert found(fills + second_stroke(4, 4), printer) == []
    assert found(fills + "G1 X110 Y100 E40 F240\nG0 Z10 F300", printer) == []


@pytest.mark.parametrize("name", ["", "; pattern C1\n"])
@pytest.mark.parametrize(
    ("strokes", "line", "says"),
    [
        (second_stroke(4, 4), None, ""),
        (
            second_stroke(6, 0, 0).replace("G1 E4 ", "G1 E6 ").replace("G1 E0 F400\n", "").replace("G1 E-0 F400\n", ""),
            10,
            "E6 less than at",
        ),
        (
            second_stroke(4, 4).replace("G0 Z10 F300\n", "G0 Z10 F300\nG1 E4\nG1 E-4\n", 1),
            12,
            "E4 is pushed out at standstill where no path",
        ),
        (second_stroke(4, 4).replace("G1 E-4 F400\nG0 Z10 F300\n", "G0 Z10 F300\nG1 E-4 F400\n"), None, ""),  # drawn back lifted
        (second_stroke(4, 4).replace("G1 E-4 F400\n", "", 1).replace("G1 E4 F400\nG1 X110 Y150", "G1 X110 Y150"), None, ""),  # kept full
    ],
)
def test_a_name_makes_no_stroke_weaker(strokes: str, line: int | None, says: str, name: str, printer: Printer) -> None:
    faults = found(HEAD + name + strokes, printer)
    assert [at - bool(name) for at, _, _ in faults] == ([] if line is None else [line])
    assert all(says in what for _, what, _ in faults)


def test_within_a_pattern_each_stroke_draws_back_what_it_primed(printer: Printer) -> None:
    strokes = second_stroke(4, 4, 1).replace("G1 E4 ", "G1 E1 ", 1)
    assert found(HEAD + strokes, printer) == []  # of a file of anyone's nobody knows how full its nozzle is at first
    ((line, what, _),) = found(HEAD + "; pattern C1\n" + strokes, printer)
    assert line == 11 and what.startswith("it primes E1 and retracts E4")
    portions = second_stroke(4, 4).replace("G1 E-4 F400\n", "G1 E-1 F400\nG1 E-3\n").replace("G1 E4 F400\n", "G1 E2 F400\nG1 E2\n")
    assert found(HEAD + "; pattern C1\n" + portions, printer) == []


def test_every_pattern_is_primed_alike(printer: Printer) -> None:
    line = "G0 X100 Y80 F6000\nG0 Z1.6 F300\nG1 X110 E40 F240\nG0 Z10 F300\nG0 X100 Y100 F6000\nG0 Z1.6 F300\n"
    more = second_stroke(4, 6, 6).replace("G0 X100 Y150", "; pattern C2\nG0 X100 Y150")
    ((at, what, where),) = found(HEAD + "; pattern C1\n" + more, printer)
    assert (at, where) == (16, "C2") and "holds E2 more than at the first stroke's start" in what
    # A line that fills the nozzle before the first pattern is none of them.
    same = second_stroke(4, 4).replace("G0 X100 Y150", "; pattern C2\nG0 X100 Y150")
    assert found(HEAD.replace("G0 X100 Y100 F6000\nG0 Z1.6 F300\n", line) + "; pattern C1\n" + same, printer) == []


def test_a_prime_away_from_the_path_counts_as_filling(printer: Printer) -> None:
    away = HEAD.replace("G0 X100", "G1 E4 F400\nG0 X100") + "{}G1 X110 Y100 E40 F240\nG1 E-4 F400\nG0 Z10 F300\n"
    (fault,) = check_text(away.format(""), printer)
    assert fault.line == 10 and "what line 6 pushes, away from the path, fills the nozzle and is no prime" in fault.what
    assert fault.remedy == "push it where the stroke begins, after the way there"
    assert found(away.format("G1 E4 F400\n"), printer) == []
    ((line, what, _),) = found(away.format("").replace("G1 E4", "; pattern C1\nG1 E4"), printer)
    assert line == 7 and "it leaves a blob" in what


def test_absolute_e_with_three_decimals(printer: Printer) -> None:
    """Each of two numbers is rounded; their difference is no fault."""
    body = "G1 E1.653 F400\nG1 X110 Y100 E41.653 F240\nG1 E40.001 F400\nG0 Z10 F300\n"
    assert found(HEAD.replace("M83", "M82\nG92 E0") + body, printer) == []


def test_balance_within_each_pattern_of_a_program(printer: Printer) -> None:
    def program(retract: float) -> Program:
        line = Extrude(Straight((100.0, 100.0), (110.0, 100.0)), 4.84, 4.0)
        down = (Travel(z=10.0, speed=5.0), Travel(x=100.0, y=100.0, speed=50.0), Comment("pattern C1"), Travel(z=1.6, speed=5.0))
        return Program("P1", (*down, Prime(0.5, 1.0), line, Retract(retract, 1.0), Travel(z=10.0, speed=5.0)))

    assert check_program(program(0.5), printer) == ()
    (fault,) = check_program(program(0.4), printer)
    assert "primes E4.13223 and retracts E3.30579" in fault.what and fault.pattern == "C1"
