"""`skinfab batch FILE.toml -o DIR`: `skinfab make` for many meshes times many settings, each once, whatever breaks off."""

from __future__ import annotations

import argparse
import json
import os
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from skinfab.cli import steps
from skinfab.errors import InputError, RefusedError

if TYPE_CHECKING:
    from skinfab.batch.run import Outcome


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "batch",
        help="make for many meshes times many settings, on all cores or a cluster",
        description="Do what `skinfab make` does for many meshes times many settings (see docs/batch.md). DIR gets a folder in jobs/ for "
        "each, batch.csv, batch.html, batch.json and jobs.jsonl. A job that fails, or takes too long or too much memory, does not stop the "
        "others. Run again with the same DIR, it does what is not done yet.",
    )
    p.add_argument("plan", metavar="FILE.toml", type=steps.named(".toml"), help="meshes, [settings] and [limits]")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for the results, made if missing")
    where = p.add_mutually_exclusive_group()
    where.add_argument("--workers", metavar="N", type=steps.counting, help="jobs at a time on this machine (default: one a core)")
    where.add_argument("--scheduler", metavar="ADDRESS", help="a Dask cluster's scheduler, such as tcp://10.0.0.5:8786")
    p.add_argument("--json", action="store_true", help="print what batch.json holds and nothing else")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Do what is left to do, and write the tables."""
    from skinfab.batch.plan import read_plan
    from skinfab.batch.run import run_batch
    from skinfab.batch.table import CSV, OBJECT, PAGE, summary, write_tables
    from skinfab.files import require_apart
    from skinfab.progress import terminal_progress

    def broken_off(outcome: Outcome) -> None:
        with suppress(InputError):  # a full disk, which is what is told
            write_tables(plan, outcome, args.output)

    with terminal_progress(quiet=args.json) as progress:
        plan = read_plan(args.plan, output=args.output, progress=progress)
    require_apart(args.output, [], [args.plan, *{job.mesh for job in plan.jobs}], perhaps=[CSV, PAGE, OBJECT])
    steps.say(plan.notes)
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    with terminal_progress(quiet=args.json) as progress:
        outcome = run_batch(
            plan.jobs, args.output, workers=args.workers or cores, scheduler=args.scheduler, progress=progress, broken_off=broken_off
        )
    found = write_tables(plan, outcome, args.output)
    steps.say(outcome.notes)
    if args.json:
        print(json.dumps(found, allow_nan=False))
    else:
        print(f"{args.output}: {summary(outcome)}")
        print(f"next, open {args.output / PAGE}; {CSV} and {OBJECT} have the same")
    return _status(outcome, args.output / PAGE)


def _status(outcome: Outcome, page: Path) -> int:
    """That of the other commands: a result that was refused, or an input that could not be used, is the status of all."""
    without = [record["status"] for record in outcome.records.values() if record["status"] != "made"]
    if not without:
        return 0
    number = len(outcome.records)
    message = f"{len(without)} of {number} jobs {'has' if len(without) == 1 else 'have'} no result; {page} says why"
    message = message if number > 1 else f"the job has no result; {page} says why"
    steps.say([message], kind="warning")
    return RefusedError.exit_status if set(without) == {"refused"} else 1
