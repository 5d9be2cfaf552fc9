"""The paper's patterns, where it prints them."""

import math

import pytest

from skinfab.fingertip.nail.patterns import EDGES4, EDGES12, PINS6, TESTS


def test_the_tests_have_the_papers_numbers_of_patterns() -> None:
    assert {name: len(patterns) for name, patterns in TESTS.items()} == {"edges4": 4, "pins6": 6, "edges12": 12}
    for patterns in TESTS.values():
        assert len({pattern.name for pattern in patterns}) == len(patterns)


def test_edges_are_45_degrees_apart_and_pass_through_the_middle() -> None:
    assert sorted(round(math.degrees(edge.angle_rad)) for edge in EDGES4) == [0, 45, 90, 135]
    assert all((edge.x_mm, edge.y_mm) == (0.0, 0.0) for edge in EDGES4)


def test_pins_are_6_mm_apart_numbered_down_the_left_row_first() -> None:
    assert [(pin.x_mm, pin.y_mm) for pin in PINS6] == [(-3, 6), (-3, 0), (-3, -6), (3, 6), (3, 0), (3, -6)]
    assert all(pin.is_pin for pin in PINS6)


def test_the_two_places_that_the_paper_prints() -> None:
    assert (EDGES12[0].x_mm, EDGES12[0].angle_rad) == (4.5, pytest.approx(math.pi / 2))
    assert EDGES12[11].y_mm == -7.5 and EDGES12[11].angle_rad == pytest.approx(math.pi / 4)
    assert [(edge.x_mm, edge.y_mm, edge.angle_rad) for edge in EDGES12[4:8]] == [(e.x_mm, e.y_mm, e.angle_rad) for e in EDGES4]
