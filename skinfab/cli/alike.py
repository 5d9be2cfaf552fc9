"""Warnings for a terminal: those that differ only in where and how much are told once, so that none drowns the others."""

from __future__ import annotations

import re
from collections.abc import Iterable

#: What a warning is about, at its beginning: "piece P3: ...", "piece P9 is ...", "sensor C1: ...".
_SUBJECT = re.compile(r"(piece|sensor) ([A-Z]\w*)(?=:? )")
#: Names and numbers, and what goes with more than one, do not make warnings differ.
_WHERE_AND_HOW_MUCH = re.compile(r"\b[A-Z]\d+\b|-?\d+(\.\d+)?(e[-+]?\d+)?|(?<=[a-z])s\b")
#: "P1, P2, P3, P4, P5, P6, P7 and P8": of a longer list the first few and a number will do.
_LIST = re.compile(r"\b[A-Z]\d+(?:, [A-Z]\d+){6,} and [A-Z]\d+\b")
_NAMED = 4


def alike(warnings: Iterable[str]) -> list[str]:
    """One sentence for all warnings of a kind, the first of them in its words, in order of their first.

    Examples
    --------
    >>> alike(["piece P1: 2 darts over 3.5 mm", "piece P4: 1 dart over 1 mm", "the bed is small"])
    ['2 pieces, first P1: 2 darts over 3.5 mm', 'the bed is small']
    >>> alike(["pieces P1, P2, P3, P4, P5, P6, P7, P8 and P9 have no sensor"])
    ['pieces P1, P2, P3, P4 and 5 more have no sensor']
    """
    kinds: dict[str, list[str]] = {}
    for warning in warnings:
        subject = _SUBJECT.match(warning)
        # Without a subject it is about the whole, and told as it is.
        key = f"{subject[1]}: {_WHERE_AND_HOW_MUCH.sub('', warning[subject.end() :])}" if subject else warning
        kinds.setdefault(key, []).append(warning)
    return [_LIST.sub(_shortened, _told(group)) for group in kinds.values()]


def _told(group: list[str]) -> str:
    first = _SUBJECT.match(group[0])
    if first is None or len(group) == 1:
        return group[0]
    names = {match[2] for match in map(_SUBJECT.match, group) if match}
    if len(names) == 1:
        return f"{group[0]} (and {len(group) - 1} more like it)"
    return f"{len(names)} {first[1]}s, first {first[2]}{group[0][first.end() :]}"


def _shortened(listed: re.Match[str]) -> str:
    names = re.findall(r"\w+\d", listed[0])
    return f"{', '.join(names[:_NAMED])} and {len(names) - _NAMED} more"
