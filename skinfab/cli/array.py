"""`skinfab array simulate|train|run|bench`: a capacitive array of tactels round a fingertip."""

from __future__ import annotations

import argparse
import importlib

#: Sub-command and what it is for; `skinfab/cli/array_NAME.py` holds it.
STEPS = {
    "simulate": "logs of a simulated array, with what is true: presses, some that pull along the skin, rods, and a bar that is twirled",
    "train": "learn an array's gains and skin from presses at known places, and say how good that is on logs that were held out",
    "run": "where the finger is touched, how hard, along which line, and what moves, in a log or as a port sends it",
    "bench": "the published ways beside the improved ones, by density of the array",
}


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its steps."""
    p = subparsers.add_parser(
        "array",
        help="a capacitive array round a fingertip: places, forces, lines, slips",
        description="Capacitors under a skin of rubber, 8 rings by 8 stripes round a fingertip, tell where it is touched, how hard, "
        "which way a rod lies on it, and when something slips or rolls (docs/array.md).",
    )
    each = p.add_subparsers(metavar="STEP", required=True, title="steps")
    for name, summary in STEPS.items():
        q = each.add_parser(name, help=summary, description=f"{summary[0].upper()}{summary[1:]}.")
        importlib.import_module(f"skinfab.cli.array_{name}").add_options(q)
        q.set_defaults(wrong_usage=q.error, parser=q)
