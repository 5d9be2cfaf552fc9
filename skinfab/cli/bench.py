"""`skinfab bench [NAME ...] -o DIR`: measure the project beside its peers."""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path
from typing import Any

from skinfab.cli import steps
from skinfab.cli.measured import measured

#: What can be measured.
NAMES = {
    "flatten": "time against distortion of the ways to flatten a disk",
    "simplify": "triangles solved for against distortion and time",
    "gcode": "arcs and chord tolerances against file size, deviation and time",
    "segment": "pieces and seam of automatic seams against the bound and time, beside xatlas",
    "calibrate": "models and degrees of a strain calibration against held-out error and time",
    "control": "gain, delay and period against the error of a controlled joint",
    "force": "averaging and least force against a contact's error and what is rejected; events",
    "shape": "features and confidence against how often a new object's shape is told right",
    "gravity": "how far a hand is turned against the error of a held object's centre of gravity",
    "liquid": "water in a stirred cup against how often it is found, and false alarms",
    "texture": "length and peaks of a spectrum against how often a texture is told right",
    "readout": "framing and byte errors against frames lost and wrong in silence",
    "array": "interpolators and densities of a tactel array against errors and time",
    "optical": "following an edge by merged pins and by a felt pose: closed contours by step and noise",
    "nail": "the published method beside the improved one, and the length of the window against accuracy and latency",
}

#: Where its `run` is, and whether it takes --sizes.
MODULES = {
    "flatten": ("skinfab.bench.flatten", True),
    "simplify": ("skinfab.bench.simplify", True),
    "gcode": ("gcode.bench", False),
    "segment": ("skinfab.bench.segment", True),
    "calibrate": ("calibration.bench.calibrate", False),
    "control": ("calibration.bench.control", False),
    "force": ("skinfab.bench.force", False),
    "shape": ("skinfab.bench.shape", False),
    "gravity": ("skinfab.bench.gravity", False),
    "liquid": ("skinfab.bench.liquid", False),
    "texture": ("skinfab.bench.texture", False),
    "readout": ("skinfab.bench.readout", False),
    "array": ("skinfab.bench.array", False),
    "optical": ("skinfab.bench.optical", False),
    "nail": ("skinfab.bench.nail", False),
}


def name(text: str) -> str:
    """One of `NAMES`, for argparse."""
    if text not in NAMES:
        raise argparse.ArgumentTypeError(f"{text!r} is not measured; there are {', '.join(NAMES)}")
    return text


def sizes(text: str) -> list[int]:
    """Numbers of triangles such as 5000,20000, for argparse."""
    words = text.split(",")
    if not all(word.isascii() and word.isdecimal() and int(word) > 0 for word in words):
        raise argparse.ArgumentTypeError(f"{text!r} is not a list of numbers of triangles such as 5000,20000")
    return sorted({int(word) for word in words})


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "bench",
        help="measure the project beside its peers",
        description="Measure the project beside its peers, all in one run, in turns and on one processor; the least time of the repeats "
        "counts, without imports, reading and writing. Writes a table, a chart and a sentence. There are: "
        + "; ".join(f"{key} ({what})" for key, what in NAMES.items())
        + ".",
    )
    p.add_argument("names", metavar="NAME", nargs="*", type=name, help="what to measure (default: everything)")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="the folder to write into")
    p.add_argument(
        "--sizes",
        metavar="N,N,...",
        type=sizes,
        help="triangles of the disks (default: 5000,20000,80000; simplify: 20000,80000,320000; segment: none)",
    )
    p.add_argument(
        "--meshes", metavar="FILE", type=Path, nargs="+", default=[], help="segment: find seams on these beside the project's own"
    )
    p.add_argument("--repeats", metavar="K", type=steps.counting, default=3, help="the least time of K counts (default: 3)")
    p.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    p.set_defaults(run=run, wrong_usage=p.error)


def run(args: argparse.Namespace) -> int:
    """Measure, write, and say what came out."""
    from skinfab.progress import Progress, part_of

    wanted = list(dict.fromkeys(args.names or NAMES))
    if args.sizes and not any(MODULES[key][1] for key in wanted):
        args.wrong_usage(f"--sizes counts triangles, and {', '.join(wanted)} has none")
    if args.meshes and "segment" not in wanted:
        args.wrong_usage(f"--meshes are for segment, and what is measured is {', '.join(wanted)}")
    if "segment" in wanted:
        from skinfab.bench.segment import mesh_files

        mesh_files(args.meshes)  # none: that is told now, not after minutes

    def measure(folder: Path, progress: Progress) -> dict[str, Any]:
        found = {}
        for k, key in enumerate(wanted):
            part = part_of(progress, k / len(wanted), (k + 1) / len(wanted))
            module, sized = MODULES[key]
            options = {"sizes": args.sizes} if sized and args.sizes else {}
            options |= {"meshes": args.meshes} if key == "segment" and args.meshes else {}
            found[key] = importlib.import_module(module).run(folder, repeats=args.repeats, progress=part, **options)
        return found

    return measured(args, measure, several=True)
