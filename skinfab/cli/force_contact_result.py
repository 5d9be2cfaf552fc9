"""What `skinfab force run contact` found, as facts, files and lines."""

from __future__ import annotations

import argparse
import csv
import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from skinfab.cli.force_result import result_folder

if TYPE_CHECKING:
    from skinfab.fingertip.force.contact import Contacts
    from skinfab.fingertip.force.logs import WrenchLog
    from skinfab.fingertip.force.motion import Motion

_HEAD = ("log", "time_s", "x_mm", "y_mm", "z_mm", "nx", "ny", "nz", "force_n", "inclination_deg", "torsion_nmm", "miss_mm", "sd_mm")


def facts_of(
    args: argparse.Namespace,
    logs: Sequence[WrenchLog],
    found: Sequence[tuple[Contacts, list[Motion]]],
    truth: Mapping[str, Sequence[Motion]],
) -> dict[str, Any]:
    """What result.json says of each log, its events, and how well they were found where the truth is known."""
    from skinfab.fingertip.force.contact import FLAGS

    out: dict[str, Any] = {
        "friction_deg": args.friction,
        "simulated": any(log.simulated for log in logs),
        "logs": {},
        "notes": [note for log in logs for note in log.notes],
    }
    for log, (contacts, events) in zip(logs, found, strict=True):
        touching, trusted = contacts.touching, contacts.trusted
        if (missed := int(((contacts.missed | contacts.mounted) & touching).sum())) * 2 > int(touching.sum()):
            out["notes"].append(
                f"{log.name}: at {missed} of {int(touching.sum())} samples with a force its line comes from where nothing touches "
                "the fingertip; is the force's sign that of the force on the fingertip, and are its frame and size right?"
            )
        out["logs"][log.name] = {
            "sha256": log.sha256,
            "simulated": log.simulated,
            "samples": len(log),
            "touching": int(touching.sum()),
            "flags": {words: int(((contacts.flags & bit) != 0).sum()) for bit, words in FLAGS.items()},
            "trusted": int(trusted.sum()),
            "median_sd_mm": float(f"{_median(contacts.sd_mm[trusted]):.4g}") if trusted.any() else None,
            "events": [{"kind": e.kind, "start_s": e.start, "end_s": None if e.lasting else e.end, "told_s": e.told} for e in events],
        }
    if truth:
        from skinfab.fingertip.force.motion_score import figures, score

        judged = [score(events, truth[log.name], end=float(log.time[-1])) for log, (_, events) in zip(logs, found, strict=True)]
        out["evaluation"] = {
            kind: {key: asdict(value) if key in ("precision", "recall") else value for key, value in of.items()}
            for kind, of in figures(judged).items()
        }
    finite: dict[str, Any] = _finite(out)
    return finite


def _median(values: Any) -> float:
    import numpy as np

    return float(np.median(values))


def _finite(value: Any) -> Any:
    """JSON has no NaN: what is not known is null."""
    if isinstance(value, dict):
        return {key: _finite(each) for key, each in value.items()}
    if isinstance(value, list):
        return [_finite(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def write(
    args: argparse.Namespace,
    logs: Sequence[WrenchLog],
    found: Sequence[tuple[Contacts, list[Motion]]],
    truth: Mapping[str, Sequence[Motion]],
    result: dict[str, Any],
) -> None:
    """Write tables, the figure of the first log, and the result."""
    from skinfab.fingertip.force.motion_figure import draw_motions
    from skinfab.fingertip.force.motion_file import events_csv

    events = {log.name: each for log, (_, each) in zip(logs, found, strict=True)}
    with result_folder(args, result) as folder:
        (folder / "contacts.csv").write_text(_contacts_csv(logs, [contacts for contacts, _ in found]))
        (folder / "events.csv").write_text(events_csv(events, simulated={log.name: log.simulated for log in logs}))
        draw_motions(logs[0], *found[0], truth.get(logs[0].name, ()), args.friction, folder / "contact.png", logs=len(logs))


def _contacts_csv(logs: Sequence[WrenchLog], found: Sequence[Contacts]) -> str:
    import numpy as np

    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow([*_HEAD, "flags", "simulated"])
    for log, c in zip(logs, found, strict=True):
        numbers = np.column_stack(
            [log.time, c.point, c.normal, c.force_n, np.degrees(c.inclination_rad), c.torsion_nmm, c.miss_mm, c.sd_mm]
        )
        for row, flags in zip(numbers.tolist(), c.flags.tolist(), strict=True):
            rows.writerow([log.name, *(f"{value:.6g}" for value in row), flags, int(log.simulated)])
    return text.getvalue()


def _lasted(ms: float) -> str:
    return f"{ms:.2g} ms" if ms < 99.5 else f"{ms:.0f} ms" if ms < 999.5 else f"{ms / 1000:.2g} s"


def lines_of(result: dict[str, Any]) -> list[str]:
    """What is printed: a line a log, how long decisions took, and how well each kind of event was found."""
    lines = []
    by = "" if result["learned"] else " by noise alone"
    for name, log in result["logs"].items():
        kinds = [event["kind"] for event in log["events"]]
        told = ", ".join(f"{kinds.count(kind)} x {kind}" for kind in dict.fromkeys(kinds)) or "nothing moved"
        made = " (simulated)" if log["simulated"] else ""
        known = "" if log["median_sd_mm"] is None else f", point known to {log['median_sd_mm']:.2g} mm{by}"
        wrong = [f"{count} where {words}" for words, count in list(log["flags"].items())[2:] if count]
        doubt = f"; flagged: {', '.join(wrong)}" if wrong else ""
        lines.append(f"{name}{made}: touched in {log['touching']} of {log['samples']} samples{known}{doubt}; {told}")
    if "latency" in result:
        of = result["latency"]
        median, most, worst = (_lasted(of[name]) for name in ("median_ms", "p99_ms", "worst_ms"))
        lines.append(f"decided after {median} (99 %: {most}, worst {worst})")
    for kind, of in result.get("evaluation", {}).items():
        rates = [
            f"{of[key]['value']:.3f} [{of[key]['low']:.3f}, {of[key]['high']:.3f}]" if of[key]["value"] is not None else "-"
            for key in ("precision", "recall")
        ]
        lines.append(f"{kind:11s}precision {rates[0]}  recall {rates[1]}  of {of['true']}")
    return lines
