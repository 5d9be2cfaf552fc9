"""`skinfab force simulate|train|run contact`: where a fingertip is touched, and whether what it holds slides, leaves or rolls."""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from skinfab.cli import steps
from skinfab.cli.force_contact_result import facts_of, lines_of, write
from skinfab.cli.force_result import told_as_json
from skinfab.cli.record import baud

if TYPE_CHECKING:
    from skinfab.fingertip.force.contact import Hemisphere
    from skinfab.fingertip.force.contact_mesh import TipMesh
    from skinfab.fingertip.force.logs import WrenchLog
    from skinfab.fingertip.force.motion import Motion
    from skinfab.fingertip.force.touch_model import TouchModel

_FILES = ("contacts.csv", "events.csv", "contact.png", "result.json")
_TRUTH = "truth.csv"
#: Of samples of a straight sensor fewer than this part read a twist, of one that is off by 1 mm and 2 degrees a half at 3 N.
_TWISTED = 0.05


def add_parsers(topics: Mapping[str, argparse._SubParsersAction[argparse.ArgumentParser]]) -> None:
    """Add the topic to its verbs."""
    from skinfab.cli.force import add_output, finish
    from skinfab.cli.force_touch import add_train

    fingertip = argparse.ArgumentParser(add_help=False)
    fingertip.add_argument(
        "--radius", metavar="MM", type=steps.positive, help="of the fingertip's dome about the sensor's origin (default: 20)"
    )
    fingertip.add_argument(
        "--tip", metavar="MESH", type=Path, help="instead of a dome: a closed mesh of the fingertip in the sensor's frame, mm"
    )
    p = topics["simulate"].add_parser("contact", help="grasps that slide, let go and roll, and the times when they do")
    p.add_argument("--grasps", metavar="N", type=steps.counting, default=6, help="logs, a grasp each (default: 6)")
    p.add_argument("--touches", metavar="N", type=steps.counting, help="instead of grasps: logs of a touch each at known places, for train")
    p.add_argument("--crooked", action="store_true", help="of grasps: by the sensor that --touches of this seed are read by, which is off")
    p.add_argument("--seed", type=steps.seed, default=0, help="of all chance (default: 0)")
    add_output(p, "a log a grasp, and truth.csv; or a log a touch, and places.csv")
    finish(p, simulate)

    add_train(topics["train"], fingertip=fingertip)

    p = topics["run"].add_parser("contact", help="contact points, and sliding, separation and rolling as events", parents=[fingertip])
    p.add_argument("logs", metavar="LOG", nargs="*", type=Path, help="columns time, Fx, Fy, Fz (N), Mx, My, Mz (N mm)")
    p.add_argument("--port", metavar="PORT", help="instead of logs: a port such as /dev/ttyACM0, told as it comes, until Ctrl-C")
    p.add_argument("--seconds", metavar="S", type=steps.positive, help="of a port: end after so long")
    p.add_argument("--baud", metavar="N", type=baud, help="of a port (default: 921600)")
    p.add_argument(
        "--friction", metavar="DEG", type=_angle, default=31.0, help="friction angle of finger and object (default: 31, that is 0.6)"
    )
    p.add_argument(
        "--tare", metavar="S", type=steps.not_negative, default=0.5, help="untouched at the beginning, taken off (default: 0.5; 0: none)"
    )
    p.add_argument("--model", metavar="FILE", type=Path, help="model.npz of train: how this sensor is mounted, and its noise")
    p.add_argument("--least-force", metavar="N", type=steps.not_negative, help="what is weaker is no contact (default: 0.3)")
    p.add_argument("--truth", metavar="FILE", type=Path, help="CSV of log,kind,start_s,end_s: how well the events are found is told too")
    add_output(p, "contacts, events, figure and result")
    finish(p, run)


def _angle(text: str) -> float:
    value = steps.positive(text)
    if value >= 90:
        raise argparse.ArgumentTypeError(f"{text} is not below 90 degrees")
    return value


def surface_of(args: argparse.Namespace) -> Hemisphere | TipMesh:
    """The fingertip that ``--radius`` or ``--tip`` says."""
    from skinfab.fingertip.force.contact import Hemisphere
    from skinfab.fingertip.force.contact_mesh import TipMesh

    if args.tip is None:
        return Hemisphere() if args.radius is None else Hemisphere(args.radius)
    if args.radius is not None:
        args.wrong_usage("--radius and --tip are two fingertips; give one")
    from skinfab.mesh.io import load_mesh

    return TipMesh(load_mesh(args.tip, units="mm").mesh)


def simulate(args: argparse.Namespace) -> int:
    """Write a log a grasp, and what is true of them; or touches at known places."""
    if args.touches:
        from skinfab.cli.force_touch import simulate as simulate_touches

        return simulate_touches(args)
    from skinfab.fingertip.force.logs import write_wrench
    from skinfab.fingertip.force.motion_file import events_csv
    from skinfab.fingertip.force.motion_simulator import GraspScene, grasp_log
    from skinfab.staging import staged_folder

    made = [grasp_log(seed=args.seed + k) for k in range(args.grasps)]
    if args.crooked:
        from skinfab.fingertip.force.touch_simulator import read_crooked

        made = [(read_crooked(log, seed=args.seed), events) for log, events in made]
    names = [f"{log.name}.csv" for log, _ in made]
    truth = {name: events for name, (_, events) in zip(names, made, strict=True)}
    with staged_folder(args.output) as folder:
        for name, (log, _) in zip(names, made, strict=True):
            write_wrench(log, folder / name)
        (folder / _TRUTH).write_text(events_csv(truth, simulated=dict.fromkeys(names, True)))
    result = {
        "simulated": True,
        "files": [str(args.output / name) for name in (*names, _TRUTH)],
        "friction_deg": GraspScene.friction_deg,
        "events": sum(len(each) for each in truth.values()),
    }
    if args.json:
        print(json.dumps(result))
    else:
        print(f"{args.output}: {len(made)} simulated grasps with {result['events']} events, and {_TRUTH}")
    return 0


def run(args: argparse.Namespace) -> int:
    """Locate, find events, write them down, and say what was found."""
    with ExitStack() as until_written:
        return _run(args, until_written)


def _run(args: argparse.Namespace, until_written: ExitStack) -> int:
    _require_usage(args)
    import numpy as np

    from skinfab.errors import InputError
    from skinfab.files import require_apart
    from skinfab.fingertip.force.contact import FLAGS, LEAST_FORCE_N, TORSION, locate
    from skinfab.fingertip.force.motion_file import read_events
    from skinfab.fingertip.force.touch_model import load_touches

    require_apart(args.output, _FILES, [*args.logs, *(path for path in (args.truth, args.tip, args.model) if path)])
    model, simulated_model = load_touches(args.model) if args.model else (None, False)
    surface, least = surface_of(args), LEAST_FORCE_N if args.least_force is None else args.least_force
    if model:
        model.require_surface(surface)
    truth = read_events(args.truth) if args.truth else {}
    latency: dict[str, float] = {}
    if args.port is not None:
        logs, events, latency = _watched(args, surface, least, model, until_written)
    else:
        logs, events = _logged(args, surface, least, model)
    noise = model.noise if model else None
    found = []
    for log, each in zip(logs, events, strict=True):
        contacts = locate(log.force, log.moment, surface, least_force=least, noise=noise)
        if model:
            whole = np.minimum(np.hypot(contacts.sd_mm, model.own_error(log, surface)), 2 * reach(surface))
            contacts = replace(contacts, sd_mm=whole)
        found.append((contacts, each))
    if args.truth and (missing := next((log.name for log in logs if log.name not in truth), None)):
        raise InputError(f"{args.truth} has no event of {missing}; name the logs there as their files")
    result = facts_of(args, logs, found, truth) | ({"latency": latency} if latency else {}) | {"learned": model is not None}
    for name, log_facts in result["logs"].items():
        if model is None and (twisted := log_facts["flags"][FLAGS[TORSION]]) > _TWISTED * log_facts["touching"]:
            result["notes"].append(
                f"{name}: at {twisted} of {log_facts['touching']} samples a moment about the force's line is no point contact's; a sensor "
                "mounted a little off reads such too: learn how it is mounted by touches at known places (train contact, --model)"
            )
    if simulated_model and not result["simulated"]:
        result["simulated"] = True
        result["notes"].append("the model was learned from simulated touches; what it makes of a real sensor is not to be relied on")
    write(args, logs, found, truth, result)
    if told_as_json(args, result):
        return 0
    for line in lines_of(result):
        print(line)
    print(f"{args.output}: {', '.join(_FILES)}")
    return 0


def _require_usage(args: argparse.Namespace) -> None:
    """Wrong usage where the words contradict each other."""
    if (args.port is None) == (not args.logs):
        args.wrong_usage("give logs, or a --port")
    for name in ("seconds", "baud"):
        if args.port is None and getattr(args, name) is not None:
            args.wrong_usage(f"--{name} is for a --port")
    if args.port is not None and args.truth:
        args.wrong_usage("--truth is for logs")


def _logged(
    args: argparse.Namespace, surface: Hemisphere | TipMesh, least: float, model: TouchModel | None
) -> tuple[list[WrenchLog], list[list[Motion]]]:
    """Logs without the sensor's offset, and the events of each."""
    import numpy as np

    from skinfab.errors import InputError
    from skinfab.fingertip.force.logs import read_wrench
    from skinfab.fingertip.force.motion import Limits, MotionWatch, find_motions
    from skinfab.fingertip.force.poses import require_alive
    from skinfab.fingertip.force.tare import tared
    from skinfab.fingertip.force.wrench import require_nmm
    from skinfab.progress import terminal_progress

    logs: list[WrenchLog] = []
    events = []
    with terminal_progress(quiet=args.json) as progress:
        for k, path in enumerate(args.logs):
            progress(k / len(args.logs), path.name)
            log = read_wrench(path)
            if any(log.name == other.name for other in logs):
                raise InputError(f"two logs are called {log.name}; give each a name of its own")
            if not math.isfinite(log.rate_hz):
                raise InputError(f"{path} has a single row; that is no log of a motion")
            require_alive(log)
            log = tared(log, seconds=args.tare) if args.tare else log
            if not log.units_said:
                require_nmm(log.force, log.moment, reach_mm=reach(surface), least_force=least, where=log.name)
            log = model.corrected(log) if model else log
            noise = model.noise if model else None
            watch = MotionWatch(Limits(args.friction), rate_hz=log.rate_hz, surface=surface, least_force=least, noise=noise)
            if late := int((np.diff(log.time) <= 0).sum()):
                said = f"{log.name}: the time does not go on at {late} samples; motions were looked for in those that come in order"
                log = replace(log, notes=(*log.notes, said))
            logs.append(log)
            events.append(find_motions(log.time, log.force, log.moment, watch))
        progress(1.0, "done")
    return logs, events


def reach(surface: Hemisphere | TipMesh) -> float:
    """How far from the sensor's origin a contact can be, mm, about."""
    from skinfab.fingertip.force.contact_mesh import TipMesh

    return surface.size / 2 if isinstance(surface, TipMesh) else surface.radius


def _watched(
    args: argparse.Namespace, surface: Hemisphere | TipMesh, least: float, model: TouchModel | None, until_written: ExitStack
) -> tuple[list[WrenchLog], list[list[Motion]], dict[str, float]]:
    """What a port sent, its events, and how long decisions took."""
    from skinfab.cli.force_port import watch_port
    from skinfab.errors import InputError
    from skinfab.fingertip.force.motion import Limits
    from skinfab.fingertip.force.poses import require_alive

    live = watch_port(
        args.port,
        limits=Limits(args.friction),
        seconds=args.seconds,
        baud=args.baud,
        least_force=least,
        surface=surface,
        tare=args.tare,
        model=model,
        quiet=args.json,
        until_written=until_written,
    )
    notes = live.notes
    if model is None:  # a matrix mixes what is dead with what lives
        try:
            require_alive(live.log)
        except InputError as fault:  # what came is written all the same: nobody can record it again
            notes = (*notes, str(fault))
    return [replace(live.log, notes=notes)], [list(live.motions)], live.latency
