"""`skinfab place SKIN`: put sensors on the flat pieces of a document."""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path

from skinfab.cli import steps


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "place",
        help="put sensors on the flat pieces",
        description="Put sensors on the pieces of a skin document, automatically or as a file says (see docs/sensors.md). Sensors that are "
        "there already are replaced.",
    )
    p.add_argument("skin", metavar="SKIN", type=Path, help="the skin document")
    p.add_argument(
        "-o", "--output", metavar="OUT.skin", type=steps.named(".skin"), help="where to write the result (default: back to SKIN)"
    )
    p.add_argument("--sensors", metavar="FILE.toml", type=Path, help="which sensors, and where (default: automatic)")
    p.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Place, check, write, and say what went where."""
    from skinfab.document import load_skin, save_skin
    from skinfab.electrical import resistance
    from skinfab.material import load_material
    from skinfab.patterns.registry import parameters

    skin = load_skin(args.skin)
    material = load_material(skin.material)
    sensors, warnings = steps.place_sensors(skin, material, args.sensors)
    skin = replace(skin, sensors=sensors)
    target = args.output or args.skin
    save_skin(skin, target)
    steps.say(warnings, kind="warning")
    if args.json:
        listed = [
            {"id": s.id, "kind": s.pattern.kind, "piece": s.piece, "channel": s.channel, "params": parameters(s.pattern)}
            for s in skin.sensors
        ]
        print(json.dumps({"skin": str(target), "sensors": listed, "warnings": list(warnings)}))
        return 0
    for s in skin.sensors:
        r = resistance(s.path.length, material.ink)
        print(
            f"{s.id}: {s.pattern.kind} on {s.piece}, channel {s.channel}, {s.path.length:.1f} mm, "
            f"{r.median:.0f} kohm ({r.low:.0f} to {r.high:.0f})"
        )
    print(f"{target}: {steps.counted(len(skin.sensors), 'sensor')}")
    return 0
