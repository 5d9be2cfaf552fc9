"""`skinfab nail simulate|train|run|bench`: what a bare fingertip touches, by shaking its nail."""

from __future__ import annotations

import argparse
import importlib

#: Sub-command and what it is for; `skinfab/cli/nail_NAME.py` holds it.
STEPS = {
    "simulate": "logs with labels of simulated participants",
    "train": "learn one person's finger from logs with labels, and say how good it is on those that were held out",
    "run": "what is touched, in a log or as a port sends it",
    "bench": "the published method beside the improved one, on simulated participants",
}


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its steps."""
    p = subparsers.add_parser(
        "nail",
        help="what a bare fingertip touches, by shaking its nail",
        description="A motor shakes the fingernail, and a sensor beside it measures acceleration and angular velocity: from these "
        "follows which edge or pin the bare fingertip touches, where and how hard (docs/nail.md).",
    )
    each = p.add_subparsers(metavar="STEP", required=True, title="steps")
    for name, summary in STEPS.items():
        q = each.add_parser(name, help=summary, description=f"{summary[0].upper()}{summary[1:]}.")
        importlib.import_module(f"skinfab.cli.nail_{name}").add_options(q)
        q.set_defaults(wrong_usage=q.error, parser=q)
