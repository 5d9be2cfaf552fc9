"""`skinfab force simulate|train|run shape`: what solid a hand holds, by four contacts, and how large it is."""

from __future__ import annotations

import argparse
import csv
import io
import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.cli.force_result import result_folder, told_as_json

if TYPE_CHECKING:
    from skinfab.fingertip.force.grasp import Grasp
    from skinfab.fingertip.force.shape import Decision
    from skinfab.fingertip.force.shape_figure import View

_TRAINED = ("model.npz", "confusion.png", "result.json")
_RUN = ("shapes.csv", "shape.png", "result.json")
_HEAD = ("log", "object", "shape", "confidence", "grasps", "sure", "size_1", "size_2", "size_3", "x_mm", "y_mm", "z_mm", "simulated")


def add_parsers(topics: Mapping[str, argparse._SubParsersAction[argparse.ArgumentParser]]) -> None:
    """Add the topic to its verbs."""
    from skinfab.cli.force import add_output, finish

    p = topics["simulate"].add_parser("shape", help="grasps of spheres, cylinders and cuboids by a four-fingered hand")
    p.add_argument("--grasps", metavar="N", type=steps.counting, default=15, help="of each object (default: 15)")
    p.add_argument("--seed", type=steps.seed, default=0, help="of all chance (default: 0)")
    add_output(p, "grasps.csv (six objects to learn from), new.csv (three others) and held.csv (the paper's three, in ten poses)")
    finish(p, simulate)

    p = topics["train"].add_parser("shape", help="learn shapes from labelled grasps")
    _add_logs(p)
    p.add_argument(
        "--features", choices=("misfits", "pose-free", "published"), default="misfits", help="misfits (default), or others to compare"
    )
    p.add_argument("--seed", type=steps.seed, default=0, help="of the first weights (default: 0)")
    add_output(p, "the model, what it took for what, and the result")
    finish(p, train)

    p = topics["run"].add_parser("shape", help="say what is held, or that it must be grasped again, and how large it is")
    _add_logs(p)
    p.add_argument("--model", metavar="FILE", type=Path, required=True, help="model.npz of train")
    p.add_argument("--confidence", metavar="P", type=_probability, default=0.9, help="less is a reason to grasp again (default: 0.9)")
    add_output(p, "table, figure and result")
    finish(p, run)


def _add_logs(p: argparse.ArgumentParser) -> None:
    p.add_argument("logs", metavar="LOG", nargs="+", type=Path, help="grasps as CSV: a row a pose, columns as in docs/force.md")


def _probability(text: str) -> float:
    value = steps.not_negative(text)
    if not value < 1:
        raise argparse.ArgumentTypeError(f"{text} is not below 1, which nothing reaches")
    return value


def simulate(args: argparse.Namespace) -> int:
    """Write grasps to learn from, others to judge on, and some to reconstruct."""
    import numpy as np

    from skinfab.fingertip.force.grasp import CUBOID, LEARNED, NEW, OVER, PAPER, ROUND, simulate_grasp
    from skinfab.fingertip.force.grasp_file import write_grasps
    from skinfab.fingertip.force.shape import MOST_GRASPS
    from skinfab.staging import staged_folder

    rng = np.random.default_rng(args.seed)
    sets = {
        "grasps.csv": [simulate_grasp(o, seed=rng, number=k) for k, o in enumerate(LEARNED) for _ in range(args.grasps)],
        "new.csv": [simulate_grasp(o, seed=rng, number=100 + k) for k, o in enumerate(NEW) for _ in range(args.grasps)],
        "held.csv": [
            simulate_grasp(o, seed=rng, number=200 + k, poses=10, fingers=OVER if o.shape == CUBOID else ROUND)
            for k, o in enumerate(PAPER)
            for _ in range(MOST_GRASPS)
        ],
    }
    with staged_folder(args.output) as folder:
        for name, grasps in sets.items():
            write_grasps(grasps, folder / name)
    files = [str(args.output / name) for name in sets]
    if args.json:
        print(json.dumps({"simulated": True, "files": files, "grasps": {name: len(each) for name, each in sets.items()}}))
    else:
        print(f"{args.output}: {', '.join(f'{name} ({len(each)} simulated grasps)' for name, each in sets.items())}")
    return 0


def train(args: argparse.Namespace) -> int:
    """Learn, judge on objects that were held out, and write the model."""
    from skinfab.files import require_apart
    from skinfab.fingertip.force.shape_study import examples, train_shapes

    require_apart(args.output, _TRAINED, args.logs)
    grasps = [each for _, read in _read(args.logs) for each in read]
    simulated = any(each.simulated for each in grasps)
    of = examples(grasps)
    model, held = train_shapes(of, args.features, seed=args.seed)
    model.facts["simulated"] = simulated
    rate = held.accuracy
    answered, right = held.rejection([0.9])[0]
    result = {
        "simulated": simulated,
        "features": args.features,
        "grasps": len(of.found),
        "objects": len(set(of.object.tolist())),
        "held_out": {"accuracy": rate.value, "low": rate.low, "high": rate.high, "split": "each object in turn"},
        "at_confidence_0.9": {"answered": answered, "right": right if math.isfinite(right) else None},
        "confusion": held.confusion.facts(),
        "notes": list(of.notes),
    }
    with result_folder(args, result) as folder:
        model.save(folder / "model.npz")
        held.confusion.draw(folder / "confusion.png", title=f"shapes by {args.features}, new objects", simulated=simulated)
    if told_as_json(args, result):
        return 0
    made = " (simulated)" if simulated else ""
    print(f"{len(of.found)} grasps of {result['objects']} objects{made}: {rate} right on objects held out")
    print(f"{args.output}: {', '.join(_TRAINED)}")
    return 0


def run(args: argparse.Namespace) -> int:
    """Decide on each object, grasp after grasp, and reconstruct it."""
    from skinfab.files import require_apart
    from skinfab.fingertip.force.shape import ShapeModel, decide
    from skinfab.fingertip.force.shape_figure import draw_solids

    require_apart(args.output, _RUN, [*args.logs, args.model])
    model = ShapeModel.load(args.model)
    facts, views, notes = [], [], []
    for path, grasps in _read(args.logs):
        for number in dict.fromkeys(each.object for each in grasps):
            of = [each for each in grasps if each.object == number]
            decision = decide(model, of, confidence=args.confidence)
            fact, view, note = _solved(path.name, number, of, decision)
            facts.append(fact)
            views.append(view)
            notes += note
    simulated = bool(model.facts.get("simulated")) or any(fact["simulated"] for fact in facts)
    result = {"simulated": simulated, "features": model.features, "confidence": args.confidence, "objects": facts, "notes": notes}
    with result_folder(args, result) as folder:
        (folder / "shapes.csv").write_text(_csv(facts))
        draw_solids(views, folder / "shape.png")
    if told_as_json(args, result):
        return 0
    for fact in facts:
        print(_line(fact))
    print(f"{args.output}: {', '.join(_RUN)}")
    return 0


def _read(paths: Sequence[Path]) -> list[tuple[Path, list[Grasp]]]:
    from skinfab.errors import InputError
    from skinfab.fingertip.force.grasp_file import read_grasps

    read = [(path, read_grasps(path)) for path in paths]
    seen: dict[int, Path] = {}
    for path, grasps in read:
        for number in {each.object for each in grasps}:
            if seen.setdefault(number, path) != path:
                raise InputError(f"object {number} is in {seen[number]} and in {path}; give each object a number of its own")
    return read


def _solved(log: str, number: int, grasps: Sequence[Grasp], decision: Decision) -> tuple[dict[str, Any], View, list[str]]:
    """What is known of an object, how it is drawn, and what stood in the way."""
    import numpy as np

    from skinfab.errors import SkinfabError
    from skinfab.fingertip.force.grasp import CUBOID, total_wrench, touches
    from skinfab.fingertip.force.gravity import centre_of_gravity, require_certain
    from skinfab.fingertip.force.reconstruct import reconstruct
    from skinfab.fingertip.force.shape import NONE
    from skinfab.fingertip.force.shape_figure import View

    sound = [(each, found) for each in grasps if not (found := touches(each)).fault]
    grasp, found = sound[decision.grasps - 1]  # the one that decided
    notes, centre, solved = [], None, None
    if len(grasp.force) > 1:
        try:
            wrench = total_wrench(grasp)
            estimate = centre_of_gravity(*wrench)
            require_certain(estimate, wrench[0])
            centre = estimate.point
        except SkinfabError as fault:
            notes.append(f"{log}, object {number}: {fault}")
    if decision.sure and (decision.shape != CUBOID or centre is not None):
        solved = reconstruct(found, decision.shape, centre)
    elif decision.sure and not notes:
        notes.append(f"{log}, object {number}: a cuboid's size needs its centre of gravity: hold it in three poses or more")
    size = [round(x, 3) if np.isfinite(x) else None for x in solved.size] if solved else []
    said = (
        f"{decision.shape}, {decision.confidence:.2f}"
        if decision.sure
        else "none of these shapes"
        if decision.shape == NONE
        else "unclear: grasp again"
    )
    told = " x ".join("?" if x is None else f"{x:.1f}" for x in size)
    title = f"{log}, object {number}\n{said}{', ' + told + ' mm' if told else ''}"
    fact = {
        "log": log,
        "object": number,
        "shape": decision.shape,
        "confidence": decision.confidence,
        "grasps": decision.grasps,
        "given": len(grasps),
        "sure": decision.sure,
        "size_mm": size,
        "centre_mm": [round(float(x), 3) for x in solved.centre] if solved else None,
        "simulated": grasp.simulated,
    }
    return fact, View(title, found, solved, centre, grasp.simulated), notes


def _csv(facts: Sequence[Mapping[str, Any]]) -> str:
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(_HEAD)
    for each in facts:
        size = ["" if x is None else f"{x:g}" for x in each["size_mm"]]
        where = [f"{x:g}" for x in each["centre_mm"]] if each["centre_mm"] else ["", "", ""]
        first = [each["log"], each["object"], each["shape"], f"{each['confidence']:.4f}", each["grasps"], int(each["sure"])]
        rows.writerow([*first, *size, *[""] * (3 - len(size)), *where, int(each["simulated"])])
    return text.getvalue()


def _line(fact: Mapping[str, Any]) -> str:
    from skinfab.fingertip.force.shape import NONE

    size = " x ".join("?" if x is None else f"{x:.1f}" for x in fact["size_mm"])
    made = " (simulated)" if fact["simulated"] else ""
    many = f"{fact['grasps']} grasp{'s' if fact['grasps'] > 1 else ''}"
    if fact["sure"] and fact["grasps"] < fact["given"]:
        many = f"sure after {fact['grasps']} of {fact['given']} grasps"
    if fact["shape"] == NONE:
        said = f"none of these shapes, by {many}; look at the units (mm, rad, N, N mm), or it is another one or smaller than learned from"
        return f"{fact['log']}, object {fact['object']}{made}: {said}"
    if not fact["sure"]:
        return (
            f"{fact['log']}, object {fact['object']}{made}: unclear after {many} ({fact['shape']}, {fact['confidence']:.2f}); grasp again"
        )
    said = f"{fact['shape']} ({fact['confidence']:.2f}, {many})"
    return f"{fact['log']}, object {fact['object']}{made}: {said}{', ' + size + ' mm' if size else ''}"
