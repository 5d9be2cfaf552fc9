"""The options of `skinfab make`, as keys of a batch's settings: found from its own parser, so that there is one list of them."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NoReturn

from skinfab.batch.job import Value, option_words
from skinfab.errors import InputError

#: Options that a batch sets itself.
_OWN = ("help", "output", "json")

#: Options whose value is a file, or may be one where it ends in .toml.
_FILES = ("sensors", "cuts", "printer", "material")

#: Options that name a profile.
_PROFILES = ("printer", "material")


class Options:
    """What may be set, and whether a value will do.

    Examples
    --------
    >>> options = Options()
    >>> options.value("max-distortion", "4.10")
    4.1
    >>> options.value("max-distortion", 3)
    Traceback (most recent call last):
        ...
    skinfab.errors.InputError: 3 is not above 4, which is a perfect flattening
    """

    def __init__(self) -> None:
        from skinfab.cli import make

        subparsers = argparse.ArgumentParser(allow_abbrev=False).add_subparsers()
        make.add_parser(subparsers)
        self._parser: argparse.ArgumentParser = subparsers.choices["make"]
        self._parser.error = _raise  # type: ignore[method-assign]  # its own ends the process
        options = [action for action in self._parser._actions if action.option_strings]
        self._actions = {action.option_strings[-1].removeprefix("--"): action for action in options}
        self._defaults = vars(self._parse("mesh.obj", {}))
        self.names = tuple(name for name in self._actions if name not in _OWN)

    def value(self, name: str, given: object) -> Value:
        """A value as the command understands it.

        Raises
        ------
        InputError
            The command would not take it.
        """
        if not isinstance(given, str | int | float):
            raise InputError(f"{given!r} is neither a text, a number, true nor false")
        action = self._actions[name]
        if isinstance(action, argparse._StoreTrueAction) != isinstance(given, bool):
            raise InputError(
                f"{given!r} does not go here; it must be " + ("a text or a number" if isinstance(given, bool) else "true or false")
            )
        try:
            found = getattr(self._parse("mesh.obj", {name: given}), action.dest)
        except InputError as fault:
            raise InputError(str(fault).split(": ", 1)[-1]) from fault  # without "argument --name"
        return str(found) if isinstance(found, Path) else found

    def is_default(self, name: str, value: Value) -> bool:
        """Whether leaving it out means the same."""
        return bool(value == self._actions[name].default)

    def is_file(self, name: str, value: Value) -> bool:
        """Whether the value is a file that is to be read."""
        return name in _FILES and (name in ("sensors", "cuts") or str(value).endswith(".toml"))

    def require_known(self, name: str, value: Value) -> None:
        """Refuse a printer or material that no profile describes.

        Raises
        ------
        InputError
        """
        from skinfab.cli import steps

        if name in _PROFILES:
            steps.profiles(**{name: str(value)})

    def require_fitting(self, mesh: str | Path, settings: Mapping[str, Value]) -> None:
        """Refuse settings that do not go together, or not with such a mesh.

        Raises
        ------
        InputError
        """
        from skinfab.cli import steps

        chosen = {self._actions[name].dest: value for name, value in settings.items()}
        args = argparse.Namespace(**{**self._defaults, **chosen, "mesh": Path(mesh), "wrong_usage": _raise})
        steps.require_fitting_options(args)

    def _parse(self, mesh: str | Path, settings: Mapping[str, Any]) -> argparse.Namespace:
        return self._parser.parse_args([str(mesh), "-o", "out", *option_words(settings)])


def _raise(message: str) -> NoReturn:
    raise InputError(message)
