"""`skinfab nail simulate -o DIR`: simulated participants of one of the paper's tests, as logs with labels."""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path
from typing import TYPE_CHECKING

from skinfab.cli import steps

if TYPE_CHECKING:
    from skinfab.fingertip.nail.labels import Label
    from skinfab.fingertip.nail.protocol import Session

#: Must be the names of `skinfab.fingertip.nail.patterns.TESTS`, which is not imported for a help text.
TESTS = ("edges4", "pins6", "edges12")
TABLE = "labels.csv"

_DECIMALS_G, _DECIMALS_DPS, _DECIMALS_S = 4, 2, 6


def add_options(p: argparse.ArgumentParser) -> None:
    """What to simulate and where to."""
    p.add_argument("--test", choices=TESTS, default="edges12", help="what is touched (default: edges12)")
    p.add_argument("--participants", metavar="N", type=steps.counting, default=2, help="a log each (default: 2; the paper had 10)")
    p.add_argument("--training", metavar="N", type=steps.counting, default=5, help="trials to learn from, of each class (default: 5)")
    p.add_argument("--rounds", metavar="N", type=steps.counting, default=10, help="of the test, over all patterns (default: 10)")
    p.add_argument("--samples", metavar="N", type=steps.counting, default=1024, help="readings a trial (default: 1024, 0.73 s)")
    p.add_argument(
        "--force",
        metavar="LOW:HIGH",
        type=_forces,
        help="N, drawn log-uniform between them, so that a force can be learned (default: the paper's, 0.98 N within a fifth)",
    )
    p.add_argument("--seed", type=steps.seed, default=0, help="the same seed gives the same logs (default: 0)")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help=f"folder for the logs and {TABLE}")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run)


def _forces(text: str) -> tuple[float, float]:
    """Two forces in N, for argparse."""
    low, _, high = text.partition(":")
    try:
        forces = steps.positive(low), steps.positive(high)
    except argparse.ArgumentTypeError:
        forces = (1.0, 0.0)
    if forces[0] > forces[1]:
        raise argparse.ArgumentTypeError(f"{text!r} is not LOW:HIGH in N, such as 0.3:3")
    return forces


def run(args: argparse.Namespace) -> int:
    """Simulate, write, and say what was written."""
    from skinfab.fingertip.nail.labels import write_labels
    from skinfab.fingertip.nail.patterns import TESTS
    from skinfab.fingertip.nail.protocol import Protocol, session
    from skinfab.fingertip.nail.simulator import Scene
    from skinfab.progress import terminal_progress
    from skinfab.staging import staged_folder

    protocol = Protocol(args.participants, args.training, args.rounds, 1, args.samples)
    scene = Scene(force_n=args.force)
    labels: list[Label] = []
    with staged_folder(args.output) as folder, terminal_progress(quiet=args.json) as progress:
        for number in range(1, args.participants + 1):
            progress((number - 1) / args.participants, f"participant {number} of {args.participants}")
            recorded = session(args.test, number, protocol=protocol, scene=scene, seed=args.seed, in_a_row=True)
            labels += _written(folder, recorded)
        write_labels(folder / TABLE, labels, simulated=True)
        files = sorted(file.name for file in folder.iterdir())
        progress(1.0, "done")
    result = {
        "simulated": True,
        "test": args.test,
        "classes": ["none", *(pattern.name for pattern in TESTS[args.test])],
        "participants": args.participants,
        "trials": {part: sum(each.part == part for each in labels) for part in ("train", "test")},
        "files": [str(args.output / name) for name in files],
    }
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    print(
        f"{steps.counted(args.participants, 'simulated participant')}, {result['trials']['train']} trials to learn from and "
        f"{result['trials']['test']} to be tested on; {args.output}: {', '.join(files)}"
    )
    return 0


def _written(folder: Path, session: Session) -> list[Label]:
    """Write one participant's log, trial after trial as one stream; its labels."""
    import numpy as np

    from skinfab.fingertip.nail.labels import NOTHING, Label
    from skinfab.fingertip.nail.simulator import RATE_HZ, nail_stream
    from skinfab.readout.frame import Recording
    from skinfab.readout.logs.log import write_log

    name = f"participant-{session.participant}.csv"
    parts = (("train", session.training), ("test", session.rounds))
    values = np.concatenate([trials.readings.reshape(-1, 6) for _, trials in parts])
    # Finer than any such sensor tells, and half the file.
    values[:, :3], values[:, 3:] = values[:, :3].round(_DECIMALS_G), values[:, 3:].round(_DECIMALS_DPS)
    time = (np.arange(len(values)) / RATE_HZ).round(_DECIMALS_S)
    write_log(Recording.of_values(nail_stream(), values, device_time=time), folder / name)
    labels, start = [], 0
    for part, trials in parts:
        samples = trials.readings.shape[1] * trials.readings.shape[2]
        for k, each in enumerate(trials.touches):
            labels.append(
                Label(
                    log=name,
                    start_s=start / RATE_HZ,
                    end_s=(start + samples) / RATE_HZ,
                    label=NOTHING if each.pattern is None else each.pattern.name,
                    participant=str(session.participant),
                    trial=f"{part} {k + 1}",
                    part=part,
                    force_n=each.force_n,
                    x_mm=math.nan if each.pattern is None else each.pattern.x_mm,
                    y_mm=math.nan if each.pattern is None else each.pattern.y_mm,
                    angle_deg=math.nan if each.pattern is None else math.degrees(each.pattern.angle_rad),
                    true_x_mm=each.x_mm,
                    true_y_mm=each.y_mm,
                    true_angle_deg=math.degrees(each.angle_rad) % 180,
                )
            )
            start += samples
    return labels
