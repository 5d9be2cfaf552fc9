"""Commands that wreck a cold print in a wet mould wherever they stand: a table of rules, asked of every command."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from gcode.printer import Printer
from gcode.trace import Finding, Trace, homed_axes
from gcode.words import HEATERS, Command

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

PROBES = ("G29", "G30", "G33", "G34", "G35", "G38.2", "G38.3", "G38.4", "G38.5", "G76", "M48")
TUNERS = ("M303", "M306")  # they heat without being told how far
SHIFTS = ("G92", "M206")
#: Motions of the firmware's own: pattern, retract, wipe, park, go to mesh point, resume, change of filament.
UNFOLLOWED = ("G6", "G10", "G11", "G12", "G26", "G27", "G42", "G61", "M125", "M600", "M701", "M702")


@dataclass(frozen=True)
class State:
    """What a rule may ask besides the command itself; `wet`: ink was laid before it."""

    printer: Printer
    wet: bool

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
    first_ink = min((m.line for m in judged.moves if m.e > 0 and m.is_planar), default=None)
    for command in judged.commands:
        state = State(printer, wet=first_ink is not None and command.line > first_ink)
        for rule in _BY_CODE.get(command.code, ()):
            if found := rule.when(command, state):
                yield Finding(command.line, rule.what.format(code=command.code, text=found), rule.remedy)


def _probes(_: Command, state: State) -> bool:
    return state.z_by_hand or state.wet


def _homes_z(command: Command, state: State) -> bool:
    return "Z" in homed_axes(command) and (state.z_by_hand or state.wet)


def _homes_what_is_by_hand(command: Command, state: State) -> str:
    axes = " and ".join(axis for axis in homed_axes(command) if axis != "Z")
    return axes if state.printer.home == "none" else ""


def _heats(command: Command, _: State) -> bool:
    # I picks a preset of temperatures; R waits for one, like S.
    return "I" in command.words or any((command.words.get(letter) or 0.0) > 0 for letter in "SR")


def _shifts(command: Command, state: State) -> str:
    by_hand = {"xyz": "", "xy": "Z", "none": "XYZ"}[state.printer.home]
    return " and ".join(axis for axis in by_hand if axis in command.words)


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
    Rule(
        tuple(sorted(HEATERS)),
        _heats,
        "{code} heats, and silicone sets early where it is warm",
        "take it out; the print is cold throughout",
    ),
    Rule(TUNERS, _always, "{code} heats to tune a heater, and silicone sets early where it is warm", "take it out"),
    Rule(SHIFTS, _shifts, "{code} shifts the {text} that was set by hand", "send it before the start, not in the file"),
    Rule(("G92.1", "M428"), _shifts_all, "{code} undoes the Z that was set by hand", "send it before the start, not in the file"),
    Rule(tuple(WORDS), _unknown_words, "{code} does not know {text}, which is passed over in silence", "correct the mistyped letter"),
    Rule(("G2", "G3"), _whole_circles, "P on an arc adds whole circles", "draw each half circle by a command of its own"),
    Rule(UNFOLLOWED, _always, "{code} moves head or ink in a way of the firmware's own, which no rule can judge", "write it as G0 and G1"),
    Rule(("M220", "M221"), _scaled, "{code} scales what the file says of speed or ink", "write the numbers themselves, with S100"),
)

_BY_CODE = {code: tuple(rule for rule in RULES if code in rule.codes) for rule in RULES for code in rule.codes}
