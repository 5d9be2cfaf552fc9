"""The text of a printer profile, with what it takes over from another: ``extends = "generic-marlin"``."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

from skinfab.errors import InputError
from skinfab.toml_file import read_toml


@dataclass(frozen=True)
class Profile:
    """The tables of a profile, those of its parents filled in.

    Parameters
    ----------
    name : str
        What it was asked for by.
    data : dict
        Its tables.
    source : str
        The profile itself, as its parents are named in `sources`.
    sources : dict
        Which profile each field was said in, by its keys, such as ``("park", "x")``.
    """

    name: str
    data: dict[str, Any]
    source: str
    sources: dict[tuple[str, ...], str]

    def where(self, *keys: str) -> str:
        """A field as an error names it."""
        return ", ".join([f"printer profile {self.name}", *keys])

    def taken_over(self, *keys: str) -> str:
        """Which parent a field was said in, in brackets; nothing where the profile says it itself.

        Examples
        --------
        >>> Profile("own.toml", {}, "own.toml", {("park", "x"): "generic-marlin"}).taken_over("park", "x")
        ' (taken over from generic-marlin)'
        """
        source = self.sources.get(keys, self.source)
        return "" if source == self.source else f" (taken over from {source})"


def read_profile(name: str | Path) -> Profile:
    """The tables of a bundled profile, by name, or of any TOML file, by path, those of its parents filled in.

    What a profile says itself counts; what it leaves out is its parent's, field by field. A parent is named as a
    profile is, a path counting from the file that names it.

    Raises
    ------
    InputError
        No such profile, not TOML, an unknown parent, or profiles that extend each other in a circle.

    Examples
    --------
    >>> read_profile("generic-marlin").data["bed"]["height"]
    200
    """
    chain: list[str] = []
    found: dict[str, Any] = {}
    sources: dict[tuple[str, ...], str] = {}
    wanted: str | Path | None = name
    while wanted is not None:
        try:
            source, data = _load(wanted)
        except InputError as fault:
            if not chain:
                raise
            raise InputError(f"printer profile {chain[-1]} extends {str(wanted)!r}: {fault}") from fault
        if source in chain:
            raise InputError(f"printer profiles extend each other in a circle: {' -> '.join([*chain, source])}; take one 'extends' out")
        chain.append(source)
        wanted = _parent(data.pop("extends", None), source)
        found = _filled(found, data)
        for keys in _fields(data):
            sources.setdefault(keys, source)
    return Profile(str(name), found, chain[0], sources)


def bundled_printers() -> tuple[str, ...]:
    """Names of the bundled profiles."""
    return tuple(sorted(p.name[:-5] for p in (resources.files("gcode") / "profiles").iterdir() if p.name.endswith(".toml")))


def _load(name: str | Path) -> tuple[str, dict[str, Any]]:
    """A profile by itself, and what to call it."""
    path = Path(name)
    if "\0" in str(name):
        raise InputError(f"no printer profile can be named {str(name)!r}; there are {', '.join(bundled_printers())}, or give a .toml file")
    if path.suffix == ".toml":
        source: Any = path
        called = str(path.resolve())
    else:
        source = resources.files("gcode") / "profiles" / f"{name}.toml"
        called = str(name)
        if called not in bundled_printers():
            raise InputError(f"no printer profile named {str(name)!r}; there are {', '.join(bundled_printers())}, or give a .toml file")
    try:
        return called, read_toml(source, path)
    except FileNotFoundError:
        raise InputError(f"no printer profile at {path}") from None
    except OSError as fault:
        raise InputError(f"cannot read the printer profile {path}: {fault.strerror or fault}") from fault


def _parent(named: Any, source: str) -> str | Path | None:
    if named is None:
        return None
    if not isinstance(named, str):
        raise InputError(f"printer profile {source}, extends is {named!r}; it must be the name of a profile in quotes")
    return Path(source).parent / named if named.endswith(".toml") else named


def _filled(own: dict[str, Any], parent: dict[str, Any]) -> dict[str, Any]:
    """`own`, and what of `parent` it does not say, table by table."""
    both = {
        key: _filled(own[key], parent[key])
        for key in own.keys() & parent.keys()
        if isinstance(own[key], dict) and isinstance(parent[key], dict)
    }
    return {**parent, **own, **both}


def _fields(data: dict[str, Any], above: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """Keys of all tables and fields."""
    for key, value in data.items():
        yield (*above, key)
        if isinstance(value, dict):
            yield from _fields(value, (*above, key))
