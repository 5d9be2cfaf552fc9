"""The search finds what trying all choices finds, where all can be tried."""

from __future__ import annotations

from itertools import combinations, product

import numpy as np
import pytest
import shapely

from skinfab.wire_choice import CLASH, CROSSING, choose_ways
from skinfab.wire_ways import Ways


def out_of_a_disk(at: np.ndarray, angles: np.ndarray, radius: float = 20.0) -> Ways:
    way = np.c_[np.cos(angles), np.sin(angles)]
    along = way @ at
    reach = -along + np.sqrt(along**2 + radius**2 - at @ at)
    begin = at + reach[:, None] * way
    end = begin + 2 * way
    start = np.broadcast_to(at, begin.shape)
    return Ways(np.stack([start, begin], axis=1), np.stack([begin, end], axis=1), np.zeros(len(way), dtype=bool), reach)


def fault_table(ways: list[Ways], apart: float) -> np.ndarray:
    """(k, c, j, d): what way c of wire k costs with way d of wire j, by shapely."""
    wires, walls = (np.array([shapely.linestrings(getattr(w, name)) for w in ways]) for name in ("wire", "wall"))
    cross = shapely.intersects(wires[:, :, None, None], wires)
    near = shapely.distance(walls[:, :, None, None], walls) < apart
    return CROSSING * cross + CLASH * near


def test_as_few_crossings_as_there_can_be() -> None:
    """Of 40 cases so crowded that most cannot do without faults, each wire with the best way beside those before it has
    more of them than there need be in at least ten; the search in at most two."""
    too_many, one_by_one_too_many, crowded = 0, 0, 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        ways = [out_of_a_disk(rng.uniform(-12, 12, 2), rng.uniform(0, 2 * np.pi, 5)) for _ in range(5)]
        own = CROSSING * (rng.random((5, 5)) < 0.7)
        apart = rng.uniform(1, 8)
        table = fault_table(ways, apart)

        def cost(choice: tuple[int, ...], own: np.ndarray = own, table: np.ndarray = table) -> float:
            pairs = combinations(enumerate(choice), 2)
            return sum(own[k, c] for k, c in enumerate(choice)) + sum(table[k, c, j, d] for (k, c), (j, d) in pairs)

        least = min(cost(each) for each in product(range(5), repeat=5))
        crowded += least > 0
        greedy: tuple[int, ...] = ()
        for _ in range(5):
            greedy = min(((*greedy, c) for c in range(5)), key=cost)
        one_by_one_too_many += cost(greedy) > least
        chosen = choose_ways(ways, list(own), apart=apart)
        taken = [(k, c) for k, c in enumerate(chosen) if c is not None]
        # A way is given up to a clash only; no two that are left have one.
        assert not any(table[k, c, j, d] >= CLASH for (k, c), (j, d) in combinations(taken, 2))
        if least < CLASH:
            too_many += len(taken) < 5 or cost(tuple(c for _, c in taken)) > least
    assert crowded >= 20 and one_by_one_too_many >= 10 and too_many <= 2


def test_the_shortest_of_those_without_a_crossing() -> None:
    ways = [out_of_a_disk(np.array([x, 0.0]), np.linspace(0, 2 * np.pi, 360, endpoint=False)) for x in (-15.0, 15.0)]
    chosen = choose_ways(ways, [np.zeros(360)] * 2, apart=1.0)
    assert [w.length[c] for w, c in zip(ways, chosen, strict=True)] == pytest.approx([5.0, 5.0])


def test_wires_without_a_way() -> None:
    none = out_of_a_disk(np.zeros(2), np.zeros(0))
    one = out_of_a_disk(np.zeros(2), np.zeros(1))
    assert choose_ways([none, one, none], [np.zeros(0), np.zeros(1), np.zeros(0)], apart=1.0) == [None, 0, None]
    assert choose_ways([], [], apart=1.0) == []
    # Two ways through one place of the wall: the first has it.
    assert choose_ways([one, one], [np.zeros(1)] * 2, apart=1.0) == [0, None]
