"""Every rule of the table refuses its planted fault, and lets the harmless neighbour of it pass."""

from dataclasses import replace
from inspect import signature

import pytest

from gcode.check import check_text
from gcode.check_commands import RULES
from gcode.emit import emit
from gcode.plan import Plan
from gcode.printer import Printer
from gcode.words import READ

SOUND = "G28 X Y\nM83\nM302 P1\nG0 Z10 F300\nG0 X100 Y100 F6000\nG0 Z1.6 F300\n{wet}G1 X110 Y100 E40 F240\n{after}G0 Z10 F300\n"


def found(printer: Printer, home: str, *, wet: str = "", after: str = "") -> list[tuple[int, str]]:
    text = SOUND.format(wet=wet and wet + "\n", after=after and after + "\n")
    homing = {"xyz": "G28", "xy": "G28 X Y", "none": "; by hand"}[home]
    findings = check_text(text.replace("G28 X Y", homing, 1), replace(printer, home=home))
    return [(f.line, f.what) for f in findings]


@pytest.mark.parametrize("home", ["xyz", "xy", "none"])
def test_the_sound_file_is_sound(printer: Printer, planned: Plan, home: str) -> None:
    assert not found(printer, home)
    assert not check_text(emit(planned.program, replace(printer, home=home)), replace(printer, home=home))


@pytest.mark.parametrize(
    ("home", "line", "says"),
    [
        ("xy", "G29", "G29 probes"),
        ("none", "G29 P1", "G29 probes"),
        ("xy", "G30 X10 Y10", "G30 probes"),
        ("xy", "G38.2 Z-5", "G38.2 probes"),
        ("xy", "M48 P10", "M48 probes"),
        ("xy", "G34", "G34 probes"),
        ("xy", "G28 Z", "homes Z"),
        ("none", "G28 Z", "homes Z"),
        ("none", "G28 X", "it homes X, the profile homes nothing"),
        ("xy", "M104 S200", "M104 heats"),
        ("xyz", "M104 T0 S200", "M104 heats"),
        ("xy", "M109 R60", "M109 heats"),
        ("xy", "M140 S60", "M140 heats"),
        ("xy", "M140 I1", "M140 heats"),
        ("xy", "M190 S0.5", "M190 heats"),
        ("none", "M141 S40", "M141 heats"),
        ("xy", "M191 S40", "M191 heats"),
        ("xy", "M192 S40", "M192 waits until the probe"),
        ("xy", "M192 R40", "M192 waits until the probe"),
        ("xy", "M486 C", "M486 cancels an object"),
        ("xy", "M486 P2", "M486 cancels an object"),
        ("xy", 'M486 S1 P0 A"Cap"', "M486 cancels an object"),
        ("xy", "M303 E0 S200", "M303 heats"),
        ("xy", "G92 Z0.3", "G92 shifts the Z"),
        ("none", "G92 X100 Z1.6", "G92 shifts the X and Z"),
        ("xy", "M206 Z-2", "M206 moves the origin of Z"),
        ("xyz", "M206 X1 Y0", "M206 moves the origin of X and Y"),
        ("xyz", "M428", "M428 makes where the head is the origin"),
        ("xy", "G92.1", "G92.1 undoes"),
        ("none", "G92.1", "G92.1 undoes"),
        ("xy", "G55", "G55 takes an origin that is stored"),
        ("xy", "G59.3", "G59.3 takes an origin that is stored"),
        ("xy", "G53 G0 X10", "no rule can judge"),
        ("xy", "M84", "M84 frees the motors of every axis before the last ink"),
        ("xyz", "M18 X Y", "M18 frees the motors of X and Y"),
        ("none", "M84 XY", "M84 frees the motors of X and Y"),
        ("xy", "M84 E", "M84 frees the motors of E"),
        ("xy", "M112", "M112 stops the machine"),
        ("xy", "M410", "M410 stops the machine"),
        ("xy", "M524", "M524 stops the machine"),
        ("xy", "M997", "M997 restarts the machine"),
        ("xy", "M209 S1", "M209 S1 makes each prime and retract the firmware's own"),
        ("xy", "M209 S", "M209 S1 makes each prime and retract the firmware's own"),
        ("xy", "M163 S0 P0.5", "M163 shares the ink among several pumps"),
        ("xy", "M164 S0", "M164 shares the ink among several pumps"),
        ("xy", "M165 A0.5 B0.5", "M165 shares the ink among several pumps"),
        ("xy", "M166 A0 Z10 I0 J1", "M166 shares the ink among several pumps"),
        ("xy", "M81", "M81 turns the power off before the last ink"),
        ("xy", "M85 S1", "M85 stops the machine for good"),
        ("xy", "M808 L3", "M808 marks moves that are run again"),
        ("xy", "M808", "M808 marks moves that are run again"),
        ("xy", "M92 E400", "M92 changes the steps per mm of E"),
        ("xy", "M92 X80 Y80 Z400", "M92 changes the steps per mm of X and Y and Z"),
        ("xy", "M200 D1.75", "M200 makes E a volume"),
        ("xy", "M200 T0 D2.85", "M200 makes E a volume"),
        ("xy", "M200 S1", "M200 makes E a volume"),
        ("xy", "M211 S0", "M211 S0 lets the head run on"),
        ("xy", "M280 P0 S10", "M280 turns a servo"),
        ("none", "M401", "M401 lets the probe down"),
        ("xy", "M402", "no rule can judge"),
        ("xy", "G32", "no rule can judge"),
        ("xy", "M290 Z0.1", "no rule can judge"),
        ("xy", "M32 P !/a.gco#", "M32 runs moves that are not in this file"),
        ("xy", "M23 other.gco", "M23 runs moves that are not in this file"),
        ("xy", "M24", "M24 runs moves that are not in this file"),
        ("xy", 'M98 P"a.g"', "M98 runs moves that are not in this file"),
        ("xy", "M810", "M810 runs moves that are not in this file"),
        ("xyz", "M501", "M501 sets steps, limits and origin to what is stored"),
        ("xy", "M502", "M502 sets steps, limits and origin to what is stored"),
        ("xy", "M218 T0 X1 Y2", "M218 shifts a nozzle in X and Y"),
        ("xy", "M900 K1", "M900 K1 lets the pump run ahead"),
        ("xy", "M900 T0 L0.2 K0", "M900 L0.2 lets the pump run ahead"),
        ("xy", "G68 X0 Y0 R45", "G68 turns all that follows"),
        ("xy", "T1", "T1 changes to another tool"),
        ("xy", "T12", "T12 changes to another tool"),
        ("xy", "G1 Q140 F240", "G1 does not know Q140"),
        ("xy", "G0 B2 Q", "G0 does not know B2 Q"),
        ("xy", "G3 X110 Y100 I5 J0 K2 E60 F200", "G3 does not know K2"),
        ("xy", "G92 E0 A5", "G92 does not know A5"),
        ("xy", "G4 X2", "G4 does not know X2"),
        ("xy", "G3 X110 Y100 I5 J0 P2 E60 F200", "adds whole circles"),
        ("xy", "G10", "no rule can judge"),
        ("xy", "G27", "no rule can judge"),
        ("xy", "M600", "no rule can judge"),
        ("xy", "M221 S150", "M221 scales"),
        ("xy", "M220 S50", "M220 scales"),
    ],
)
def test_planted_faults(printer: Printer, home: str, line: str, says: str) -> None:
    assert any(at == 7 and says in what for at, what in found(printer, home, wet=line)), found(printer, home, wet=line)


@pytest.mark.parametrize("line", ["G28", "G28 Z", "G29", "G30", "M280 P0 S10", "M401"])
def test_a_printer_that_homes_z_does_so_before_the_ink(printer: Printer, line: str) -> None:
    assert any(at == 8 and "wet mould" in what for at, what in found(printer, "xyz", after=line))
    assert not check_text(SOUND.format(wet="", after="").replace("G28 X Y", f"G28\n{line}"), replace(printer, home="xyz"))


@pytest.mark.parametrize(
    ("home", "line"),
    [
        ("xyz", "G92 Z1.6"),  # the place it is at
        ("xy", "G92 X100 Y100 E0"),
        ("none", "G92 E0"),
        ("xy", "M206"),  # tells the offsets
        ("xy", "G54"),
        ("xy", "T0"),
        ("xy", "M17"),
        ("xy", "M84 S60"),  # only after a minute at rest
        ("xy", "M92"),
        ("xy", "M200 D0"),
        ("xy", "M200 D1.75 S0"),
        ("xy", "M200"),
        ("xy", "M211 S1"),
        ("xy", "M211"),
        ("xy", "M0"),  # before the ink it may wait
        ("xy", "M104 S0"),
        ("xy", "M140 T0 S0"),
        ("xy", "M190 R0"),
        ("xy", "M192 S0"),
        ("xy", "M486 T5"),
        ("xy", "M486 S-1"),
        ("xy", "M486 U2"),
        ("xy", 'M486 S1 A"Cap P0"'),
        ("xy", "M486 APlate-C P 1"),
        ("xy", "M109"),
        ("xy", "G1 F240 S0"),
        ("xy", "G4 P100"),
        ("xy", "M220 S100"),
        ("xy", "M221 S100"),
        ("xy", "M106 S255"),
        ("xy", "M280 P0"),  # tells
        ("xy", "M401 S1"),  # a mode
        ("xyz", "M280 P0 S10"),  # before the ink
        ("xyz", "M401"),
        ("xy", "M500"),
        ("xy", "M80"),
        ("xy", "M85"),
        ("xy", "M85 S0"),
        ("xy", "M907 E500"),
        ("xy", "M218"),
        ("xy", "M900 K0"),
        ("xy", "M900"),
        ("xy", "G69"),
        ("xy", "M25"),
        ("xy", "M209"),
        ("xy", "M209 S0"),
        ("xy", "M209 S1\nM209 S0"),
        ("xy", "M111 S8\nM111 S0"),
        ("xy", "M111 S8\nM111\nM111 S7"),
        ("xy", "M226 P1 S1"),
        ("xy", "M117 Heating is off, 0% Q"),
    ],
)
def test_harmless_neighbours_pass(printer: Printer, home: str, line: str) -> None:
    assert not found(printer, home, wet=line)


INK_AND_INK = SOUND.removesuffix("G0 Z10 F300\n") + "G0 Z10 F300\nG0 X100 Y110 F6000\nG0 Z1.6 F300\nG1 X110 Y110 E40 F240\nG0 Z10 F300\n"


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("M0", "waits for a click"),
        ("M1 S5", "waits for a click"),
        ("M18", "frees the motors"),
        ("M81", "turns the power off"),
        ("M907 E50", "changes the motors' current"),
        ("M906 I1 T0 E800", "changes the motors' current"),
        ("M111 S8", "begins a dry run"),
        ("M111 S14", "begins a dry run"),
        ("M28 other.gco", "writes what follows to a card"),
        ("M350 X16 Y16", "changes the microsteps"),
        ("M420 V S1", "how the firmware corrects places"),
        ("M420 S1 Z10", "how the firmware corrects places"),
        ("M425 X Z F1", "how the firmware corrects places"),
        ("M605 S2", "which carriage is driven"),
        ("M601", "waits for someone to resume"),
        ("G4 S901", "waits 901 s in the midst of the ink, where 900 is the most"),
        ("G4 P901000", "waits 901 s in the midst of the ink"),
    ],
)
def test_in_the_midst_of_the_ink_and_after_it(printer: Printer, line: str, says: str) -> None:
    (fault,) = check_text(INK_AND_INK.format(wet="", after=line + "\n"), printer)
    assert fault.line == 8 and says in fault.what
    assert not check_text(INK_AND_INK.format(wet="", after="") + line + "\n", printer)


@pytest.mark.parametrize(
    "line", ["M906", "M111", "M111 S7", "M111 S38", "M350", "M420", "M420 V", "M420 V T1", "M425", "G4 S900", "M29", "M928 log.txt"]
)
def test_what_only_tells_passes_amid_the_ink(printer: Printer, line: str) -> None:
    assert not check_text(INK_AND_INK.format(wet="", after="G0 Z10 F300\n" + line + "\n"), printer)


@pytest.mark.parametrize("line", ["M420 S1", "M420 S1 Z10", "M425 F1 S0", "M605 S1", "M906 X800 E400", "M111 S0", "G4 S2000", "M601"])
def test_what_is_usual_before_the_ink_passes(printer: Printer, line: str) -> None:
    assert not check_text(INK_AND_INK.format(wet="", after="").replace("M83", f"M83\n{line}"), printer)


@pytest.mark.parametrize("line", ["M111 S8", "M28 a.gco", "M350 E16"])
def test_what_spoils_the_ink_before_it_begins(printer: Printer, line: str) -> None:
    (fault,) = check_text(INK_AND_INK.format(wet="", after="").replace("M83", f"M83\n{line}"), printer)
    assert fault.line == 3


@pytest.mark.parametrize(
    ("lines", "faults"),
    [
        ("M111 S8\nG1 X101 E4 F240\nM111 S0", [7]),  # ink on the way
        ("M111 S8\nG1 E2\nM111 S0\nG1 E-2", [7]),
        ("M111 S8\nM111 S24\nM111 S0", []),
        ("M111 S8\nM111", [7]),  # tells, and takes nothing back
        ("M209 S1\nG1 E2 F240\nM209 S0\nG1 E-2", [7]),
    ],
)
def test_a_switch_is_a_fault_where_ink_comes_before_it_is_taken_back(printer: Printer, lines: str, faults: list[int]) -> None:
    assert [at for at, what in found(printer, "xy", wet=lines) if "dry run" in what or "M209" in what] == faults


@pytest.mark.parametrize(
    ("first", "later", "faults"),
    [
        ("G28", "G28 O", []),  # all is homed: it does nothing
        ("G28\nM84", "G28 O", ["homes Z"]),
        ("G28 X Y", "G28 O", ["homes Z"]),
        ("G28", "G28 O0", ["homes Z"]),
        ("G28", "G28", ["homes Z"]),
    ],
)
def test_homing_only_where_it_is_needed(first: str, later: str, faults: list[str], printer: Printer) -> None:
    text = INK_AND_INK.format(wet="", after=f"G0 Z10 F300\n{later}\nG0 Z10 F300\n").replace("G28 X Y", first)
    told = check_text(text, replace(printer, home="xyz"))
    lines = text.splitlines()
    at = len(lines) - lines[::-1].index(later)
    assert [word for f in told for word in faults if word in f.what and f.line == at] == faults
    assert faults or not told


def test_homing_where_it_is_needed_homes(printer: Printer) -> None:
    text = INK_AND_INK.format(wet="", after="")
    assert not check_text(text.replace("G28 X Y", "G28 O"), replace(printer, home="xyz"))
    assert "it homes Z" in check_text(text.replace("G28 X Y", "G28 O"), printer)[0].what


def test_motors_may_rest_before_they_are_homed(printer: Printer) -> None:
    text = SOUND.format(wet="", after="")
    by_probe = replace(printer, home="xyz")
    assert not check_text("M84\n" + text.replace("G28 X Y", "G28"), by_probe)
    assert [f.line for f in check_text("M84\n" + text, printer)] == [1]  # the Z that was set by hand is lost


def test_every_rule_that_asks_for_words_gets_them() -> None:
    asking = {code for rule in RULES if next(iter(signature(rule.when).parameters)) != "_" for code in rule.codes}
    assert {"G28", "M104", "M900"} <= asking
    assert asking <= READ
