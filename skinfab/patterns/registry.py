"""The patterns there are, by kind; a pattern from a name and a table of numbers, and back.

Every module of this folder is looked at: a pattern is there because its file is.
"""

from __future__ import annotations

import difflib
import importlib
import inspect
import pkgutil
from collections.abc import Mapping
from dataclasses import MISSING, fields
from typing import Any

import skinfab.patterns
from skinfab.errors import InputError
from skinfab.patterns.base import Pattern


def _find() -> dict[str, type[Pattern]]:
    """The concrete subclasses of `Pattern` that the modules of this folder define, by kind."""
    found: dict[str, type[Pattern]] = {}
    for entry in pkgutil.iter_modules(skinfab.patterns.__path__):
        name = f"skinfab.patterns.{entry.name}"
        if name == __name__:
            continue
        for cls in vars(importlib.import_module(name)).values():
            if isinstance(cls, type) and issubclass(cls, Pattern) and not inspect.isabstract(cls) and cls.__module__ == name:
                if cls.kind in found:
                    raise ImportError(f"two patterns are of kind {cls.kind!r}: in {found[cls.kind].__module__} and in {name}")
                found[cls.kind] = cls
    return dict(sorted(found.items()))


#: Every kind of pattern; a new one needs a file in this folder and nothing else.
PATTERNS: dict[str, type[Pattern]] = _find()


def make_pattern(kind: str, params: Mapping[str, Any]) -> Pattern:
    """The pattern of that kind with those parameters.

    Parameters
    ----------
    kind : str
        A key of `PATTERNS`.
    params : mapping of str to number
        By the pattern's own parameter names; `bead`, `gap` and `pad` are known to all of them. Only `Pattern.required`
        must be there: the others follow from these (`Pattern.usual`).

    Raises
    ------
    InputError
        No such kind, or a parameter missing, misspelt or not a number.
    PatternError
        A parameter breaks a bound.

    Examples
    --------
    >>> make_pattern("strain-lines", {"l1": 53, "l2": 43, "b": 6}).lines
    4
    >>> parameters(make_pattern("contact-spiral", {"s": 15, "pad": 0}))
    {'bead': 0.785, 'gap': 0.6, 'pad': 0.0, 'n': 3, 'x': 1.7, 'b': 1.5, 'l': 3.0, 's': 15.0, 'caps': False}
    """
    if kind not in PATTERNS:
        raise InputError(f"no pattern of kind {kind!r}{_suggest(kind, PATTERNS)}; there are {', '.join(sorted(PATTERNS))}")
    known = {f.name: f for f in fields(PATTERNS[kind])}
    for name in params:
        if name not in known:
            raise InputError(f"{kind}: unknown parameter {name!r}{_suggest(name, known)}; it knows {', '.join(sorted(known))}")
    cls = PATTERNS[kind]
    required = cls.required()
    missing = [name for name in required if name not in params]
    if missing:
        raise InputError(f"{kind}: parameter {missing[0]!r} is missing; it needs {', '.join(required)}")
    defaults = {name: f.default for name, f in known.items() if f.default is not MISSING}
    given = defaults | {name: cls.read(name, value) for name, value in params.items()}
    return cls(**cls.usual(given) | dict(params))


def parameters(pattern: Pattern) -> dict[str, float | int]:
    """Every parameter of a pattern by name, as `make_pattern` takes them.

    Examples
    --------
    >>> spiral = make_pattern("contact-spiral", {"n": 3, "x": 1.7, "b": 1.5, "l": 3, "s": 15})
    >>> make_pattern(spiral.kind, parameters(spiral)) == spiral
    True
    """
    return {f.name: getattr(pattern, f.name) for f in fields(pattern)}


def _suggest(name: str, known: Mapping[str, Any]) -> str:
    near = difflib.get_close_matches(str(name), list(known), n=1, cutoff=0.5)
    return f" (did you mean {near[0]!r}?)" if near else ""
