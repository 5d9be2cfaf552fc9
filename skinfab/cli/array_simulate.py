"""`skinfab array simulate -o DIR`: logs of a simulated array, with what is true."""

from __future__ import annotations

import argparse
import csv
import io
import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from skinfab.cli import steps

if TYPE_CHECKING:
    from skinfab.fingertip.array.tracking import Event

EVENTS = ["kind", "start_s", "end_s", "along_mm", "around_mm", "contact"]


def add_options(p: argparse.ArgumentParser) -> None:
    """What to simulate and where to."""
    p.add_argument("--density", metavar="RxS", default="8x8", help="rings and stripes on the seed's finger, such as 8x16 (default: 8x8)")
    p.add_argument(
        "--logs",
        metavar="N",
        type=steps.counting,
        default=5,
        help="of presses (default: 5); of rods and twirling two, of presses that also pull along the skin one",
    )
    p.add_argument("--contacts", metavar="N", type=steps.counting, default=40, help="in a log (default: 40)")
    p.add_argument("--seed", type=steps.seed, default=0, help="of the array and of what touches it (default: 0)")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for the logs")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Simulate, write, and say what was written."""
    from skinfab.files import atomic_write
    from skinfab.fingertip.array.geometry import Geometry
    from skinfab.fingertip.array.protocols import presses, pushes, rods, twirl
    from skinfab.fingertip.array.simulator import Device
    from skinfab.readout.logs.log import write_log
    from skinfab.staging import staged_folder

    device = Device(Geometry.of_density(args.density), seed=args.seed)
    with staged_folder(args.output) as folder:
        for k in range(1, args.logs + 1):
            write_log(presses(device, args.contacts, seed=1000 * args.seed + k), folder / f"presses-{k}.csv")
        write_log(pushes(device, args.contacts, seed=1000 * args.seed + 1), folder / "pushes-1.csv")
        for k in (1, 2):
            write_log(rods(device, args.contacts, seed=1000 * args.seed + k), folder / f"rods-{k}.csv")
            log, events = twirl(device, seed=1000 * args.seed + k)
            write_log(log, folder / f"twirl-{k}.csv")
            atomic_write(folder / f"twirl-{k}-events.csv", events_csv(events, simulated=True))
        files = sorted(file.name for file in folder.iterdir())
    result = {"simulated": True, "density": args.density, "files": [str(args.output / name) for name in files]}
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    print(f"a simulated array of {args.density} tactels; {args.output}: {', '.join(files)}")
    return 0


def events_csv(events: Sequence[Event], *, simulated: bool) -> str:
    """Events as a table, a row each."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow([*EVENTS, "simulated"])
    for event in events:
        numbers = (f"{value:.3f}" for value in (event.start, event.end, event.along_mm, event.around_mm))
        rows.writerow([event.kind, *numbers, event.number, int(simulated)])
    return text.getvalue()
