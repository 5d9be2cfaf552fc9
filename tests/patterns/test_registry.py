"""From names and numbers to a pattern and back, with help for what is misspelt."""

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.patterns.registry import PATTERNS, make_pattern, parameters

EXAMPLES = {
    "contact-spiral": {"n": 3, "x": 1.7, "b": 1.5, "l": 3, "s": 15},
    "strain-lines": {"l1": 60, "l2": 54, "b": 6},
}


@pytest.mark.parametrize("kind", PATTERNS)
def test_every_pattern_keeps_the_common_rules(kind: str) -> None:
    pattern = make_pattern(kind, EXAMPLES[kind])
    path = pattern.path()
    np.testing.assert_allclose(path.start, (0, 0), atol=1e-12)
    assert path.end[0] == pytest.approx(0) and path.end[1] > 0
    assert path.segments[0].end[1] == pytest.approx(0) and path.segments[0].end[0] > 0  # both leads run along +x
    assert make_pattern(kind, parameters(pattern)) == pattern
    assert len({pattern, make_pattern(kind, parameters(pattern))}) == 1


@pytest.mark.parametrize(
    ("kind", "params", "says"),
    [
        ("contact-spirale", {}, "did you mean 'contact-spiral'"),
        ("strain-lines", {"l1": 60, "l2": 54, "b": 6, "line": 4}, "unknown parameter 'line' .did you mean 'lines'"),
        ("strain-lines", {"l1": 60, "b": 6}, "'l2' is missing; it needs l1, l2, b"),
        ("strain-lines", {"l1": "60", "l2": 54, "b": 6}, "l1 is '60'; it must be a finite number"),
    ],
)
def test_mistakes_are_explained(kind: str, params: dict, says: str) -> None:
    with pytest.raises(InputError, match=says):
        make_pattern(kind, params)
