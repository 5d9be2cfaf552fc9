"""`skinfab contact LOG...|PORT|simulator -o DIR`: when each sensor of a skin is touched."""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.cli.record import baud

if TYPE_CHECKING:
    from calibration.contact.detector import Contact, Detection
    from calibration.contact.score import Score
    from calibration.contact.table import Row
    from skinfab.readout.frame import Recording
    from skinfab.wiring import Wire

SIMULATOR = "simulator"
#: Why a channel could not be watched; and so many are named.
_UNWATCHED = {"silent": "never read anything", "constant": "read one value all the time", "never at rest": "was never at rest"}
_NAMED = 4
#: Must be the names of `calibration.contact.objects.OBJECTS`, which is not imported for a help text.
OBJECTS = ("cube", "cylinder", "dodecahedron", "grip", "cup")


@dataclass(frozen=True, eq=False)
class Trial:
    """A recording, what was found in it, and what is true where it was simulated."""

    name: str
    sha256: str
    recording: Recording
    found: Detection
    truth: tuple[Contact, ...] = ()


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "contact",
        help="find contacts in the readings of a skin",
        description="Find when each contact sensor is touched, by its signed change against its own noise, at a stated rate of false "
        "alarms; and what each reads at rest and touched, over trials. Logs begin at rest, for 3 seconds.",
    )
    p.add_argument(
        "logs",
        metavar="LOG",
        nargs="+",
        help="logs of one object, each a trial (CSV, MCAP, ROS bag, recording); or a port such as /dev/ttyACM0, watched until Ctrl-C; "
        f"or {SIMULATOR}: a simulated hand on the paper's objects",
    )
    p.add_argument(
        "--false-alarms",
        metavar="PER_MINUTE",
        type=steps.positive,
        default=0.1,
        help="to be expected, all channels together (default: 0.1)",
    )
    p.add_argument(
        "--channel",
        metavar="NAME",
        action="append",
        help="watch this channel; may be given again (default: contact sensors, or all there are)",
    )
    p.add_argument(
        "--wiring",
        metavar="FILE",
        type=Path,
        help="of logs or a port: wiring.csv of the skin, or its .skin; channels get their sensors' names",
    )
    p.add_argument("--object", choices=(*OBJECTS, "all"), help=f"of the {SIMULATOR} (default: all)")
    p.add_argument("--trials", metavar="N", type=steps.seed, help=f"of the {SIMULATOR}, per object (default: 5)")
    p.add_argument("--seed", type=steps.seed, help=f"of the {SIMULATOR} (default: 0)")
    p.add_argument("--seconds", metavar="S", type=steps.positive, help="of a port: end after so long (default: at Ctrl-C)")
    p.add_argument("--baud", metavar="N", type=baud, help="of a port (default: 921600)")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for events, table, result and figure")
    p.add_argument("--json", action="store_true", help="print the result as one JSON object and nothing else")
    p.set_defaults(run=run, wrong_usage=p.error)


def run(args: argparse.Namespace) -> int:
    """Find contacts, write them down, and say what was found."""
    with ExitStack() as until_written:
        return _run(args, until_written)


def _run(args: argparse.Namespace, until_written: ExitStack) -> int:
    from skinfab.cli.contact_files import FILES, TRUTH, write_files
    from skinfab.files import require_apart

    kind = _kind(args)
    require_apart(args.output, FILES, args.logs if kind == "log" else (), perhaps=(TRUTH,))
    scores: dict[str, dict[str, list[Score]]] = {}
    if kind == SIMULATOR:
        sessions, scores = _simulated(args)
        notes: list[str] = []
    else:
        sessions, notes = _watched(args, until_written) if kind == "port" else _logged(args)
    _require_watched(sessions)
    from calibration.contact.table import contact_table

    tables = {name: contact_table([(each.recording, each.found) for each in trials]) for name, trials in sessions.items()}
    for trials in sessions.values():
        for each in trials:
            notes += [f"{each.name}: {fault}" for fault in each.found.faults if not scores]
    result = _facts(args, sessions, tables, scores, notes)
    files = write_files(args.output, sessions, tables, result)
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return 0
    steps.say(notes)
    for line in _lines(sessions, tables, result):
        print(line)
    print(f"{args.output}: {', '.join(files)}")
    return 0


#: Options that not every kind of source has.
_ONLY = {"object": SIMULATOR, "trials": SIMULATOR, "seed": SIMULATOR, "seconds": "port", "baud": "port"}


def _is_port(path: Path) -> bool:
    """One that is there, or was to be: a log in /dev is nobody's, and who has unplugged a port is not to be told to give a log."""
    return path.is_char_device() or (Path("/dev") in path.parents and not path.exists())


def _kind(args: argparse.Namespace) -> str:
    """What the contacts are to be found in; wrong usage where the words contradict each other."""
    live = [word for word in args.logs if word == SIMULATOR or _is_port(Path(word))]
    if live and len(args.logs) > 1:
        args.wrong_usage(f"{live[0]} stands alone: it is no log among others")
    kind = "log" if not live else SIMULATOR if live[0] == SIMULATOR else "port"
    for name, only in _ONLY.items():
        if getattr(args, name) is not None and kind != only:
            args.wrong_usage(f"--{name} is for the {only}, not for a {kind}")
    if kind == SIMULATOR and args.wiring:
        args.wrong_usage(f"--wiring is for logs and ports; the {SIMULATOR}'s channels have their sensors' names")
    if kind == SIMULATOR and args.channel:
        args.wrong_usage(f"--channel is for logs and ports; the {SIMULATOR}'s channels are all contact sensors")
    if args.trials == 0:
        args.wrong_usage("--trials 0 is no trial")
    return kind


def _watched(args: argparse.Namespace, until_written: ExitStack) -> tuple[dict[str, list[Trial]], list[str]]:
    from skinfab.cli.contact_port import watch_port
    from skinfab.wired import load_wiring

    wires = load_wiring(args.wiring) if args.wiring else ()
    recording, found, notes = watch_port(
        args.logs[0],
        baud=args.baud,
        seconds=args.seconds,
        false_alarms=args.false_alarms,
        channels=args.channel,
        wires=wires,
        until_written=until_written,
    )
    return {recording.stream.name: [Trial(recording.stream.name, "", recording, found)]}, notes


def _logged(args: argparse.Namespace) -> tuple[dict[str, list[Trial]], list[str]]:
    from calibration.contact.detector import detect
    from skinfab.errors import InputError
    from skinfab.progress import terminal_progress
    from skinfab.readout.checks import check_times
    from skinfab.readout.logs.log import read_log

    wires: tuple[Wire, ...] = ()
    if args.wiring:
        from skinfab.wired import load_wiring, rests, unit_notes, wired

        wires = load_wiring(args.wiring)
    trials, notes = [], []
    with terminal_progress(quiet=args.json) as progress:
        for k, path in enumerate(args.logs):
            progress(k / len(args.logs), Path(path).name)
            log = read_log(path)
            notes += [*log.notes, *(f"{log.file}: {wrong}" for wrong in check_times(log.recording))]
            if wires:
                stream, told = wired(log.recording.stream, wires)
                log = replace(log, recording=replace(log.recording, stream=stream))
                told += unit_notes(stream, wires)
                told += [each.verdict for each in rests(log.recording, wires) if each.verdict]
                notes += [f"{log.file}: {each}" for each in told]
            try:
                found = detect(log.recording, false_alarms=args.false_alarms, channels=args.channel)
            except InputError as fault:
                raise InputError(f"{path}: {fault}") from fault
            trials.append(Trial(log.file, log.sha256, log.recording, found))
        progress(1.0, "done")
    return {trials[0].recording.stream.name or trials[0].name: trials}, notes


def _require_watched(sessions: dict[str, list[Trial]]) -> None:
    """Refuse what nothing could be watched in: that no contact was found there says nothing."""
    from calibration.contact.rest import STILL_S
    from skinfab.errors import InputError

    health = [(each.name, channel) for trials in sessions.values() for each in trials for channel in each.found.channels]
    if any(channel.state in ("", "frozen") for _, channel in health):
        return
    states = list(dict.fromkeys(f"{channel.channel} of {name} {_UNWATCHED[channel.state]}" for name, channel in health))
    more = f", and {len(states) - _NAMED} more" if len(states) > _NAMED else ""
    raise InputError(
        f"no channel could be watched: {', '.join(states[:_NAMED])}{more}; check the wires, and leave the object alone for the first "
        f"{STILL_S:g} s"
    )


def _simulated(args: argparse.Namespace) -> tuple[dict[str, list[Trial]], dict[str, dict[str, list[Score]]]]:
    from calibration.contact.detector import detect
    from calibration.contact.simulator import simulate
    from calibration.contact.study import judge
    from skinfab.progress import terminal_progress

    names = OBJECTS if args.object in (None, "all") else (args.object,)
    count, seed = args.trials or 5, args.seed or 0
    sessions: dict[str, list[Trial]] = {}
    scores: dict[str, dict[str, list[Score]]] = {}
    with terminal_progress(quiet=args.json) as progress:
        for k, name in enumerate(names):
            progress(k / len(names), name)
            made = [simulate(name, seed=seed + j) for j in range(count)]
            sessions[name] = [
                Trial(f"{name}-{seed + j}", "", each.recording, detect(each.recording, false_alarms=args.false_alarms), each.truth)
                for j, each in enumerate(made)
            ]
            scores[name] = judge(made, false_alarms=args.false_alarms)
        progress(1.0, "done")
    return sessions, scores


def _facts(
    args: argparse.Namespace,
    sessions: dict[str, list[Trial]],
    tables: dict[str, tuple[Row, ...]],
    scores: dict[str, dict[str, list[Score]]],
    notes: Sequence[str],
) -> dict[str, Any]:
    """The result, ready for JSON."""
    from calibration.contact.study import figures

    facts: dict[str, Any] = {"false_alarms_per_minute": args.false_alarms, "objects": {}, "notes": list(notes)}
    for name, trials in sessions.items():
        first = trials[0].found
        facts["objects"][name] = {
            "simulated": any(each.recording.stream.simulated for each in trials),
            "threshold_sigma": first.alarm.threshold,
            "cap_sigma": first.alarm.cap,
            "trials": [
                {
                    "log": each.name,
                    "sha256": each.sha256 or None,
                    "frames": len(each.recording),
                    "contacts": len(each.found.contacts),
                    "channels": [asdict(health) | {"state": health.state, "faults": health.faults} for health in each.found.channels],
                }
                for each in trials
            ],
            "table": [asdict(row) for row in tables[name]],
        }
    if scores:
        together: dict[str, list[Score]] = {}
        for each_object in scores.values():
            for detector, of in each_object.items():
                together.setdefault(detector, []).extend(of)
        facts["evaluation"] = {
            name: {detector: asdict(figures(of)) for detector, of in each.items()} for name, each in (scores | {"all": together}).items()
        }
    out: dict[str, Any] = _finite(facts)
    return out


def _finite(value: Any) -> Any:
    """JSON has no NaN: what is not known is null."""
    if isinstance(value, dict):
        return {key: _finite(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _lines(sessions: dict[str, list[Trial]], tables: dict[str, tuple[Row, ...]], result: dict[str, Any]) -> list[str]:
    lines = []
    for name, trials in sessions.items():
        contacts = sum(len(each.found.contacts) for each in trials)
        made = " (simulated)" if result["objects"][name]["simulated"] else ""
        lines.append(f"{name}{made}: {contacts} contacts in {len(trials)} {'trial' if len(trials) == 1 else 'trials'}")
        lines.append("  channel      at rest  at stable contact        change  contacts")
        for row in tables[name]:
            spread = "" if math.isnan(row.scatter) else f" +- {row.scatter:.4g}"
            change = "-" if math.isnan(row.change) else f"{100 * row.change:+.1f} %"
            touched = "-" if math.isnan(row.touched) else f"{row.touched:.4g}{spread}"
            state = f"  ({row.state})" if row.state else ""
            rest = "-" if math.isnan(row.r0) else f"{row.r0:.4g}"
            lines.append(f"  {row.channel:10s}{rest:>10s}  {touched + ' ' + row.unit:22s}{change:>10s}{row.contacts:10d}{state}")
    for name, each in result.get("evaluation", {}).items():
        lines += [f"{name}: {detector:16s}{_judged(of)}" for detector, of in each.items()]
    return lines


def _judged(of: dict[str, Any]) -> str:
    def rate(key: str) -> str:
        return f"{of[key]['value']:.3f} [{of[key]['low']:.3f}, {of[key]['high']:.3f}]" if of[key]["value"] is not None else "-"

    return f"precision {rate('precision')}  recall {rate('recall')}  false alarms a minute {rate('false_alarms')}"
