"""Tables whose numbers can be of no use, or of another unit or column, are refused or noted before anything is learned from them."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.optical.edge import Edge
from skinfab.fingertip.optical.targets import Columns, Targets, fit_to_learn

COUNT = 40
Numbers = tuple[float, float, float]


def targets(change: Callable[[float, float, float], Numbers] = lambda *numbers: numbers) -> Targets:
    """Offset (mm), angle (degrees) and depth (mm) of some images, changed."""
    rng = np.random.default_rng(0)
    rows = [change(rng.uniform(-5, 5), rng.uniform(-180, 180), rng.uniform(1, 2)) for _ in range(COUNT)]
    names = tuple(f"{k}.png" for k in range(COUNT))
    edges = tuple(Edge(offset, math.radians(angle), depth) for offset, angle, depth in rows)
    return Targets(names, (np.zeros((20, 20), np.uint8),) * COUNT, edges, names, False, ())


def test_usual_numbers_are_taken_as_they_are() -> None:
    for usual in (targets(), targets(lambda offset, angle, _: (offset, angle, math.nan))):
        assert fit_to_learn(usual, Columns()).notes == ()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda offset, angle, depth: (1.0, angle, depth), "'y' is 1 in all images, .* name another by --offset-column"),
        (lambda offset, angle, depth: (offset, 0.0, depth), "'angle_deg' is 0 in all images, .* name another by --angle-column"),
    ],
)
def test_what_is_always_the_same_is_refused(change: Callable[..., Numbers], words: str) -> None:
    with pytest.raises(InputError, match=words):
        fit_to_learn(targets(change), Columns(offset="y"))


def test_a_depth_that_is_always_the_same_is_left_out() -> None:
    found = fit_to_learn(targets(lambda offset, angle, _: (offset, angle, 2.0)), Columns())
    assert found.notes == ("column 'depth_mm' is 2 in all images: depth is not learned",)
    assert all(math.isnan(edge.depth_mm) for edge in found.edges)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda offset, angle, depth: (offset, math.radians(angle), depth), "if these are radians, give degrees"),
        (lambda offset, angle, depth: (offset, math.radians(angle + 180), depth), "if these are radians, give degrees"),
        (lambda offset, angle, depth: (offset / 1000, angle, depth), "if these are metres, give mm"),
        (lambda offset, angle, depth: (offset + 1e6 * (offset > 4.7), angle, depth), "of column 'offset_mm' lie far from all others"),
        (lambda offset, angle, depth: (offset, angle, depth + 1e6 * (offset > 4.7)), "of column 'depth_mm' lie far from all others"),
    ],
)
def test_numbers_of_another_unit_are_noted(change: Callable[..., Numbers], words: str) -> None:
    [note] = fit_to_learn(targets(change), Columns()).notes
    assert words in note
