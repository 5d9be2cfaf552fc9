"""`skinfab force simulate|run liquid`: whether a held cup holds a liquid, after it was stirred."""

from __future__ import annotations

import argparse
import csv
import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.cli.bench import repeats

if TYPE_CHECKING:
    from skinfab.fingertip.force.liquid import Stirred
    from skinfab.fingertip.force.logs import WrenchLog

_RUN = ("liquid.csv", "liquid.png", "result.json")
_HEAD = ("log", "answer", "chance", "wander_mm", "period_s", "pivot_x_mm", "pivot_y_mm", "pivot_z_mm", "simulated")
#: A weight is at most so far from the hand's origin, mm, and at least so heavy, N.
_REACH_MM, _LEAST_N = 500.0, 0.3
#: Water that swings in the simulated cups, g.
_WATER_G = (0, 20, 100)


def add_parsers(topics: Mapping[str, argparse._SubParsersAction[argparse.ArgumentParser]]) -> None:
    """Add the topic to its verbs."""
    from skinfab.cli.force import add_output, finish

    p = topics["simulate"].add_parser("liquid", help="cups with and without water, stirred and then held still")
    p.add_argument("--trials", metavar="N", type=repeats, default=2, help="of each cup and way to stir (default: 2)")
    p.add_argument("--seed", type=steps.seed, default=0, help="of all chance (default: 0)")
    add_output(p, "a log a trial")
    finish(p, simulate)

    p = topics["run"].add_parser("liquid", help="say whether stirred cups hold a liquid")
    p.add_argument(
        "logs",
        metavar="LOG",
        nargs="+",
        type=Path,
        help="from when the stick was taken out, held still for 3 s or more: time, Fx, Fy, Fz (N), Mx, My, Mz (N mm) of the whole hand",
    )
    add_output(p, "table, figure and result")
    finish(p, run)


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
                log = stir(water_kg=grams / 1000, way=way, seed=[args.seed, k, trial])
                write_wrench(replace(log, group=f"{way} {grams} g"), folder / name)
                files.append(str(args.output / name))
                labels[name] = log.label
    if args.json:
        print(json.dumps({"simulated": True, "files": files, "labels": labels}))
        return 0
    print(f"{args.output}: {len(files)} simulated logs of cups with {', '.join(map(str, _WATER_G))} g of water")
    return 0


def run(args: argparse.Namespace) -> int:
    """Judge each log."""
    from skinfab.files import require_apart
    from skinfab.fingertip.force.liquid import FALSE_ALARM, stirred
    from skinfab.fingertip.force.liquid_figure import draw_paths
    from skinfab.fingertip.force.logs import read_wrench
    from skinfab.fingertip.force.wrench import require_nmm
    from skinfab.staging import staged_folder

    require_apart(args.output, _RUN, args.logs)
    logs = [read_wrench(path) for path in args.logs]
    for log in logs:
        if not log.units_said:
            require_nmm(log.force, log.moment, reach_mm=_REACH_MM, least_force=_LEAST_N, where=log.name)
    found = [stirred(log) for log in logs]
    notes = [note for log in logs for note in log.notes]
    simulated = any(log.simulated for log in logs)
    result: dict[str, Any] = {
        "simulated": simulated,
        "false_alarm": FALSE_ALARM,
        "cups": [_facts(log, each) for log, each in zip(logs, found, strict=True)],
        "notes": notes,
    }
    with staged_folder(args.output) as folder:
        (folder / "liquid.csv").write_text(_csv(result["cups"]))
        draw_paths([(log.name, each) for log, each in zip(logs, found, strict=True)], folder / "liquid.png", simulated=simulated)
        (folder / "result.json").write_text(json.dumps(result, indent=1, allow_nan=False) + "\n")
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    steps.say(notes)
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
