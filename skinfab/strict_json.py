"""JSON of others, whose numbers all fit a float: what Python reads beyond that fails later, far from the file."""

from __future__ import annotations

import json
import math
from typing import Any


def strict_json(text: str | bytes) -> Any:
    """What a text says.

    Raises
    ------
    ValueError
        It is no JSON, or holds NaN, an infinity, or a number that is too large for a float.
    RecursionError
        It is nested too deep.

    Examples
    --------
    >>> strict_json('{"a": [1, 2.5]}')
    {'a': [1, 2.5]}
    >>> strict_json("[1e999]")
    Traceback (most recent call last):
        ...
    ValueError: 1e999 is too large a number
    """
    return json.loads(text, parse_constant=_refused, parse_float=_finite, parse_int=_whole)


def _refused(word: str) -> float:
    raise ValueError(f"{word} is not a number")


def _finite(word: str) -> float:
    if not math.isfinite(value := float(word)):
        raise ValueError(f"{word[:20]} is too large a number")
    return value


def _whole(word: str) -> int:
    _finite(word)
    return int(word)
