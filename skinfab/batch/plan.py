"""The file that says what a batch is to do: meshes, settings, limits. Every list of settings multiplies."""

from __future__ import annotations

import difflib
import fnmatch
import itertools
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from skinfab.batch.job import Job, Value, name_of
from skinfab.batch.options import Options
from skinfab.errors import InputError
from skinfab.progress import Progress, silent
from skinfab.toml_file import MAX_BYTES, parse_toml

#: More jobs are a slip of the pen: at a second each they would take twelve days on one core.
MOST_JOBS = 1_000_000

_TABLES = ("meshes", "settings", "limits")
_LIMITS = ("time_s", "memory_mb")


@dataclass(frozen=True)
class Plan:
    """What is to be done.

    Parameters
    ----------
    jobs : tuple of Job
        Each once, in the order of the file: mesh after mesh, the last setting fastest.
    keys : tuple of str
        The settings that the file names.
    given : dict of str to dict
        The settings of each job by its name, also those that are the default.
    notes : tuple of str
        What the user should know.
    """

    jobs: tuple[Job, ...]
    keys: tuple[str, ...]
    given: Mapping[str, Mapping[str, Value]]
    notes: tuple[str, ...] = ()


def read_plan(path: str | Path, *, output: str | Path, progress: Progress = silent) -> Plan:
    """Read a file such as

    .. code-block:: toml

        meshes = ["objects/*.stl", "grip.obj"]

        [settings]
        pieces = ["usual", "fewest"]
        max-distortion = [4.05, 4.1, 4.2]

        [limits]
        time_s = 600
        memory_mb = 4000

    Parameters
    ----------
    path : path
        Paths and patterns in it count from its folder.
    output : path
        What lies there is a result and no mesh, whatever a pattern says.
    progress : Progress
        A pattern may have a whole disk to look through.

    Raises
    ------
    InputError
        It cannot be read, names what is not known, or nothing is left to do: says which line and what to write.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            raw = file.read(MAX_BYTES + 1)
    except OSError as fault:
        raise InputError(
            f"cannot read {path}: {fault.strerror or fault}; give a TOML file of meshes and settings (docs/batch.md)"
        ) from fault
    data = parse_toml(raw, path)
    return _Reader(path, raw.decode(), Path(output).resolve(), progress).plan(data)


class _Reader:
    """Knows the file, so that each fault names its line."""

    def __init__(self, path: Path, text: str, output: Path, progress: Progress) -> None:
        self._path, self._text, self._output, self._progress = path, text, output, progress
        self._folder = path.resolve().parent
        self._options = Options()

    def plan(self, data: dict[str, Any]) -> Plan:
        self._known(data, _TABLES, "")
        for name in ("settings", "limits"):
            if not isinstance(data.get(name, {}), dict):
                self._refuse("", name, f"it must be a table; write [{name}] on a line of its own")
        meshes = self._meshes(data)
        settings = self._settings(data.get("settings", {}))
        limits = self._limits(data.get("limits", {}))
        number = len(meshes)
        for each in settings.values():
            number *= len(each)
        if number > MOST_JOBS:
            raise InputError(
                f"{self._path}: {len(meshes)} meshes and these settings make {number:,} jobs, more than {MOST_JOBS:,}; part the file"
            )
        self._require_fitting(meshes, settings)
        self._progress(0.0, f"reading {len(meshes)} files")
        return self._product(meshes, settings, limits)

    def _product(self, meshes: Sequence[Path], settings: dict[str, list[Value]], limits: dict[str, float]) -> Plan:
        jobs: dict[str, Job] = {}
        given: dict[str, dict[str, Value]] = {}
        same: list[str] = []
        digests: dict[str, str] = {}
        for mesh in meshes:
            for values in itertools.product(*settings.values()):
                every = dict(zip(settings, values, strict=True))
                chosen = {key: value for key, value in every.items() if not self._options.is_default(key, value)}
                files = tuple(key for key, value in chosen.items() if self._options.is_file(key, value))
                job = Job(name_of(mesh, chosen, files, digests=digests), str(mesh), chosen, files, **limits)
                if jobs.setdefault(job.name, job) is job:
                    given[job.name] = every
                else:
                    same.append(f"{mesh.name} is the same as {Path(jobs[job.name].mesh).name}")
        asked = len(jobs) + len(same)
        notes = (f"{len(same)} of {asked} jobs are asked for twice ({same[0]}) and done once",) if same else ()
        return Plan(tuple(jobs.values()), tuple(settings), given, notes)

    def _meshes(self, data: dict[str, Any]) -> list[Path]:
        if "meshes" not in data:
            raise InputError(f'{self._path}: meshes is missing; write meshes = ["objects/*.stl"]')
        patterns = [data["meshes"]] if isinstance(data["meshes"], str) else data["meshes"]
        if not isinstance(patterns, list) or not patterns or not all(isinstance(p, str) and p for p in patterns):
            self._refuse("", "meshes", 'it must be a list of files or patterns such as ["objects/*.stl"]')
        found: dict[Path, None] = {}
        for pattern in patterns:
            self._progress(0.0, f"looking for {pattern}")
            try:
                matches = sorted(self._matches(pattern))
            except ValueError as fault:
                self._refuse("", "meshes", f"{pattern!r} is no pattern of files: {fault}")
            if not matches:
                self._refuse("", "meshes", f"{pattern!r} matches no file in {self._folder} (results in {self._output} do not count)")
            found.update(dict.fromkeys(matches))
        return list(found)

    def _matches(self, pattern: str) -> Iterable[Path]:
        for path in matching(self._folder, Path(pattern).parts):
            if os.path.isfile(path) and self._output not in path.resolve().parents:
                yield path

    def _settings(self, table: dict[str, Any]) -> dict[str, list[Value]]:
        self._known(table, self._options.names, "settings")
        settings: dict[str, list[Value]] = {}
        for key, given in table.items():
            values = given if isinstance(given, list) else [given]
            if not values:
                self._refuse("settings", key, "the list is empty; give values, or leave the key out")
            settings[key] = [self._value(key, value) for value in values]
        return settings

    def _value(self, key: str, given: Any) -> Value:
        try:
            value = self._options.value(key, given)
            if self._options.is_file(key, value):
                value = str(self._folder / str(value))
                if not Path(value).is_file():
                    what = f"{value} is a folder" if Path(value).is_dir() else f"there is no file {value}"
                    raise InputError(f"{what}; paths count from the folder of {self._path.name}")
            self._options.require_known(key, value)
        except InputError as fault:
            self._refuse("settings", key, str(fault))
        return value

    def _limits(self, table: dict[str, Any]) -> dict[str, float]:
        self._known(table, _LIMITS, "limits")
        for key, value in table.items():
            if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value < float("inf"):
                self._refuse("limits", key, f"{value!r} is not a positive number")
        return {key: float(value) for key, value in table.items()}

    def _require_fitting(self, meshes: Sequence[Path], settings: dict[str, list[Value]]) -> None:
        """Each way to set them, with a mesh of each kind."""
        kinds = {mesh.suffix.lower(): mesh for mesh in reversed(meshes)}
        for mesh in kinds.values():
            for values in itertools.product(*settings.values()):
                try:
                    self._options.require_fitting(mesh, dict(zip(settings, values, strict=True)))
                except InputError as fault:
                    raise InputError(f"{self._path}, [settings]: {mesh.name}: {fault}") from fault

    def _known(self, table: dict[str, Any], names: Sequence[str], where: str) -> None:
        for key in table:
            if key not in names:
                near = difflib.get_close_matches(key, names, n=1)
                hint = f"did you mean {near[0]}?" if near else f"there are {', '.join(names)}"
                self._refuse(where, key, f"it is not known here; {hint}")

    def _refuse(self, table: str, key: str, why: str) -> NoReturn:
        """Raise, with the line."""
        where = f"[{table}] {key}" if table else key
        raise InputError(f"{self._path}, line {line_of(self._text, table, key)}, {where}: {why}")


def matching(folder: Path, parts: Sequence[str]) -> Iterator[Path]:
    """Paths in a folder by a pattern, taken apart at its slashes; `Path.glob` gives up where a folder goes away while it looks.

    Parameters
    ----------
    folder : path
    parts : sequence of str
        Names; ``*``, ``?`` and ``[`` as in a shell; ``**`` is any depth, without following links.

    Raises
    ------
    ValueError
        ``**`` beside something else, or a name that no system has.
    """
    if not parts:
        yield folder
        return
    first, rest = parts[0], parts[1:]
    if first == "**":
        for inside, _, _ in os.walk(folder):
            yield from matching(Path(inside), rest)
    elif "**" in first:
        raise ValueError("** must stand between slashes")
    elif any(sign in first for sign in "*?["):
        with suppress(OSError):  # it has gone, is no folder, or not ours to look into
            for name in fnmatch.filter(os.listdir(folder), first):
                yield from matching(folder / name, rest)
    else:
        yield from matching(folder / first, rest)


def line_of(text: str, table: str, key: str) -> int:
    """The line of a TOML text where a key is set, from 1; that of its table where it stands inside another value.

    Examples
    --------
    >>> text = "meshes = []\\n[settings]\\npieces = 3"
    >>> line_of(text, "settings", "pieces"), line_of(text, "", "settings"), line_of("settings = {pieces = 3}", "settings", "pieces")
    (3, 2, 1)
    """
    name = rf"[\"']?{re.escape(key)}[\"']?"
    here, fallback = "", 1
    for number, line in enumerate(text.splitlines(), 1):
        if head := re.match(r"\s*\[+\s*([^\]]*?)\s*\]+\s*(#|$)", line):
            here = head[1].strip("\"'")
            if here == key and not table:
                return number
            fallback = number if here == table else fallback
        elif here == table and re.match(rf"\s*{name}\s*=", line):
            return number
        elif not here and table and re.match(rf"\s*{re.escape(table)}\s*[.=]", line):
            fallback = number
            if re.match(rf"\s*{re.escape(table)}\s*\.\s*{name}\s*=", line):
                return number
    return fallback
