"""One job: a mesh and the settings of `skinfab make`, named by what is in them, and the folder that its result is in."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

from skinfab.errors import InputError
from skinfab.toml_file import read_toml

#: What an option may be set to.
Value: TypeAlias = str | int | float | bool

#: Record of a job, in its folder.
RECORD = "job.json"

#: What the command printed, in its folder.
SAID = "said.txt"

#: Held by the client of the batch, in its folder.
LOCK = ".lock"

#: How a job may end. All but the last are kept and not done again.
STATUSES = ("made", "failed", "refused", "time", "memory", "crashed", "lost", "not run")

#: So many workers may die of a job.
ATTEMPTS = 3


@dataclass(frozen=True)
class Job:
    """What is to be made.

    Parameters
    ----------
    name : str
        Of its content, as `name_of` gives it.
    mesh : str
        Absolute path.
    settings : dict
        Options of the command by their long names, without the dashes; what is left out has its default.
    files : tuple of str
        The options whose value is a file to be read.
    time_s : float, s, optional
    memory_mb : float, MB (10^6 bytes), optional
    """

    name: str
    mesh: str
    settings: Mapping[str, Value]
    files: tuple[str, ...] = field(default=())
    time_s: float | None = None
    memory_mb: float | None = None

    def words(self, output: str | Path) -> list[str]:
        """The command that does it, without the program's name.

        Examples
        --------
        >>> Job("3f", "/a.obj", {"pieces": "fewest", "repair": True}).words("out")
        ['make', '/a.obj', '-o', 'out', '--pieces=fewest', '--repair']
        """
        return ["make", self.mesh, "-o", str(output), *option_words(self.settings)]

    def has_changed(self) -> bool:
        """Whether the mesh, or a file of the settings, is no longer what it was when the job was named."""
        return name_of(self.mesh, self.settings, self.files) != self.name


def option_words(settings: Mapping[str, Value]) -> list[str]:
    """Settings as words of a command line; a flag that is false is left out.

    Examples
    --------
    >>> option_words({"seed": 3, "complete": False, "repair": True})
    ['--seed=3', '--repair']
    """
    words = []
    for key, value in settings.items():
        if value is True:
            words.append(f"--{key}")
        elif value is not False:
            words.append(f"--{key}={value}")
    return words


def name_of(mesh: str | Path, settings: Mapping[str, Value], files: tuple[str, ...] = (), *, digests: dict[str, str] | None = None) -> str:
    """Sixteen hexadecimal digits that stand for the content of a mesh file and its settings.

    Where the mesh lies and what it is called does not count, but for its suffix, by which it is read. Of a setting that is a file
    its content counts, and that of the printer profiles it extends.

    Parameters
    ----------
    mesh : path
    settings : mapping
    files : tuple of str
        Keys of `settings` whose value is a file.
    digests : dict, optional
        Of files by path; those missing are added, so that a file is read once however many jobs it is part of.
    """
    digests = {} if digests is None else digests
    for path in (str(mesh), *(str(settings[key]) for key in files)):
        if path not in digests:
            digests[path] = _digest(path)
    content = {key: digests[str(value)] if key in files else value for key, value in settings.items()}
    named = json.dumps({"mesh": digests[str(mesh)], "suffix": Path(mesh).suffix.lower(), "settings": content}, sort_keys=True)
    return hashlib.sha256(named.encode()).hexdigest()[:16]


def _digest(path: str) -> str:
    """Of a file's content; one that cannot be read stands for itself, and the job will say what is wrong with it."""
    seen: list[str] = []
    total = hashlib.sha256()
    here: Path | None = Path(path)
    while here is not None and str(here) not in seen:
        seen.append(str(here))
        try:
            with here.open("rb") as file:
                total.update(hashlib.file_digest(file, "sha256").digest())
        except OSError as fault:
            total.update(f"{here}: {fault.strerror}".encode())
            break
        here = _parent(here)
    return total.hexdigest()


def _parent(path: Path) -> Path | None:
    """The file that a printer profile extends."""
    if path.suffix != ".toml":
        return None
    try:
        named = read_toml(path, path).get("extends")
    except (OSError, InputError):
        return None  # the job will say so
    return path.parent / named if isinstance(named, str) and named.endswith(".toml") else None


@dataclass(frozen=True)
class Home:
    """The folder of a batch: ``jobs/NAME`` for each job that is over, and what is under way, hidden.

    Parameters
    ----------
    folder : path
    """

    folder: Path

    def place(self, name: str) -> Path:
        """Where the result of a job is."""
        return self.folder / "jobs" / name

    def record(self, name: str) -> Path:
        """Where its record is."""
        return self.place(name) / RECORD

    @property
    def under_way(self) -> Path:
        """For locks, and for what is being made."""
        return self.folder / ".under-way"

    def names(self) -> set[str]:
        """Names of all jobs that are over, also those of other settings."""
        try:
            return {entry.name for entry in os.scandir(self.folder / "jobs") if entry.is_dir()}
        except FileNotFoundError:
            return set()
