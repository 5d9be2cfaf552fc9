"""`skinfab optical run DIR|VIDEO|--camera N --model MODEL.npz -o DIR`: the edge in each image."""

from __future__ import annotations

import argparse
import json
import math
import threading
import time
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.cli.ending import ended_by_signals

if TYPE_CHECKING:
    from skinfab.fingertip.optical.images import ImageSource
    from skinfab.fingertip.optical.seat import Seat
    from skinfab.fingertip.optical.source import EdgeSource
    from skinfab.readout.frame import Frame

FILES = ("edges.csv", "optical.png", "result.json")
#: How long to wait for a picture before looking whether time is up, s.
_WAIT_S = 0.2
#: What is no more than half sure is pointed out.
_SURE = 0.5


def add_options(p: argparse.ArgumentParser) -> None:
    """What is looked at, with which model, and where the results go."""
    p.add_argument("images", metavar="IMAGES", type=Path, nargs="?", help="a folder of pictures, or a video")
    p.add_argument("--camera", metavar="N", help="its number from 0 (or an address), until Ctrl-C, instead")
    p.add_argument("--model", metavar="MODEL.npz", type=Path, required=True, help="from skinfab optical train, of this fingertip")
    p.add_argument("--rest", metavar="IMAGE", type=Path, help="of the untouched fingertip now: its camera has moved since the training")
    p.add_argument("--rate", metavar="HZ", type=steps.positive, help="pictures a second of a folder (default: 30)")
    p.add_argument(
        "--seconds", metavar="S", type=steps.positive, help="of a camera: end so long after its first picture (default: at Ctrl-C)"
    )
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for the table of edges, result and figure")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Look, write, and say what was felt."""
    from dataclasses import replace

    from skinfab.errors import InputError
    from skinfab.files import require_apart
    from skinfab.fingertip.optical.model_file import load_edge
    from skinfab.fingertip.optical.seat import read_rest, seat
    from skinfab.fingertip.optical.source import EdgeSource

    if (args.images is None) == (args.camera is None):
        args.wrong_usage("give IMAGES or --camera N, one of them")
    if args.seconds is not None and args.camera is None:
        args.wrong_usage("--seconds is for a camera")
    require_apart(args.output, FILES, [path for path in (args.images, args.model, args.rest) if path is not None])
    if args.images is not None and args.images.is_dir() and args.output.resolve() == args.images.resolve():
        raise InputError(f"{args.output} holds the pictures, and the figure would be taken for one of them; give another folder by -o")
    model, made_from = load_edge(args.model)
    at = None
    if args.rest is not None:
        at = seat(model.pins, read_rest(args.rest, model.pins.shape))
        model = replace(model, pins=at.pins)
    source = EdgeSource(_images(args), model)
    # Ctrl-C is the way to end a camera: what came before it is written, also where it is pressed again meanwhile.
    with ended_by_signals() if args.camera is not None else nullcontext(threading.Event()) as stop:
        felt, spent = _felt(args, source, stop)
        if not felt and stop.is_set():
            raise KeyboardInterrupt
        if not felt:
            raise InputError(f"{source.images.name} gave no picture that can be read; {'; '.join(source.images.notes) or 'look at it'}")
        simulated = source.stream.simulated or bool(made_from.get("simulated"))
        result = _facts(source.images, felt, spent, simulated=simulated) | _rest(at)
        result["notes"] += [] if at is None or at.fits else [_unseated(args.rest, at)]
        _write(args.output, felt, result)
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    steps.say(result["notes"])
    made = " (simulated)" if simulated else ""
    print(
        f"{result['source']}{made}: {result['pictures']} pictures, {result['sure']} of them more than half sure; "
        f"{result['ms']['median']:.2f} ms from picture to edge, worst {result['ms']['worst']:.2f}"
    )
    if at is not None:
        print(f"the camera has moved by {at.shift_px:.1f} px and {math.degrees(at.turn_rad):.1f} degrees against the pins (--rest)")
    print(f"{args.output}: {', '.join(FILES)}")
    return 0


def _rest(at: Seat | None) -> dict[str, Any]:
    found = {"shift_px": at.shift_px, "turn_deg": math.degrees(at.turn_rad), "left_px": at.left_px} if at is not None else None
    return {"rest": found}


def _unseated(path: Path, at: Seat) -> str:
    return (
        f"--rest {path}: shifted and turned as a whole, the learned pins still lie {at.left_px:.1f} px (root mean square) from where this "
        f"image shows them, {100 * at.left_px / at.pitch_px:.0f} % of a pin's pitch; it shows a contact or another fingertip, or "
        "the camera has moved by half a pitch at the rim; give another, or train "
        "again where few pictures are surely read"
    )


def _images(args: argparse.Namespace) -> ImageSource:
    from skinfab.fingertip.optical.camera import CameraImages
    from skinfab.fingertip.optical.images import RATE_HZ, FolderImages, VideoImages

    if args.camera is not None:
        if args.rate is not None:
            args.wrong_usage("--rate is for a folder: a camera has its own")
        return CameraImages(int(args.camera) if args.camera.isdecimal() else args.camera)
    if args.images.is_dir():
        return FolderImages(args.images, rate_hz=args.rate or RATE_HZ)
    if args.rate is not None:
        args.wrong_usage("--rate is for a folder: a video has its own")
    return VideoImages(args.images)


def _felt(args: argparse.Namespace, source: EdgeSource, stop: threading.Event) -> tuple[list[tuple[str, Frame]], list[float]]:
    """Every picture's name and frame (not the picture: a camera would fill the memory), and how long each took from picture to edge, ms."""
    from skinfab.errors import InputError
    from skinfab.fingertip.optical.camera import STILL_S

    felt: list[tuple[str, Frame]] = []
    spent: list[float] = []
    told = args.camera is not None and not args.json
    with source:
        end, warn = math.inf, time.monotonic() + STILL_S
        while not (source.images.ended or stop.is_set()) and (left := end - time.monotonic()) > 0:
            try:
                frame = source.read(min(left, _WAIT_S))
            except InputError as fault:
                if not felt:
                    raise
                source.images.notes.append(f"{fault}; what came before is kept")
                break
            if frame is None or source.last is None:
                if told and time.monotonic() > warn:
                    steps.say([f"{source.images.name} has given no picture for {STILL_S:g} s"])
                    warn = math.inf
                continue
            if not felt:
                end = time.monotonic() + (args.seconds or math.inf)  # a camera may take seconds to its first one
            spent.append(source.last_ms)
            felt.append((source.last.name, frame))
            warn = time.monotonic() + STILL_S
            if told:
                print(_words(frame), flush=True)
    return felt, spent


def _words(frame: Frame) -> str:
    """
    Examples
    --------
    >>> import numpy as np
    >>> from skinfab.readout.frame import Frame
    >>> yes = np.ones(4, dtype=bool)
    >>> _words(Frame(1.0, 1.0, 0, np.array([0.5, 2.0, -90.0, 0.9]), yes, ~yes))
    '    1.00 s  +0.50 mm off the plate, -90.0 deg, 90 % sure'
    """
    offset, _, angle, sure = frame.values
    return f"{frame.device_time:8.2f} s  {offset:+.2f} mm off the plate, {angle:.1f} deg, {100 * sure:.0f} % sure"


def _facts(images: ImageSource, felt: list[tuple[str, Frame]], spent: list[float], *, simulated: bool) -> dict[str, Any]:
    sure = sum(float(frame.values[3]) > _SURE for _, frame in felt)
    notes = list(images.notes)
    for count, how in ((images.counts.lost, "lost"), (images.counts.bad, "unreadable or of another size")):
        if count:
            notes.append(f"{count} pictures were {how}")
    if sure < len(felt):
        notes.append(
            f"{len(felt) - sure} pictures are unlike what was learned, or far from an edge; what is said of them is not to be trusted"
        )
    return {
        "source": images.name,
        "simulated": simulated,
        "pictures": len(felt),
        "lost": images.counts.lost,
        "unreadable": images.counts.bad,
        "sure": sure,
        "ms": {"median": sorted(spent)[len(spent) // 2], "worst": max(spent)},
        "notes": notes,
    }


def _write(target: Path, felt: list[tuple[str, Frame]], result: dict[str, Any]) -> None:
    from skinfab.files import atomic_write
    from skinfab.fingertip.optical.edge import Edge
    from skinfab.fingertip.optical.figure import draw_run
    from skinfab.staging import staged_folder

    rows = (frame.values.tolist() for _, frame in felt)
    edges = [Edge(offset, math.radians(angle), depth, confidence) for offset, depth, angle, confidence in rows]
    times, simulated = [frame.device_time for _, frame in felt], result["simulated"]
    with staged_folder(target) as folder:
        atomic_write(folder / "edges.csv", _table(felt, simulated))
        atomic_write(folder / "result.json", json.dumps(result, indent=1, allow_nan=False) + "\n")
        draw_run(times, edges, folder / "optical.png", title=result["source"], simulated=simulated)


def _table(felt: list[tuple[str, Frame]], simulated: bool) -> str:
    import csv
    import io

    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["time_s", "host_time_s", "sequence", "image", "offset_mm", "depth_mm", "angle_deg", "confidence", "simulated"])
    for name, frame in felt:
        numbers = (f"{v:.5f}" if math.isfinite(v) else "" for v in frame.values.tolist())
        row = [f"{frame.device_time:.6f}", f"{frame.host_time:.6f}", frame.sequence, name, *numbers, int(simulated)]
        rows.writerow(row)
    return text.getvalue()
