"""`skinfab force simulate|train|run gravity`: where a held object's centre of gravity is; what is learned is the empty hand."""

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
from skinfab.cli.force_result import result_folder, told_as_json

if TYPE_CHECKING:
    from skinfab.fingertip.force.gravity import Centre
    from skinfab.fingertip.force.gravity_model import HandModel
    from skinfab.fingertip.force.logs import WrenchLog
    from skinfab.fingertip.force.mass import Mass
    from skinfab.fingertip.force.poses import Poses

_TRAINED = ("model.npz", "result.json")
_RUN = ("gravity.csv", "gravity.png", "result.json")
#: Headings of truth.csv, which lies beside the simulator's logs and is none.
_TRUE = ("log", "x_mm", "y_mm", "z_mm", "mass_kg", "simulated")
#: Of simulated hands: a fingertip's mass, and how far an offset drifts from log to log. The same whether they are weighed or not:
#: a hand whose fingertips weigh something when it is weighed alone would make every object lighter.
_TIP_KG, _DRIFT_N = 0.01, 0.01
#: From the hand's origin to what it holds.
_HAND_MM = 300.0


@dataclass(frozen=True, eq=False)
class Found:
    """What a log says of an object."""

    log: WrenchLog
    poses: Poses
    drawn: Poses
    centre: Centre
    published: Centre | None
    mass: Mass | None


def add_parsers(topics: Mapping[str, argparse._SubParsersAction[argparse.ArgumentParser]]) -> None:
    """Add the topic to its verbs."""
    from skinfab.cli.force import add_output, finish

    p = topics["simulate"].add_parser("gravity", help="a ball held by four fingers at the paper's five places, in ten poses")
    p.add_argument("--poses", metavar="N", type=steps.counting, default=10, help="of the hand (default: 10)")
    p.add_argument("--span", metavar="DEG", type=steps.positive, default=45.0, help="the hand is turned by up to so much (default: 45)")
    p.add_argument(
        "--weighings",
        metavar="N",
        type=steps.counting,
        default=0,
        help="weigh each hand empty too, so many times (default: none)",
    )
    p.add_argument("--seed", type=steps.seed, default=0, help="of all chance (default: 0)")
    add_output(p, "a log a place, and truth.csv")
    finish(p, simulate)

    p = topics["train"].add_parser("gravity", help="weigh the empty hand: its offsets, and what of it turns with it")
    p.add_argument(
        "logs", metavar="LOG", nargs="+", type=Path, help="of the empty hand, its fingers as they hold; columns as of run, poses too"
    )
    add_output(p, "the model and the result")
    finish(p, train)

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
    p.add_argument("--model", metavar="FILE", type=Path, help="model.npz of train: the empty hand is taken off, and two poses can do")
    add_output(p, "table, figure and result")
    finish(p, run)


def simulate(args: argparse.Namespace) -> int:
    """Write a log a place."""
    from skinfab.fingertip.force.gravity_simulator import PAPER_PLACES, PAPER_TRUTH, HandScene, hold
    from skinfab.fingertip.force.logs import write_wrench
    from skinfab.staging import staged_folder

    scene = HandScene(poses=args.poses, span_deg=args.span, tip_kg=_TIP_KG, drift_n=_DRIFT_N)
    empty = []
    names = [f"{place.replace(' ', '-')}.csv" for place in PAPER_PLACES]
    truth = [list(_TRUE)]
    with staged_folder(args.output) as folder:
        for k, (name, centre) in enumerate(zip(names, PAPER_TRUTH, strict=True)):
            held = hold(centre, seed=1000 * args.seed + k, scene=scene, name=name)
            write_wrench(held.log, folder / name)
            for again in range(args.weighings):
                empty.append(f"empty-{name[:-4]}-{again + 1}.csv")
                log = hold(centre, seed=1000 * args.seed + k, scene=replace(scene, poses=10, span_deg=45.0), weighing=again).log
                write_wrench(replace(log, name=empty[-1], label="empty"), folder / empty[-1])
            truth.append([name, *(f"{each:g}" for each in centre), f"{held.mass_kg:g}", "1"])
        (folder / "truth.csv").write_text(_csv(truth))
    files = [str(args.output / name) for name in (*names, *empty, "truth.csv")]
    if args.json:
        print(json.dumps({"simulated": True, "files": files}))
        return 0
    print(f"{args.output}: {len(names)} simulated logs of {args.poses} poses, truth.csv{f', {len(empty)} of empty hands' if empty else ''}")
    return 0


def train(args: argparse.Namespace) -> int:
    """Weigh the empty hand, judge each weighing by the others, and write the model."""
    import numpy as np

    from skinfab.files import require_apart
    from skinfab.fingertip.force.gravity_fit import left_over
    from skinfab.fingertip.force.gravity_model import save_hand
    from skinfab.fingertip.force.logs import once
    from skinfab.fingertip.force.weighings import learn_alike

    require_apart(args.output, _TRAINED, args.logs)
    read = [_poses(path) for path in args.logs]
    kept, copies = once([log for log, _ in read])
    read = [(log, poses) for log, poses in read if any(log is each for each in kept)]
    weighings = [poses for _, poses in read]
    notes = [*copies, *(note for log, poses in read for note in (*log.notes, *poses.notes))]
    model = learn_alike(weighings, [log.name for log, _ in read])
    (before, after) = left_over(weighings) if len(read) > 1 else (None, None)
    if not model.weight_n:
        notes.append("no weight was felt to turn with the hand; if its fingertips have one, it was not turned far enough to weigh it")
    if after is None:
        notes.append("one weighing does not show how far the offsets drift; weigh the hand again at another time, and give both logs")
    made_from = [{"file": log.name, "sha256": log.sha256, "simulated": log.simulated, "poses": len(p.samples)} for log, p in read]
    simulated = any(log.simulated for log, _ in read)
    result = {
        "simulated": simulated,
        "weighings": len(read),
        "offset": model.offset.tolist(),
        "offset_sd": np.sqrt(model.covariance.diagonal()[:6]).tolist(),
        "weight_n": model.weight_n,
        "weight_centre_mm": (model.moment_nmm / model.weight_n).tolist() if model.weight_n else None,
        "held_out": {"before": _left(before), "after": _left(after)} if before and after else None,
        "made_from": made_from,
        "notes": notes,
    }
    with result_folder(args, result) as folder:
        save_hand(model, folder / "model.npz", facts={"simulated": simulated, "held_out": result["held_out"], "made_from": made_from})
    if told_as_json(args, result):
        return 0
    made = " (simulated)" if simulated else ""
    weight = f"a weight of {model.weight_n:.3f} N turns with the hand" if model.weight_n else "no weight turns with the hand"
    print(f"{len(read)} weighing{'s' * (len(read) > 1)} of the empty hand{made}: offsets, and {weight}")
    if before and after:
        print(
            f"weighings held out read {before[0]:.2g} N and {before[1]:.2g} N mm, less the others' model {after[0]:.2g} and {after[1]:.2g}"
        )
    print(f"{args.output}: {', '.join(_TRAINED)}")
    return 0


def _left(over: tuple[float, float]) -> dict[str, float]:
    return {"force_n": over[0], "moment_nmm": over[1]}


def run(args: argparse.Namespace) -> int:
    """Find the centre of each object, and write it down."""
    from skinfab.errors import InputError
    from skinfab.files import require_apart
    from skinfab.fingertip.force.gravity_figure import draw_centres
    from skinfab.fingertip.force.gravity_model import load_hand

    require_apart(args.output, _RUN, [*args.logs, *([args.model] if args.model else [])])
    model, simulated_model = load_hand(args.model) if args.model else (None, False)
    found, notes = [], []
    if model and model.weighings == 1:
        notes.append(
            "the model is of one weighing, which shows no drift: what is stated holds as if the offsets had stayed where they were"
        )
    logs = [path for path in args.logs if not _is_truth(path)]
    notes += [f"{path} is the simulator's table of what is true, and was passed over" for path in args.logs if path not in logs]
    if not logs:
        raise InputError(f"{args.logs[0]} is the simulator's table of what is true; give the logs beside it")
    for path in logs:
        each, said = _one(path, args, model)
        found.append(each)
        notes += said
    simulated = simulated_model or any(each.log.simulated for each in found)
    if simulated_model and not all(each.log.simulated for each in found):
        notes.append("the empty hand was a simulated one; what is left of a real one is not to be relied on")
    result = {"simulated": simulated, "weighed": model is not None, "objects": [_facts(each) for each in found], "notes": notes}
    with result_folder(args, result) as folder:
        (folder / "gravity.csv").write_text(_csv(_rows(found)))
        drawn = [(e.log.name, e.drawn, e.centre, e.published) for e in found]
        draw_centres(drawn, folder / "gravity.png", simulated=simulated, weighed=model is not None)
    if told_as_json(args, result):
        return 0
    with_tips = "" if model else " with the fingertips"
    for each in found:
        x, y, z = each.centre.point
        mass = f", {1000 * each.mass.kg:.1f} +- {1000 * each.mass.sd_kg:.1f} g{with_tips}" if each.mass else ""
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


def _poses(path: Path) -> tuple[WrenchLog, Poses]:
    """A log in which all components live, and its poses; faults name the file."""
    from skinfab.errors import InputError
    from skinfab.fingertip.force.logs import read_wrench
    from skinfab.fingertip.force.poses import poses_of, require_alive

    log = read_wrench(path)
    try:
        require_alive(log)
        return log, poses_of(log)
    except InputError as fault:
        raise _named(path, fault) from fault


def _named(path: Path, fault: Exception) -> Exception:
    return type(fault)(f"{path}: {fault}" if path.name not in str(fault) else str(fault))


def _one(path: Path, args: argparse.Namespace, model: HandModel | None) -> tuple[Found, list[str]]:
    import numpy as np

    from skinfab.errors import InputError, RefusedError
    from skinfab.fingertip.force.gravity import centre_of_gravity, published_centre, require_certain
    from skinfab.fingertip.force.gravity_model import centre_with, mass_with
    from skinfab.fingertip.force.mass import fit_mass
    from skinfab.fingertip.force.same_hand import TELLING, require_own_hand
    from skinfab.fingertip.force.wrench import require_nmm

    log, poses = _poses(path)
    notes = [*log.notes, *poses.notes]
    try:
        if not log.units_said:
            require_nmm(poses.force, poses.moment, reach_mm=_HAND_MM, least_force=0.0, where=log.name)
        if model is None:
            centre = centre_of_gravity(poses.force, poses.moment, poses.covariance, freedom=poses.freedom)
        else:
            centre = centre_with(model, poses)
            require_own_hand(model, poses, centre)
        centre = replace(centre, covariance=centre.covariance + args.place_sd**2 * np.eye(3))
        require_certain(centre, poses.force, worst_sd_mm=args.max_sd)
    except (InputError, RefusedError) as fault:
        raise _named(path, fault) from fault
    if model is not None and len(poses.force) < TELLING:
        notes.append(f"{log.name}: {len(poses.force)} poses hardly show whether the model is of this hand as it holds here; {TELLING} do")
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
        of_force = None if poses.covariance is None else poses.covariance[:, :3, :3]
        mass = fit_mass(poses.force, of_force) if model is None else mass_with(model, poses)
    except (InputError, RefusedError) as fault:
        notes.append(f"{log.name}: no mass: {fault}")
    drawn = poses
    if model is not None:  # the lines of what is held alone
        force, moment, _ = model.less(poses.force, poses.moment)
        drawn = replace(poses, force=force, moment=moment)
    return Found(log, poses, drawn, centre, published, mass), notes


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
