"""`skinfab force simulate|run gravity`: where a held object's centre of gravity is. There is nothing to be learned, so no train."""

from __future__ import annotations

import argparse
import csv
import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.cli.bench import repeats

if TYPE_CHECKING:
    from skinfab.fingertip.force.gravity import Centre
    from skinfab.fingertip.force.logs import WrenchLog
    from skinfab.fingertip.force.mass import Mass
    from skinfab.fingertip.force.poses import Poses

_RUN = ("gravity.csv", "gravity.png", "result.json")
#: Headings of truth.csv, which lies beside the simulator's logs and is none.
_TRUE = ("log", "x_mm", "y_mm", "z_mm", "mass_kg", "simulated")
#: From the hand's origin to what it holds.
_HAND_MM = 300.0


@dataclass(frozen=True, eq=False)
class Found:
    """What a log says of an object."""

    log: WrenchLog
    poses: Poses
    centre: Centre
    published: Centre | None
    mass: Mass | None


def add_parsers(topics: Mapping[str, argparse._SubParsersAction[argparse.ArgumentParser]]) -> None:
    """Add the topic to its verbs."""
    from skinfab.cli.force import add_output, finish

    p = topics["simulate"].add_parser("gravity", help="a ball held by four fingers at the paper's five places, in ten poses")
    p.add_argument("--poses", metavar="N", type=repeats, default=10, help="of the hand (default: 10)")
    p.add_argument("--span", metavar="DEG", type=steps.positive, default=45.0, help="the hand is turned by up to so much (default: 45)")
    p.add_argument("--seed", type=steps.seed, default=0, help="of all chance (default: 0)")
    add_output(p, "a log a place, and truth.csv")
    finish(p, simulate)

    p = topics["run"].add_parser("gravity", help="find the centre of gravity and the mass of held objects")
    p.add_argument(
        "logs",
        metavar="LOG",
        nargs="+",
        type=Path,
        help="of one object each: columns time, Fx, Fy, Fz (N), Mx, My, Mz (N mm) of the whole hand in its frame, and pose (a number)",
    )
    p.add_argument(
        "--max-sd",
        metavar="MM",
        type=steps.positive,
        default=5.0,
        help="refuse what is more uncertain, one standard deviation (default: 5)",
    )
    p.add_argument(
        "--place-sd",
        metavar="MM",
        type=steps.not_negative,
        default=0.0,
        help="of where the hand believes its fingertips to be (default: 0)",
    )
    add_output(p, "table, figure and result")
    finish(p, run)


def simulate(args: argparse.Namespace) -> int:
    """Write a log a place."""
    from skinfab.fingertip.force.gravity_simulator import PAPER_PLACES, PAPER_TRUTH, HandScene, hold
    from skinfab.fingertip.force.logs import write_wrench
    from skinfab.staging import staged_folder

    scene = HandScene(poses=args.poses, span_deg=args.span)
    names = [f"{place.replace(' ', '-')}.csv" for place in PAPER_PLACES]
    truth = [list(_TRUE)]
    with staged_folder(args.output) as folder:
        for k, (name, centre) in enumerate(zip(names, PAPER_TRUTH, strict=True)):
            held = hold(centre, seed=1000 * args.seed + k, scene=scene, name=name)
            write_wrench(held.log, folder / name)
            truth.append([name, *(f"{each:g}" for each in centre), f"{held.mass_kg:g}", "1"])
        (folder / "truth.csv").write_text(_csv(truth))
    files = [str(args.output / name) for name in (*names, "truth.csv")]
    if args.json:
        print(json.dumps({"simulated": True, "files": files}))
        return 0
    print(f"{args.output}: {len(names)} simulated logs of {args.poses} poses, truth.csv")
    return 0


def run(args: argparse.Namespace) -> int:
    """Find the centre of each object, and write it down."""
    from skinfab.errors import InputError
    from skinfab.files import require_apart
    from skinfab.fingertip.force.gravity_figure import draw_centres
    from skinfab.staging import staged_folder

    require_apart(args.output, _RUN, args.logs)
    found, notes = [], []
    logs = [path for path in args.logs if not _is_truth(path)]
    notes += [f"{path} is the simulator's table of what is true, and was passed over" for path in args.logs if path not in logs]
    if not logs:
        raise InputError(f"{args.logs[0]} is the simulator's table of what is true; give the logs beside it")
    for path in logs:
        each, said = _one(path, args)
        found.append(each)
        notes += said
    simulated = any(each.log.simulated for each in found)
    result = {"simulated": simulated, "objects": [_facts(each) for each in found], "notes": notes}
    with staged_folder(args.output) as folder:
        (folder / "gravity.csv").write_text(_csv(_rows(found)))
        (folder / "result.json").write_text(json.dumps(result, indent=1, allow_nan=False) + "\n")
        draw_centres([(e.log.name, e.poses, e.centre, e.published) for e in found], folder / "gravity.png", simulated=simulated)
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    steps.say(notes)
    for each in found:
        x, y, z = each.centre.point
        mass = f", {1000 * each.mass.kg:.1f} +- {1000 * each.mass.sd_kg:.1f} g" if each.mass else ""
        made = " (simulated)" if each.log.simulated else ""
        print(
            f"{each.log.name}{made}: {x:.1f}, {y:.1f}, {z:.1f} mm, +- {each.centre.sd_mm:.2f} in the worst direction{mass}; "
            f"{len(each.poses.samples)} poses, smallest eigenvalue {each.centre.eigenvalue:.3f} a pose"
        )
    print(f"{args.output}: {', '.join(_RUN)}")
    return 0


def _is_truth(path: Path) -> bool:
    if path.suffix.lower() != ".csv" or not path.is_file():
        return False
    with path.open("rb") as file:
        return file.readline(200).decode("utf-8", "replace").strip() == ",".join(_TRUE)


def _one(path: Path, args: argparse.Namespace) -> tuple[Found, list[str]]:
    import numpy as np

    from skinfab.errors import InputError, RefusedError
    from skinfab.fingertip.force.gravity import centre_of_gravity, published_centre, require_certain
    from skinfab.fingertip.force.logs import read_wrench
    from skinfab.fingertip.force.mass import fit_mass
    from skinfab.fingertip.force.poses import poses_of, require_alive
    from skinfab.fingertip.force.wrench import require_nmm

    log = read_wrench(path)
    notes = list(log.notes)
    try:
        require_alive(log)
        poses = poses_of(log)
        notes += poses.notes
        if not log.units_said:
            require_nmm(poses.force, poses.moment, reach_mm=_HAND_MM, least_force=0.0, where=log.name)
        centre = centre_of_gravity(poses.force, poses.moment, poses.covariance, freedom=poses.freedom)
        centre = replace(centre, covariance=centre.covariance + args.place_sd**2 * np.eye(3))
        require_certain(centre, poses.force, worst_sd_mm=args.max_sd)
    except (InputError, RefusedError) as fault:
        raise type(fault)(f"{path}: {fault}" if path.name not in str(fault) else str(fault)) from fault
    if not centre.meets:
        notes.append(
            f"{log.name}: the lines of the poses do not meet in a point (misfit {centre.misfit:.1f}): the object or a contact moved, it "
            "holds a liquid, or the sensor is less exact than its noise; the uncertainty was widened to what was seen"
        )
    published, mass = None, None
    try:
        published = published_centre(poses.force, poses.moment, poses.covariance, freedom=poses.freedom)
    except RefusedError as fault:
        notes.append(f"{log.name}, as published: {fault}")
    try:
        mass = fit_mass(poses.force, None if poses.covariance is None else poses.covariance[:, :3, :3])
    except (InputError, RefusedError) as fault:
        notes.append(f"{log.name}: no mass: {fault}")
    return Found(log, poses, centre, published, mass), notes


def _facts(each: Found) -> dict[str, Any]:
    from skinfab.fingertip.force.gravity import pose_span

    c = each.centre
    return {
        "log": each.log.name,
        "sha256": each.log.sha256,
        "simulated": each.log.simulated,
        "poses": len(each.poses.samples),
        "span_deg": pose_span(each.poses.force),
        "centre_mm": c.point.tolist(),
        "covariance_mm2": c.covariance.tolist(),
        "worst_sd_mm": c.sd_mm,
        "worst_direction": c.worst.tolist(),
        "offset_nmm": c.offset.tolist(),
        "eigenvalue": c.eigenvalue,
        "misfit": c.misfit,
        "lines_meet": c.meets,
        "mass_kg": each.mass.kg if each.mass else None,
        "mass_sd_kg": each.mass.sd_kg if each.mass else None,
        "force_offset_n": each.mass.offset_n.tolist() if each.mass else None,
        "published": {"centre_mm": each.published.point.tolist(), "worst_sd_mm": each.published.sd_mm} if each.published else None,
    }


def _rows(found: Sequence[Found]) -> list[list[str]]:
    rows = [["log", "x_mm", "y_mm", "z_mm", "worst_sd_mm", "mass_kg", "poses", "eigenvalue", "misfit", "simulated"]]
    for each in found:
        c = each.centre
        numbers = [f"{value:.3f}" for value in (*c.point.tolist(), c.sd_mm)]
        mass = f"{each.mass.kg:.5f}" if each.mass else ""
        rows.append(
            [
                each.log.name,
                *numbers,
                mass,
                str(len(each.poses.samples)),
                f"{c.eigenvalue:.4f}",
                f"{c.misfit:.3f}",
                str(int(each.log.simulated)),
            ]
        )
    return rows


def _csv(rows: Sequence[Sequence[str]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()
