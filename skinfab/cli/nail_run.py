"""`skinfab nail run MODEL.npz LOG|--port PORT -o DIR`: what is touched, in a log or as it comes."""

from __future__ import annotations

import argparse
import json
import math
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.cli.record import baud

if TYPE_CHECKING:
    from skinfab.fingertip.nail.live import Told
    from skinfab.readout.logs.log import Log

#: Readings from one decision to the next: 5.7 ms, a turn of the motor.
_EVERY = 8
#: Readings that a decision is made on: 24 ms.
_WINDOW = 33
#: Decisions that come so much later than their readings, s, in the median, are ever more behind.
_BEHIND_S = 0.2
#: Where more of the windows are like nothing learned, nothing was decided.
_ALL_STRANGE = 0.95
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
    p.add_argument("--seconds", metavar="S", type=steps.positive, help="of a port: end after so long (default: at Ctrl-C)")
    p.add_argument("--baud", metavar="N", type=baud, help="of a port (default: 921600)")
    p.add_argument("--labels", metavar="LABELS.csv", type=Path, help="of a log: what was touched when, to count how much is right")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for the decisions, the result and the figure")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Decide, write, and say what came out."""
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
        told, facts = _from_port(args, content)
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
            f"{args.port or args.log} has {facts['frames']} frames and a window {facts['window_readings']}; give a shorter --window"
        )
    if not decided:
        raise InputError(
            f"{args.port or args.log}: nothing could be decided in any of {len(told)} windows; two channels at least must have readings"
        )
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
    from skinfab.fingertip.nail.units import absent, units_said
    from skinfab.readout.checks import check_times
    from skinfab.readout.logs.log import read_log

    log = read_log(args.log)
    told, lost = decide_log(content.model, log.recording, samples=args.window, every=args.every, regression=content.regression)
    samples = getattr(content.model, "samples", args.window)
    facts: dict[str, Any] = {
        "source": log.file,
        "sha256": log.sha256,
        "simulated": log.recording.stream.simulated,
        "frames": len(log.recording),
        "lost": lost,
        "window_readings": samples,
        "notes": [*log.notes, *(f"{log.file}: {wrong}" for wrong in check_times(log.recording)), *absent(log.recording.stream)],
    }
    said = content.made_from.get("units_said")
    if said is not None and said != units_said(log.recording.stream):
        one, other = ("model's logs declare", "this log does not") if said else ("log declares", "the model's did not")
        facts["notes"].append(f"the {one} the units, and {other}: what says nothing is taken for G and deg/s, and wrong in other units")
    if args.labels:
        judged, notes = _judged(args.labels, log, told, samples, content)
        facts |= judged | {"notes": [*facts["notes"], *notes]}
    return told, facts


def _judged(path: Path, log: Log, told: Sequence[Told], samples: int, content: Any) -> tuple[dict[str, Any], list[str]]:
    """How many of the trials of this log that the model did not learn from are right: what most of the windows in a trial say."""
    import numpy as np

    from skinfab.errors import InputError
    from skinfab.fingertip.confusion import grouped_accuracy
    from skinfab.fingertip.nail.doubles import without_doubles
    from skinfab.fingertip.nail.labels import read_labels

    labels, _ = read_labels(path)
    own = [each for each in labels if each.log == log.file]
    if not own:
        raise InputError(f"{path} has no row of {log.file}; give the table that goes with the log")
    rows, notes = without_doubles(own, [each.log for each in own], path)
    own = [own[k] for k in rows]
    learned = content.made_from.get("learned")
    spans = (learned or {}).get(log.sha256, [])
    fresh = [each for each in own if not any(each.start_s < end and start < each.end_s for start, end in spans)]
    if learned is None:
        notes.append("the model does not say which trials it learned from; where they are among these, more is right than of new ones")
    strangers = {each.participant for each in own if each.participant} - set(known := _participants(content))
    if strangers and known:
        notes.append(
            f"the trials are of {', '.join(sorted(strangers))} and the model learned from {', '.join(known)}: fingers differ, and "
            "another's is often told wrong; train a model for each person"
        )
    if left_out := len(own) - len(fresh):
        notes.append(f"the model learned from {left_out} of the {len(own)} trials, which are not counted")
    rate_hz = content.model.rate_hz
    right, groups = [], []
    for k, each in enumerate(fresh):
        # Of the last reading: half a reading to spare, so that a window that just fits does.
        first, last = each.start_s + (samples - 1.5) / rate_hz, each.end_s - 0.5 / rate_hz
        said = Counter(one.decision.label for one in told if one.decision and first <= one.time_s <= last)
        if said:
            right.append(said.most_common(1)[0][0] == each.label)
            groups.append(f"{each.participant}/{each.trial or k}")
    if fresh and not right:
        notes.append(f"no trial has a window of {samples} readings that could be decided; give a shorter --window")
    of = {"trials": len(right), "right": sum(right), "learned_from": left_out}
    if not right:
        return {"labels": {"file": path.name, **of, "accuracy": {"value": None, "low": None, "high": None}}}, notes
    rate = grouped_accuracy(np.array(right), groups)
    return {"labels": {"file": path.name, **of, "accuracy": {"value": rate.value, "low": rate.low, "high": rate.high}}}, notes


def _from_port(args: argparse.Namespace, content: Any) -> tuple[list[Told], dict[str, Any]]:
    from skinfab.cli.nail_port import watch_port

    return watch_port(
        args.port,
        content.model,
        content.regression,
        samples=args.window,
        every=args.every,
        baud=args.baud,
        seconds=args.seconds,
        quiet=args.json,
    )


def _facts(args: argparse.Namespace, content: Any, told: Sequence[Told], facts: dict[str, Any]) -> dict[str, Any]:
    import numpy as np

    decisions = [each.decision for each in told if each.decision is not None]
    notes = list(facts.pop("notes"))
    if missing := max(each.missing for each in decisions):
        part = sum(each.missing > 0 for each in decisions) / len(decisions)
        notes.append(
            f"up to {missing} of the six channels had too few readings or stood still, in {part:.1%} of the windows, decided without them"
        )
    left_out = float(np.mean([each.left_out for each in told]))
    if left_out > 0.01:
        notes.append(f"{left_out:.1%} of the readings are missing or saturated and were left out")
    if (off := sum(each.turning is False for each in told) / len(told)) > 0:
        notes.append(f"the motor did not turn in {off:.1%} of the windows, which were not decided")
    whose = f", here of {', '.join(known)}" if (known := _participants(content)) else ""
    if (strange := sum(each.strange for each in decisions) / len(decisions)) > 0.2:
        notes.append(
            f"{strange:.0%} of the windows are like nothing that was learned; is it the same finger (a model is one person's{whose}), "
            "the sensor where it was, and all in the same units?"
        )
    if (latency := facts.get("latency_ms")) and latency["median"] > 1000 * _BEHIND_S:
        notes.append(
            f"decisions were {latency['median'] / 1000:.1f} s behind in the median: too many for this machine; give a larger --every"
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
        "participants": _participants(content),
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


def _participants(content: Any) -> list[str]:
    """Whose finger was learned, as far as somebody said."""
    return [str(each) for each in content.made_from.get("participants") or [] if each]


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
    rows.writerow(["time_s", "label", "confidence", "contact", "strange", *numbers, "missing", "drive_hz", "left_out"])
    for each in told:
        d = each.decision
        if d is None:
            rows.writerow([f"{each.time_s:.6f}", *[""] * 9, _cell(each.drive_hz), _cell(each.left_out)])
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
                d.missing,
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
        lines.append(f"{labels['right']} of {labels['trials']} trials that the model did not learn from are right: {share}")
    if latency := result.get("latency_ms"):
        lines.append(
            f"from the last reading's arrival to the decision: {latency['median']:.2f} ms (median), {latency['p99']:.2f} (99 %), "
            f"{latency['worst']:.2f} (worst)"
        )
    return lines
