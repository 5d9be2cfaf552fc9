import math
import re
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.bench.words import exponents, growth_exponent, pareto_front, reached, sentence

coordinate = st.integers(0, 5)


def row(method: str, triangles: int, seconds: float, mean_d: float, *, usable: int = 1) -> dict[str, Any]:
    return {"method": method, "triangles": triangles, "seconds": seconds, "mean_d": mean_d, "usable": usable, "peak_mb": 7.5}


def step(method: str, seconds: float, mean_d: float) -> dict[str, Any]:
    return {"method": method, "triangles": 400, "seconds": seconds, "mean_d": mean_d}


TABLE = [
    *(row("bff", n, 0.25, 4.2) for n in (100, 400)),
    *(row("isometric", n, s, 4.1) for n, s in ((100, 0.5), (400, 2.0))),
    *(row("slim", n, s, 4.1) for n, s in ((100, 0.5), (400, 8.0))),
    *(row("xatlas", n, 0.1, 4.001, usable=0) for n in (100, 400)),
]
REFINEMENT = [step("newton", 0, 4.2), step("newton", 1, 4.1), step("slim", 0, 4.2), step("slim", 1, 4.15), step("slim", 5, 4.1002)]


@given(st.lists(st.tuples(coordinate, coordinate), max_size=12))
def test_front_is_what_no_other_point_beats(points: list[tuple[float, float]]) -> None:
    beaten = {k for k, p in enumerate(points) for q in points if q != p and q[0] <= p[0] and q[1] <= p[1]}
    front = pareto_front(points)
    assert sorted(front) == sorted(set(range(len(points))) - beaten)
    assert [points[k][0] for k in front] == sorted(points[k][0] for k in front)


@given(st.floats(0.2, 3), st.floats(1e-6, 10))
def test_exponent_of_a_power_law_is_found(p: float, factor: float) -> None:
    sizes = [300, 1_000, 20_000]
    assert growth_exponent(sizes, [factor * n**p for n in sizes]) == pytest.approx(p, abs=1e-9)


def test_one_size_has_no_exponent() -> None:
    assert growth_exponent([300, 300], [1, 2]) is None
    assert exponents(TABLE[:1]) == {}


def test_same_d_is_where_each_first_comes_close_to_the_least() -> None:
    assert reached(REFINEMENT, 400) == (1, 5, True)
    assert reached(REFINEMENT[:-1], 400) == (1, 1, False)


def test_every_number_of_the_sentence_is_from_the_tables() -> None:
    said = sentence(TABLE, REFINEMENT)
    assert said.count(".") - len(re.findall(r"\d\.\d", said)) == 1
    assert "at 400 triangles it reaches a mean d of 4.10000 (least of all usable results: 4.10000) in 2 s of processor time" in said
    assert "what is quicker (bff) leaves 2 times as much" in said  # xatlas is quicker too, but cuts
    assert f"the ratio of times is {2 / 8:.2f}" in said and f"of the least, it is {1 / 5:.2f};" in said
    assert f"1.00 (isometric), {math.log(16) / math.log(4):.2f} (slim)" in said
    assert "memory rises by 7.5 MB" in said


def test_sentence_changes_with_the_tables() -> None:
    slower = [{**r, "seconds": r["seconds"] * 4} if r["method"] == "isometric" else r for r in TABLE]
    assert "the ratio of times is 1.00" in sentence(slower, REFINEMENT)
    assert "0.20 at most" not in sentence(TABLE, REFINEMENT)
    assert "1.00 at most, as SLIM did not get there" in sentence(TABLE, REFINEMENT[:-1])
    as_flat = [
        *TABLE,
        {**next(r for r in TABLE if r["method"] == "isometric" and r["triangles"] == 400), "method": "bijective", "seconds": 1.9},
    ]
    assert "(bff) leaves 2 times as much of d - 4, and bijective takes 1.9 s to no more;" in sentence(as_flat, REFINEMENT)
    quickest = [r for r in TABLE if r["method"] not in ("bff", "xatlas")]
    assert "nothing is quicker" in sentence(quickest, REFINEMENT)
