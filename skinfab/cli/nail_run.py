"""`skinfab nail run MODEL.npz LOG|--port PORT -o DIR`: what is touched, in a log or as it comes."""

from __future__ import annotations

import argparse
import json
import math
from collections import Counter
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.cli.nail_errors import off_line
from skinfab.cli.nail_judged import judged, participants_of
from skinfab.cli.record import baud

if TYPE_CHECKING:
    from skinfab.fingertip.nail.live import Told

#: Readings from one decision to the next: 5.7 ms, a turn of the motor.
_EVERY = 8
#: Readings that a decision is made on: 24 ms.
_WINDOW = 33
#: Decisions that come so much later than their readings, s, in the median, are ever more behind.
_BEHIND_S = 0.2
#: Deciding is what makes them late where it takes more of the time.
_MOSTLY = 0.5
#: Where more of the windows are like nothing learned, nothing was decided.
_ALL_STRANGE = 0.95
#: So much of the windows may have a force at the end of what was learned before it is told of.
_AT_END = 0.2
FILES = ("decisions.csv", "nail.png", "result.json")


def add_options(p: argparse.ArgumentParser) -> None:
    """The model, what it is applied to, and where the results go."""
    p.add_argument("model", metavar="MODEL.npz", type=Path, help="from skinfab nail train")
    p.add_argument("log", metavar="LOG", type=Path, nargs="?", help="CSV, MCAP, ROS bag or recording of the channels Ax Ay Az Gx Gy Gz")
    p.add_argument("--port", metavar="PORT", help="such as /dev/ttyACM0, until Ctrl-C, instead of a log")
    p.add_argument(
        "--window",
        metavar="N",
        type=steps.counting,
        help="readings a decision is made on, from 8 up (default: 33, 24 ms; published: its own)",
    )
    p.add_argument(
        "--every", metavar="N", type=steps.counting, help="a decision after so many readings (default: 8; published: its window)"
    )
    p.add_argument(
        "--rate", metavar="HZ", type=steps.positive, help="readings a second, where neither times nor count nor the stream itself say it"
    )
    p.add_argument("--seconds", metavar="S", type=steps.positive, help="of a port: end after so long (default: at Ctrl-C)")
    p.add_argument("--baud", metavar="N", type=baud, help="of a port (default: 921600)")
    p.add_argument("--labels", metavar="LABELS.csv", type=Path, help="of a log: what was touched when, to count how much is right")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for the decisions, the result and the figure")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Decide, write, and say what came out."""
    with ExitStack() as until_written:
        return _run(args, until_written)


def _run(args: argparse.Namespace, until_written: ExitStack) -> int:
    from skinfab.files import require_apart
    from skinfab.fingertip.nail.model_file import load_nail

    if (args.log is None) == (args.port is None):
        args.wrong_usage("give a LOG or --port PORT, one of them")
    for name, other in (("labels", "log"), ("seconds", "port"), ("baud", "port")):
        if getattr(args, name) is not None and getattr(args, other) is None:
            args.wrong_usage(f"--{name} is for a {other}")
    require_apart(args.output, FILES, [path for path in (args.model, args.log, args.labels) if path is not None])
    content = load_nail(args.model)
    if (own := getattr(content.model, "samples", None)) and args.window not in (None, own):
        args.wrong_usage(f"the published method decides on the {own} readings that {args.model.name} learned from; leave --window out")
    args.window = args.window or own or _WINDOW
    if args.every is None:
        args.every = getattr(content.model, "samples", _EVERY)
    names = list(content.model.names)
    if args.port:
        told, facts = _from_port(args, content, until_written)
    else:
        told, facts = _from_log(args, content)
    from skinfab.errors import InputError, RefusedError

    decided = [each for each in told if each.decision is not None]
    if not decided and any(each.turning is False for each in told):
        raise RefusedError(
            f"{args.port or args.log}: the motor does not turn, nothing that vibrates stands out of the noise in {len(told)} windows; "
            "switch it on, and look at the sensor's wires"
        )
    if not told:
        raise InputError(
            f"{args.port or args.log}: fewer than {facts['window_readings']} of {facts['frames']} frames have all six channels, which the "
            "published method needs; look at the sensor's wires, or train with --method improved"
            if own and facts["frames"] >= facts["window_readings"]
            else f"{args.port or args.log} has {facts['frames']} frames and a window {facts['window_readings']}; give "
            + ("a longer log" if own else "a shorter --window")
        )
    if not decided:
        why = Counter(each.reason for each in told if each.reason).most_common(1)[0][0]
        raise InputError(f"{args.port or args.log}: nothing could be decided in any of {len(told)} windows: {why}")
    result = _facts(args, content, told, facts)
    _write(args.output, told, names, result)
    # The decisions are there to be looked at; whoever goes by the status must not take them for touches.
    status = RefusedError.exit_status if result["strange"] > _ALL_STRANGE else 0
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return status
    steps.say(result["notes"])
    for line in _lines(result):
        print(line)
    print(f"{args.output}: {', '.join(FILES)}")
    return status


def _from_log(args: argparse.Namespace, content: Any) -> tuple[list[Told], dict[str, Any]]:
    from skinfab.fingertip.nail.live import decide_log
    from skinfab.fingertip.nail.pace import pace_of_log
    from skinfab.fingertip.nail.units import absent, units_note
    from skinfab.readout.logs.log import read_log

    log = read_log(args.log)
    pace = pace_of_log(log, rate_hz=args.rate)
    told, lost = decide_log(content.model, log.recording, samples=args.window, every=args.every, regression=content.regression, pace=pace)
    samples = getattr(content.model, "samples", args.window)
    facts: dict[str, Any] = {
        "source": log.file,
        "sha256": log.sha256,
        "simulated": log.recording.stream.simulated,
        "frames": len(log.recording),
        "lost": lost,
        "window_readings": samples,
        "notes": [
            *log.notes,
            *(f"{log.file}: {wrong}" for wrong in pace.notes),
            *absent(log.recording.stream),
            *units_note(content.made_from.get("units_said"), log.recording.stream, "log"),
        ],
    }
    if args.labels:
        of, notes = judged(args.labels, log, told, samples, content, pace)
        facts |= of | {"notes": [*facts["notes"], *notes]}
    return told, facts


def _from_port(args: argparse.Namespace, content: Any, until_written: ExitStack) -> tuple[list[Told], dict[str, Any]]:
    from skinfab.cli.nail_port import watch_port

    return watch_port(
        args.port,
        content.model,
        content.regression,
        samples=args.window,
        every=args.every,
        baud=args.baud,
        seconds=args.seconds,
        rate_hz=args.rate,
        units_said=content.made_from.get("units_said"),
        quiet=args.json,
        until_written=until_written,
    )


def _facts(args: argparse.Namespace, content: Any, told: Sequence[Told], facts: dict[str, Any]) -> dict[str, Any]:
    import numpy as np

    decisions = [each.decision for each in told if each.decision is not None]
    notes = list(facts.pop("notes"))
    for name, count in Counter(name for each in decisions for name in each.missing).items():
        notes.append(
            f"channel {name} had too few readings or stood still, in {count / len(decisions):.1%} of the windows, decided without it"
        )
    for end, word in (("high", "more"), ("low", "less")):
        if (part := sum(each.continuous.force_end == end for each in decisions) / len(decisions)) > _AT_END:
            notes.append(f"the force is at the {end} end of those that were learned in {part:.0%} of the windows: it may be {word}")
    left_out = float(np.mean([each.left_out for each in told]))
    if left_out > 0.01:
        notes.append(f"{left_out:.1%} of the readings are missing or saturated and were left out")
    if (off := sum(each.turning is False for each in told) / len(told)) > 0:
        notes.append(f"the motor did not turn in {off:.1%} of the windows, which were not decided")
    whose = f", here of {', '.join(known)}" if (known := participants_of(content)) else ""
    if (strange := sum(each.strange for each in decisions) / len(decisions)) > 0.2:
        notes.append(
            f"{strange:.0%} of the windows are like nothing that was learned; is it the same finger (a model is one person's{whose}), "
            "the sensor where it was, and all in the same units?"
        )
    if (latency := facts.get("latency_ms")) and latency["median"] > 1000 * _BEHIND_S:
        late = f"decisions were {latency['median'] / 1000:.1f} s behind in the median: "
        notes.append(
            f"{late}they are too many for this machine, which spent {facts['deciding']:.0%} of the time on them; give a larger --every"
            if facts["deciding"] > _MOSTLY
            else f"{late}this machine was busy with other things, as deciding took {facts['deciding']:.0%} of the time; end some of them"
        )
    if facts["lost"]:
        notes.append(f"{facts['lost']} frames were lost on the way")
    if content.made_from.get("simulated") and not facts["simulated"]:
        notes.append(
            f"{args.model.name} was learned from simulated readings: what it says of measured ones is marked as simulated, and worth little"
        )
    drives = np.array([each.drive_hz for each in told if each.decision is not None and not each.decision.strange])
    found = drives[np.isfinite(drives)]
    return {
        **facts,
        "simulated": bool(facts["simulated"] or content.made_from.get("simulated")),
        "model": args.model.name,
        "participants": participants_of(content),
        "window_s": facts["window_readings"] / content.model.rate_hz,
        "windows": len(told),
        "undecided": len(told) - len(decisions),
        "touched": dict(Counter(each.label for each in decisions).most_common()),
        "drive_hz": dict(zip(("low", "median", "high"), np.quantile(found, [0.05, 0.5, 0.95]).tolist(), strict=True))
        if len(found)
        else None,
        "strange": strange,
        "left_out": left_out,
        "notes": notes,
    }


def _write(output: Path, told: Sequence[Told], names: list[str], result: dict[str, Any]) -> None:
    import csv
    import io

    from skinfab.files import atomic_write
    from skinfab.fingertip.nail.figure import draw_run
    from skinfab.staging import staged_folder

    text = io.StringIO()
    text.write("# simulated: true\n" if result["simulated"] else "")
    rows = csv.writer(text, lineterminator="\n")
    numbers = ("angle_deg", "x_mm", "y_mm", "force_n")
    rows.writerow(["time_s", "label", "confidence", "contact", "strange", *numbers, "force_end", "missing", "drive_hz", "left_out"])
    for each in told:
        d = each.decision
        if d is None:
            rows.writerow([f"{each.time_s:.6f}", *[""] * 10, _cell(each.drive_hz), _cell(each.left_out)])
            continue
        found = [_cell(getattr(d.continuous, name)) for name in numbers]
        flags = [int(d.contact), int(d.strange)]
        rows.writerow(
            [
                f"{each.time_s:.6f}",
                d.label,
                "" if d.strange else _cell(d.confidence),
                *flags,
                *found,
                d.continuous.force_end,
                " ".join(d.missing),
                _cell(each.drive_hz),
                _cell(each.left_out),
            ]
        )
    with staged_folder(output) as folder:
        atomic_write(folder / "decisions.csv", text.getvalue())
        atomic_write(folder / "result.json", json.dumps(result, indent=1, allow_nan=False) + "\n")
        title = f"{result['source']}: a decision on {result['window_readings']} readings ({1000 * result['window_s']:.0f} ms)"
        draw_run(told, names, folder / "nail.png", title=title, simulated=result["simulated"])


def _cell(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.5g}"


def _lines(result: dict[str, Any]) -> list[str]:
    made = " (simulated)" if result["simulated"] else ""
    touched = ", ".join(f"{name} {100 * count / result['windows']:.0f} %" for name, count in result["touched"].items())
    lines = ["nothing is decided: the windows are like nothing the model learned from"] * (result["strange"] > _ALL_STRANGE)
    lines += [f"{result['source']}{made}: {result['windows']} windows of {1000 * result['window_s']:.1f} ms: {touched}"]
    if drive := result["drive_hz"]:
        lines.append(f"the motor turned at {drive['median']:.1f} Hz (90 % of the time {drive['low']:.1f} to {drive['high']:.1f})")
    if labels := result.get("labels"):
        rate = labels["accuracy"]
        share = "-" if rate["value"] is None else f"{100 * rate['value']:.1f} % [{100 * rate['low']:.1f}, {100 * rate['high']:.1f}]"
        lines.append(
            f"{labels['right']} of {labels['trials']} trials that the model did not learn from are right: {share}{off_line(labels)}"
        )
    if latency := result.get("latency_ms"):
        lines.append(
            f"from the last reading's arrival to the decision: {latency['median']:.2f} ms (median), {latency['p99']:.2f} (99 %), "
            f"{latency['worst']:.2f} (worst)"
        )
    return lines
