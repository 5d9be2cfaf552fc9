"""The text of a printer profile, with what it takes over from another: ``extends = "generic-marlin"``."""

from __future__ import annotations

import tomllib
from importlib import resources
from pathlib import Path
from typing import Any

from skinfab.errors import InputError


def read_profile(name: str | Path) -> dict[str, Any]:
    """The tables of a bundled profile, by name, or of any TOML file, by path, those of its parents filled in.

    What a profile says itself counts; what it leaves out is its parent's, field by field. A parent is named as a
    profile is, a path counting from the file that names it.

    Raises
    ------
    InputError
        No such profile, not TOML, an unknown parent, or profiles that extend each other in a circle.

    Examples
    --------
    >>> read_profile("generic-marlin")["bed"]["height"]
    200
    """
    chain: list[str] = []
    found: dict[str, Any] = {}
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
    return found


def bundled_printers() -> tuple[str, ...]:
    """Names of the bundled profiles."""
    return tuple(sorted(p.name[:-5] for p in (resources.files("gcode") / "profiles").iterdir() if p.name.endswith(".toml")))


def _load(name: str | Path) -> tuple[str, dict[str, Any]]:
    """A profile by itself, and what to call it."""
    path = Path(name)
    if path.suffix == ".toml":
        source: Any = path
        called = str(path.resolve())
    else:
        source = resources.files("gcode") / "profiles" / f"{name}.toml"
        called = str(name)
        if not source.is_file():
            raise InputError(f"no printer profile named {str(name)!r}; there are {', '.join(bundled_printers())}, or give a .toml file")
    try:
        return called, tomllib.loads(source.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise InputError(f"no printer profile at {path}") from None
    except OSError as fault:
        raise InputError(f"cannot read the printer profile {path}: {fault.strerror or fault}") from fault
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as fault:
        raise InputError(f"{path} is not a TOML file: {fault}") from fault


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
