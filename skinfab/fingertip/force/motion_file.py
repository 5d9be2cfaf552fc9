"""Events as a CSV file: a row an event, with the log it is of."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from pathlib import Path

from skinfab.errors import InputError
from skinfab.fingertip.force.motion import KINDS, Motion
from skinfab.spreadsheet import read_csv_rows

HEAD = ("log", "kind", "start_s", "end_s", "told_s", "simulated")
_MAX_BYTES = 50_000_000


def events_csv(events: Mapping[str, Sequence[Motion]], *, simulated: Mapping[str, bool]) -> str:
    """The table; what still lasts at the end of its log has no end.

    Examples
    --------
    >>> print(events_csv({"a.csv": [Motion("rolling", 1.0, 2.0, 1.1)]}, simulated={"a.csv": True}), end="")
    log,kind,start_s,end_s,told_s,simulated
    a.csv,rolling,1.000,2.000,1.100,1
    """
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(HEAD)
    for name, each in events.items():
        for event in each:
            times = ("" if math.isnan(t) else f"{t:.3f}" for t in (event.start, event.end, event.told))
            rows.writerow([name, event.kind, *times, int(simulated[name])])
    return text.getvalue()


def read_events(path: str | Path) -> dict[str, list[Motion]]:
    """What `events_csv` made, or a table by hand with at least log, kind, start_s and end_s.

    Raises
    ------
    InputError
        It cannot be read, lacks a heading, or has a row that is no event; which one is said.
    """
    path = Path(path)
    rows = read_csv_rows(path, max_bytes=_MAX_BYTES, wanted="a table of events as a CSV file")
    if rows and any(name not in rows[0] for name in HEAD[:4]):
        raise InputError(f"{path} is no table of events; give it the headings {','.join(HEAD[:4])} and a row an event")
    out: dict[str, list[Motion]] = {}
    for k, row in enumerate(rows):
        try:
            start, end = float(row["start_s"]), float(row["end_s"])
        except (TypeError, ValueError):
            start = end = math.nan
        if row["kind"] not in KINDS or not start <= end:
            raise InputError(f"{path}, row {k + 1}: {row['kind']} from {row['start_s']} to {row['end_s']} s is no event; mend the row")
        out.setdefault((row["log"] or "").strip(), []).append(Motion(row["kind"], start, end))
    return out
