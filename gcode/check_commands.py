"""Commands that wreck a cold print in a wet mould wherever they stand: a table of rules, asked of every command."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from gcode.moves import Finding, Trace
from gcode.printer import Printer
from gcode.trace import homed_axes
from gcode.words import HEATERS, MOTORS_OFF, Command

#: Words that Marlin reads on a machine of three axes; it passes over any other in silence.
WORDS = {
    "G0": "XYZEFS",
    "G1": "XYZEFS",
    "G2": "XYZEFIJRPS",
    "G3": "XYZEFIJRPS",
    "G4": "PS",
    "G28": "XYZLOR",
    "G92": "XYZE",
}
_WORDS = {code: frozenset(known) for code, known in WORDS.items()}
_PLAIN = ("G0", "G1")  # no other rule asks them anything

PROBES = ("G29", "G30", "G33", "G34", "G35", "G38.2", "G38.3", "G38.4", "G38.5", "G76", "M48")
TUNERS = ("M303", "M306")  # they heat without being told how far
SHIFTS = ("G92",)
WORKSPACES = ("G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
#: They load settings that were stored or built in (marlinfw.org, M501, M502); M500 only stores them.
RESETS = ("M501", "M502")
#: They run what is not in this file: another file, a macro (RepRapFirmware's M98; marlinfw.org, M23, M24, M32, M810).
CALLS = ("M23", "M24", "M32", "M98", *(f"M{number}" for number in range(810, 820)))
#: Of the flags of M111 (marlinfw.org): echo 1, info 2, errors 4, dry run 8, communication 16, levelling 32.
DRY_RUN = 8
#: What each of these sets by S holds until the next of them.
SWITCHES = frozenset({"M111", "M209"})
STOPS = ("M112", "M410", "M524")
#: Of an extruder of several pumps: shares of each, one by one, made valid, all at once, along Z (marlinfw.org, M163 to M166).
MIXES = ("M163", "M164", "M165", "M166")
#: Motions of the firmware's own: pattern, retract, wipe, park, sled, go to mesh point, resume, calibrate, change of filament,
#: babystep, stow (the head may rise for it).
UNFOLLOWED = (
    *("G6", "G53", "G10", "G11", "G12", "G26", "G27", "G31", "G32", "G42", "G61", "G425"),
    *("M125", "M290", "M402", "M600", "M701", "M702"),
)


@dataclass(frozen=True)
class State:
    """What a rule may ask besides the command itself: was ink laid before, is some to come, was it homed?"""

    printer: Printer
    wet: bool
    ink_follows: bool
    homed: bool
    holds_for_ink: bool  # ink is pushed or drawn after it and before the next of its code

    @property
    def z_by_hand(self) -> bool:
        """Z was set before the start: nothing in the file may touch it."""
        return self.printer.home != "xyz"


@dataclass(frozen=True)
class Rule:
    """Commands `codes` are faulty `when` so; `what` may name the ``{code}`` and, where `when` gives a text, that ``{text}``."""

    codes: tuple[str, ...]
    when: Callable[[Command, State], bool | str]
    what: str
    remedy: str


def command_findings(judged: Trace, printer: Printer) -> Iterator[Finding]:
    """What the table finds, in the order of the lines.

    Examples
    --------
    >>> from gcode.printer import load_printer
    >>> from gcode.trace import trace
    >>> print(*command_findings(trace("G28 X Y\\nG29"), load_printer()))
    line 2: G29 probes: the probe dips into the wet mould; take it out and set Z by hand
    """
    inked = [m.line for m in judged.moves if m.e > 0 and m.is_planar]
    first, last = min(inked, default=math.inf), max(inked, default=-math.inf)
    homed = False
    pushed = [m.line for m in judged.moves if m.e]
    until = _next_of(judged, SWITCHES)
    for command in judged.commands:
        code = command.code
        if code in _PLAIN and command.words.keys() <= _WORDS[code]:
            continue  # nearly every line
        rules = _BY_CODE.get(code, ())
        if code.startswith("T") and code != "T0":
            rules = (TOOL,)
        if rules:
            behind = bisect_right(pushed, command.line)
            holds = behind < len(pushed) and pushed[behind] < until.get(command.line, math.inf)
            state = State(printer, wet=command.line >= first, ink_follows=command.line < last, homed=homed, holds_for_ink=holds)
            for rule in rules:
                if found := rule.when(command, state):
                    yield Finding(command.line, rule.what.format(code=code, text=found), rule.remedy)
        homed |= code == "G28"


def _next_of(judged: Trace, codes: frozenset[str]) -> dict[int, int]:
    """Lines of commands that set something, and the line of the next that sets it anew."""
    found: dict[int, int] = {}
    later: dict[str, int] = {}
    for command in reversed(judged.commands):
        if command.code in codes and "S" in command.words:
            if command.code in later:
                found[command.line] = later[command.code]
            later[command.code] = command.line
    return found


def _probes(_: Command, state: State) -> bool:
    return state.z_by_hand or state.wet


def _deploys(command: Command, state: State) -> bool:
    """H and S ask for or set a mode of the probe and leave it where it is."""
    return _probes(command, state) and not command.words.keys() & {"H", "S"}


def _turns_servo(command: Command, state: State) -> bool:
    """Without S it only tells where the servo is."""
    return _probes(command, state) and "S" in command.words


def _homes_z(command: Command, state: State) -> bool:
    return "Z" in homed_axes(command) and (state.z_by_hand or state.wet)


def _homes_what_is_by_hand(command: Command, state: State) -> str:
    axes = " and ".join(axis for axis in homed_axes(command) if axis != "Z")
    return axes if state.printer.home == "none" else ""


def _heats(command: Command, _: State) -> bool:
    # I picks a preset of temperatures; R waits for one, like S.
    return "I" in command.words or any((command.words.get(letter) or 0.0) > 0 for letter in "SR")


def _waits_for_warmth(command: Command, _: State) -> bool:
    """With S until the probe is as warm, with R until it is as cold, too."""
    return bool(command.words.get("S")) or "R" in command.words


def _cancels(command: Command, state: State) -> bool:
    return state.ink_follows and bool(command.words.keys() & {"C", "P"})


def _shifts(command: Command, state: State) -> str:
    by_hand = {"xyz": "", "xy": "Z", "none": "XYZ"}[state.printer.home]
    return " and ".join(axis for axis in by_hand if axis in command.words)


def _moves_origin(command: Command, _: State) -> str:
    return " and ".join(axis for axis in "XYZ" if axis in command.words)


def _advances(command: Command, _: State) -> str:
    return " ".join(f"{letter}{value:g}" for letter in "KL" if (value := command.words.get(letter)))


def _frees_motors(command: Command, state: State) -> str:
    """S only says after how long they may rest."""
    if not state.ink_follows or not (state.wet or state.homed or state.z_by_hand) or "S" in command.words:
        return ""
    return " and ".join(axis for axis in "XYZE" if axis in command.words) or "every axis"


def _steps(command: Command, _: State) -> str:
    return " and ".join(axis for axis in "XYZE" if axis in command.words)


def _before_the_last_ink(_: Command, state: State) -> bool:
    """At the end of a print it is usual, or does no harm."""
    return state.ink_follows


def _ends_when_idle(command: Command, state: State) -> bool:
    """S0 lets it stand for ever."""
    return state.ink_follows and bool(command.words.get("S"))


def _amid_the_ink(_: Command, state: State) -> bool:
    """Before it, a file may well set what the machine has; the unit is the driver's, so no value is wrong by itself."""
    return state.wet and state.ink_follows


def _dry_run(command: Command, state: State) -> bool:
    """Bit 3 of its flags: the head moves and E does not."""
    return state.holds_for_ink and bool(int(command.words.get("S") or 0.0) & DRY_RUN)


def _retracts_by_itself(command: Command, state: State) -> bool:
    """An S without a number is 1 (Marlin's parser.h)."""
    return state.holds_for_ink and command.words.get("S", 0.0) != 0


def _sets_amid_the_ink(command: Command, state: State) -> bool:
    """Without words, or with those that choose how, it only tells what is set."""
    return _amid_the_ink(command, state) and bool(command.words.keys() - {"V", "T"})


def _microsteps(command: Command, state: State) -> bool:
    return state.ink_follows and bool(command.words)


def _volumetric(command: Command, _: State) -> bool:
    """D is the filament's diameter, which switches it on unless it is 0 or S is."""
    d, s = (command.words.get(letter) for letter in "DS")
    return d != 0 and s != 0 and bool(d or s or ("S" in command.words and s is None))


def _lets_go_of_bounds(command: Command, _: State) -> bool:
    return command.words.get("S") == 0


def _shifts_all(_: Command, state: State) -> bool:
    return state.z_by_hand


def _unknown_words(command: Command, _: State) -> str:
    unknown = [letter for letter in command.words if letter not in WORDS[command.code]]
    return " ".join(letter if (value := command.words[letter]) is None else f"{letter}{value:g}" for letter in unknown)


def _whole_circles(command: Command, _: State) -> bool:
    return "P" in command.words


def _scaled(command: Command, _: State) -> bool:
    return command.words.get("S") not in (None, 100.0)


def _always(_: Command, __: State) -> bool:
    return True


RULES = (
    Rule(("G28",), _homes_z, "it homes Z: the probe dips into the wet mould", "home with G28 X Y and set Z = 0 by hand"),
    Rule(("G28",), _homes_what_is_by_hand, "it homes {text}, the profile homes nothing", "take it out and set the place by hand"),
    Rule(PROBES, _probes, "{code} probes: the probe dips into the wet mould", "take it out and set Z by hand"),
    Rule(("M401",), _deploys, "{code} lets the probe down into the wet mould", "take it out and set Z by hand"),
    Rule(
        ("M280",),
        _turns_servo,
        "{code} turns a servo, as a rule the one that lets the probe down into the wet mould",
        "take it out and set Z by hand",
    ),
    Rule(
        tuple(sorted(HEATERS)),
        _heats,
        "{code} heats, and silicone sets early where it is warm",
        "take it out; the print is cold throughout",
    ),
    Rule(
        ("M192",),
        _waits_for_warmth,
        "{code} waits until the probe has a temperature, in a cold print for ever, and the silicone sets meanwhile",
        "take it out; the print is cold throughout",
    ),
    Rule(("M486",), _cancels, "{code} cancels an object: moves that follow are not printed", "take it out, with its C or P"),
    Rule(TUNERS, _always, "{code} heats to tune a heater, and silicone sets early where it is warm", "take it out"),
    Rule(SHIFTS, _shifts, "{code} shifts the {text} that was set by hand", "send it before the start, not in the file"),
    Rule(("G92.1",), _shifts_all, "{code} undoes the Z that was set by hand", "send it before the start, not in the file"),
    Rule(
        ("M206",),
        _moves_origin,
        "M206 moves the origin of {text}: what follows lies elsewhere",
        "send it before the start, not in the file",
    ),
    Rule(
        ("M428",),
        _always,
        "M428 makes where the head is the origin: what follows lies elsewhere",
        "send it before the start, not in the file",
    ),
    Rule(("M218",), _moves_origin, "M218 shifts a nozzle in {text}: what follows lies elsewhere", "take it out; there is one nozzle"),
    Rule(
        ("G68",),
        _always,
        "G68 turns all that follows where a firmware knows it, and is passed over where it does not",
        "write the turned places themselves",
    ),
    Rule(WORKSPACES, _always, "{code} takes an origin that is stored in the machine: what follows lies elsewhere", "take it out"),
    Rule(
        tuple(sorted(MOTORS_OFF)),
        _frees_motors,
        "{code} frees the motors of {text} before the last ink: the head no longer stands where it was",
        "put it at the end",
    ),
    Rule(STOPS, _always, "{code} stops the machine at once: what follows is not printed", "take it out"),
    Rule(("M997",), _always, "M997 restarts the machine with another firmware: what follows is not printed", "take it out"),
    Rule(("M81",), _before_the_last_ink, "M81 turns the power off before the last ink: what follows is not printed", "put it at the end"),
    Rule(
        ("M85",),
        _ends_when_idle,
        "M85 stops the machine for good where it waits longer than S seconds, as in a dwell",
        "take it out, or send M85 S0",
    ),
    Rule(
        ("M808",),
        _always,
        "M808 marks moves that are run again from a card: the nozzle goes through its own wet ink",
        "write every move once, and take it out",
    ),
    Rule(
        ("M907",),
        _amid_the_ink,
        "{code} changes the motors' current amid the ink, and a motor with too little loses steps",
        "send it before the start, not in the file",
    ),
    Rule(
        ("M906",),
        _sets_amid_the_ink,
        "{code} changes the motors' current amid the ink, and a motor with too little loses steps",
        "send it before the start, not in the file",
    ),
    Rule(
        ("M350",),
        _microsteps,
        "{code} changes the microsteps: each mm told is another length",
        "set it in the firmware before you measure",
    ),
    Rule(
        ("M420", "M425"),
        _sets_amid_the_ink,
        "{code} changes amid the ink how the firmware corrects places: what follows lies elsewhere than what was laid",
        "send it before the first ink",
    ),
    Rule(
        ("M605",),
        _amid_the_ink,
        "{code} changes amid the ink which carriage is driven, and another nozzle is elsewhere",
        "send it before the start, not in the file",
    ),
    Rule(("M111",), _dry_run, "{code} begins a dry run: the head moves and no ink comes", "take it out, or leave out the 8 of S"),
    Rule(
        ("M209",),
        _retracts_by_itself,
        "M209 S1 makes each prime and retract the firmware's own, of a length that is stored in the machine",
        "take it out, or send M209 S0",
    ),
    Rule(MIXES, _always, "{code} shares the ink among several pumps, the profile has one", "take it out"),
    Rule(
        ("M28",),
        _before_the_last_ink,
        "{code} writes what follows to a card, and nothing of it is printed",
        "take it out",
    ),
    Rule(
        ("M92",),
        _steps,
        "M92 changes the steps per mm of {text}: each mm told is another length",
        "set it in the firmware before you measure",
    ),
    Rule(
        ("M200",),
        _volumetric,
        "M200 makes E a volume and divides it by a filament's cross-section, the profile's E is mm of the pump's axis",
        "take it out, or send M200 D0",
    ),
    Rule(
        RESETS,
        _always,
        "{code} sets steps, limits and origin to what is stored or built in, and what was set by hand is lost",
        "send it before you set the origin, not in the file",
    ),
    Rule(
        ("M900",),
        _advances,
        "M900 {text} lets the pump run ahead of the head and back, so a move's ink lies elsewhere than on the move",
        "send M900 K0",
    ),
    Rule(CALLS, _always, "{code} runs moves that are not in this file, which no rule can judge", "put those moves into this file"),
    Rule(("M211",), _lets_go_of_bounds, "M211 S0 lets the head run on beyond the ends of its axes", "take it out"),
    Rule(tuple(WORDS), _unknown_words, "{code} does not know {text}, which is passed over in silence", "correct the mistyped letter"),
    Rule(("G2", "G3"), _whole_circles, "P on an arc adds whole circles", "draw each half circle by a command of its own"),
    Rule(UNFOLLOWED, _always, "{code} moves head or ink in a way of the firmware's own, which no rule can judge", "write it as G0 and G1"),
    Rule(("M220", "M221"), _scaled, "{code} scales what the file says of speed or ink", "write the numbers themselves, with S100"),
)

#: Of any T but T0.
TOOL = Rule((), _always, "{code} changes to another tool, whose nozzle is elsewhere", "take it out; there is one pump")

_BY_CODE = {code: tuple(rule for rule in RULES if code in rule.codes) for rule in RULES for code in rule.codes}
