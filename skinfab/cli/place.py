"""`skinfab place SKIN`: put sensors on the flat pieces of a document, or change those that are there."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps

if TYPE_CHECKING:
    from skinfab.material import Material
    from skinfab.placement.sensor import Sensor
    from skinfab.skin import Skin


class _Edit(argparse.Action):
    """Keeps changes in the order in which they were given, whatever their kind."""

    def __call__(self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any, option: str | None = None) -> None:
        id, *words = [values] if isinstance(values, str) else values
        namespace.edits = [*namespace.edits, (self.dest, id, _READ[self.dest](parser, str(option), words))]


def _numbers(parser: argparse.ArgumentParser, option: str, words: Sequence[str]) -> list[float]:
    import math

    values = [_value(word) for word in words]
    for word, value in zip(words, values, strict=True):
        if isinstance(value, (str, bool)) or not math.isfinite(value):
            parser.error(f"argument {option}: {word!r} is not a number")
    return [float(v) for v in values]


def _nothing(parser: argparse.ArgumentParser, option: str, words: Sequence[str]) -> list[Any]:
    return list(words)


def _to_piece(parser: argparse.ArgumentParser, option: str, words: Sequence[str]) -> list[Any]:
    return [words[0], *_numbers(parser, option, words[1:])]


def _assignments(parser: argparse.ArgumentParser, option: str, words: Sequence[str]) -> dict[str, Any]:
    pairs = [word.partition("=") for word in words]
    if not pairs or not all(name and value for name, _, value in pairs):
        parser.error(f"argument {option}: write NAME=VALUE, such as n=4 s=22")
    return {name: _value(value) for name, _, value in pairs}


def _value(text: str) -> Any:
    """A number, a truth, or the word itself, which the pattern will refuse in its own words."""
    if text in ("true", "false"):
        return text == "true"
    try:
        return int(text) if text.lstrip("+-").isdecimal() else float(text)
    except ValueError:
        return text


_READ: dict[str, Any] = {
    "move": _numbers,
    "move_to": _to_piece,
    "shift": _numbers,
    "rotate": _numbers,
    "set": _assignments,
    "remove": _nothing,
}


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "place",
        help="put sensors on the flat pieces",
        description="Put sensors on the pieces of a skin document, automatically or as a file says (see docs/sensors.md): sensors that are "
        "there already are replaced. Or change those that are there, one by one, in the order given; nothing is written unless all of "
        "them fit afterwards.",
    )
    p.add_argument("skin", metavar="SKIN", nargs="?", type=Path, help="the skin document")
    p.add_argument(
        "-o", "--output", metavar="OUT.skin", type=steps.named(".skin"), help="where to write the result (default: back to SKIN)"
    )
    p.add_argument("--sensors", metavar="FILE.toml", type=Path, help="which sensors, and where (default: automatic)")
    p.add_argument("--add", metavar="FILE.toml", type=Path, help="sensors to add to those that are there")
    p.add_argument("--list", action="store_true", help="say what sensors there are, with their parameters; change nothing")
    p.add_argument(
        "--patterns",
        action="store_true",
        help="say what patterns there are, and of each parameter its unit, bounds and what it is unless given; needs no SKIN",
    )
    p.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    changes = p.add_argument_group("changes", "X and Y are mm of the flat piece, and where the end of the sensor's lower lead lies")
    for option, count, metavar, text in (
        ("--move", 3, ("ID", "X", "Y"), "put a sensor there"),
        ("--move-to", 4, ("ID", "PIECE", "X", "Y"), "put it on another piece"),
        ("--shift", 3, ("ID", "DX", "DY"), "move it by so many mm"),
        ("--rotate", 2, ("ID", "DEG"), "turn it about its middle, from x towards y"),
        ("--set", "+", ("ID", "NAME=VALUE"), "other parameters of its pattern, or channel=N; its middle stays where it is"),
        ("--remove", None, "ID", "take it off"),
    ):
        changes.add_argument(option, nargs=count, metavar=metavar, action=_Edit, help=text)
    p.set_defaults(run=run, edits=[], wrong_usage=p.error)


def run(args: argparse.Namespace) -> int:
    """Place or change, check, write, and say what is where."""
    from gcode.printer import load_printer
    from gcode.used import with_room_for_nozzle
    from skinfab.document import load_skin, save_skin
    from skinfab.material import load_material
    from skinfab.placement.lifted import off_words
    from skinfab.placement.place import place_sensors

    changes = bool(args.edits or args.add)
    if args.patterns:
        if args.skin or changes or args.sensors or args.output or args.list:
            args.wrong_usage("--patterns lists what there is to place; it goes with --json and nothing else")
        return _say_patterns(as_json=args.json)
    if args.skin is None:
        args.wrong_usage("SKIN is missing: the skin document; --patterns says what patterns there are to place")
    if args.sensors is not None and changes:
        args.wrong_usage("--sensors replaces all sensors, so it does not go with changes; --add FILE adds some")
    if args.list and (changes or args.sensors or args.output):
        args.wrong_usage("--list changes and writes nothing")
    skin = load_skin(args.skin)
    material = load_material(skin.material)
    target = args.output or args.skin
    warnings: list[str] = []
    had = len(skin.sensors) + len(skin.lifted)
    if had and not (args.list or changes):
        steps.say([f"the {steps.counted(had, 'sensor')} that {args.skin} had are placed anew; --list would only show them"])
    if not args.list:
        roomy, wider = with_room_for_nozzle(material, load_printer(skin.printer))
        sensors, warnings = _changed(skin, roomy, args) if changes else place_sensors(skin, roomy, args.sensors)
        skin = replace(skin, sensors=sensors, lifted=skin.lifted if changes else ())
        warnings = [*wider, *warnings, *_beyond_the_boards(sensors)]
        save_skin(skin, target)
    warnings = [*warnings, *off_words(skin.lifted)]
    steps.say(warnings, kind="warning")
    if args.json:
        print(json.dumps({"skin": str(target), "sensors": [_facts(s) for s in skin.sensors], "warnings": list(warnings)}))
        return 0
    for s in skin.sensors:
        print(_line(s, material, places=args.list or changes, parameters=args.list))
    print(f"{target}: {steps.counted(len(skin.sensors), 'sensor')}")
    return 0


def _beyond_the_boards(sensors: tuple[Sensor, ...]) -> list[str]:
    from skinfab.placement.share import CHANNELS
    from skinfab.wiring import board_of

    far = [s for s in sensors if s.channel >= CHANNELS]
    if not far or len(sensors) > CHANNELS:  # too many sensors are told of where they are placed
        return []
    named = ", ".join(f"{s.id} on channel {s.channel} (board {board_of(s.channel)[0]})" for s in far)
    return [f"{named}: two boards read channels 0 to {CHANNELS - 1}; give each a lower one, or wire more boards"]


def _say_patterns(*, as_json: bool) -> int:
    from skinfab.drawings import catalogue

    print(json.dumps(catalogue.as_json()) if as_json else catalogue.as_text(), end="\n" if as_json else "")
    return 0


def _changed(skin: Skin, material: Material, args: argparse.Namespace) -> tuple[tuple[Sensor, ...], list[str]]:
    """The sensors after all changes, checked."""
    from skinfab.placement.check import validate
    from skinfab.placement.requested import place_from_file

    sensors = skin.sensors
    for what, id, values in args.edits:
        sensors = _edited(sensors, what, id, values)
    warnings: list[str] = []
    if args.add is not None:
        # First of all, so that a fault of a change is not told as one of the file.
        validate(replace(skin, sensors=sensors), material)
        sensors, warnings = place_from_file(args.add, skin.mesh, skin.pieces, material=material, seed=skin.seed, present=sensors)
    validate(replace(skin, sensors=sensors), material)
    return sensors, warnings


def _edited(sensors: tuple[Sensor, ...], what: str, id: str, values: Any) -> tuple[Sensor, ...]:
    import math

    from skinfab.errors import InputError
    from skinfab.placement import edit

    if what == "move":
        return edit.move(sensors, id, x=values[0], y=values[1])
    if what == "move_to":
        return edit.move(sensors, id, piece=values[0], x=values[1], y=values[2])
    if what == "shift":
        return edit.shift(sensors, id, dx=values[0], dy=values[1])
    if what == "rotate":
        return edit.rotate(sensors, id, angle=math.radians(values[0]))
    if what == "remove":
        return edit.remove(sensors, id)
    params = {name: value for name, value in values.items() if name != "channel"}
    if "channel" in values:
        if not isinstance(values["channel"], int):
            raise InputError(f"{id}: channel is {values['channel']!r}; it must be a whole number, 0 or more")
        sensors = edit.rewire(sensors, id, channel=values["channel"])
    return edit.resize(sensors, id, params) if params else sensors


def _facts(sensor: Sensor) -> dict[str, Any]:
    import math

    from skinfab.patterns.registry import parameters

    pose = {"x": sensor.x, "y": sensor.y, "angle_deg": math.degrees(sensor.angle) % 360}
    return {
        "id": sensor.id,
        "kind": sensor.pattern.kind,
        "piece": sensor.piece,
        "channel": sensor.channel,
        "params": parameters(sensor.pattern),
        "pose": pose,
    }


def _line(sensor: Sensor, material: Material, *, places: bool, parameters: bool) -> str:
    """One sensor for a person to read, its parameters as a sensors file takes them."""
    import math

    from skinfab.electrical import resistance
    from skinfab.patterns import registry

    values = registry.parameters(sensor.pattern).items() if parameters else ()
    params = ", ".join(f"{name} = {str(v).lower() if isinstance(v, bool) else f'{v:g}'}" for name, v in values)
    r = resistance(sensor.path.length, material.ink)
    at = f" at ({sensor.x:.2f}, {sensor.y:.2f}) turned {math.degrees(sensor.angle) % 360:.1f} deg" if places else ""
    return (
        f"{sensor.id}: {sensor.pattern.kind} on {sensor.piece}{at}, channel {sensor.channel}, {sensor.path.length:.1f} mm, "
        f"{r.median:.0f} kohm ({r.low:.0f} to {r.high:.0f})" + (f"; params = {{ {params} }}" if params else "")
    )
