"""`skinfab control --port`: the loop in real time, on frames from a board."""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.errors import InputError

if TYPE_CHECKING:
    from calibration.control.controller import Command, Input
    from calibration.control.loop import Loop
    from calibration.control.margin import Margin

#: So many stops are told one by one.
_TOLD = 5
#: For so long a command may wait until the hand's port takes it, s: no longer than the joint goes on without a good frame.
WRITE_S = 0.05


def run_port(args: argparse.Namespace, human: Input, robot: Input) -> int:
    """Measure how often the board sends, judge the gain, control for `args.seconds`, write what happened, and say how it went."""
    from calibration.control.controller import JointController
    from calibration.control.loop import run_loop
    from calibration.control.rate import measured_rate
    from skinfab.cli.control import judge, outside_words
    from skinfab.cli.listening import outage_notes, outages
    from skinfab.readout.priority import real_time
    from skinfab.readout.serial_port import SerialPort

    # Before the port is opened, whose reader is a thread of its own.
    with real_time() as granted, SerialPort(args.port) as port:
        stream = port.stream
        human, robot = (type(each)(each.calibration, stream.index(each.calibration.signal)) for each in (human, robot))
        rate = measured_rate(port)
        told = _rate_told(stream.rate_hz, rate)
        if not args.json:
            steps.say(told)
        margin = judge(args, robot, period_s=1 / rate)
        options: dict[str, Any] = {"law": args.controller, "gain": margin.gain, "lag_s": args.lag, "delay_s": args.delay}
        began = time.time()
        with _commands(args.commands) as send:
            loop = run_loop(port, JointController(human, robot, **options, period_s=1 / rate), send, seconds=args.seconds)
        counts, gone = port.counts, outages(port, began, time.time())
    result = facts(args, loop, margin, simulated=stream.simulated)
    seen = _idle_notes(loop)
    result |= {"rate_hz": rate, "real_time": granted, "outages": gone, "notes": [*told, *seen], "fault": loop.fault}
    result["counts"] = {"lost": counts.lost, "bad": counts.bad, "late": counts.late, "reopened": counts.reopened}
    _write(args, loop, result)
    if loop.fault:
        steps.say(outage_notes(args.port, gone) + seen)
        raise InputError(f"{loop.fault} (what went on until then is in {args.output})")
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    steps.say(outage_notes(args.port, gone))
    steps.say(seen)
    taken = result["latency_ms"]
    print(
        f"{result['commands']} commands in {args.seconds:g} s to {rate:.4g} frames a second: from frame to "
        f"command {taken['median']:.2f} ms, worst {taken['worst']:.2f}; "
        f"held or stopped {100 * result['held_or_stopped']:.0f} % of them, out of range {100 * result['outside']:.0f} %"
        f"{outside_words(result)}; {counts.lost} frames lost, {counts.bad} bad; "
        f"{'with' if granted else 'without'} real-time priority"
        if taken
        else f"no frame came from {args.port} in {args.seconds:g} s"
    )
    print(f"{args.output}: control.csv, control.json, control.png")
    return 0


def _rate_told(said_hz: float, rate_hz: float) -> list[str]:
    """Where a stream's own word is not what was measured.

    Examples
    --------
    >>> _rate_told(100.0, 50.2), _rate_told(100.0, 99.1), _rate_told(0.0, 50.2)
    (['the board sends 50.2 frames a second, and says 100; what was measured is used'], [], [])
    """
    from calibration.control.rate import RATE_PART

    if not said_hz or abs(rate_hz - said_hz) <= RATE_PART * said_hz:
        return []
    return [f"the board sends {rate_hz:.3g} frames a second, and says {said_hz:g}; what was measured is used"]


def _idle_notes(loop: Loop) -> list[str]:
    """When the joint was not driven by what was read, and why: each stop, and how often a command was held."""
    spans: list[tuple[int, int]] = []
    for k, command in enumerate(loop.commands):
        if command.state in ("hold", "stop"):
            spans = [*spans[:-1], (spans[-1][0], k)] if spans and spans[-1][1] == k - 1 else [*spans, (k, k)]
    stops = [(first, last) for first, last in spans if loop.commands[last].state == "stop"]
    notes = [
        f"from {loop.time[first]:.2f} s to {f'{loop.time[last + 1]:.2f} s' if last + 1 < len(loop.commands) else 'the end'} the last "
        f"command was held and the joint then stopped: {_why(loop.commands[first : last + 1])}"
        for first, last in stops[:_TOLD]
    ]
    if len(stops) > _TOLD:
        notes.append(f"the joint was stopped {len(stops) - _TOLD} times more; control.csv says why")
    shut = [k for k, command in enumerate(loop.commands) if command.state == "block"]
    if shut:
        notes.append(
            f"from {loop.time[shut[0]]:.2f} s to {loop.time[shut[-1]]:.2f} s the joint was not driven on in {len(shut)} of "
            f"{shut[-1] - shut[0] + 1} commands: {loop.commands[shut[0]].reason}"
        )
    if held := [first for first, last in spans if loop.commands[last].state == "hold"]:
        first = held[0]
        times = "once" if len(held) == 1 else f"{len(held)} times, first"
        notes.append(f"the last command was held {times} at {loop.time[first]:.2f} s: {loop.commands[first].reason}")
    return notes


def _why(commands: Sequence[Command]) -> str:
    """The last reason; that a frame was missing meanwhile is none where there is another."""
    reasons = [command.reason for command in commands]
    return next((reason for reason in reversed(reasons) if not reason.startswith("no frame")), reasons[-1])


@contextmanager
def _commands(port: str | None) -> Iterator[Callable[[float], None]]:
    """Where commands go: a line of text each, deg/s."""
    if port is None:
        yield lambda speed: None
        return
    import serial

    try:
        device = serial.Serial(port, write_timeout=WRITE_S)
    except (OSError, ValueError) as fault:
        raise InputError(f"{port}: {fault}; give the port of the robot's hand") from fault

    def send(speed: float) -> None:
        try:
            device.write(f"{speed:.3f}\n".encode())
        except serial.SerialTimeoutException as fault:
            raise InputError(f"{port}: the hand read no command for {WRITE_S:g} s; is it on, and does its program run?") from fault
        except OSError as fault:
            raise InputError(f"{port} takes no commands any more ({fault}); is it still plugged in?") from fault

    with device:
        yield send


def facts(args: argparse.Namespace, loop: Loop, margin: Margin, *, simulated: bool) -> dict[str, Any]:
    """The result, ready for JSON."""
    import numpy as np

    from calibration.control.laws import Beyond
    from skinfab.cli.control import margin_facts

    def share(of: list[bool]) -> float:
        return float(np.mean(of)) if of else 0.0

    taken = 1e3 * loop.latency_s[np.isfinite(loop.latency_s)]
    jitter = 1e3 * np.abs(loop.jitter_s)
    return {
        "controller": args.controller,
        "simulated": simulated,
        "margin": margin_facts(margin),
        "commands": len(loop.commands),
        "passed_over": loop.passed_over,
        "held_or_stopped": share([command.state != "run" for command in loop.commands]),
        "outside": share([command.outside for command in loop.commands]),
        "outside_of": {name: share([getattr(command.beyond, name) for command in loop.commands]) for name in Beyond._fields},
        "latency_ms": {"median": float(np.median(taken)), "p99": float(np.quantile(taken, 0.99)), "worst": float(taken.max())}
        if len(taken)
        else None,
        "jitter_ms": {"p99": float(np.quantile(jitter, 0.99)), "worst": float(jitter.max())} if len(jitter) else None,
    }


def _write(args: argparse.Namespace, loop: Loop, result: dict[str, Any]) -> None:
    import csv
    import io
    import math

    from calibration.control.loop_figure import draw_loop
    from skinfab.files import atomic_write
    from skinfab.staging import staged_folder

    text = io.StringIO()
    if result["simulated"]:
        text.write("# simulated: true\n")
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(
        ["time_s", "sequence", "target_deg", "estimate_deg", "command_deg_s", "state", "reason", "outside", "clamped", "latency_ms"]
    )
    for t, k, late, c in zip(loop.time.tolist(), loop.sequence.tolist(), loop.latency_s.tolist(), loop.commands, strict=True):
        numbers = ["" if math.isnan(value) else f"{value:.6g}" for value in (c.target, c.angle, c.speed)]
        taken = "" if math.isnan(late) else f"{1e3 * late:.4g}"
        rows.writerow([f"{t:.4f}", k, *numbers, c.state, c.reason, int(c.outside), int(c.clamped), taken])
    title = f"controller {args.controller}" + (" (simulated)" if result["simulated"] else "")
    with staged_folder(args.output) as folder:
        atomic_write(folder / "control.csv", text.getvalue())
        atomic_write(folder / "control.json", json.dumps(result, indent=1, allow_nan=False) + "\n")
        draw_loop(loop, folder / "control.png", title=title)
