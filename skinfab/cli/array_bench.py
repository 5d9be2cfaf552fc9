"""`skinfab array bench -o DIR`: the published ways beside the improved ones, on simulated arrays."""

from __future__ import annotations

import argparse
from pathlib import Path

from skinfab.cli import steps
from skinfab.cli.measured import measured


def add_options(p: argparse.ArgumentParser) -> None:
    """How often what is timed is repeated, and where the results go."""
    p.add_argument("--repeats", metavar="K", type=steps.counting, default=3, help="of what is timed; the least time counts (default: 3)")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for tables, charts and a sentence")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Measure, write, and say what came out."""
    from skinfab.bench.array import run as bench

    return measured(args, lambda folder, progress: bench(folder, repeats=args.repeats, progress=progress), simulated=True)
