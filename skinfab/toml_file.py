"""TOML from anybody: a faulty, deep or vast text is one sentence, whatever the standard library's parser makes of it."""

from __future__ import annotations

import tomllib
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from skinfab.errors import InputError

#: No profile, list of sensors or plan of a batch is as large: tomllib takes a second and 80 MB for so much.
MAX_BYTES = 1_000_000

#: Tables within tables; ours go three deep.
MAX_DEPTH = 32

#: What TOML promises of whole numbers: Python reads longer ones, and fails where it makes a float of them.
MOST = 2**63


def read_toml(source: Path | Traversable, called: object) -> dict[str, Any]:
    """The tables of a TOML file.

    Parameters
    ----------
    source : path or importlib.resources Traversable
    called : object
        What a message calls it.

    Raises
    ------
    InputError
        It is no TOML, too large, or nested too deep.
    OSError
        It cannot be opened or read.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> path = Path(tempfile.mkdtemp()) / "a.toml"
    >>> _ = path.write_text("[bed]\\nheight = 200\\n")
    >>> read_toml(path, path.name)
    {'bed': {'height': 200}}
    """
    try:
        with source.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except ValueError as fault:  # a zero byte in the name
        raise InputError(f"{str(called)!r} cannot be the name of a file ({fault}); give a TOML file") from fault
    return parse_toml(data, called)


def parse_toml(data: bytes, called: object) -> dict[str, Any]:
    """As `read_toml`, of what was read already.

    Examples
    --------
    >>> parse_toml(b"a = " + b"[" * 9999, "a.toml")
    Traceback (most recent call last):
        ...
    skinfab.errors.InputError: a.toml is not a TOML file: its brackets are nested too deep
    """
    if len(data) > MAX_BYTES:
        raise InputError(f"{called} has more than {MAX_BYTES / 1e6:g} MB, which none of ours has; give another TOML file")
    try:
        found = tomllib.loads(data.decode().replace("\r\n", "\n"))
    except RecursionError:
        raise InputError(f"{called} is not a TOML file: its brackets are nested too deep") from None
    except ValueError as fault:  # TOML, UTF-8, dates that are none and numbers of thousands of digits alike
        raise InputError(f"{called} is not a TOML file: {' '.join(str(fault).split())}") from fault
    level: list[Any] = [found]
    for _ in range(MAX_DEPTH):
        inside = [each for held in level for each in (held.values() if isinstance(held, dict) else held)]
        if any(isinstance(each, int) and not -MOST <= each < MOST for each in inside):
            raise InputError(f"{called} is not a TOML file: a whole number in it has more than 64 bits")
        level = [each for each in inside if isinstance(each, dict | list)]
        if not level:
            return found
    raise InputError(f"{called} has tables within tables more than {MAX_DEPTH} deep; write it flatter")
