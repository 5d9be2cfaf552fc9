"""`skinfab angle FILE --mcp M --pip P --dip D -o LOG`: the angle of a joint from the markers of a motion capture."""

from __future__ import annotations

import argparse
import json
import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps

if TYPE_CHECKING:
    from calibration.mocap.markers import Markers
    from skinfab.readout.frame import Recording

#: What the column is called.
COLUMN = "angle_deg"
#: A board whose times go back by more than this, s, was restarted; late packets are not that late.
ANEW_S = 1.0


def number(text: str) -> float:
    """Any finite number."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is no number of seconds")
    return value


def shift(text: str) -> float | None:
    """Seconds, or ``auto``."""
    return None if text == "auto" else number(text)


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "angle",
        help="a joint's angle from the markers of a motion capture",
        description="The angle between the bones MCP to PIP and PIP to DIP from a C3D file or Vicon's CSV export: as a log of its own, or "
        "added to a log of readings, which skinfab calibrate takes with --angle angle_deg.",
    )
    p.add_argument("capture", metavar="FILE", type=Path, help="C3D file or Vicon CSV export")
    for name, what in (("mcp", "metacarpophalangeal"), ("pip", "proximal interphalangeal"), ("dip", "distal interphalangeal")):
        p.add_argument(f"--{name}", metavar="MARKER", required=True, help=f"label of the marker on the {what} joint")
    p.add_argument("--max-gap", metavar="S", type=steps.not_negative, default=None, help="bridge gaps up to this (default: 0.1 s; 0: none)")
    p.add_argument("--log", metavar="LOG", type=Path, help="add the angle to this log of readings, at its times")
    p.add_argument(
        "--shift",
        metavar="S|auto",
        type=shift,
        default=0.0,
        help="when the capture began by the log's time, s (default: 0); auto: found from the movement that both have recorded",
    )
    p.add_argument("--signal", metavar="COLUMN", help="reading of the log that --shift auto goes by (default: the only one)")
    p.add_argument("-o", "--output", metavar="LOG", type=Path, required=True, help="where to: .csv, .mcap, .bag, or a folder for ROS 2")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run, wrong_usage=p.error)


def run(args: argparse.Namespace) -> int:
    """Read, reckon, write, and say what was seen."""
    if args.shift != 0 and not args.log:
        args.wrong_usage("--shift says when the capture began by the time of a log; give --log too")
    if args.signal and args.shift is not None:
        args.wrong_usage("--signal is what --shift auto goes by; give --shift auto too")
    import numpy as np

    from calibration.mocap.angle import MAX_GAP_S, bridge_gaps, joint_angle
    from calibration.mocap.markers import read_markers
    from skinfab.errors import InputError
    from skinfab.files import require_place
    from skinfab.readout.logs.log import write_log

    if os.path.lexists(args.output):
        raise InputError(f"{args.output} is there already, and logs are never overwritten; give another name")
    require_place(args.output)
    if len({args.mcp, args.pip, args.dip}) < 3:
        raise InputError(f"{args.mcp}, {args.pip} and {args.dip} must be three different markers")
    max_gap = MAX_GAP_S if args.max_gap is None else args.max_gap
    made = read_markers(args.capture)
    labels = {"mcp": args.mcp, "pip": args.pip, "dip": args.dip}
    filled = {name: bridge_gaps(made.time, made.marker(label), max_gap_s=max_gap) for name, label in labels.items()}
    angle = joint_angle(*(positions for positions, _ in filled.values()))
    there = np.isfinite(angle)
    if not there.any():
        raise InputError(f"{args.capture}: in no frame are {', '.join(labels.values())} seen together, so there is no angle; bridge more")
    bridged = np.any([each for _, each in filled.values()], axis=0) & there
    notes = list(made.notes)
    clock: dict[str, Any] = {}
    recording = _alone(made, angle) if args.log is None else _added(args, made, angle, notes, clock)
    write_log(recording, args.output)
    result: dict[str, Any] = {
        "capture": {"file": made.file, "sha256": made.sha256},
        "markers": labels,
        "frames": len(made.time),
        "rate_hz": made.rate_hz,
        "seen": int(np.count_nonzero(there & ~bridged)),
        "bridged": int(np.count_nonzero(bridged)),
        "missing": int(np.count_nonzero(~there)),
        "max_gap_s": max_gap,
        "min_deg": float(angle[there].min()),
        "max_deg": float(angle[there].max()),
        "column": COLUMN,
        **clock,
        "notes": notes,
    }
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    steps.say(notes)
    print(
        f"{made.file}: {result['min_deg']:.1f} to {result['max_deg']:.1f} degrees in {result['frames']:,} frames at {made.rate_hz:g} Hz; "
        f"{result['bridged']:,} over gaps of up to {max_gap:g} s, {result['missing']:,} without an angle"
    )
    if "shift_interval_s" in result:
        low, high = result["shift_interval_s"]
        print(f"the capture began {result['shift_s']:.3f} s after the log ({low:.3f} to {high:.3f} s)")
    print(f"{args.output}: {COLUMN}")
    return 0


def _alone(made: Markers, angle: Any) -> Recording:
    """The angle as a log of its own."""
    from skinfab.readout.frame import Channel, Recording, Stream

    stream = Stream(made.file, (Channel(COLUMN, "deg", "angle"),), made.rate_hz)
    return Recording.of_values(stream, angle[:, None], device_time=made.time)


def _added(args: argparse.Namespace, made: Markers, angle: Any, notes: list[str], clock: dict[str, Any]) -> Recording:
    """A log with the angle as one channel more; into `clock` goes the shift that was taken."""
    from dataclasses import replace

    import numpy as np

    from skinfab.errors import InputError
    from skinfab.readout.frame import Channel, Recording
    from skinfab.readout.logs.log import read_log

    path = args.log
    log = read_log(path)
    notes.extend(log.notes)
    old = log.recording
    if not len(old):
        raise InputError(f"{path} has no frame; record something first")
    since = old.device_time - old.device_time[0]
    again = np.flatnonzero(np.diff(since) < -ANEW_S)
    if len(again):
        k = int(again[0])
        raise InputError(
            f"{path}, frame {k + 2}: times go back from {since[k]:g} to {since[k + 1]:g} s, as when the board restarts, so that what "
            "follows has no place in the capture's time; cut the log there and give each part a --shift of its own"
        )
    shift = _shift(args, old, since, made, angle, clock)
    # A straight line to a frame without an angle has none: nothing is carried over a gap.
    column = np.interp(since, made.time + shift, angle, left=np.nan, right=np.nan)[:, None]
    there = np.isfinite(column)
    if not there.any():
        raise InputError(f"{path} and {made.file} have no moment in common; say with --shift when the capture began")
    if not there.all():
        notes.append(f"{log.file}: {int(np.count_nonzero(~there)):,} of {len(old):,} frames have no angle")
    clock["shift_s"] = shift
    stream = replace(old.stream, channels=(*old.stream.channels, Channel(COLUMN, "deg", "angle")))
    flags = np.zeros_like(there)
    return Recording(
        stream,
        old.device_time,
        old.host_time,
        old.sequence,
        np.hstack([old.values, column]),
        np.hstack([old.valid, there]),
        np.hstack([old.saturated, flags]),
    )


def _shift(args: argparse.Namespace, log: Recording, since: Any, made: Markers, angle: Any, clock: dict[str, Any]) -> float:
    """As given, or found."""
    if args.shift is not None:
        return float(args.shift)
    from calibration.mocap.shift import find_shift
    from skinfab.errors import InputError

    names = log.stream.names
    if args.signal is None and len(names) > 1:
        raise InputError(f"{args.log} has {len(names)} columns; say with --signal which one goes with this joint: {', '.join(names)}")
    try:
        found = find_shift(since, log.column(args.signal or names[0]), made.time, angle)
    except InputError as fault:
        raise InputError(f"{args.log} and {made.file}: {fault}") from fault
    clock |= {"shift_interval_s": [found.low_s, found.high_s], "slack_deg": found.slack_deg}
    return found.lag_s
