"""`skinfab force simulate|train|run texture`: what the fingertip slides over."""

from __future__ import annotations

import argparse
import csv
import io
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from skinfab.cli import steps
from skinfab.cli.force_result import result_folder, told_as_json

if TYPE_CHECKING:
    from skinfab.fingertip.force.logs import WrenchLog
    from skinfab.fingertip.force.texture import Slide
    from skinfab.fingertip.force.texture_model import Decision

_TRAINED = ("model.npz", "confusion.png", "result.json")
_RUN = ("texture.csv", "texture.png", "result.json")


def add_parsers(topics: Mapping[str, argparse._SubParsersAction[argparse.ArgumentParser]]) -> None:
    """Add the topic to its verbs."""
    from skinfab.cli.force import add_output, finish

    p = topics["simulate"].add_parser("texture", help="slides over the paper's six materials")
    p.add_argument("--specimens", metavar="N", type=steps.counting, default=6, help="of each material (default: 6)")
    p.add_argument("--slides", metavar="N", type=steps.counting, default=6, help="over each specimen (default: 6)")
    p.add_argument("--seed", type=steps.seed, default=0, help="of all chance (default: 0)")
    add_output(p, "a log a slide")
    finish(p, simulate)

    p = topics["train"].add_parser("texture", help="learn textures from labelled slides")
    _add_logs(p)
    p.add_argument("--labels", metavar="FILE", type=Path, help="CSV of log,label,group, for logs that do not say it themselves")
    p.add_argument("--features", choices=("bands", "published"), default="bands", help="bands (default), or the paper's nine")
    p.add_argument("--seed", type=steps.seed, default=0, help="of what is held out when (default: 0)")
    add_output(p, "the model, what it took for what, and the result")
    finish(p, train)

    p = topics["run"].add_parser("texture", help="say which texture logs were taken of")
    _add_logs(p)
    p.add_argument("--model", metavar="FILE", type=Path, required=True, help="model.npz of train")
    add_output(p, "table, figure and result")
    finish(p, run)


def _add_logs(p: argparse.ArgumentParser) -> None:
    p.add_argument("logs", metavar="LOG", nargs="+", type=Path, help="slides: columns time, Fx, Fy, Fz (N), Mx, My, Mz (N mm)")


def simulate(args: argparse.Namespace) -> int:
    """Write a log a slide."""
    from skinfab.fingertip.force.logs import write_wrench
    from skinfab.fingertip.force.simulator import texture_logs
    from skinfab.staging import staged_folder

    logs = texture_logs(specimens=args.specimens, slides=args.slides, seed=args.seed)
    names = [f"{log.name.replace(chr(39), '').replace(' ', '-')}.csv" for log in logs]
    with staged_folder(args.output) as folder:
        for name, log in zip(names, logs, strict=True):
            write_wrench(log, folder / name)
    result = {
        "simulated": True,
        "files": [str(args.output / name) for name in names],
        "labels": {name: log.label for name, log in zip(names, logs, strict=True)},
        "groups": {name: log.group for name, log in zip(names, logs, strict=True)},
    }
    if args.json:
        print(json.dumps(result))
        return 0
    materials = len({log.label for log in logs})
    print(f"{args.output}: {len(logs)} simulated slides over {args.specimens} specimens of {materials} materials")
    return 0


def train(args: argparse.Namespace) -> int:
    """Learn, judge on specimens that were held out, and write the model."""
    from skinfab.files import require_apart
    from skinfab.fingertip.force.labels import require_labels, with_labels
    from skinfab.fingertip.force.texture_model import save_texture, train_texture

    require_apart(args.output, _TRAINED, [*args.logs, *([args.labels] if args.labels else [])])
    logs, slides, notes = _read(args.logs, quiet=args.json)
    if args.labels:
        logs = with_labels(logs, args.labels)
    require_labels(logs)
    trained = train_texture(slides, [log.label for log in logs], [log.group for log in logs], features=args.features, seed=args.seed)
    made_from = [
        {"file": log.name, "sha256": log.sha256, "label": log.label, "group": log.group, "simulated": log.simulated} for log in logs
    ]
    simulated = any(log.simulated for log in logs)
    result = {
        "simulated": simulated,
        "features": args.features,
        "logs": len(logs),
        "groups": trained.groups,
        "held_out": trained.confusion.facts() | {"accuracy": asdict(trained.accuracy)},
        "accuracy_of_a_random_split": trained.ungrouped,
        "made_from": made_from,
        "notes": notes,
    }
    with result_folder(args, result) as folder:
        save_texture(trained, folder / "model.npz", made_from=made_from)
        trained.confusion.draw(folder / "confusion.png", title="Textures held out", simulated=simulated)
    if told_as_json(args, result):
        return 0
    print(
        f"{len(logs)} slides of {len(trained.confusion.names)} materials{_made(simulated)}: {trained.accuracy} right on specimens held out"
    )
    print(f"{args.output}: {', '.join(_TRAINED)}")
    return 0


def run(args: argparse.Namespace) -> int:
    """Say which texture each log was taken of."""
    from skinfab.files import require_apart
    from skinfab.fingertip.force.texture_figure import draw_slides
    from skinfab.fingertip.force.texture_model import load_texture

    require_apart(args.output, _RUN, [*args.logs, args.model])
    model, simulated_model = load_texture(args.model)
    logs, slides, decisions, notes, failed = _decided(args.logs, model.decide, quiet=args.json)
    notes += [
        f"{log.name}: slides for {len(each.normal) / each.rate_hz:.1f} s, {d.windows} window{'s' * (d.windows > 1)} of its spectrum: of "
        f"held-out slides so short {100 * d.right:.0f} % were told right, of whole ones {100 * model.lengths[-1].right:.0f} %"
        for log, each, d in zip(logs, slides, decisions, strict=True)
        if d.short
    ]
    simulated = simulated_model or any(log.simulated for log in logs)
    if simulated_model and not all(log.simulated for log in logs):
        notes.append("the model was learned from simulated slides; what it says of real ones is not to be relied on")
    result = {
        "simulated": simulated,
        "decisions": [
            {
                "log": log.name,
                "simulated": log.simulated,
                "texture": d.name,
                "nearest": d.nearest,
                "probability": d.probability if d.known else None,
                "probabilities": d.probabilities if d.known else None,
                "label": log.label or None,
                "samples": len(each.normal),
                "windows": d.windows,
                "right_at_this_length": d.right,
            }
            for log, each, d in zip(logs, slides, decisions, strict=True)
        ],
        "failed": failed,
        "notes": notes,
    }
    with result_folder(args, result) as folder:
        (folder / "texture.csv").write_text(_table(logs, decisions))
        draw_slides(logs, slides, decisions, folder / "texture.png", simulated=simulated)
    if told_as_json(args, result):
        return 1 if failed else 0
    for log, d in zip(logs, decisions, strict=True):
        print(
            f"{log.name}{_made(log.simulated)}: {d.name}"
            + (f" (like no known one; nearest {d.nearest})" if not d.known else f", {d.probability:.2f}")
        )
    print(f"{args.output}: {', '.join(_RUN)}")
    steps.say([why if name in why else f"{name}: {why}" for name, why in failed.items()], kind="failed")
    return 1 if failed else 0


def _read(paths: Sequence[Path], *, quiet: bool) -> tuple[list[WrenchLog], list[Slide], list[str]]:
    from skinfab.progress import terminal_progress

    _require_names(paths)
    logs, slides = [], []
    with terminal_progress(quiet=quiet) as progress:
        for k, path in enumerate(paths):
            progress(k / len(paths), path.name)
            log, part = _read_one(path)
            logs.append(log)
            slides.append(part)
        progress(1.0, "done")
    return logs, slides, [note for log, part in zip(logs, slides, strict=True) for note in (*log.notes, *part.notes)]


def _decided(
    paths: Sequence[Path], decide: Callable[[Slide], Decision], *, quiet: bool
) -> tuple[list[WrenchLog], list[Slide], list[Decision], list[str], dict[str, str]]:
    """As `_read`, but logs that cannot be decided on are told by name, and stop no others.

    Raises
    ------
    InputError
        None of them can be.
    """
    from skinfab.errors import InputError
    from skinfab.progress import terminal_progress

    _require_names(paths)
    logs, slides, decisions, notes = [], [], [], []
    failed: dict[str, str] = {}
    with terminal_progress(quiet=quiet) as progress:
        for k, path in enumerate(paths):
            progress(k / len(paths), path.name)
            try:
                log, part = _read_one(path)
                decisions.append(decide(part))
            except InputError as fault:
                failed[path.name] = str(fault)
                continue
            logs.append(log)
            slides.append(part)
            notes += [*log.notes, *part.notes]
        progress(1.0, "done")
    if not logs:
        name, why = next(iter(failed.items()))
        raise InputError((why if name in why else f"{name}: {why}") + (f" (and {len(failed) - 1} more failed)" if len(failed) > 1 else ""))
    return logs, slides, decisions, notes, failed


def _read_one(path: Path) -> tuple[WrenchLog, Slide]:
    from skinfab.fingertip.force.logs import read_wrench
    from skinfab.fingertip.force.poses import require_alive
    from skinfab.fingertip.force.texture import sliding_part

    log = read_wrench(path)
    require_alive(log)
    return log, sliding_part(log)


def _require_names(paths: Sequence[Path]) -> None:
    from skinfab.errors import InputError

    names = [path.name for path in paths]
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise InputError(f"two logs are called {twice}; give each file a name of its own")


def _table(logs: Sequence[WrenchLog], decisions: Sequence[Decision]) -> str:
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["log", "texture", "nearest", "probability", "label", "simulated"])
    for log, d in zip(logs, decisions, strict=True):
        rows.writerow([log.name, d.name, d.nearest, f"{d.probability:.4f}" if d.known else "", log.label, int(log.simulated)])
    return text.getvalue()


def _made(simulated: bool) -> str:
    return " (simulated)" if simulated else ""
