"""Random sets of parameters for any pattern, valid or not, and their mending by the errors' own advice."""

from __future__ import annotations

from dataclasses import fields
from functools import cache, partial
from operator import mul
from typing import Any

from hypothesis import strategies as st

from skinfab.patterns.base import Pattern, PatternError
from skinfab.patterns.registry import PATTERNS, make_pattern

#: What every pattern has.
_COMMON = {"bead": st.floats(0.2, 1.6), "gap": st.floats(0.0, 1.2), "pad": st.just(0) | st.floats(0.5, 6)}

#: More steps of advice than this, and it goes round in circles.
_STEPS = 12


@cache
def parameter_sets(kind: str) -> st.SearchStrategy[dict[str, Any]]:
    """Around the pattern's example, far enough out to break every bound."""
    cls = PATTERNS[kind]
    own: dict[str, st.SearchStrategy[Any]] = {}
    for field in fields(cls):
        if field.name in _COMMON:
            continue
        if field.type == "bool":
            own[field.name] = st.booleans()
        elif field.type == "int":
            own[field.name] = st.integers(-2, 14)
        else:
            own[field.name] = st.floats(0.02, 5).map(partial(mul, cls.example.get(field.name, field.default)))
    return st.fixed_dictionaries(_COMMON | own)


def mended(kind: str, params: dict[str, Any]) -> Pattern:
    """The pattern, once all advice is followed: what each error calls the nearest value that works is put in its place."""
    params = dict(params)
    followed: list[str] = []
    for _ in range(_STEPS):
        fault = fault_of(kind, params)
        if fault is None:
            return make_pattern(kind, params)
        followed.append(str(fault))
        assert fault.parameter in params and fault.nearest != params[fault.parameter], followed
        params[fault.parameter] = fault.nearest
    raise AssertionError(f"the advice never ends: {followed}")


def fault_of(kind: str, params: dict[str, Any]) -> PatternError | None:
    """What is wrong with a set of parameters, if anything."""
    try:
        make_pattern(kind, params)
    except PatternError as fault:
        return fault
    return None


@cache
def patterns(kind: str) -> st.SearchStrategy[Pattern]:
    """Valid patterns, many of them right on a bound."""
    return parameter_sets(kind).map(lambda params: mended(kind, params))
