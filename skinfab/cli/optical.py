"""`skinfab optical simulate|train|run|bench`: a camera in a soft fingertip, which sees the pins of its skin lean."""

from __future__ import annotations

import argparse
import importlib

#: Sub-command and what it is for; `skinfab/cli/optical_NAME.py` holds it.
STEPS = {
    "simulate": "images of a simulated fingertip on an edge, with the edge's true pose",
    "train": "learn an edge's pose from labelled images, and say how good that is on images that were held out",
    "run": "the edge in each image of a folder, of a video or of a camera",
    "bench": "the published way of following an edge beside the improved one, by step and by noise",
}


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its steps."""
    p = subparsers.add_parser(
        "optical",
        help="an optical fingertip: edges by the pins of its skin",
        description="A camera watches the pins inside a soft dome; where they lean tells the edge of the plate that the dome is pressed "
        "on, and the edge can be followed all round (docs/optical.md).",
    )
    each = p.add_subparsers(metavar="STEP", required=True, title="steps")
    for name, summary in STEPS.items():
        q = each.add_parser(name, help=summary, description=f"{summary[0].upper()}{summary[1:]}.")
        importlib.import_module(f"skinfab.cli.optical_{name}").add_options(q)
        q.set_defaults(wrong_usage=q.error, parser=q)
