"""`skinfab force train contact`: what a fingertip's sensor reads where it is touched at known places."""

from __future__ import annotations

import argparse
import csv
import io
import json
from pathlib import Path

from skinfab.cli import steps
from skinfab.cli.force_result import result_folder, told_as_json

_TRAINED = ("model.npz", "result.json")
PLACES = "places.csv"


def add_train(topics: argparse._SubParsersAction[argparse.ArgumentParser], *, fingertip: argparse.ArgumentParser) -> None:
    """Add the parser; `fingertip` has the options that say what the fingertip is."""
    from skinfab.cli.force import add_output, finish

    p = topics.add_parser("contact", help="learn from touches at known places how the sensor is mounted", parents=[fingertip])
    p.add_argument("logs", metavar="LOG", nargs="+", type=Path, help="a touch each, pushed from several sides; from six places on")
    p.add_argument("--places", metavar="FILE", type=Path, required=True, help="CSV of log,x_mm,y_mm,z_mm in the fingertip's frame")
    p.add_argument("--tare", metavar="S", type=steps.positive, default=0.5, help="untouched at the beginning (default: 0.5)")
    add_output(p, "the model and the result")
    finish(p, train)


def simulate(args: argparse.Namespace) -> int:
    """Write a log a touch, and the table of places."""
    from skinfab.fingertip.force.logs import write_wrench
    from skinfab.fingertip.force.touch_model import HEAD
    from skinfab.fingertip.force.touch_simulator import simulate_touches
    from skinfab.staging import staged_folder

    logs, places = simulate_touches(args.touches, seed=args.seed)
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow([*HEAD, "simulated"])
    rows.writerows([name, *(f"{x:.4f}" for x in place.tolist()), 1] for name, place in places.items())
    with staged_folder(args.output) as folder:
        for log in logs:
            write_wrench(log, folder / log.name)
        (folder / PLACES).write_text(text.getvalue())
    result = {"simulated": True, "files": [str(args.output / name) for name in (*places, PLACES)]}
    print(json.dumps(result) if args.json else f"{args.output}: {len(logs)} simulated touches, and {PLACES}")
    return 0


def train(args: argparse.Namespace) -> int:
    """Learn the sensor's matrix, judge it on places that were held out, and write the model."""
    from skinfab.cli.force_contact import reach, surface_of
    from skinfab.errors import InputError
    from skinfab.files import require_apart
    from skinfab.fingertip.force.contact import LEAST_FORCE_N
    from skinfab.fingertip.force.logs import read_wrench
    from skinfab.fingertip.force.poses import require_alive
    from skinfab.fingertip.force.touch_model import learn_touches, read_places, save_touches
    from skinfab.fingertip.force.wrench import require_nmm

    require_apart(args.output, _TRAINED, [*args.logs, args.places, *([args.tip] if args.tip else [])])
    surface, places = surface_of(args), read_places(args.places)
    logs = [read_wrench(path) for path in args.logs]
    names = [log.name for log in logs]
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise InputError(f"two logs are called {twice}; give each file a name of its own")
    for log in logs:
        require_alive(log)
        if not log.units_said:
            require_nmm(log.force, log.moment, reach_mm=reach(surface), least_force=LEAST_FORCE_N, where=log.name)
    trained = learn_touches(logs, places, surface, rest_s=args.tare)
    made_from = [
        {"file": log.name, "sha256": log.sha256, "simulated": log.simulated, "place_mm": places[log.name].tolist()} for log in logs
    ]
    simulated, model = any(log.simulated for log in logs), trained.model
    notes = [note for log in logs for note in log.notes]
    notes += [f"{said}; it was left out, so mend the table of places or touch there again" for said in trained.left_out]
    if not trained.helps:
        notes.append("places held out are found no better by a learned matrix, so the readings stay as they are; the noise was learned")
    result = {
        "simulated": simulated,
        "surface": model.surface,
        "places": trained.places,
        "held_out_mm": {
            "before": trained.before_mm,
            "after": trained.after_mm,
            "worst_before": trained.worst_before_mm,
            "worst_after": trained.worst_after_mm,
        },
        "helps": trained.helps,
        "left_out": list(trained.left_out),
        "matrix": model.matrix.tolist(),
        "noise": {"force_n": model.noise.force_n, "moment_nmm": model.noise.moment_nmm},
        "made_from": made_from,
        "notes": notes,
    }
    with result_folder(args, result) as folder:
        save_touches(trained, folder / "model.npz", made_from=made_from)
    if told_as_json(args, result):
        return 0
    made = " (simulated)" if simulated else ""
    print(
        f"{trained.places} touches on {model.surface}{made}: places held out are found to {trained.after_mm:.2f} mm (worst "
        f"{trained.worst_after_mm:.2f}), as read to {trained.before_mm:.2f} (worst {trained.worst_before_mm:.2f}); noise "
        f"{model.noise.force_n:.2g} N and {model.noise.moment_nmm:.2g} N mm"
    )
    print(f"{args.output}: {', '.join(_TRAINED)}")
    return 0
