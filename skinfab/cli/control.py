"""`skinfab control simulator|LOG|--port PORT --human C.json --robot C.json -o DIR`: a robot's joint follows a human's."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps

if TYPE_CHECKING:
    from collections.abc import Sequence

    from calibration.control.controller import Input
    from calibration.control.margin import Margin
    from calibration.control.protocols import Run

#: Must be `calibration.control.controller.LAWS`, which is not imported for a help text.
LAWS = ("p", "branches", "full")
#: Of the simulated board; a real one's is measured.
RATE_HZ = 100.0
#: What a run leaves.
FILES = ("control.csv", "control.json", "control.png")


def gain(text: str) -> float | None:
    """``auto`` or a positive number."""
    return None if text == "auto" else steps.positive(text)


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "control",
        help="a robot's joint follows a human's, both read by strain sensors",
        description="Let a robot's joint follow a human's, both read by calibrated strain sensors; say how much gain the loop takes. "
        "'simulator' runs the paper's two protocols on the simulated finger; a LOG of a human's sensor is followed by the simulated "
        "robot finger; with --port both sensors are read from a board and commands go to another port.",
    )
    p.add_argument("what", metavar="simulator|LOG", nargs="?", help="the simulated finger, or a CSV log of the human's sensor")
    p.add_argument("--port", metavar="PORT", help="a serial port that sends both sensors' channels")
    p.add_argument("--human", metavar="C.json", type=Path, help="calibration of the human's sensor (simulator: its own)")
    p.add_argument(
        "--robot", metavar="C.json", type=Path, help="calibration of the robot's sensor (simulator and LOG: the simulator's own)"
    )
    p.add_argument("--controller", choices=LAWS, default="full", help="p: as published; branches: by flexion and extension; full (default)")
    p.add_argument("--gain", metavar="K|auto", type=gain, default=None, help="1/s (default: auto, a third of what the loop takes)")
    p.add_argument("--lag", metavar="S", type=steps.not_negative, default=0.1, help="time constant of the joint's speed (default 0.1)")
    p.add_argument("--delay", metavar="S", type=steps.positive, default=0.05, help="from motion to frame (default 0.05)")
    p.add_argument("--force", action="store_true", help="take a gain that the loop does not take")
    p.add_argument("--seed", type=steps.seed, default=0, help="of the simulator's noise and random motion")
    p.add_argument("--seconds", metavar="S", type=steps.positive, default=10.0, help="with --port: how long (default 10)")
    p.add_argument("--commands", metavar="PORT", help="with --port: where commands go, a line of deg/s each (default: only recorded)")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for control.csv, control.json, control.png")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run, wrong_usage=p.error)


def run(args: argparse.Namespace) -> int:
    """Judge the gain, control, write, and say how well it went."""
    _require_fitting_options(args)
    from skinfab.files import require_apart

    log = None if args.what == "simulator" else args.what
    require_apart(args.output, FILES, [path for path in (log, args.human, args.robot) if path])
    human, robot = _inputs(args)
    if args.port is not None:
        from skinfab.cli.control_port import run_port

        return run_port(args, human, robot)
    margin = judge(args, robot, period_s=1 / RATE_HZ)
    runs, notes = _simulated(args, human, robot, margin)
    result = facts(args, runs, margin, notes)
    _write(args, runs, result)
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    steps.say(notes)
    for line in _lines(result):
        print(line)
    print(f"{args.output}: {', '.join(FILES)}")
    return 0


def judge(args: argparse.Namespace, robot: Input, *, period_s: float) -> Margin:
    """The margin of the gain at this period, told; or that it is none."""
    from calibration.control.margin import judged

    margin = judged(robot, args.controller, args.gain, lag_s=args.lag, delay_s=args.delay, period_s=period_s, force=args.force)
    if not args.json:
        print(margin.sentence)
    if margin.ratio <= 1:
        steps.say(["the gain is beyond what the loop takes, and was forced: expect the joint to swing"], kind="warning")
    return margin


def _require_fitting_options(args: argparse.Namespace) -> None:
    if (args.what is None) == (args.port is None):
        args.wrong_usage("give one of: simulator, a LOG, --port PORT")
    if args.port is None and args.commands is not None:
        args.wrong_usage("--commands goes with --port")
    if args.what != "simulator" and args.human is None:
        args.wrong_usage("--human C.json is needed: the calibration of the human's sensor")
    if args.port is not None and args.robot is None:
        args.wrong_usage("--robot C.json is needed: the calibration of the robot's sensor")


def _inputs(args: argparse.Namespace) -> tuple[Input, Input]:
    """Both sensors; the simulator's own where none is given."""
    from calibration.control.controller import Input, require_two_sensors
    from calibration.finger.logs import calibrated
    from calibration.finger.simulated import HUMAN, ROBOT
    from calibration.strain.document import load_calibration

    model = "poly" if args.controller == "p" else "branches"
    given = ((args.human, HUMAN), (args.robot, ROBOT))
    human, robot = (Input(calibrated(sensor, model) if path is None else load_calibration(path)) for path, sensor in given)
    if args.human is not None and args.robot is not None:
        require_two_sensors(human, robot, names=(str(args.human), str(args.robot)), one_board=args.port is not None)
    return human, robot


def margin_facts(margin: Margin) -> dict[str, Any]:
    """A margin, ready for JSON."""
    return {
        "gain_per_s": margin.gain,
        "loop_gain_per_s": margin.loop_gain,
        "gain_margin": margin.ratio,
        "sure_below_per_s": margin.sure,
        "swings_from_per_s": margin.with_play.gain,
        "swings_at_hz": margin.with_play.frequency_hz,
        "swings_from_without_play_per_s": margin.linear.gain,
    }


def _simulated(args: argparse.Namespace, human: Input, robot: Input, margin: Margin) -> tuple[list[Run], list[str]]:
    from calibration.control.controller import JointController
    from calibration.control.human_log import human_motion
    from calibration.control.protocols import follow, random, uniform
    from calibration.finger.simulated import Plant
    from skinfab.readout.table import read_table

    def controller() -> JointController:
        return JointController(human, robot, law=args.controller, gain=margin.gain, lag_s=args.lag, delay_s=args.delay)

    plant = Plant(lag_s=args.lag, delay_s=args.delay)
    if args.what == "simulator":
        return [follow(motion, controller(), seed=args.seed, plant=plant) for motion in (uniform(), random(args.seed))], []
    motion, readings, measured, notes = human_motion(read_table(args.what), human.calibration)
    if not measured:
        notes.append(f"{motion.name} has no column {human.calibration.angle!r}: the error is that to the angle read, not to a true one")
    return [follow(motion, controller(), seed=args.seed, plant=plant, readings=readings)], notes


def facts(args: argparse.Namespace, runs: Sequence[Run], margin: Margin, notes: Sequence[str]) -> dict[str, Any]:
    """The result, ready for JSON."""
    from calibration.control.laws import Beyond
    from calibration.control.protocols import PAPER_DEG

    def share(of: list[bool]) -> float:
        return sum(of) / len(of)

    return {
        "controller": args.controller,
        "simulated": True,
        "margin": margin_facts(margin),
        "runs": [
            {
                "protocol": run.motion.name,
                "seconds": float(run.motion.time[-1]),
                "mean_error_deg": run.error_deg,
                "paper_mean_error_deg": PAPER_DEG.get(run.motion.name),
                "worst_error_deg": float(abs(run.robot - run.motion.angle).max()),
                "outside": share([command.outside for command in run.commands]),
                "outside_of": {name: share([getattr(command.beyond, name) for command in run.commands]) for name in Beyond._fields},
                "motion_deg": [float(run.motion.angle.min()), float(run.motion.angle.max())],
                "clamped": share([command.clamped for command in run.commands]),
                "held_or_stopped": share([command.state != "run" for command in run.commands]),
            }
            for run in runs
        ],
        "notes": list(notes),
    }


def _write(args: argparse.Namespace, runs: Sequence[Run], result: dict[str, Any]) -> None:
    import csv
    import io

    from calibration.control.figure import draw_runs
    from skinfab.files import atomic_write
    from skinfab.staging import staged_folder

    text = io.StringIO()
    text.write("# simulated: true\n")
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(
        ["protocol", "time_s", "human_deg", "robot_deg", "target_deg", "estimate_deg", "command_deg_s", "state", "outside", "clamped"]
    )
    for each in runs:
        for t, a, b, c in zip(each.motion.time.tolist(), each.motion.angle.tolist(), each.robot.tolist(), each.commands, strict=True):
            numbers = (f"{value:.6g}" for value in (t, a, b, c.target, c.angle, c.speed))
            rows.writerow([each.motion.name, *numbers, c.state, int(c.outside), int(c.clamped)])
    title = f"controller {args.controller}, gain {result['margin']['gain_per_s']:.3g} 1/s"
    with staged_folder(args.output) as folder:
        atomic_write(folder / "control.csv", text.getvalue())
        atomic_write(folder / "control.json", json.dumps(result, indent=1, allow_nan=False) + "\n")
        draw_runs(runs, folder / "control.png", title=title)


def outside_words(run: dict[str, Any]) -> str:
    """What was out of the calibrated range, and how far the motion went, where that is known.

    Examples
    --------
    >>> outside_words({"outside": 0.25, "outside_of": {"human": 0.25, "target": 0.0, "robot": 0.125}, "motion_deg": [10.0, 85.0]})
    " (the human's reading 25 %, the target 0 %, the robot's reading 12 %, in a motion from 10 to 85 degrees)"
    """
    if not run["outside"]:
        return ""
    of = run["outside_of"]
    motion = f", in a motion from {run['motion_deg'][0]:.0f} to {run['motion_deg'][1]:.0f} degrees" if "motion_deg" in run else ""
    return (
        f" (the human's reading {100 * of['human']:.0f} %, the target {100 * of['target']:.0f} %, the robot's reading "
        f"{100 * of['robot']:.0f} %{motion})"
    )


def _lines(result: dict[str, Any]) -> list[str]:
    lines = []
    for each in result["runs"]:
        paper = each["paper_mean_error_deg"]
        beside = "" if paper is None else f" (the paper's: {paper})"
        lines.append(
            f"{each['protocol']}: mean error {each['mean_error_deg']:.2f} degrees{beside}, worst {each['worst_error_deg']:.1f}; "
            f"out of range {100 * each['outside']:.0f} % of the time{outside_words(each)}, clamped {100 * each['clamped']:.0f} %, "
            f"held or stopped {100 * each['held_or_stopped']:.0f} %"
        )
    return lines
