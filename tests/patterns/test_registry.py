"""From names and numbers to a pattern and back, with help for what is misspelt."""

import pytest

from skinfab.errors import InputError
from skinfab.patterns.registry import PATTERNS, make_pattern, parameters


def test_the_patterns_that_come_with_it() -> None:
    assert {"contact-spiral", "strain-lines", "strain-neck"} <= set(PATTERNS)
    assert all(cls.kind == kind for kind, cls in PATTERNS.items()) and list(PATTERNS) == sorted(PATTERNS)


@pytest.mark.parametrize("kind", PATTERNS)
def test_equal_parameters_make_equal_patterns(kind: str) -> None:
    pattern = make_pattern(kind, PATTERNS[kind].example)
    assert len({pattern, make_pattern(kind, parameters(pattern))}) == 1


@pytest.mark.parametrize(
    ("kind", "params", "says"),
    [
        ("contact-spirale", {}, "did you mean 'contact-spiral'"),
        ("strain-lines", {"l1": 60, "l2": 54, "b": 6, "line": 4}, "unknown parameter 'line' .did you mean 'lines'"),
        ("strain-lines", {"l2": 54, "b": 6}, "'l1' is missing; it needs l1$"),
        ("strain-lines", {"l1": "60"}, "l1 is '60'; it must be a finite number"),
        ("contact-spiral", {"s": 20, "x": [1]}, r"x is \[1\]; it must be a finite number"),
        ("contact-spiral", {"s": 20, "caps": 1}, "caps is 1; it must be true or false"),
        ("strain-neck", {"l2": float("nan")}, "l2 is nan; it must be a finite number"),
        ("strain-lines", {"l1": "60", "l2": 54, "b": 6}, "l1 is '60'; it must be a finite number"),
    ],
)
def test_mistakes_are_explained(kind: str, params: dict, says: str) -> None:
    with pytest.raises(InputError, match=says):
        make_pattern(kind, params)
