"""`skinfab array train LOG... -o DIR`: an array's own model from presses at known places."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps

if TYPE_CHECKING:
    from skinfab.fingertip.array.judge import Error
    from skinfab.fingertip.array.logs import ArrayLog
    from skinfab.fingertip.array.matched import ArrayModel

FILES = ("errors.csv", "model.npz", "result.json", "train.png")


def add_options(p: argparse.ArgumentParser) -> None:
    """The logs, the array that they are of, and where the model goes."""
    p.add_argument(
        "logs",
        metavar="LOG",
        nargs="+",
        type=Path,
        help="two or more that begin untouched: channels r0s0, r0s1, ... (ring, stripe; V) and columns axial_mm (from ring 0), angle_deg "
        "(from stripe 0), force_n, and line_deg for rods; each log is held out in turn",
    )
    p.add_argument("--ring-pitch", metavar="MM", type=steps.positive, help="distance of the rings (default: as many on the seed's finger)")
    p.add_argument("--finger-radius", metavar="MM", type=steps.positive, default=12.7, help="of the skin's outside (default: 12.7)")
    p.add_argument("--skin", metavar="MM", type=steps.positive, default=3.8, help="of rubber over the electrodes (default: 3.8)")
    p.add_argument("--fill", metavar="PART", type=steps.share, default=0.9, help="electrode width over pitch (default: 0.9)")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for the model, its errors and a figure")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Learn, judge, write, and say how good it is."""
    from skinfab.files import require_apart
    from skinfab.fingertip.array.geometry import Geometry
    from skinfab.fingertip.array.judge import better, held_out, poor
    from skinfab.fingertip.array.learn import learn, save_array
    from skinfab.fingertip.array.logs import read_array_log
    from skinfab.progress import terminal_progress
    from skinfab.staging import staged_folder

    require_apart(args.output, FILES, args.logs)
    logs = [read_array_log(path) for path in args.logs]
    _require_different(logs)
    _require_alike(args.logs, logs)
    rings, stripes = logs[0].shape
    pitch = args.ring_pitch or Geometry.of_density(f"{rings}x{stripes}").ring_pitch
    geometry = Geometry(rings, stripes, pitch, args.finger_radius, args.skin, args.fill)
    with terminal_progress(quiet=args.json) as progress:
        progress(0.0, "learning")
        learned = learn(logs, geometry)
        progress(0.3, "judging on each log what was learned from the others")
        errors = held_out(logs, geometry)
        progress(1.0, "done")
    won, worse = better(errors)
    model = learned.model if won else learned.drawn
    kept = "learned" if won else "drawn"
    said = [*learned.notes, *_poor(won, worse), *_wrong(poor(errors, kept), args.skin)]
    result = _facts(logs, model, errors, said, kept)
    with staged_folder(args.output) as folder:
        save_array(folder / "model.npz", model, {key: result[key] for key in ("made_from", "simulated", "errors", "noise", "kept")})
        _write(folder, model, errors, result)
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    steps.say(result["notes"])
    for line in _lines(model, errors):
        print(line)
    print(f"{args.output}: {', '.join(FILES)}")
    return 0


def _require_different(logs: Sequence[ArrayLog]) -> None:
    """One log given twice would be learned from and judged on."""
    from skinfab.errors import InputError

    seen: dict[str, str] = {}
    for log in logs:
        if log.sha256 in seen:
            raise InputError(f"{seen[log.sha256]} and {log.name} are the same log; it would be learned from and judged on: give it once")
        seen[log.sha256] = log.name


def _require_alike(paths: Sequence[Path], logs: Sequence[ArrayLog]) -> None:
    from skinfab.errors import InputError

    for path, log in zip(paths, logs, strict=True):
        if log.shape != logs[0].shape:
            (rings, stripes), (other_rings, other_stripes) = log.shape, logs[0].shape
            raise InputError(
                f"{path} is of {rings} x {stripes} tactels and {paths[0]} of {other_rings} x {other_stripes}; give logs of one array"
            )


def _poor(won: bool, worse: Sequence[str]) -> list[str]:
    """What to say where learning does not pay."""
    if not won:
        return [
            "what was learned finds places no better than the array as drawn, on logs that were held out: the drawing is kept, with the "
            "modulus that was learned; press more places, all over the array"
        ]
    return [f"what was learned is no better than the array as drawn in {name}; press more places, all over the array" for name in worse]


def _wrong(poor: Sequence[str], skin_mm: float) -> list[str]:
    """What to say of a model that is no good."""
    if not poor:
        return []
    return [
        f"on logs that were held out {'; '.join(poor)}: do not trust this model; is --skin ({skin_mm:g} mm) what lies over the electrodes, "
        "are --finger-radius and --ring-pitch this array's, and were the places and forces those of these presses?"
    ]


def _facts(logs: Sequence[ArrayLog], model: ArrayModel, errors: Sequence[Error], said: Sequence[str], kept: str) -> dict[str, Any]:
    import numpy as np

    return {
        "simulated": any(log.simulated for log in logs),
        "made_from": [{"file": log.name, "sha256": log.sha256, "contacts": len(log.touched())} for log in logs],
        "kept": kept,
        "geometry": asdict(model.geometry),
        "rubber": asdict(model.rubber),
        "gain_scatter": float(np.std(model.gains)),
        "noise": float(np.median([log.noise for log in logs])),
        "errors": [asdict(error) for error in errors],
        "notes": [*(note for log in logs for note in log.notes), *said],
    }


def _write(folder: Path, model: ArrayModel, errors: Sequence[Error], result: dict[str, Any]) -> None:
    import csv
    import io

    from skinfab.files import atomic_write
    from skinfab.fingertip.array.figure import draw_training

    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["quantity", "way", "rms", "low", "high", "worst", "frames", "simulated"])
    for each in errors:
        numbers = (f"{value:.6g}" for value in (each.rms, each.low, each.high, each.worst))
        rows.writerow([each.quantity, each.way, *numbers, each.frames, int(result["simulated"])])
    atomic_write(folder / "errors.csv", text.getvalue())
    atomic_write(folder / "result.json", json.dumps(result, indent=1, allow_nan=False) + "\n")
    draw_training(model, errors, folder / "train.png", simulated=result["simulated"])


def _lines(model: ArrayModel, errors: Sequence[Error]) -> list[str]:
    from skinfab.fingertip.array.judge import QUANTITIES

    g, rubber = model.geometry, model.rubber
    lines = [
        f"{g.rings} x {g.stripes} tactels under {g.skin:.2f} mm of skin, E {rubber.young:.3g} N/mm^2, Poisson {rubber.poisson:.2f}; "
        "root mean square error on logs that were held out, with its 95 % interval:"
    ]
    for quantity, unit in QUANTITIES.items():
        for each in (one for one in errors if one.quantity == quantity):
            lines.append(
                f"  {quantity:6s} {each.way:10s} {each.rms:8.3f} [{each.low:.3f}, {each.high:.3f}] {unit}, worst {each.worst:.3g} "
                f"of {each.frames} frames"
            )
    return lines
