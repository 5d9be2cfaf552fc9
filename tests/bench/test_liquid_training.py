"""The table of trainings: full cups are named, and its sentence says what it holds."""

import pytest

from skinfab.bench import liquid_training
from skinfab.fingertip.force.liquid_simulator import CupScene


def test_a_full_cup_is_named_and_the_sentence_is_of_the_table(monkeypatch: pytest.MonkeyPatch) -> None:
    hands = {"hand trembles much": CupScene(tremble_mm_s2=200.0)}
    monkeypatch.setattr(liquid_training, "FALSE_ALARM", 0.1)  # one in a hundred needs a hundred pieces
    made = liquid_training.trainings(hands=hands, pool=24, pieces=20, cups=3, count=20)
    rows = {row.grams: row for row in made}
    assert tuple(rows) == liquid_training.WATER_G
    assert rows[100].named > rows[10].named and rows[0].named <= rows[100].named
    assert 0 < rows[0].found_high < 0.3 and rows[100].found > 0.6 and rows[20].found_low <= rows[20].found_high
    said = liquid_training.sentence([vars(row) for row in made])
    assert f"named in {rows[100].named:.0%} with 100 g" in said and "Of 20 trainings by a hand that trembles by 0.2 m/s2" in said
