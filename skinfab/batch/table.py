"""What came out of a batch: one table for spreadsheets, one page for people, one object for scripts."""

from __future__ import annotations

import csv
import io
import json
import os
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from skinfab.batch.job import STATUSES, Job
from skinfab.batch.plan import Plan
from skinfab.batch.run import Outcome
from skinfab.files import atomic_write
from skinfab.report.html import STYLE

#: Files that a batch leaves beside the jobs' folders.
CSV, PAGE, OBJECT = "batch.csv", "batch.html", "batch.json"

#: Figures of a job that was made, by their names in its record, and on the page.
_FIGURES = {
    "n_faces": ("faces", "{:,}"),
    "n_pieces": ("pieces", "{}"),
    "d_mean": ("d mean", "{:.4f}"),
    "d_p99": ("d 99 %", "{:.4f}"),
    "seam_mm": ("seam, mm", "{:.0f}"),
    "n_sensors": ("sensors", "{}"),
    "ink_mm3": ("ink, mm³", "{:.0f}"),
    "print_s": ("print, s", "{:.0f}"),
    "n_moulds": ("moulds", "{}"),
    "n_warnings": ("warnings", "{}"),
}
_USED = {"wall_s": ("took, s", "{:.1f}"), "cpu_s": ("processor, s", "{:.1f}"), "peak_mb": ("memory, MB", "{:.0f}")}

#: How each end of a job is told.
MEANING = {
    "made": "made",
    "failed": "whose input cannot be used",
    "refused": "refused by their own checks",
    "time": "over the time limit",
    "memory": "over the memory limit",
    "crashed": "crashed",
    "lost": "lost with their workers",
    "not run": "not run",
}


def counts(outcome: Outcome) -> dict[str, int]:
    """How many jobs ended in each way, in a fixed order."""
    ends = [record["status"] for record in outcome.records.values()]
    return {status: ends.count(status) for status in STATUSES}


def summary(outcome: Outcome) -> str:
    """The counts in words.

    Examples
    --------
    >>> summary(Outcome({"a": {"status": "made"}, "b": {"status": "time"}}, 1, ()))
    '2 jobs (1 of them done before): 1 made, 1 over the time limit'
    """
    number = len(outcome.records)
    ends = ", ".join(f"{n} {MEANING[status]}" for status, n in counts(outcome).items() if n)
    before = f" ({outcome.before} of them done before)" if outcome.before else ""
    return f"{number} job{'s' * (number != 1)}{before}: {ends}"


def as_object(plan: Plan, outcome: Outcome) -> dict[str, Any]:
    """For scripts: counts, and of each job its record and where its result lies, in the order of the plan."""
    jobs = [
        {**outcome.records[job.name], "mesh": job.mesh, "settings": dict(plan.given[job.name]), "folder": f"jobs/{job.name}"}
        for job in plan.jobs
    ]
    return {"schema": 1, "counts": counts(outcome), "done_before": outcome.before, "jobs": jobs, "notes": [*plan.notes, *outcome.notes]}


def write_tables(plan: Plan, outcome: Outcome, folder: Path) -> dict[str, Any]:
    """Write ``batch.csv``, ``batch.html`` and ``batch.json``; what the last of them holds.

    Raises
    ------
    InputError
        They cannot be written.
    """
    found = as_object(plan, outcome)
    for name, text in ((CSV, _csv(plan, outcome)), (PAGE, _page(plan, outcome, folder))):
        atomic_write(folder / name, text.encode(errors="backslashreplace"))  # names of files may have bytes that are no UTF-8
    atomic_write(folder / OBJECT, json.dumps(found, indent=1, allow_nan=False) + "\n")
    return found


def _csv(plan: Plan, outcome: Outcome) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["job", "mesh", *plan.keys, "status", *_FIGURES, *_USED, "attempts", "message"])
    for job in plan.jobs:
        record = outcome.records[job.name]
        figures = record.get("figures", {})
        settings = [plan.given[job.name][key] for key in plan.keys]
        cells = [*(figures.get(key, "") for key in _FIGURES), *(record.get(key, "") for key in (*_USED, "attempts"))]
        writer.writerow([job.name, job.mesh, *settings, record["status"], *cells, record["message"]])
    return text.getvalue()


def _page(plan: Plan, outcome: Outcome, folder: Path) -> str:
    named = _Names([job.mesh for job in plan.jobs])
    failed = [job for job in plan.jobs if outcome.records[job.name]["status"] != "made"]
    options = [f"--{key}" for key in plan.keys]  # a figure may have the name of a setting
    head = ["mesh", *options, "result", *(f"#{title}" for title, _ in (*_FIGURES.values(), *_USED.values()))]
    rows = [_row(job, named(job), outcome.records[job.name], _settings(job, plan)) for job in plan.jobs]
    why = [
        [_link(job, named(job), outcome.records[job.name]["status"]), *_settings(job, plan), escape(outcome.records[job.name]["message"])]
        for job in failed
    ]
    parts = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">',
        f"<title>Batch {escape(folder.name)}</title><style>{STYLE}</style></head><body>",
        f"<h1>Batch {escape(folder.name)}</h1>",
        f"<p>{escape(summary(outcome))}.</p>",
        *(f'<div class="warning"><p>{escape(note)}</p></div>' for note in (*plan.notes, *outcome.notes)),
        *(["<h2>Without a result</h2>", _table(["mesh", *options, "why"], why)] if why else []),
        "<h2>All jobs</h2>",
        _table(head, rows),
        "<p>d is the distortion: 4 is perfect.</p>",
        "</body></html>",
    ]
    return "\n".join(parts) + "\n"


def _row(job: Job, name: str, record: Mapping[str, Any], settings: Sequence[str]) -> list[str]:
    figures = record.get("figures", {})
    numbers = [form.format(figures[key]) if key in figures else "" for key, (_, form) in _FIGURES.items()]
    used = [form.format(record[key]) if key in record else "" for key, (_, form) in _USED.items()]
    return [_link(job, name, record["status"]), *settings, escape(record["status"]), *numbers, *used]


def _settings(job: Job, plan: Plan) -> list[str]:
    """Cells; of a file its name."""
    given = {key: str(plan.given[job.name][key]) for key in plan.keys}
    return [escape(Path(value).name if key in job.files else value) for key, value in given.items()]


class _Names:
    """Meshes by their paths in the folder that holds them all."""

    def __init__(self, meshes: Sequence[str]) -> None:
        self._folder = os.path.commonpath([os.path.dirname(mesh) for mesh in meshes])

    def __call__(self, job: Job) -> str:
        return os.path.relpath(job.mesh, self._folder)


def _link(job: Job, text: str, status: str) -> str:
    """To what there is of it."""
    if status == "not run":
        return escape(text)
    return f'<a href="jobs/{job.name}/{"report.html" if status == "made" else ""}">{escape(text)}</a>'


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Cells are HTML; a heading that begins with # has numbers below it."""
    marks = [' class="n"' if title.startswith("#") else "" for title in head]
    top = "".join(f"<th{mark}>{escape(title.removeprefix('#'))}</th>" for mark, title in zip(marks, head, strict=True))
    body = "\n".join("<tr>" + "".join(f"<td{m}>{cell}</td>" for m, cell in zip(marks, row, strict=True)) + "</tr>" for row in rows)
    return f'<div class="table"><table><thead><tr>{top}</tr></thead><tbody>\n{body}\n</tbody></table></div>'
