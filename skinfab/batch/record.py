"""The record of a job that is over, as it is read again: what a later run, its tables and its page rely on is looked at here, once."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from skinfab.batch.job import STATUSES
from skinfab.errors import InputError
from skinfab.strict_json import strict_json

#: What every record has.
_ALWAYS = {"status": str, "message": str, "mesh": str, "skinfab": str, "host": str, "settings": dict, "limits": dict, "attempts": int}

#: Tables of numbers, and numbers; some jobs have none.
_TABLES, _NUMBERS = ("limits", "figures"), ("wall_s", "cpu_s", "peak_mb")


def read_record(path: Path, name: str) -> dict[str, Any] | None:
    """What a job's record says, or None where the job is not over.

    Parameters
    ----------
    path : path
        Of the record, in the folder of the job.
    name : str
        Of the job.

    Raises
    ------
    InputError
        There is a folder without a record, or with one that is not what was written: says which is to be removed.
    """
    again = f"remove {path.parent}, and the job is done again"
    try:
        found = strict_json(path.read_bytes())
    except (FileNotFoundError, NotADirectoryError):
        if _in_the_way(path.parent):
            raise InputError(f"{path.parent} has no {path.name}; {again}") from None
        return None
    except OSError as fault:
        raise InputError(f"cannot read {path} ({fault.strerror or fault}); {again}") from fault
    except RecursionError:
        raise InputError(f"{path} is damaged (its brackets are nested too deep); {again}") from None
    except ValueError as fault:
        raise InputError(f"{path} is damaged ({fault}); {again}") from fault
    if not isinstance(found, dict) or found.get("job") != name or found.get("status") not in STATUSES[:-1]:
        raise InputError(f"{path} is not the record of job {name}; {again}")
    if wrong := _wrong(found):
        raise InputError(f"{path} is damaged ({wrong} is not what was written); {again}")
    return found


def _in_the_way(place: Path) -> bool:
    """Whether a result cannot be moved there: nothing may be, or a folder with nothing in it."""
    try:
        return any(place.iterdir())
    except FileNotFoundError:
        return place.is_symlink()
    except NotADirectoryError:
        return True


def _wrong(record: dict[str, Any]) -> str:
    """The key of what is missing or of another kind; empty where nothing is."""
    for key, kind in _ALWAYS.items():
        if not isinstance(record.get(key), kind):
            return key
    for key, value in record.items():
        # One table deep: it is written again for every table of the batch.
        if not all(
            each is None or isinstance(each, str | int | float) for each in (value.values() if isinstance(value, dict) else [value])
        ):
            return key
    tables = {key: record.get(key, {}) for key in _TABLES}
    tables["limits"] = {key: value for key, value in tables["limits"].items() if value is not None}
    for key, table in tables.items():
        if not isinstance(table, dict) or not all(map(_is_number, table.values())):
            return key
    if not {"time_s", "memory_mb"} <= record["limits"].keys():
        return "limits"
    return next((key for key in _NUMBERS if key in record and not _is_number(record[key])), "")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
