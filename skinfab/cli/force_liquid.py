"""`skinfab force simulate|run liquid`: whether a held cup holds a liquid, after it was stirred."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.cli.bench import repeats

if TYPE_CHECKING:
    from skinfab.fingertip.force.liquid import Stirred
    from skinfab.fingertip.force.logs import WrenchLog

_RUN = ("liquid.png", "result.json")
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
        help="from when the stick was taken out, held still for 2 s or more: time, Fx, Fy, Fz (N), Mx, My, Mz (N mm) of the whole hand",
    )
    add_output(p, "figure and result")
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
    from skinfab.staging import staged_folder

    require_apart(args.output, _RUN, args.logs)
    logs = [read_wrench(path) for path in args.logs]
    found = [stirred(log) for log in logs]
    notes = [note for log in logs for note in log.notes]
    simulated = any(log.simulated for log in logs)
    result = {
        "simulated": simulated,
        "false_alarm": FALSE_ALARM,
        "cups": [_facts(log, each) for log, each in zip(logs, found, strict=True)],
        "notes": notes,
    }
    with staged_folder(args.output) as folder:
        draw_paths([(log.name, each) for log, each in zip(logs, found, strict=True)], folder / "liquid.png", simulated=simulated)
        (folder / "result.json").write_text(json.dumps(result, indent=1, allow_nan=False) + "\n")
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    steps.say(notes)
    for log, each in zip(logs, found, strict=True):
        swings = f", swings with a period of {each.period_s:.2f} s" if each.liquid else ""
        print(f"{log.name}{' (simulated)' if log.simulated else ''}: {_word(each)}; its line wanders by {each.wander_mm:.2f} mm{swings}")
    print(f"{args.output}: {', '.join(_RUN)}")
    return 0


def _word(each: Stirred) -> str:
    return "liquid" if each.liquid else "solid or empty"


def _facts(log: WrenchLog, each: Stirred) -> dict[str, Any]:
    import numpy as np

    return {
        "log": log.name,
        "sha256": log.sha256,
        "simulated": log.simulated,
        "label": log.label or None,
        "liquid": each.liquid,
        "chance": each.chance,
        "wander_mm": each.wander_mm,
        "period_s": each.period_s if each.liquid else None,
        "pivot_mm": each.pivot.tolist() if np.isfinite(each.pivot).all() else None,
    }
