"""`skinfab force simulate|train|run liquid`: whether a held cup holds a liquid, after it was stirred."""

from __future__ import annotations

import argparse
import csv
import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.cli.force_result import result_folder, told_as_json

if TYPE_CHECKING:
    from skinfab.fingertip.force.liquid import Stirred
    from skinfab.fingertip.force.liquid_model import LiquidModel
    from skinfab.fingertip.force.logs import WrenchLog

_TRAINED = ("model.npz", "result.json")
_RUN = ("liquid.csv", "liquid.png", "result.json")
_HEAD = ("log", "answer", "chance", "wander_mm", "period_s", "pivot_x_mm", "pivot_y_mm", "pivot_z_mm", "simulated")
#: A weight is at most so far from the hand's origin, mm, and at least so heavy, N.
_REACH_MM, _LEAST_N = 500.0, 0.3
#: A hand of which more than this part of the pieces swing beyond noise finds little.
_MOSTLY = 0.5
#: Water that swings in the simulated cups, g.
_WATER_G = (0, 20, 100)


def add_parsers(topics: Mapping[str, argparse._SubParsersAction[argparse.ArgumentParser]]) -> None:
    """Add the topic to its verbs."""
    from skinfab.cli.force import add_output, finish

    p = topics["simulate"].add_parser("liquid", help="cups with and without water, stirred and then held still")
    p.add_argument("--trials", metavar="N", type=steps.counting, default=2, help="of each cup and way to stir (default: 2)")
    p.add_argument("--seed", type=steps.seed, default=0, help="of all chance (default: 0)")
    p.add_argument("--seconds", metavar="S", type=_lasting, default=6.0, help="that a log lasts (default: 6)")
    add_output(p, "a log a trial")
    finish(p, simulate)

    p = topics["train"].add_parser("liquid", help="learn how much objects without a liquid swing in this hand")
    p.add_argument(
        "logs", metavar="LOG", nargs="+", type=Path, help="of empty cups and solid objects, held still; a grasp each, two or more"
    )
    p.add_argument(
        "--false-alarm",
        metavar="P",
        type=_chance,
        default=0.01,
        help="how often an object without a liquid may be taken for one with (default: 0.01)",
    )
    p.add_argument("--seconds", metavar="S", type=_lasting, default=6.0, help="so much of a log is judged (default: 6)")
    add_output(p, "the model and the result")
    finish(p, train)

    p = topics["run"].add_parser("liquid", help="say whether stirred cups hold a liquid")
    p.add_argument(
        "logs",
        metavar="LOG",
        nargs="+",
        type=Path,
        help="from when the stick was taken out, held still for 3 s or more: time, Fx, Fy, Fz (N), Mx, My, Mz (N mm) of the whole hand",
    )
    p.add_argument("--model", metavar="FILE", type=Path, help="model.npz of train; without it, what noise alone would do is the limit")
    add_output(p, "table, figure and result")
    finish(p, run)


def _lasting(text: str) -> float:
    value = steps.positive(text)
    if value < 3:
        raise argparse.ArgumentTypeError(f"{text} s is shorter than the 3 s that can be judged")
    return value


def _chance(text: str) -> float:
    value = steps.positive(text)
    if not value < 1:
        raise argparse.ArgumentTypeError(f"{text} is not below 1")
    return value


def simulate(args: argparse.Namespace) -> int:
    """Write a log a trial."""
    from skinfab.fingertip.force.liquid_simulator import WAYS, stir
    from skinfab.fingertip.force.logs import write_wrench
    from skinfab.staging import staged_folder

    files, labels = [], {}
    with staged_folder(args.output) as folder:
        for k, (way, grams) in enumerate((way, grams) for way in WAYS for grams in _WATER_G):
            for trial in range(args.trials):
                name = f"{way}-{grams}-g-{trial + 1}.csv"
                log = stir(water_kg=grams / 1000, way=way, seconds=args.seconds, seed=[args.seed, k, trial])
                write_wrench(replace(log, group=f"{way} {grams} g"), folder / name)
                files.append(str(args.output / name))
                labels[name] = log.label
    if args.json:
        print(json.dumps({"simulated": True, "files": files, "labels": labels}))
        return 0
    print(f"{args.output}: {len(files)} simulated logs of cups with {', '.join(map(str, _WATER_G))} g of water")
    return 0


def train(args: argparse.Namespace) -> int:
    """Learn the limit, judge it on recordings that were held out, and write the model."""
    from skinfab.files import require_apart
    from skinfab.fingertip.force.liquid_model import save_liquid, train_liquid
    from skinfab.fingertip.force.logs import once

    require_apart(args.output, _TRAINED, args.logs)
    logs, notes = _read(args.logs)
    logs, copies = once(logs)
    notes += copies
    trained = train_liquid(logs, false_alarm=args.false_alarm, seconds=args.seconds)
    made_from = [{"file": log.name, "sha256": log.sha256, "label": log.label, "simulated": log.simulated} for log in logs]
    simulated, model = any(log.simulated for log in logs), trained.model
    if trained.moving:
        notes.append(f"{trained.moving} of {model.pieces} pieces move without swinging, so the hand was not still there")
    if trained.strange:
        notes.append(
            f"{', '.join(trained.strange)} swing{'s' * (len(trained.strange) == 1)} as a liquid does, and was learned from since its label "
            "says that it holds none; less than that is not found any more"
        )
    if trained.plain > _MOSTLY:
        notes.append(
            f"{100 * trained.plain:.0f} % of the pieces would be taken for a liquid without learning: support the hand, or look whether "
            "they hold one"
        )
    result = {
        "simulated": simulated,
        "false_alarm": model.false_alarm,
        "limit": model.limit,
        "seconds": model.seconds,
        "pieces": model.pieces,
        "logs": trained.logs,
        "held_out_false_alarm": asdict(trained.held_out),
        "untaught_false_alarm": trained.plain,
        "limit_of": {"log": trained.limit_log, "wander_mm": trained.limit_mm, "middle_mm": trained.middle_mm},
        "strange": list(trained.strange),
        "made_from": made_from,
        "notes": notes,
    }
    with result_folder(args, result) as folder:
        save_liquid(trained, folder / "model.npz", made_from=made_from)
    if told_as_json(args, result):
        return 0
    made = " (simulated)" if simulated else ""
    print(
        f"{model.pieces} pieces of {trained.logs} recordings{made}: a chance below {model.limit:.2g} is a liquid; of recordings held out "
        f"{trained.held_out} were taken for one (wanted: {model.false_alarm:g}; without learning: {trained.plain:.3f})"
    )
    print(
        f"the limit is as strong a swing as in {trained.limit_log}, whose line wanders by {trained.limit_mm:.2g} mm (the middle one: "
        f"{trained.middle_mm:.2g}); of liquids that swing less, few are found"
    )
    print(f"{args.output}: {', '.join(_TRAINED)}")
    return 0


def _read(paths: Sequence[Path]) -> tuple[list[WrenchLog], list[str]]:
    """Logs whose moments are in N mm, and what to know of them."""
    from skinfab.fingertip.force.logs import read_wrench
    from skinfab.fingertip.force.wrench import require_nmm

    logs = [read_wrench(path) for path in paths]
    for log in logs:
        if not log.units_said:
            require_nmm(log.force, log.moment, reach_mm=_REACH_MM, least_force=_LEAST_N, where=log.name)
    return logs, [note for log in logs for note in log.notes]


def run(args: argparse.Namespace) -> int:
    """Judge each log."""
    from skinfab.files import require_apart
    from skinfab.fingertip.force.liquid import FALSE_ALARM, stirred
    from skinfab.fingertip.force.liquid_figure import draw_paths
    from skinfab.fingertip.force.liquid_model import load_liquid

    require_apart(args.output, _RUN, [*args.logs, *([args.model] if args.model else [])])
    model: LiquidModel | None
    model, simulated_model = load_liquid(args.model) if args.model else (None, False)
    logs, notes = _read(args.logs)
    found = [stirred(log) if model is None else model.judge(log) for log in logs]
    simulated = simulated_model or any(log.simulated for log in logs)
    if simulated_model and not all(log.simulated for log in logs):
        notes.append("the model was learned from simulated recordings; what it says of real ones is not to be relied on")
    result: dict[str, Any] = {
        "simulated": simulated,
        "false_alarm": model.false_alarm if model else FALSE_ALARM,
        "limit": model.limit if model else FALSE_ALARM,
        "learned": model is not None,
        "cups": [_facts(log, each) for log, each in zip(logs, found, strict=True)],
        "notes": notes,
    }
    with result_folder(args, result) as folder:
        (folder / "liquid.csv").write_text(_csv(result["cups"]))
        draw_paths([(log.name, each) for log, each in zip(logs, found, strict=True)], folder / "liquid.png", simulated=simulated)
    if told_as_json(args, result):
        return 0
    for log, each in zip(logs, found, strict=True):
        swings = f", swings with a period of {each.period_s:.2f} s" if each.liquid else ""
        still = "; a liquid cannot be told: hold still after stirring" if each.moves else ""
        made = " (simulated)" if log.simulated else ""
        print(f"{log.name}{made}: {each.answer}{still}; its line wanders by {each.wander_mm:.2f} mm{swings}")
    print(f"{args.output}: {', '.join(_RUN)}")
    return 0


def _csv(cups: Sequence[Mapping[str, Any]]) -> str:
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(_HEAD)
    for each in cups:
        period = "" if each["period_s"] is None else f"{each['period_s']:.4g}"
        pivot = [f"{x:.5g}" for x in each["pivot_mm"] or ()] or [""] * 3
        rows.writerow(
            [each["log"], each["answer"], f"{each['chance']:.3g}", f"{each['wander_mm']:.4g}", period, *pivot, int(each["simulated"])]
        )
    return text.getvalue()


def _facts(log: WrenchLog, each: Stirred) -> dict[str, Any]:
    import numpy as np

    return {
        "log": log.name,
        "sha256": log.sha256,
        "simulated": log.simulated,
        "label": log.label or None,
        "answer": each.answer,
        "liquid": each.liquid,
        "chance": each.chance,
        "wander_mm": each.wander_mm,
        "period_s": each.period_s if each.liquid else None,
        "pivot_mm": each.pivot.tolist() if np.isfinite(each.pivot).all() else None,
    }
