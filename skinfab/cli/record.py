"""`skinfab record PORT|simulator -o FILE`: frames from a port into a file, until Ctrl-C."""

from __future__ import annotations

import argparse
import json
import sys
import time
from contextlib import ExitStack, contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.cli.ending import ended_by_signals
from skinfab.cli.listening import outage_notes, outages

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from skinfab.readout.paced import PacedFrames
    from skinfab.readout.record import State
    from skinfab.readout.serial_port import SerialPort
    from skinfab.wired import AtRest
    from skinfab.wiring import Wire

SIMULATOR = "simulator"
#: A larger recording is not read again at its end to be checked.
_CHECKED_BYTES = 200_000_000


def baud(text: str) -> int:
    """A whole number from 1 up, for argparse."""
    if not (text.isascii() and text.isdecimal() and int(text) > 0):
        raise argparse.ArgumentTypeError(f"{text!r} is no baud rate; give one such as 921600")
    return int(text)


def channels(text: str) -> int:
    """A whole number from 1 to 256, for argparse."""
    if not (text.isascii() and text.isdecimal() and 1 <= int(text) <= 256):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of channels from 1 to 256")
    return int(text)


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "record",
        help="record the frames of a port",
        description="Record what a device sends until Ctrl-C, or for a while. Each frame is in the file at once: whatever happens, at most "
        "the last one is lost. A port that is unplugged is waited for. What a device has to send: docs/readout.md.",
    )
    p.add_argument("port", metavar="PORT|simulator", help="such as /dev/ttyACM0, or simulator: strain channels of a joint that bends")
    p.add_argument("-o", "--output", metavar="FILE", type=Path, required=True, help=".frames (exact, with checksums) or .csv; a new file")
    p.add_argument("--seconds", metavar="S", type=steps.positive, help="end after so long (default: at Ctrl-C)")
    p.add_argument("--baud", metavar="N", type=baud, help="of the port (default: 921600; a board with USB of its own does not care)")
    p.add_argument("--channels", metavar="N", type=channels, help="of the simulator (default: 32)")
    p.add_argument("--rate", metavar="HZ", type=steps.positive, help="of the simulator (default: 100)")
    p.add_argument("--wiring", metavar="FILE", type=Path, help="wiring.csv of the skin, or its .skin: channels get their sensors' names")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run, wrong_usage=p.error)


def run(args: argparse.Namespace) -> int:
    """Record, and say what came and what did not."""
    simulated = args.port == SIMULATOR
    if simulated and args.baud:
        args.wrong_usage("--baud is of a port; leave it out for the simulator")
    if not simulated and (args.channels or args.rate):
        args.wrong_usage("--channels and --rate are of the simulator; a port says itself what it sends")
    from skinfab.readout.record import Recorder, record, require_new
    from skinfab.readout.serial_port import SerialPort

    require_new(args.output)
    wires = _wires(args.wiring)
    wiring_notes: list[str] = []
    with _source(args) as source, ExitStack() as opened:
        stream = source.stream
        if wires:
            from skinfab.wired import wired

            stream, wiring_notes = wired(stream, wires)
            if not args.json:
                steps.say(wiring_notes)
        recorder = opened.enter_context(Recorder(args.output, stream))
        began = time.time()
        with _shown(quiet=args.json, source=source) as show, ended_by_signals() as stop:
            record(source, recorder, seconds=args.seconds, told=show, stop=stop)
        counts, gone = asdict(source.counts), outages(source, began, time.time())
        fault, doubt = (source.fault, source.doubt) if isinstance(source, SerialPort) else ("", "")
    notes, rest = _notes(counts, args.output, recorder.bytes if recorder.frames else 0, wires)
    if counts["bad"] and fault:
        notes.append(f"the last that was none: {fault}")
    if doubt:
        notes.append(doubt)
    result: dict[str, Any] = {
        "file": str(args.output),
        "stream": source.stream.name,
        "simulated": source.stream.simulated,
        "channels": list(stream.names),
        "frames": recorder.frames,
        "bytes": recorder.bytes,
        "counts": counts,
        "outages": gone,
        "notes": [*outage_notes(args.port, gone), *notes],
    }
    # What would go on with the recording (record && calibrate) must not where there is none.
    status = 0 if recorder.frames else 1
    if wires:
        from skinfab.wired import rest_facts, rest_lines

        result |= {"at_rest": rest_facts(rest), "wiring_notes": wiring_notes}
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return status
    steps.say(result["notes"])
    if recorder.frames:
        print(_sentence(result))
    for line in rest_lines(rest) if wires else []:
        print(line)
    return status


def _wires(path: Path | None) -> tuple[Wire, ...]:
    if path is None:
        return ()
    from skinfab.wired import load_wiring

    return load_wiring(path)


def _source(args: argparse.Namespace) -> SerialPort | PacedFrames:
    if args.port == SIMULATOR:
        from skinfab.readout.strain_simulator import CHANNELS, RATE_HZ, simulated_strain

        return simulated_strain(channels=args.channels or CHANNELS, rate_hz=args.rate or RATE_HZ)
    from skinfab.readout.serial_port import BAUD, SerialPort

    return SerialPort(args.port, baud=args.baud or BAUD)


@contextmanager
def _shown(*, quiet: bool, source: SerialPort | PacedFrames) -> Iterator[Callable[[State], None]]:
    """A line on standard error that is written anew every second, where that is a terminal."""
    if quiet or not sys.stderr.isatty():
        yield lambda state: None
        return

    def show(state: State) -> None:
        now = source.counts
        gone = "PORT GONE  " if any(not each["back"] for each in outages(source, time.time(), time.time())) else ""
        print(
            f"\r\x1b[K{_clock(state.seconds)}  {gone}{state.frames:,} frames  {state.rate_hz:.1f} Hz  "
            f"{state.bytes / 1e6:.1f} MB  lost {now.lost}  bad {now.bad}  late {now.late}  "
            f"disk {state.free_bytes / 1e9:.1f} GB left, {_clock(state.room_s)}  (Ctrl-C ends)",
            end="",
            file=sys.stderr,
            flush=True,
        )

    try:
        yield show
    finally:
        print("\r\x1b[K", end="", file=sys.stderr, flush=True)


def _clock(seconds: float) -> str:
    """Seconds as people read them.

    Examples
    --------
    >>> _clock(75), _clock(7262), _clock(350_000), _clock(float("inf"))
    ('1:15', '2:01:02', '4 days', 'for ever')
    """
    if seconds > 2 * 86_400:
        return f"{seconds / 86_400:.0f} days" if seconds < 36_500 * 86_400 else "for ever"
    minutes, rest = divmod(int(seconds), 60)
    return f"{minutes // 60}:{minutes % 60:02}:{rest:02}" if minutes >= 60 else f"{minutes}:{rest:02}"


def _notes(counts: dict[str, int], path: Path, size: int, wires: tuple[Wire, ...]) -> tuple[list[str], tuple[AtRest, ...]]:
    """What is to be known of the recording, a sentence each; its resistances at rest where it is known whose they are."""
    from skinfab.readout.checks import check
    from skinfab.readout.logs.log import read_log

    told = {
        "bad": "pieces were no frame: noise on the line, or another program's output",
        "late": "frames came late or a second time, and were dropped",
        "unchecked": "frames came without a checksum; a wrong digit in them does not show",
        "reopened": "times the port was gone and came back, or the device began anew",
    }
    notes = [f"{counts[name]:,} {words}" for name, words in told.items() if counts[name]]
    rest: tuple[AtRest, ...] = ()
    if not size:
        notes.append("no frame came; no file was left")
    elif size <= _CHECKED_BYTES:
        recording = read_log(path).recording
        notes += check(recording)
        if wires:
            from skinfab.wired import rests, unit_notes

            rest = rests(recording, wires)
            notes += unit_notes(recording.stream, wires)
            notes += [each.verdict for each in rest if each.verdict]
    return notes, rest


def _sentence(result: dict[str, Any]) -> str:
    lost, frames = result["counts"]["lost"], result["frames"]
    made = " of simulated data" if result["simulated"] else ""
    share = f" ({lost / (lost + frames):.2%})" if lost else ""
    size = f"{len(result['channels'])} channels, {result['bytes'] / 1e6:.2f} MB"
    return f"{result['file']}: {frames:,} frames{made}, {size}, lost {lost:,}{share}"
