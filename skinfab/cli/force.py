"""`skinfab force simulate|train|run|bench TOPIC ...`: a six-axis force/torque sensor in a fingertip."""

from __future__ import annotations

import argparse
import importlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from skinfab.cli import steps
from skinfab.cli.measured import measured

#: What is done with the sensor's readings; `skinfab/cli/force_NAME.py` adds its own parsers to the verbs it has.
TOPICS = ("contact", "shape", "texture", "gravity", "liquid")

VERBS = {
    "simulate": "write logs of a simulated sensor, with their labels",
    "train": "fit a model to labelled logs, and say how good it is on those that were held out",
    "run": "read logs, or a port, and say what is in them",
    "bench": "what was published beside what is done here, measured on simulated logs",
}

#: Where the `run` of each chart is; the same that `skinfab bench` runs.
BENCHES = {
    "contact": "skinfab.bench.force",
    "shape": "skinfab.bench.shape",
    "texture": "skinfab.bench.texture",
    "gravity": "skinfab.bench.gravity",
    "liquid": "skinfab.bench.liquid",
}

Verbs = Mapping[str, "argparse._SubParsersAction[argparse.ArgumentParser]"]


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command: a parser for each verb, and in it one for each topic."""
    p = subparsers.add_parser(
        "force",
        help="a six-axis force/torque fingertip: contacts, textures, centre of gravity, shapes",
        description="What a six-axis force/torque sensor under a fingertip feels: where it is touched and what moves, which texture it "
        "slides over, where a held object's centre of gravity is, and what shape it has.",
    )
    verbs = p.add_subparsers(metavar="VERB", required=True, title="verbs")
    topics = {}
    for verb, summary in VERBS.items():
        q = verbs.add_parser(verb, help=summary, description=f"{summary[0].upper()}{summary[1:]}.")
        if verb == "bench":
            _add_bench(q)
        else:
            topics[verb] = q.add_subparsers(metavar="TOPIC", required=True, title="topics")
    for topic in TOPICS:
        importlib.import_module(f"skinfab.cli.force_{topic}").add_parsers(topics)


def add_output(p: argparse.ArgumentParser, what: str) -> None:
    """The options that every verb has: where results go, and JSON."""
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help=f"folder for {what}")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")


def finish(p: argparse.ArgumentParser, run: object) -> None:
    """What the command line needs to know of a topic's parser."""
    p.set_defaults(run=run, wrong_usage=p.error, parser=p)


def _add_bench(p: argparse.ArgumentParser) -> None:
    p.add_argument("topics", metavar="TOPIC", nargs="*", type=_topic, help=f"what to measure: {', '.join(BENCHES)} (default: everything)")
    p.add_argument(
        "--repeats", metavar="K", type=steps.counting, default=3, help="of what is timed; the least time of K counts (default: 3)"
    )
    add_output(p, "tables, charts and sentences")
    finish(p, run_bench)


def _topic(text: str) -> str:
    if text not in BENCHES:
        raise argparse.ArgumentTypeError(f"{text!r} is not measured; there are {', '.join(BENCHES)}")
    return text


def run_bench(args: argparse.Namespace) -> int:
    """Measure, write, and say what came out."""
    from skinfab.progress import Progress, part_of

    wanted = list(dict.fromkeys(args.topics or BENCHES))

    def measure(folder: Path, progress: Progress) -> dict[str, Any]:
        found = {}
        for k, topic in enumerate(wanted):
            part = part_of(progress, k / len(wanted), (k + 1) / len(wanted))
            found[topic] = importlib.import_module(BENCHES[topic]).run(folder, repeats=args.repeats, progress=part)
        return found

    return measured(args, measure, several=True, simulated=True)
