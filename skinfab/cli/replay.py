"""`skinfab replay LOG [--calibration FILE] [-o DIR]`: a log through the same code as live data."""

from __future__ import annotations

import argparse
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.progress import Progress, terminal_progress

if TYPE_CHECKING:
    from calibration.strain.document import SensorCalibration
    from skinfab.readout.logs.log import Log
    from skinfab.readout.replay import Replay
    from skinfab.wiring import Wire

#: What a run with -o leaves.
FILES = ("replay.csv", "replay.png", "result.json")


def pace(text: str) -> float | None:
    """``max`` or how many times as fast as it was recorded."""
    return None if text == "max" else steps.positive(text)


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "replay",
        help="a recorded log through the same code as live data",
        description="Replay a log frame by frame through the code that live data goes through: checks, causal filter, bridge and "
        "calibration. Reads CSV, MCAP, ROS 1 and 2 bags, and recordings of skinfab record.",
    )
    p.add_argument("log", metavar="LOG", type=Path, help="the log, known by its content; a ROS 2 bag is a folder")
    p.add_argument("--calibration", metavar="FILE", type=Path, help="calibration.json of skinfab calibrate: angles are given out")
    p.add_argument("--signal", metavar="COLUMN", help="channel to read the angle from (default: the calibration's)")
    p.add_argument("--bridge", metavar=("SUPPLY_V", "SERIES_KOHM"), type=steps.positive, nargs=2, help="voltages also as resistances")
    p.add_argument("--wiring", metavar="FILE", type=Path, help="wiring.csv of the skin, or its .skin: channels get their sensors' names")
    p.add_argument("--speed", metavar="X|max", type=pace, default=argparse.SUPPRESS, help="1: as recorded (default: max; 1 with --serve)")
    p.add_argument(
        "--serve", action="store_true", help="send the log over a pseudo-terminal, as a board would, until it is read to its end"
    )
    p.add_argument("-o", "--output", metavar="DIR", type=Path, help="folder for replay.csv, result.json and replay.png")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run, wrong_usage=p.error)


def run(args: argparse.Namespace) -> int:
    """Replay, write, and say what was in it."""
    if args.serve and (args.output or args.calibration or args.bridge or args.json):
        args.wrong_usage("--serve sends the log and nothing else; leave out -o, --calibration, --bridge and --json")
    if args.signal and not args.calibration:
        args.wrong_usage("--signal says what the calibration is to read; give --calibration too")
    from skinfab.files import require_apart
    from skinfab.readout.checks import check
    from skinfab.readout.logs.log import read_log
    from skinfab.readout.replay import Replay

    if args.output:
        require_apart(args.output, FILES, [path for path in (args.log, args.calibration) if path])
    calibration = _calibration(args.calibration)
    log = read_log(args.log)
    wires: tuple[Wire, ...] = ()
    notes = list(log.notes)
    if args.wiring:
        from skinfab.wired import load_wiring, wired

        wires = load_wiring(args.wiring)
        stream, more = wired(log.recording.stream, wires)
        log, notes = replace(log, recording=replace(log.recording, stream=stream)), [*notes, *more]
    source = Replay(log.recording, speed=getattr(args, "speed", 1.0 if args.serve else None))
    found = check(log.recording)
    if args.serve:
        steps.say([*notes, *found])
        return _serve(source, len(log.recording))
    with terminal_progress(quiet=args.json) as progress:
        columns, facts = _through(args, source, log, calibration, progress)
    result = {
        "log": {"file": log.file, "kind": log.kind, "sha256": log.sha256, "simulated": log.recording.stream.simulated},
        "stream": log.recording.stream.name,
        "frames": source.counts.frames,
        "lost": source.counts.lost,
        "duration_s": _span(columns["time_s"]),
        "checks": found,
        "notes": notes,
        **facts,
    }
    table: list[str] = []
    if wires:
        from skinfab.wired import rest_facts, rest_lines, rests, unit_notes

        rest = rests(log.recording, wires, known={name: math.nan if r is None else r for name, r in facts.get("r0_kohm", {}).items()})
        notes += [] if args.bridge else unit_notes(log.recording.stream, wires)
        notes += [each.verdict for each in rest if each.verdict]
        result["at_rest"], table = rest_facts(rest), rest_lines(rest)
    if args.output:
        _write(args.output, columns, result, log, calibration)
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    steps.say([*notes, *found])
    for line in [*_lines(result), *table]:
        print(line)
    if args.output:
        print(f"{args.output}: {', '.join(FILES)}")
    return 0


def _calibration(path: Path | None) -> SensorCalibration | None:
    if path is None:
        return None
    from calibration.strain.document import load_calibration

    return load_calibration(path)


def _serve(source: Replay, frames: int) -> int:
    import time

    from skinfab.readout.packets import FRAME_64
    from skinfab.readout.pty_server import PtyServer

    # The replay keeps the pace itself; the server sends what it is given as it is read, and loses none.
    with source, PtyServer(source.stream, source, rate_hz=0, kind=FRAME_64) as server:
        print(server.path, flush=True)
        steps.say([f"{len(source.stream.channels)} channels on {server.path}; it begins when the port is opened"])
        # Python 3.11 takes a thread for ended if an interrupt comes while one waits for it: wait beside it.
        while not server.wait(0):
            time.sleep(0.1)
    if server.left:
        steps.say(
            [f"the reader closed the port before the log's end, and did not come back: {server.sent:,} of {frames:,} frames were sent"]
        )
    else:
        print(f"{server.sent} frames sent")
    return 0


def _span(time: list[float]) -> float:
    whole = [each for each in time if math.isfinite(each)]
    return whole[-1] - whole[0] if whole else 0.0


def _through(
    args: argparse.Namespace, source: Replay, log: Log, calibration: SensorCalibration | None, progress: Progress
) -> tuple[dict[str, list[float]], dict[str, Any]]:
    """The columns of the table, frame by frame, and what is to be said of them."""
    from calibration.strain.live import Live

    live = Live(source.stream, log.recording, calibration, channel=args.signal, bridge=tuple(args.bridge) if args.bridge else None)
    columns: dict[str, list[float]] = {name: [] for name in live.names}
    total = max(len(log.recording), 1)
    with source:
        for k, frame in enumerate(source):
            for name, value in zip(live.names, live.step(frame), strict=True):
                columns[name].append(value)
            if k % 200 == 0:
                progress(k / total, "replaying")
    progress(1.0, "replaying")
    return columns, live.facts(columns)


def _write(output: Path, columns: dict[str, list[float]], result: dict[str, Any], log: Log, calibration: SensorCalibration | None) -> None:
    import csv
    import io

    from calibration.strain.live import drawn
    from calibration.strain.time_figure import draw_over_time
    from skinfab.files import atomic_write
    from skinfab.staging import staged_folder

    text = io.StringIO()
    simulated = log.recording.stream.simulated
    if simulated:
        text.write("# simulated: true\n")
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(columns)
    for row in zip(*columns.values(), strict=True):
        rows.writerow(["" if math.isnan(value) else f"{value:.12g}" for value in row])
    time, panels = drawn(columns, log.recording, calibration)
    with staged_folder(output) as folder:
        atomic_write(folder / "replay.csv", text.getvalue())
        draw_over_time(time, panels, folder / "replay.png", title=log.file, simulated=simulated)
        atomic_write(folder / "result.json", json.dumps(result, indent=1, allow_nan=False) + "\n")


def _lines(result: dict[str, Any]) -> list[str]:
    simulated = ", simulated" if result["log"]["simulated"] else ""
    lines = [
        f"{result['log']['file']} ({result['log']['kind']}{simulated}): {result['frames']:,} frames in {result['duration_s']:.1f} s, "
        f"{result['lost']:,} missing"
    ]
    if (angle := result.get("angle")) and angle["min_deg"] is not None:
        lines.append(
            f"angle {angle['min_deg']:.1f} to {angle['max_deg']:.1f} degrees, {100 * angle['outside']:.1f} % outside the calibration, "
            f"{100 * angle['without']:.1f} % without an angle; the filter is {1000 * angle['filter_delay_s']:.0f} ms late"
        )
        if angle["rms_in_step_deg"] is not None:
            lines.append(
                f"against {angle['truth']}: {angle['rms_deg']:.2f} degrees rms as it comes, {angle['rms_in_step_deg']:.2f} with the "
                "filter's delay taken off"
            )
    return lines
