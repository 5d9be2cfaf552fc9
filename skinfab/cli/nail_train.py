"""`skinfab nail train LABELS.csv -o MODEL.npz`: learn from logs with labels."""

from __future__ import annotations

import argparse
import hashlib
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.cli.nail_errors import mean_errors, off_line

if TYPE_CHECKING:
    from skinfab.fingertip.nail.held_out import Held
    from skinfab.fingertip.nail.labels import Trial

#: Ten simulated participants, each asked by the models of the nine others; their own: 88, 98 and 89 % (docs/nail.md).
_ANOTHER = "another's was told right in 46 % of four edges, 81 % of six pins and 55 % of twelve edges, simulated"
METHODS = ("improved", "published")


def add_options(p: argparse.ArgumentParser) -> None:
    """LABELS, how to learn from them, and where the model goes."""
    p.add_argument("labels", metavar="LABELS.csv", type=Path, help="which log holds what from when to when (docs/nail.md)")
    p.add_argument("--method", choices=METHODS, default="improved", help="phasors (improved, the default) or angle histograms (published)")
    p.add_argument(
        "--participant",
        metavar="NAME",
        help="learn from this one's trials (needed where there are several, as fingers differ); all: from everybody's, far worse for each",
    )
    p.add_argument("--drive", metavar="HZ", type=steps.positive, help="the motor's frequency (default: found in each trial)")
    p.add_argument("--rate", metavar="HZ", type=steps.positive, help="readings a second, where neither times nor count nor the logs say it")
    p.add_argument("-o", "--output", metavar="MODEL.npz", type=steps.named(".npz"), required=True, help="the model")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Learn, judge on what was held out, write, and say how good it is."""
    import numpy as np

    from skinfab.errors import InputError
    from skinfab.files import require_place
    from skinfab.fingertip.nail.held_out import judge, splits_of
    from skinfab.fingertip.nail.labels import read_trials
    from skinfab.fingertip.nail.model_file import NailFile, save_nail
    from skinfab.fingertip.nail.prints import kept_of
    from skinfab.fingertip.nail.regress import Regression, learnable, targets_of
    from skinfab.fingertip.nail.train import WINDOW, prepare

    require_place(args.output)
    if args.output.exists() and args.output.samefile(args.labels):
        raise InputError(f"{args.output} is read and would be replaced; give another -o")
    every, simulated, notes = read_trials(args.labels, rate_hz=args.rate)
    trials, across = _chosen(every, args.participant)
    made = prepare(trials, drive_hz=args.drive)
    splits = splits_of(trials, across=across)
    published = args.method == "published"
    held = {} if published else {f"{WINDOW} readings": judge(made, splits, samples=WINDOW, across=across)}
    held["whole trials"] = judge(made, splits, samples=None, published=published, across=across)
    rows = _learned_rows(trials, across)
    notes += made.notes
    if len({each.units_said for each in trials}) > 1:
        notes.append("some logs declare their units and others do not, which are taken for G and deg/s")
    regression = None
    if published:
        model: Any = made.fit_published(rows)
    else:
        targets, more = learnable(targets_of([trials[k].label for k in rows]))
        notes += more
        model = made.fit(rows, across=across)
        regression = Regression(model, targets)
        if model.at_rest is not None and not model.gate_is_safe:
            notes.append("some trials with contact are as much like rest as those without; contact will be mistaken at times: press harder")
    result = {
        "simulated": simulated,
        "method": args.method,
        "labels": {"file": args.labels.name, "sha256": hashlib.sha256(args.labels.read_bytes()).hexdigest()},
        "participants": list(dict.fromkeys(each.label.participant for each in trials)),
        "trials": len(rows),
        "classes": list(made.names),
        "rate_hz": made.rate_hz,
        "drive_hz": {"low": float(made.drive_hz.min()), "median": float(np.median(made.drive_hz)), "high": float(made.drive_hz.max())},
        "held_out": {"by": _split_by(trials, across), **{name: _facts(each) for name, each in held.items()}},
        "notes": notes,
    }
    kept = {key: result[key] for key in ("simulated", "labels", "participants", "trials", "held_out")}
    said = {trials[k].units_said for k in rows.tolist()}
    kept["units_said"] = said == {True}
    kept["readings"] = [view for k in rows.tolist() for view in kept_of(trials[k].values)]
    kept["learned"] = _learned_from(trials, rows.tolist())
    save_nail(args.output, NailFile(model, regression, kept))
    result["file"] = str(args.output)
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    steps.say(notes)
    for line in _lines(result, held):
        print(line)
    return 0


def _chosen(every: list[Trial], name: str | None) -> tuple[list[Trial], bool]:
    """The trials that are learned from, and whether they are of several participants."""
    from skinfab.errors import InputError

    there = list(dict.fromkeys(each.label.participant for each in every))
    if name is None and len(there) > 1:
        raise InputError(
            f"the trials are of {len(there)} participants ({', '.join(there)}), and fingers differ; choose with --participant, or all"
        )
    if name is None or name == "all":
        return every, len(there) > 1
    chosen = [each for each in every if each.label.participant == name]
    if not chosen:
        raise InputError(f"there is no participant {name!r}; there are {', '.join(map(repr, there))}")
    return chosen, False


def _learned_rows(trials: list[Trial], across: bool) -> Any:
    """The trials that the model in the file is learned from: never those of the test part."""
    import numpy as np

    test = np.array([each.label.part == "test" for each in trials])
    return np.flatnonzero(~test) if test.any() and not test.all() and not across else np.arange(len(trials))


def _learned_from(trials: list[Trial], rows: list[int]) -> dict[str, list[list[float]]]:
    """From when to when in which log, by its hash: these trials must not tell how good the model is."""
    out: dict[str, list[list[float]]] = {}
    for k in rows:
        out.setdefault(trials[k].sha256, []).append([trials[k].label.start_s, trials[k].label.end_s])
    return out


def _split_by(trials: list[Trial], across: bool) -> str:
    if across:
        return "participant"
    parts = {each.label.part for each in trials}
    return "test part of the table" if "test" in parts and len(parts) > 1 else "trial, in folds"


def _facts(held: Held) -> dict[str, Any]:
    import numpy as np

    from skinfab.fingertip.confusion import grouped_accuracy

    rate = grouped_accuracy(held.right, held.groups)
    return {
        **held.confusion.facts(),
        "accuracy": {"value": rate.value, "low": rate.low, "high": rate.high},
        **mean_errors(np.column_stack([held.angle_deg, held.place_mm, held.force_part])),
        "confidence": _confidence(held),
    }


def _confidence(held: Held) -> dict[str, float] | None:
    """Of the windows that were taken for contacts: how sure it was in the mean, and how many of them were right."""
    import numpy as np

    told = np.isfinite(held.confidence)
    return {"mean": float(held.confidence[told].mean()), "right": float(held.right[told].mean())} if told.any() else None


def _lines(result: dict[str, Any], held: dict[str, Held]) -> list[str]:
    made = " (simulated)" if result["simulated"] else ""
    who = ", ".join(each for each in result["participants"] if each) or "nobody named"
    drive = result["drive_hz"]
    lines = [
        f"{result['method']}{made}: {result['trials']} trials of {who}, {len(result['classes'])} classes; the motor turns at "
        f"{drive['median']:.1f} Hz ({drive['low']:.1f} to {drive['high']:.1f})",
        f"held out by {result['held_out']['by']}:",
    ]
    for name in held:
        facts = result["held_out"][name]
        rate = facts["accuracy"]
        line = f"  {name}: {100 * rate['value']:.1f} % right [{100 * rate['low']:.1f}, {100 * rate['high']:.1f}]"
        line += off_line(facts)
        if facts["confidence"]:
            line += f", confidence {facts['confidence']['mean']:.2f} where {facts['confidence']['right']:.2f} of the contacts are right"
        lines.append(line)
    if any("off by" in line for line in lines):
        lines.append("  (off from what the table says was touched: where a finger was aimed at, not where it came to lie)")
    if result["held_out"]["by"] != "participant":
        lines.append(f"  (of this finger, with the sensor as it sits; {_ANOTHER}: train a model for each person)")
    lines.append(f"wrote {result['file']}")
    return lines
