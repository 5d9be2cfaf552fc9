"""The files that `skinfab contact` leaves: all of one run, or none."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from calibration.contact.detector import Contact
    from calibration.contact.table import Row
    from skinfab.cli.contact import Trial

#: What every run leaves; and what only one on the simulator does.
FILES, TRUTH = ("contact.png", "events.csv", "result.json", "table.csv"), "truth.csv"
_EVENT = ["object", "log", "channel", "start_s", "end_s", "sign", "strength", "saturated", "dropped", "simulated"]
_ROW = [
    "object",
    "channel",
    "unit",
    "r0",
    "touched",
    "scatter",
    "change",
    "change_scatter",
    "contacts",
    "trials",
    "watched",
    "state",
    "simulated",
]


def write_files(
    target: Path, sessions: dict[str, list[Trial]], tables: dict[str, tuple[Row, ...]], result: dict[str, Any]
) -> tuple[str, ...]:
    """Write events, table, result and figure, and the truth where it is known; the files' names.

    A table says in a column of its own whether its rows are simulated, so that any reader of CSV files reads it.

    Raises
    ------
    InputError
        The folder cannot be made or written, or the disk is full.
    """
    from calibration.contact.figure import Panel, draw_contacts
    from skinfab.staging import staged_folder

    everything = [(name, each) for name, trials in sessions.items() for each in trials]
    found = [_event(name, each, c) for name, each in everything for c in each.found.contacts]
    true = [_event(name, each, c) for name, each in everything for c in each.truth]
    # The first trial of each object; of a single object its first trials.
    panels = everything if len(sessions) == 1 else [(name, trials[0]) for name, trials in sessions.items()]
    with staged_folder(target) as folder:
        (folder / "events.csv").write_text(_csv(_EVENT, found))
        if true:
            (folder / TRUTH).write_text(_csv(_EVENT, true))
        (folder / "table.csv").write_text(_csv(_ROW, _rows(tables, result)))
        (folder / "result.json").write_text(json.dumps(result, indent=1, allow_nan=False) + "\n")
        draw_contacts([Panel(each.name, each.recording, each.found, each.truth) for _, each in panels], folder / "contact.png")
        names = tuple(sorted(each.name for each in folder.iterdir()))
    if not true:
        _remove_truth(target / TRUTH)
    return names


def _remove_truth(path: Path) -> None:
    """Remove what an earlier run on the simulator left: it is not the truth of these contacts. A file of somebody else's stays."""
    try:
        with path.open(encoding="utf-8") as file:
            ours = file.readline(1000).rstrip("\n") == ",".join(_EVENT)
    except (OSError, UnicodeDecodeError):
        return
    if ours:
        path.unlink(missing_ok=True)


def _event(name: str, trial: Trial, c: Contact) -> list[str]:
    end = "" if c.lasting else f"{c.end:.3f}"
    flags = [str(int(flag)) for flag in (c.saturated, c.dropped, trial.recording.stream.simulated)]
    return [name, trial.name, c.channel, f"{c.start:.3f}", end, str(c.sign), f"{c.strength:.4g}", *flags]


def _rows(tables: dict[str, tuple[Row, ...]], result: dict[str, Any]) -> list[list[str]]:
    return [
        [
            name,
            row.channel,
            row.unit,
            *("" if math.isnan(x) else f"{x:.6g}" for x in (row.r0, row.touched, row.scatter, row.change, row.change_scatter)),
            str(row.contacts),
            str(row.trials),
            f"{row.watched:.4f}",
            row.state,
            str(int(result["objects"][name]["simulated"])),
        ]
        for name, table in tables.items()
        for row in table
    ]


def _csv(head: list[str], rows: Sequence[list[str]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([head, *rows])
    return text.getvalue()
