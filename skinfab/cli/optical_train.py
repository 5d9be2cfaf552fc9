"""`skinfab optical train --targets targets.csv -o DIR`: an edge's pose from labelled images."""

from __future__ import annotations

import argparse
import hashlib
import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps

if TYPE_CHECKING:
    from skinfab.fingertip.optical.judge import Error
    from skinfab.fingertip.optical.targets import Columns, Targets

FILES = ("errors.csv", "model.npz", "result.json", "train.png")


def add_options(p: argparse.ArgumentParser) -> None:
    """The images, what the table's columns are called, and where the model goes."""
    p.add_argument("--targets", metavar="CSV", type=Path, required=True, help="a line an image: its name and where the edge was in it")
    p.add_argument("--images", metavar="DIR", type=Path, help="where the images lie (default: where the table names them)")
    p.add_argument("--image-column", metavar="NAME", default="image", help="of the image's name (default: image)")
    p.add_argument("--offset-column", metavar="NAME", default="offset_mm", help="mm off the plate (default: offset_mm)")
    p.add_argument("--depth-column", metavar="NAME", default="depth_mm", help="mm; may be missing (default: depth_mm)")
    p.add_argument("--angle-column", metavar="NAME", default="angle_deg", help="degrees (default: angle_deg)")
    p.add_argument("--group-column", metavar="NAME", default="group", help="the trial of an image; may be missing (default: group)")
    p.add_argument("--rest", metavar="IMAGE", type=Path, help="of the untouched fingertip (default: the pins' usual places)")
    p.add_argument("--count", metavar="N", type=steps.counting, help="learn from so many, drawn at random (default: from all)")
    p.add_argument("--seed", type=steps.seed, default=0, help="of the drawing (default: 0)")
    p.add_argument("--test-targets", metavar="CSV", type=Path, help="judge on these (default: on fifths of the groups, in turn)")
    p.add_argument("--test-images", metavar="DIR", type=Path, help="where those lie")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for the model, its errors and a figure")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Learn, judge, write, and say how good it is."""
    from skinfab.files import atomic_write, require_apart
    from skinfab.fingertip.optical.figure import draw_training
    from skinfab.fingertip.optical.judge import SURE, errors, guessed, held_out, off_by, said
    from skinfab.fingertip.optical.model_file import save_edge
    from skinfab.fingertip.optical.regress import Examples, learn
    from skinfab.fingertip.optical.seat import read_rest
    from skinfab.fingertip.optical.targets import fit_to_learn
    from skinfab.progress import terminal_progress
    from skinfab.staging import staged_folder

    if args.test_images is not None and args.test_targets is None:
        args.wrong_usage("--test-images goes with --test-targets CSV")
    inputs = [p for p in (args.targets, args.images, args.rest, args.test_targets, args.test_images) if p is not None]
    require_apart(args.output, FILES, inputs)
    with terminal_progress(quiet=args.json) as progress:
        progress(0.0, "reading")
        learned = fit_to_learn(_drawn(_read(args, args.targets, args.images), args.count, args.seed), _columns(args))
        rest = read_rest(args.rest, learned.images[0].shape) if args.rest else None
        examples = Examples.of(learned.images, learned.edges, rest=rest)
        progress(0.3, "learning")
        model = learn(examples, groups=learned.groups)
        progress(0.4, "judging")
        if args.test_targets is None:
            judged, by, seen = learned, "groups in fifths", examples
            edges = held_out(examples, learned.groups)
        else:
            judged, by = _read(args, args.test_targets, args.test_images), f"{args.test_targets.parent.name}/{args.test_targets.name}"
            _require_unseen(args, learned, judged)
            seen = Examples.of(judged.images, judged.edges, pins=model.pins)
            edges = said(model, seen)
        truth = seen.truth if seen.truth.shape[1] == examples.truth.shape[1] else seen.truth[:, :3]
        off, confidence = off_by(edges, truth), [edge.confidence for edge in edges]
        found = errors(off, judged.groups, guess=guessed(examples.truth[:, : truth.shape[1]], truth), confidence=confidence)
    sure = sum(each > SURE for each in confidence)
    result = _facts(args, learned, judged, found, by, sure) | {"pins": len(model.pins.rest), "gamma": model.gamma, "ridge": model.ridge}
    with staged_folder(args.output) as folder:
        save_edge(folder / "model.npz", model, {key: result[key] for key in ("simulated", "targets", "images", "held_out")})
        atomic_write(folder / "errors.csv", _table(found, result["simulated"]))
        atomic_write(folder / "result.json", json.dumps(result, indent=1, allow_nan=False) + "\n")
        draw_training(off, seen.truth, folder / "train.png", simulated=result["simulated"])
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    steps.say(result["notes"])
    made = " (simulated)" if result["simulated"] else ""
    print(f"{len(learned.images)} images{made} of {len(model.pins.rest)} pins; mean absolute error on what was held out ({by}):")
    for each in found:
        where = "" if each.sure is None else f"; {each.sure:.3g} where more than half sure"
        words = f"{each.mean:.3g} [{each.low:.3g}, {each.high:.3g}] {each.unit}, 95 % within {each.p95:.3g}{where}"
        print(f"  {each.quantity:6s} {words} (a guess: {each.guess:.3g})")
    print(f"  more than half sure of {sure} of {len(edges)}")
    print(f"{args.output}: {', '.join(FILES)}")
    return 0


def _read(args: argparse.Namespace, table: Path, folder: Path | None) -> Targets:
    from skinfab.fingertip.optical.targets import read_targets

    return read_targets(table, folder, columns=_columns(args))


def _columns(args: argparse.Namespace) -> Columns:
    from skinfab.fingertip.optical.targets import Columns

    return Columns(args.image_column, args.offset_column, args.angle_column, args.depth_column, args.group_column)


def _drawn(targets: Targets, count: int | None, seed: int) -> Targets:
    """Some of them: tables are often sorted by pose, so the first ones would be of one corner."""
    from dataclasses import replace

    import numpy as np

    from skinfab.errors import InputError

    if count is None:
        return targets
    if count > len(targets.names):
        raise InputError(f"--count asks for {count} images and there are {len(targets.names)}; ask for fewer")
    rows = np.random.default_rng(seed).permutation(len(targets.names))[:count].tolist()
    t = targets
    each = ([name[k] for k in rows] for name in (t.names, t.images, t.edges, t.groups))
    names, images, edges, groups = map(tuple, each)
    return replace(t, names=names, images=images, edges=edges, groups=groups)


def _require_unseen(args: argparse.Namespace, learned: Targets, judged: Targets) -> None:
    """An image that was learned from says nothing of others."""
    from skinfab.errors import InputError

    seen = {image.tobytes(): name for image, name in zip(learned.images, learned.names, strict=True)}
    for image, name in zip(judged.images, judged.names, strict=True):
        if other := seen.get(image.tobytes()):
            raise InputError(f"image {name} of {args.test_targets} is {other} of {args.targets}, which was learned from; leave it out")


def _facts(args: argparse.Namespace, learned: Targets, judged: Targets, found: Sequence[Error], by: str, sure: int) -> dict[str, Any]:
    notes = [
        f"{e.quantity}: {e.mean:.3g} {e.unit} off, and {e.guess:.3g} would be who says the same of every image: nothing was learned of it; "
        "look whether the table's columns and rows are those of the images"
        for e in found
        if e.chance
    ]
    return {
        "simulated": learned.simulated or judged.simulated,
        "targets": {"file": args.targets.name, "sha256": hashlib.sha256(args.targets.read_bytes()).hexdigest()},
        "images": len(learned.images),
        "groups": len(set(learned.groups)),
        "held_out": {"by": by, "images": len(judged.images), "sure": sure, "errors": [asdict(each) for each in found]},
        "notes": [*learned.notes, *notes],
    }


def _table(found: Sequence[Error], simulated: bool) -> str:
    lines = ["quantity,unit,mean,low,high,p95,guess,sure,images,simulated"]
    for e in found:
        sure = "" if e.sure is None else f"{e.sure:.6g}"
        numbers = ",".join(f"{value:.6g}" for value in (e.mean, e.low, e.high, e.p95, e.guess))
        lines.append(f"{e.quantity},{e.unit},{numbers},{sure},{e.images},{int(simulated)}")
    return "\n".join(lines) + "\n"
