"""The recipe against a calculation by hand, and against what must add up."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.material import load_material
from skinfab.recipe import recipe

MATERIAL = load_material()


def test_against_hand_calculation() -> None:
    # Two moulds of 10 ml and 2.5 ml: 12.5 ml over 2.5 mm, so 10 ml of reservoir and 2.5 ml of filler.
    made = recipe({"P1": 10.0, "P2": 2.5}, MATERIAL)
    reservoir, filler = made.batches
    # 10 ml x 1.07 g/ml x 1.15 = 12.305 g = base x 1.03; base 11.9466 g, half of it A.
    assert reservoir.volume_ml == pytest.approx(10) and reservoir.mass_g == pytest.approx(12.305)
    assert reservoir.weigh_g == pytest.approx(
        {"Ecoflex 00-30 A": 5.97330, "Ecoflex 00-30 B": 5.97330, "Slo-Jo platinum silicone cure retarder": 0.238932, "Thivex": 0.119466},
        rel=1e-5,
    )
    # 2.5 x 1.07 x 1.15 = 3.07625 g = base x 1.12; base 2.746652 g.
    assert filler.weigh_g == pytest.approx(
        {
            "Ecoflex 00-30 A": 1.373326,
            "Ecoflex 00-30 B": 1.373326,
            "Slo-Jo platinum silicone cure retarder": 0.0549330,
            "Silicone Thinner": 0.2746652,
        },
        rel=1e-5,
    )
    # 8 ml and 2 ml of reservoir at 1.07 g/ml.
    assert reservoir.pour_g == pytest.approx({"P1": 8.56, "P2": 2.14})


@given(st.lists(st.floats(0.01, 500), min_size=1, max_size=6), st.floats(0, 60))
def test_what_is_weighed_is_what_is_poured_and_wasted(volumes: list[float], waste: float) -> None:
    made = recipe({f"P{k}": v for k, v in enumerate(volumes)}, replace(MATERIAL, waste_percent=waste))
    for batch in made.batches:
        assert sum(batch.weigh_g.values()) == pytest.approx(batch.mass_g)
        assert sum(batch.pour_g.values()) * (1 + waste / 100) == pytest.approx(batch.mass_g)
    assert sum(b.volume_ml for b in made.batches) == pytest.approx(sum(volumes))


def test_lips_are_filled_by_the_top_layer_alone() -> None:
    plain, lipped = recipe({"P1": 10.0, "P2": 2.5}, MATERIAL), recipe({"P1": 10.0, "P2": 2.5}, MATERIAL, lips_ml={"P2": 0.4})
    assert lipped.batches[0] == plain.batches[0]
    assert lipped.batches[1].volume_ml == pytest.approx(2.5 + 0.4)
    assert lipped.batches[1].pour_g == pytest.approx({"P1": 2 * 1.07, "P2": 0.9 * 1.07})


def test_portions_are_the_whole() -> None:
    for batch in recipe({"P1": 10.0, "P2": 2.5}, MATERIAL, lips_ml={"P1": 0.3}).batches:
        assert list(batch.portions) == ["P1", "P2"]
        for name, grams in batch.weigh_g.items():
            assert sum(portion.weigh_g[name] for portion in batch.portions.values()) == pytest.approx(grams)
        for piece, portion in batch.portions.items():
            assert portion.mass_g == pytest.approx(batch.pour_g[piece] * 1.15) == pytest.approx(sum(portion.weigh_g.values()))


def test_as_dict_is_plain_json() -> None:
    made = recipe({"P1": 1.0}, MATERIAL).as_dict()
    assert json.loads(json.dumps(made)) == made


@pytest.mark.parametrize(("cavities", "says"), [({}, "no moulds"), ({"P1": 0.0}, "P1 holds 0 ml"), ({"P1": np.nan}, "P1 holds nan ml")])
def test_impossible_volumes_say_which(cavities: dict[str, float], says: str) -> None:
    with pytest.raises(InputError, match=says):
        recipe(cavities, MATERIAL)


def test_layer_without_base_is_named() -> None:
    empty = replace(MATERIAL, layers=(replace(MATERIAL.layers[0], base={}), MATERIAL.layers[1]))
    with pytest.raises(InputError, match="'reservoir'"):
        recipe({"P1": 1.0}, empty)
    with pytest.raises(InputError, match="no layer with a depth"):
        recipe({"P1": 1.0}, replace(MATERIAL, layers=()))
