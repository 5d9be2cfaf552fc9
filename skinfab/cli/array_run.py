"""`skinfab array run LOG|--port PORT -o DIR`: what an array feels, in a log or as it comes."""

from __future__ import annotations

import argparse
import csv
import io
import json
import math
from collections import Counter
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.cli.lag import Lag
from skinfab.cli.record import baud

if TYPE_CHECKING:
    from skinfab.fingertip.array.analyser import Reading
    from skinfab.fingertip.array.matched import ArrayModel
    from skinfab.fingertip.array.tracking import Event
    from skinfab.fingertip.array.watch import ArrayWatch

FILES = ("array.png", "events.csv", "frames.csv", "result.json")
_HEAD = [
    "time_s",
    "state",
    "axial_mm",
    "angle_deg",
    "force_n",
    "line_deg",
    "line_sd_deg",
    "line_sure",
    "radius_mm",
    "tilt_along_deg",
    "tilt_around_deg",
    "points",
    "peak_axial_mm",
    "peak_angle_deg",
    "peak_state",
    "saturated",
    "simulated",
]


def add_options(p: argparse.ArgumentParser) -> None:
    """What is read, with which model, and where the results go."""
    p.add_argument("log", metavar="LOG", type=Path, nargs="?", help="begins untouched for a second; channels r0s0, r0s1, ... (V)")
    p.add_argument("--port", metavar="PORT", help="such as /dev/ttyACM0, until Ctrl-C, instead of a log; untouched for the first second")
    p.add_argument("--model", metavar="MODEL.npz", type=Path, help="from skinfab array train (default: the seed's array as drawn)")
    p.add_argument("--seconds", metavar="S", type=steps.positive, help="of a port: end after so long (default: at Ctrl-C)")
    p.add_argument("--baud", metavar="N", type=baud, help="of a port (default: 921600)")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for frames, events, result and figure")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Read, write, and say what was felt."""
    from skinfab.files import require_apart

    if (args.log is None) == (args.port is None):
        args.wrong_usage("give a LOG or --port PORT, one of them")
    for name in ("seconds", "baud"):
        if getattr(args, name) is not None and args.port is None:
            args.wrong_usage(f"--{name} is for a port")
    require_apart(args.output, FILES, [path for path in (args.log, args.model) if path is not None])
    with ExitStack() as until_written:
        readings, watch, facts = _from_port(args, until_written) if args.port else _from_log(args)
        result = _facts(readings, watch, facts)
        _write(args.output, readings, watch.model, result)
        return _say(args, result)


def _say(args: argparse.Namespace, result: dict[str, Any]) -> int:
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    steps.say(result["notes"])
    for line in _lines(result):
        print(line)
    print(f"{args.output}: {', '.join(FILES)}")
    return 0


def _model(args: argparse.Namespace, shape: tuple[int, int]) -> tuple[ArrayModel, list[str]]:
    """The model given, or the array of this shape as drawn."""
    from skinfab.fingertip.array.geometry import Geometry
    from skinfab.fingertip.array.learn import load_array
    from skinfab.fingertip.array.matched import ArrayModel

    if args.model is not None:
        return load_array(args.model)[0], []
    geometry = Geometry.of_density(f"{shape[0]}x{shape[1]}")
    return ArrayModel.nominal(geometry), [
        "no --model: the array is taken as drawn, with the modulus of the simulator, so forces mean little"
    ]


def _from_log(args: argparse.Namespace) -> tuple[tuple[Reading, ...], ArrayWatch, dict[str, Any]]:
    from skinfab.fingertip.array.geometry import tactel_columns
    from skinfab.fingertip.array.watch import read_all
    from skinfab.readout.checks import check_times
    from skinfab.readout.logs.log import read_log

    log = read_log(args.log)
    model, notes = _model(args, tactel_columns(log.recording.stream)[0])
    readings, watch = read_all(log.recording, model)
    notes += [*log.notes, *(f"{log.file}: {wrong}" for wrong in check_times(log.recording))]
    return readings, watch, {"source": log.file, "sha256": log.sha256, "notes": notes, "latency_ms": None}


def _from_port(args: argparse.Namespace, until_written: ExitStack) -> tuple[tuple[Reading, ...], ArrayWatch, dict[str, Any]]:
    """What came until Ctrl-C, which once the port is open is held off in `until_written`."""
    from dataclasses import replace

    from skinfab.cli.ending import ended_by_signals
    from skinfab.cli.listening import Listening
    from skinfab.fingertip.array.geometry import tactel_columns
    from skinfab.fingertip.array.watch import ArrayWatch, warm_up
    from skinfab.readout.serial_port import BAUD, SerialPort
    from skinfab.readout.source import HostClock

    readings: list[Reading] = []
    lag = Lag()
    warm_up()
    with SerialPort(args.port, baud=args.baud or BAUD) as source:
        stop = until_written.enter_context(ended_by_signals())
        model, notes = _model(args, tactel_columns(source.stream)[0])
        watch = ArrayWatch(source.stream, model)
        listening, clock = Listening(source, stop, seconds=args.seconds, quiet=args.json), HostClock()
        asked = clock.now()
        for frame in listening.frames():
            if (made := watch.step(frame)) is not None:
                lag.add(asked, frame.host_time, clock.now())
                readings.append(made)
                _tell(args, made.events)
            asked = clock.now()
        counts = source.counts
        if not readings:
            raise listening.too_little(f"sent {counts.frames} frames, and the first second of them is rest", "let it send for longer")
        notes += listening.notes
    last = watch.finish()
    _tell(args, last)
    readings[-1] = replace(readings[-1], events=(*readings[-1].events, *last))
    notes += [
        f"{count} frames were {how}" for how, count in (("lost", counts.lost), ("damaged", counts.bad), ("late", counts.late)) if count
    ]
    times = lag.times_ms()
    if (rate := watch.stream.rate_hz) and lag.live and times["median"] > 1000 / rate:
        notes.append(
            f"readings lag {times['median']:.0f} ms behind their frames, of which {rate:g} come in a second: this computer is too busy"
        )
    return tuple(readings), watch, {"source": args.port, "sha256": None, "notes": notes, "latency_ms": times}


def _tell(args: argparse.Namespace, events: Sequence[Event]) -> None:
    if not args.json:
        for event in events:
            print(_words(event), flush=True)


def _words(event: Event) -> str:
    """
    Examples
    --------
    >>> from skinfab.fingertip.array.tracking import Event
    >>> _words(Event("slip", 1.0, 1.2, 7.0, -0.5))
    '    1.00 s  slip to 1.20 s: +7.0 mm along, -0.5 mm around'
    """
    moved = f" to {event.end:.2f} s: {event.along_mm:+.1f} mm along, {event.around_mm:+.1f} mm around"
    which = f" of contact {event.number}" if event.number > 1 else ""
    return f"{event.start:8.2f} s  {event.kind}{which}{moved if event.kind in ('slip', 'roll') else ''}"


def _facts(readings: Sequence[Reading], watch: ArrayWatch, facts: dict[str, Any]) -> dict[str, Any]:
    from dataclasses import asdict

    events = [event for reading in readings for event in reading.events]
    states = Counter(reading.state for reading in readings)
    notes = [*facts["notes"], *watch.notes]
    for state, words in (
        ("past", "lie farther beyond the first or last ring than can be told"),
        ("wide", "are explained by no point, line or round patch and no few points: a wide contact"),
        ("pulled", "read less than at rest: the array was touched in the first second, or its voltage falls when it is pressed"),
    ):
        if states[state]:
            notes.append(
                f"{states[state]} of {len(readings)} frames {words}; their places are not to be trusted, and nothing slips or rolls there"
            )
    if full := sum(reading.saturated > 0 for reading in readings):
        notes.append(f"in {full} frames tactels are at the end of their range; they were left out")
    return {
        **{key: facts[key] for key in ("source", "sha256", "latency_ms")},
        "simulated": watch.stream.simulated,
        "frames": len(readings),
        "noise": watch.noise,
        "states": dict(states),
        "events": [asdict(event) for event in events],
        "largest_force_n": max((reading.place.force_n for reading in readings if reading.contacts), default=0.0),
        "notes": notes,
    }


def _write(target: Path, readings: Sequence[Reading], model: ArrayModel, result: dict[str, Any]) -> None:
    from skinfab.cli.array_simulate import events_csv
    from skinfab.files import atomic_write
    from skinfab.fingertip.array.figure import draw_run
    from skinfab.staging import staged_folder

    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(_HEAD)
    rows.writerows(_row(reading, result["simulated"]) for reading in readings)
    events = [event for reading in readings for event in reading.events]
    with staged_folder(target) as folder:
        atomic_write(folder / "frames.csv", text.getvalue())
        atomic_write(folder / "events.csv", events_csv(events, simulated=result["simulated"]))
        atomic_write(folder / "result.json", json.dumps(result, indent=1, allow_nan=False) + "\n")
        draw_run(readings, model, folder / "array.png", title=result["source"], simulated=result["simulated"])


def _row(reading: Reading, simulated: bool) -> list[str]:
    def number(value: float) -> str:
        return f"{value:.4f}" if math.isfinite(value) else ""

    line, points = reading.line, reading.contacts
    place, peak = reading.place, reading.peak
    direction = ["", "", ""]
    if line is not None:
        sure = str(int(line.orientation.sure))
        direction = [number(math.degrees(line.line_rad)), number(math.degrees(line.line_sd_rad)), sure]
    turned = ["", "", ""]
    if (spot := reading.spot) is not None:
        # A disc that was fitted without any pull along the skin says nothing of it.
        tilt = spot.tilt_rad if spot.along_n or spot.around_n else (math.nan, math.nan)
        turned = [number(spot.radius_mm), *(number(math.degrees(angle)) for angle in tilt)]
    return [
        f"{reading.time:.6f}",
        reading.state,
        *(number(value) for value in (place.axial_mm, math.degrees(place.angle_rad), place.force_n)),
        *direction,
        *turned,
        " ".join(f"{each.axial_mm:.3f}/{math.degrees(each.angle_rad):.2f}/{each.force_n:.3f}" for each in points),
        number(peak.axial_mm),
        number(math.degrees(peak.angle_rad)),
        peak.state,
        str(reading.saturated),
        str(int(simulated)),
    ]


def _lines(result: dict[str, Any]) -> list[str]:
    made = " (simulated)" if result["simulated"] else ""
    states = ", ".join(f"{count} {state}" for state, count in sorted(result["states"].items()))
    counts = Counter(event["kind"] for event in result["events"])
    events = ", ".join(f"{count} {kind}" for kind, count in counts.items()) or "none"
    lines = [f"{result['source']}{made}: {result['frames']} frames ({states}); events: {events}"]
    if result["latency_ms"]:
        lines.append(f"from frame to reading {result['latency_ms']['median']:.2f} ms, worst {result['latency_ms']['worst']:.2f}")
    return lines
