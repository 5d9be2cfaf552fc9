"""`skinfab nail bench -o DIR`: the paper's three tests on simulated participants."""

from __future__ import annotations

import argparse
from pathlib import Path

from skinfab.cli import steps
from skinfab.cli.measured import measured


def add_options(p: argparse.ArgumentParser) -> None:
    """How much is simulated, and where to."""
    p.add_argument("--participants", metavar="N", type=steps.counting, default=10, help="from 3 up (default: 10, the paper's)")
    p.add_argument("--training", metavar="N", type=steps.counting, default=5, help="trials to learn from, of each class (default: 5)")
    p.add_argument("--rounds", metavar="N", type=steps.counting, default=10, help="of each test (default: 10)")
    p.add_argument("--estimates", metavar="N", type=steps.counting, default=10, help="windows of a trial (default: 10)")
    p.add_argument("--seed", type=steps.seed, default=0, help="of the participants (default: 0)")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for tables, charts and a sentence")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Simulate, judge, write, and say what came out."""
    if args.participants < 3:
        args.wrong_usage(f"--participants {args.participants}: conditions cannot be compared on fewer than 3")
    from skinfab.bench.nail import run as bench
    from skinfab.fingertip.nail.protocol import Protocol

    protocol = Protocol(args.participants, args.training, args.rounds, args.estimates)
    return measured(args, lambda folder, progress: bench(folder, protocol=protocol, seed=args.seed, progress=progress))
