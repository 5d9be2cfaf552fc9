"""Random sets of parameters for any pattern, valid or not, and their mending by the errors' own advice."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from hypothesis import strategies as st

from skinfab.patterns.base import Pattern, PatternError
from skinfab.patterns.registry import PATTERNS, make_pattern

#: More steps of advice than this, and it goes round in circles.
_STEPS = 12


@st.composite
def parameter_sets(draw: st.DrawFn, kind: str) -> dict[str, Any]:
    """Around the pattern's example, far enough out to break every bound."""
    cls = PATTERNS[kind]
    params: dict[str, Any] = {
        "bead": draw(st.floats(0.2, 1.6)),
        "gap": draw(st.floats(0.0, 1.2)),
        "pad": draw(st.just(0) | st.floats(0.5, 6)),
    }
    for field in fields(cls):
        if field.name in params:
            continue
        if field.type == "bool":
            params[field.name] = draw(st.booleans())
        elif field.type == "int":
            params[field.name] = draw(st.integers(-2, 14))
        else:
            params[field.name] = draw(st.floats(0.02, 5)) * cls.example.get(field.name, field.default)
    return params


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


def patterns(kind: str) -> st.SearchStrategy[Pattern]:
    """Valid patterns, many of them right on a bound."""
    return parameter_sets(kind).map(lambda params: mended(kind, params))
