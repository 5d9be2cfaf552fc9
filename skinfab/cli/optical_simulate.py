"""`skinfab optical simulate -o DIR`: images of a simulated fingertip, with what is true."""

from __future__ import annotations

import argparse
import csv
import io
import json
import math
import struct
import zlib
from pathlib import Path

from skinfab.cli import steps

#: Columns of targets.csv: the edge in the fingertip's frame.
COLUMNS = ["image", "group", "offset_mm", "depth_mm", "angle_deg", "shear_x_mm", "shear_y_mm", "simulated"]
#: Images that are split together. Simulated ones are independent of each other; of a real fingertip those of one run are not.
TRIAL = 10


def add_options(p: argparse.ArgumentParser) -> None:
    """What to simulate and where to."""
    p.add_argument("--images", metavar="N", type=steps.counting, default=500, help="how many (default: 500)")
    p.add_argument("--reach", metavar="MM", type=_length, default=8.0, help="farthest that an edge lies from the middle (default: 8)")
    p.add_argument(
        "--depth",
        metavar=("LOW", "HIGH"),
        type=_depth,
        nargs=2,
        default=[0.3, 2.4],
        help="how deep the dome is pressed, mm (default: 0.3 2.4, from a light touch on; a robot at 2 mm learns best from 1.6 2.4)",
    )
    p.add_argument("--shear", metavar="MM", type=_length, default=0.3, help="most that the skin is dragged, each way (default: 0.3)")
    p.add_argument("--paper", action="store_true", help="the seed's dome, 271 pins 2 mm apart, in place of 127 pins 3 mm apart")
    p.add_argument("--seed", type=steps.seed, default=0, help="of the fingertip and of what it is pressed on (default: 0)")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for images/ and targets.csv")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run)


def _length(text: str) -> float:
    """A length from nothing up, for argparse."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 <= value <= 20:
        raise argparse.ArgumentTypeError(f"{text!r} is not a length between 0 and the dome's 20 mm")
    return value


def _depth(text: str) -> float:
    """A depth in which only the plate is touched, for argparse."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value <= 3:
        raise argparse.ArgumentTypeError(f"{text!r} is not a depth above 0 and up to the plate's 3 mm")
    return value


def run(args: argparse.Namespace) -> int:
    """Simulate, write, and say what was written."""
    import cv2

    from skinfab.files import atomic_write
    from skinfab.fingertip.optical.labelled import labelled
    from skinfab.fingertip.optical.simulator import Fingertip, paper_fingertip
    from skinfab.progress import terminal_progress
    from skinfab.staging import staged_folder

    low, high = args.depth
    if low > high:
        args.wrong_usage(f"--depth {low:g} {high:g}: give the smaller one first")
    _require_no_others(args.output / "images", args.images)
    tip = paper_fingertip(args.seed) if args.paper else Fingertip(seed=args.seed)
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(COLUMNS)
    with staged_folder(args.output) as folder, terminal_progress(quiet=args.json) as progress:
        (folder / "images").mkdir()
        for k, each in enumerate(
            labelled(tip, args.images, reach_mm=args.reach, depths_mm=(low, high), shear_mm=args.shear, seed=args.seed)
        ):
            progress(k / args.images, "images")
            name = _name(k)
            # A picture says that it is simulated where a copy of the table does not follow it.
            atomic_write(folder / "images" / name, _png(cv2.imencode(".png", each.image)[1].tobytes()))
            e = each.edge
            numbers = (e.offset_mm, e.depth_mm, math.degrees(e.angle_rad), *each.shear_mm)
            rows.writerow([f"images/{name}", f"trial-{k // TRIAL + 1}", *(f"{value:.4f}" for value in numbers), 1])
        atomic_write(folder / "targets.csv", text.getvalue())
    result = {"simulated": True, "images": args.images, "pins": len(tip.rest), "size_px": tip.dome.size_px}
    if args.json:
        print(json.dumps({**result, "files": [str(args.output / "targets.csv"), str(args.output / "images")]}, allow_nan=False))
        return 0
    print(f"{args.images} images of a simulated fingertip with {len(tip.rest)} pins; {args.output}: targets.csv, images")
    return 0


def _name(k: int) -> str:
    return f"{k + 1:05d}.png"


def _require_no_others(folder: Path, count: int) -> None:
    """Pictures of another run would be taken for some of this one."""
    from skinfab.errors import InputError

    mine = {_name(k) for k in range(count)}
    others = sorted(path.name for path in folder.iterdir() if path.name not in mine) if folder.is_dir() else []
    if others:
        raise InputError(f"{folder} holds {len(others)} others already ({others[0]}, ...); remove them, or give another folder by -o")


def _png(data: bytes) -> bytes:
    """A PNG with a text chunk that says that it is simulated, after its header."""
    chunk = b"tEXt" + b"Comment\0simulated: true"
    after = 8 + 25  # signature and IHDR
    return data[:after] + struct.pack(">I", len(chunk) - 4) + chunk + struct.pack(">I", zlib.crc32(chunk)) + data[after:]
