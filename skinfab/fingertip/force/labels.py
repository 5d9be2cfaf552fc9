"""What logs were taken of, where they do not say so themselves: a table of log, label and group."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from skinfab.errors import InputError
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.spreadsheet import read_csv_rows

HEAD = ("log", "label", "group")
_MAX_BYTES = 10_000_000


def with_labels(logs: Sequence[WrenchLog], path: str | Path) -> list[WrenchLog]:
    """The logs with the labels and groups of a CSV file; it stands above what a log says of itself.

    Raises
    ------
    InputError
        The file cannot be read, lacks a heading, or has no row for a log; or two for one.
    """
    path = Path(path)
    rows = read_csv_rows(path, max_bytes=_MAX_BYTES, wanted="a table of log,label,group as a CSV file")
    if not rows or any(name not in rows[0] for name in HEAD):
        raise InputError(f"{path} is no table of labels; give it the headings {','.join(HEAD)} and a row a log")
    said: dict[str, tuple[str, str]] = {}
    for row in rows:
        name = (row["log"] or "").strip()
        if name in said:
            raise InputError(f"{path} has two rows for {name!r}; leave one")
        said[name] = ((row["label"] or "").strip(), (row["group"] or "").strip())
    if missing := next((log.name for log in logs if log.name not in said), None):
        raise InputError(f"{path} has no row for {missing}; add one: {missing},LABEL,GROUP")
    return [replace(log, label=said[log.name][0], group=said[log.name][1]) for log in logs]


def require_labels(logs: Sequence[WrenchLog]) -> None:
    """Refuse logs of which nobody said what they were taken of, or with what they belong together.

    Raises
    ------
    InputError
        The first one is named.
    """
    for log in logs:
        if not log.label:
            raise InputError(f'{log.name} does not say what it was taken of; write "# label: NAME" before its headings, or give --labels')
        if not log.group:
            raise InputError(
                f'{log.name} does not say what it belongs together with; write "# group: NAME" (its specimen) before its headings, '
                "or give --labels: slides over one specimen must not be both learned from and judged on"
            )
