"""`skinfab calibrate LOG --signal COLUMN --angle COLUMN -o DIR`: fit a strain sensor to joint angles."""

from __future__ import annotations

import argparse
import json
import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps

if TYPE_CHECKING:
    from calibration.strain.calibrate import Calibration
    from calibration.strain.document import SensorCalibration
    from calibration.strain.prepare import Prepared
    from skinfab.readout.table import Table

#: What a run leaves.
FILES = ("calibration.json", "calibration.png", "result.json", "samples.csv")
#: Must be the names of `calibration.strain.models.MODELS`, which is not imported for a help text.
NAMES = ("auto", "poly", "branches", "play", "lag")


def degree(text: str) -> int | None:
    """``auto`` or a whole number from 1 on."""
    if text == "auto":
        return None
    try:
        number = int(text)
    except ValueError:
        number = 0
    if not 1 <= number <= 12:
        raise argparse.ArgumentTypeError(f"{text!r} is neither auto nor a degree from 1 to 12")
    return number


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "calibrate",
        help="fit a strain sensor to joint angles",
        description="Fit the readings of a strain sensor to joint angles: the characteristic curve, models with hysteresis compared on the "
        "half of the log that they were not fitted to, and a calibration.json that control and replay load.",
    )
    p.add_argument("log", metavar="LOG", type=Path, help="CSV, MCAP, ROS bag or recording: times, readings, true angles")
    p.add_argument("--signal", metavar="COLUMN", required=True, help="heading of the readings, in any unit")
    p.add_argument("--angle", metavar="COLUMN", required=True, help="heading of the true angles, degrees")
    p.add_argument(
        "--range",
        metavar=("LOW", "HIGH"),
        dest="limits",
        type=float,
        nargs=2,
        help="angles that count, degrees (default: 10 80 where the log covers that, else all of it)",
    )
    p.add_argument("--model", choices=NAMES, default="auto", help="auto (default): the simplest that is as good as the best")
    p.add_argument("--degree", metavar="N|auto", type=degree, default=None, help="of the curve (default: auto, by cross-validation)")
    p.add_argument(
        "--new-task", metavar="LOG", type=Path, action="append", default=[], help="judge all models on this log too; may be given again"
    )
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for calibration.json, tables and the figure")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run, wrong_usage=p.error)


def run(args: argparse.Namespace) -> int:
    """Fit, judge, write, and say how good it is."""
    if args.limits and not (math.isfinite(sum(args.limits)) and args.limits[0] < args.limits[1]):
        args.wrong_usage(f"--range {args.limits[0]:g} {args.limits[1]:g}: the first must be below the second")
    from calibration.strain.calibrate import calibrate, require_useful
    from calibration.strain.clock import clock_facts, clock_line
    from calibration.strain.prepare import prepare
    from skinfab.errors import RefusedError
    from skinfab.files import require_apart
    from skinfab.readout.logs.log import read_log_table
    from skinfab.staging import staged_folder

    limits = tuple(args.limits) if args.limits else None
    table, said = read_log_table(args.log)
    _require_own(args.output, table)
    require_apart(args.output, FILES, [args.log, *args.new_task])
    log = prepare(table, signal=args.signal, angle=args.angle, limits=limits)
    found = calibrate(log, model=args.model, degree=args.degree)
    clock, clock_notes = clock_facts(log)
    tasks = [_new_task(path, args, log, found) for path in args.new_task]
    result = facts(table, log, found) | {"clock": clock} | ({"new_tasks": tasks} if tasks else {})
    # What the clocks do comes first: where they do not agree, nothing else counts.
    result["notes"] = [*clock_notes, *said, *result["notes"], *(note for task in tasks for note in task["notes"])]
    try:
        require_useful(log, found)
    except RefusedError:
        # What was passed over and what the clocks do may say why.
        steps.say(result["notes"] if not args.json else ())
        raise
    with staged_folder(args.output) as folder:
        _write(args, folder, table, log, found, result)
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    steps.say(result["notes"])
    for line in _lines(found, tasks):
        print(line)
    if clock:
        print(clock_line(clock))
    print(f"{args.output}: {', '.join(FILES)}")
    return 0


def facts(table: Table, log: Prepared, found: Calibration) -> dict[str, Any]:
    """The result, ready for JSON."""
    least, mean, most = found.sensitivity_per_deg
    return {
        "model": found.model.name,
        "degree": found.plain.degree,
        "n": found.n,
        "sse": found.sse,
        "r2": found.r2,
        "rms_deg": found.rms_deg,
        "held_out_rms_deg": found.scores[found.model.name].held_out_rms_deg,
        "sensitivity_per_deg": {"min": least, "mean": mean, "max": most},
        "monotone_range_deg": list(found.monotone_range_deg),
        "range_deg": [log.low, log.high],
        "coefficients": found.plain.coefficients.tolist(),
        "u0": log.u0,
        "rate_hz": log.rate_hz,
        "models": {
            name: {
                "held_out_rms_deg": score.held_out_rms_deg,
                "us_per_sample": score.us_per_sample,
                "degree": score.degree,
                "outside": score.outside,
                "cross_validated_rms_deg": {str(k): error for k, error in found.tried[name].items()},
            }
            for name, score in found.scores.items()
        },
        "band": {"angle_deg": found.band[:, 0].tolist(), "low": _finite(found.band[:, 1]), "high": _finite(found.band[:, 2])},
        "log": {"file": table.file, "sha256": table.sha256, "simulated": table.simulated},
        "notes": list(found.notes),
    }


def _finite(values: Any) -> list[float | None]:
    return [float(v) if math.isfinite(v) else None for v in values]


def _new_task(path: Path, args: argparse.Namespace, log: Prepared, found: Calibration) -> dict[str, Any]:
    """All models, fitted to the log, on another one."""
    from calibration.strain.calibrate import rms_on
    from calibration.strain.prepare import prepare
    from skinfab.readout.logs.log import read_log_table

    table, said = read_log_table(path)
    other = prepare(table, signal=args.signal, angle=args.angle, limits=(log.low, log.high), u0=log.u0)
    errors = {name: {"rms_deg": error} for name, error in rms_on(log, found, other).items()}
    return {"file": path.name, "n": other.n, "models": errors, "notes": [*said, *other.notes]}


def _require_own(folder: Path, table: Table) -> None:
    """Nothing there, or what this log gave before: a calibration of another sensor is not lost to a slip of the keyboard."""
    from calibration.strain.document import load_calibration
    from skinfab.errors import InputError

    path = folder / "calibration.json"
    if not os.path.lexists(path):
        return
    again = "give another -o, or remove it first"
    try:
        made_from = load_calibration(path).made_from
    except InputError as fault:
        raise InputError(f"{path} is there already and is not a calibration that could be made anew ({fault}); {again}") from fault
    if made_from.get("sha256") != table.sha256:
        raise InputError(f"{path} is there already and is of another log, {made_from.get('file')}; {again}")


def _write(args: argparse.Namespace, folder: Path, table: Table, log: Prepared, found: Calibration, result: dict[str, Any]) -> None:
    import csv
    import io

    from calibration.strain.document import save_calibration
    from calibration.strain.figure import draw_calibration
    from skinfab.files import atomic_write

    save_calibration(_calibration(args, table, log, found), folder / "calibration.json")
    atomic_write(folder / "result.json", json.dumps(result, indent=1, allow_nan=False) + "\n")
    text = io.StringIO()
    if table.simulated:
        text.write("# simulated: true\n")
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["time_s", "angle_deg", "relative_change", "estimate_deg", "outside", "fitted"])
    for each in log.runs:
        estimate, outside = found.model.estimate(each.time, each.signal)
        columns = (each.time, each.angle, each.signal, estimate)
        numbers = [[f"{value:.9g}" for value in column.tolist()] for column in columns]
        rows.writerows(zip(*numbers, outside.astype(int).tolist(), each.fit.astype(int).tolist(), strict=True))
    atomic_write(folder / "samples.csv", text.getvalue())
    title = f"{table.file}: {args.signal} against {args.angle}"
    draw_calibration(log, found, folder / "calibration.png", title=title, names=(args.signal, args.angle), simulated=table.simulated)


def _calibration(args: argparse.Namespace, table: Table, log: Prepared, found: Calibration) -> SensorCalibration:
    from datetime import UTC, datetime

    from calibration.strain.document import SensorCalibration
    from calibration.strain.models import BranchModel

    # Control needs both branches, whichever model tells angles best.
    branches = found.scores.get(BranchModel.name) if found.model.name != BranchModel.name else None
    return SensorCalibration(
        found.model,
        args.signal,
        args.angle,
        log.u0,
        log.low,
        log.high,
        {"file": table.file, "sha256": table.sha256, "simulated": table.simulated, "n": found.n},
        datetime.now(UTC).isoformat(timespec="seconds"),
        {"rms_deg": found.rms_deg, "held_out_rms_deg": found.scores[found.model.name].held_out_rms_deg},
        None if branches is None else BranchModel.fit(log.runs, degree=branches.degree),
    )


def _lines(found: Calibration, tasks: list[dict[str, Any]]) -> list[str]:
    least, mean, most = found.sensitivity_per_deg
    low, high = found.monotone_range_deg
    lines = [
        f"curve of degree {found.plain.degree} through {found.n:,} samples: R2 {found.r2:.4f}, SSE {found.sse:.4g}, sensitivity "
        f"{least:.2e} / {mean:.2e} / {most:.2e} per degree, monotone over {low:.1f} to {high:.1f} degrees",
        "model        degree  held out" + "".join(f"  {task['file']}" for task in tasks) + "  us a sample",
    ]
    for name, score in found.scores.items():
        others = "".join(f"  {task['models'][name]['rms_deg']:>{len(task['file'])}.2f}" for task in tasks)
        mark = "*" if name == found.model.name else " "
        lines.append(f"{mark} {name:10s}{score.degree:7d}{score.held_out_rms_deg:10.2f}{others}{score.us_per_sample:13.1f}")
    lines.append(
        f"{found.model.name}: {found.scores[found.model.name].held_out_rms_deg:.2f} degrees rms on the half that was held out, "
        f"{found.rms_deg:.2f} on all of the log"
    )
    return lines
