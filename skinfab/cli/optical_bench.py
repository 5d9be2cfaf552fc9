"""`skinfab optical bench -o DIR`: the published way of following an edge beside the improved one, on a simulated fingertip."""

from __future__ import annotations

import argparse
from pathlib import Path

from skinfab.cli import steps
from skinfab.cli.measured import measured


def add_options(p: argparse.ArgumentParser) -> None:
    """How many contours are followed, and where the results go."""
    p.add_argument(
        "--seeds", metavar="N", type=steps.counting, default=20, help="contours a point, and a shape by the improved way (default: 20)"
    )
    p.add_argument("--runs", metavar="N", type=steps.counting, default=5, help="round each of the seed's shapes as published (default: 5)")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for tables, charts and a sentence")
    p.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Measure, write, and say what came out."""
    from skinfab.bench.optical import run as bench

    return measured(args, lambda folder, progress: bench(folder, seeds=args.seeds, runs=args.runs, progress=progress), simulated=True)
