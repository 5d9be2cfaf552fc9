"""A short way between the patterns: near the shortest there is, found in bounded work, the same every time."""

import itertools
import math

import numpy as np
import pytest

import gcode.order
from gcode.order import short_order
from skinfab.paths import Line, Path


def scattered(count: int, seed: int) -> dict[str, Path]:
    """Strokes of 3 to 40 mm, anyhow on a bed of 300 mm."""
    random = np.random.default_rng(seed)
    at, turn, length = random.uniform(0, 300, (count, 2)), random.uniform(0, 2 * np.pi, count), random.uniform(3, 40, count)
    ends = at + length[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    return {f"P{k:03d}": Path((Line(a, b),)) for k, (a, b) in enumerate(zip(at, ends, strict=True))}


def travel(order: list[tuple[str, Path]]) -> float:
    """From (0, 0) through all of them, mm."""
    places = [np.zeros(2), *(p for _, path in order for p in (path.start, path.end))]
    return sum(math.dist(places[k], places[k + 1]) for k in range(0, len(places) - 1, 2))


def shortest(paths: dict[str, Path]) -> float:
    """By all permutations, each with the best turns, mm."""
    ends = [((0.0, 0.0), (0.0, 0.0)), *((tuple(p.start), tuple(p.end)) for p in paths.values())]
    far = [[[[math.dist(a[1 - s], b[t]) for t in (0, 1)] for s in (0, 1)] for b in ends] for a in ends]
    best = math.inf
    for each in itertools.permutations(range(1, len(ends))):
        here, cost = 0, (0.0, 0.0)
        for there in each:
            step = far[here][there]
            cost = min(cost[0] + step[0][0], cost[1] + step[1][0]), min(cost[0] + step[0][1], cost[1] + step[1][1])
            here = there
        best = min(best, *cost)
    return best


def test_within_three_per_cent_of_the_shortest() -> None:
    ratios = []
    for seed in range(40):
        paths = scattered(1 + seed % 7, seed)
        order = short_order(paths, start=(0.0, 0.0))
        assert sorted(name for name, _ in order) == sorted(paths)
        assert all({tuple(p.start), tuple(p.end)} == {tuple(paths[n].start), tuple(paths[n].end)} for n, p in order)
        ratios.append(travel(order) / shortest(paths))
    assert min(ratios) > 1 - 1e-9
    assert max(ratios) <= 1.03


def test_no_turn_and_no_move_of_one_pattern_shortens_it() -> None:
    """Tried one by one on the finished order, by its own arithmetic."""
    order = short_order(scattered(14, 3), start=(0.0, 0.0))
    least = travel(order) - 1e-4  # lengths are compared by nanometres
    for i, j in itertools.combinations_with_replacement(range(len(order)), 2):
        turned = [(n, p.reversed()) for n, p in order[i : j + 1][::-1]]
        assert travel([*order[:i], *turned, *order[j + 1 :]]) >= least
        for size in (1, 2, 3):
            run, rest = order[i : i + size], order[:i] + order[i + size :]
            for each in (run, [(n, p.reversed()) for n, p in run[::-1]]):
                assert travel([*rest[:j], *each, *rest[j:]]) >= least


def test_the_same_whatever_the_order_of_the_input_and_among_equals_by_name() -> None:
    paths = scattered(12, 5)
    backwards = dict(reversed(paths.items()))
    assert [n for n, _ in short_order(paths, start=(0.0, 0.0))] == [n for n, _ in short_order(backwards, start=(0.0, 0.0))]
    line = Path((Line((0, 0), (10, 0)),))
    same = {name: line for name in "CAB"}
    assert [n for n, _ in short_order(same, start=(0.0, 0.0))] == ["A", "B", "C"]
    rows = {name: line.transformed(angle=0.0, shift=(0, y)) for name, y in [("A", 0), ("B", 40), ("C", 20), ("D", 60)]}
    order = short_order(rows, start=(0.0, 0.0))
    assert [n for n, _ in order] == ["A", "C", "B", "D"]
    assert [tuple(p.start) for _, p in order] == [(0, 0), (10, 20), (0, 40), (10, 60)]  # turned to begin near


def test_two_hundred_patterns_take_a_bounded_number_of_moves(monkeypatch: pytest.MonkeyPatch) -> None:
    looked, best_move = [], gcode.order._best_move
    monkeypatch.setattr(gcode.order, "_best_move", lambda order, far: looked.append(len(order)) or best_move(order, far))
    paths = scattered(200, 1)
    order = short_order(paths, start=(0.0, 0.0))
    assert len({name for name, _ in order}) == 200
    assert 2 <= len(looked) <= 2 * 200  # two orders are improved, each by fewer moves than there are patterns
