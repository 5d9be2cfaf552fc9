"""The learned limit of a swing: it keeps the wanted false alarm where noise alone would not, and comes back from its file."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force import liquid_model
from skinfab.fingertip.force.liquid import Stirred
from skinfab.fingertip.force.liquid_model import LiquidModel, Trained, limit_of, load_liquid, pieces, save_liquid, train_liquid
from skinfab.fingertip.force.liquid_simulator import CupScene, stir
from skinfab.fingertip.saved import save_model
from skinfab.rates import wilson

TREMBLING = CupScene(tremble_mm_s2=100)
MADE = [{"file": "a.csv", "sha256": "", "label": "", "simulated": True}]


@pytest.fixture(scope="module")
def trained() -> Trained:
    logs = [stir(water_kg=0.0, seconds=30, scene=TREMBLING, seed=[k, 7]) for k in range(6)]
    return train_liquid(logs, false_alarm=0.05, seconds=3.0)


def test_a_trembling_hand_is_no_liquid_once_it_is_known(trained: Trained) -> None:
    assert trained.plain > 0.3 and trained.held_out.low < 0.05 < trained.held_out.high
    assert trained.model.pieces == 60 and trained.logs == 6
    still = [stir(water_kg=0.0, seconds=3, scene=TREMBLING, seed=[k, 8]) for k in range(30)]
    wrong = sum(trained.model.judge(log).liquid for log in still)
    assert wilson(wrong, 30).low < 0.05
    full = [stir(water_kg=0.1, seconds=3, scene=TREMBLING, seed=[k, 9]) for k in range(10)]
    assert all(trained.model.judge(log).liquid for log in full)


def test_the_limit_is_passed_no_oftener_than_wanted_whatever_the_chances_are_like() -> None:
    rng = np.random.default_rng(0)
    for n in (99, 150):
        drawn = rng.uniform(size=(4000, n + 1)) ** 9  # nothing like the uniform chances of noise
        passed = [each[-1] < limit_of(each[:-1], 0.01) for each in drawn]
        assert wilson(sum(passed), len(passed)).low < 0.01 < 0.003 + wilson(sum(passed), len(passed)).high
    assert limit_of(np.linspace(0.1, 1, 9), 0.1) == pytest.approx(0.1)  # 0.1 x 10 is a whole number


def test_only_so_much_of_a_log_is_judged_as_was_learned_from(monkeypatch: pytest.MonkeyPatch) -> None:
    log = stir(water_kg=0.0, seconds=20, seed=1)
    seen: list[int] = []
    monkeypatch.setattr(liquid_model, "stirred", lambda part, *, false_alarm: seen.append(len(part)))
    LiquidModel(0.001, 0.01, 6.0, 200.0, 100).judge(log)
    assert seen == [1200] and [len(each) for each in pieces(log, 6.0)] == [1200] * 3


def test_a_model_comes_back_as_it_was(trained: Trained, tmp_path: Path) -> None:
    save_liquid(trained, tmp_path / "model.npz", made_from=MADE)
    assert load_liquid(tmp_path / "model.npz") == (trained.model, True)


def test_models_that_are_none(trained: Trained, tmp_path: Path) -> None:
    save_model(tmp_path / "a.npz", kind="force texture", facts={}, arrays={})
    with pytest.raises(InputError, match="another kind, 'force texture'"):
        load_liquid(tmp_path / "a.npz")
    save_model(tmp_path / "b.npz", kind="force liquid", facts={"simulated": True}, arrays={"limit": np.array([0.1])})
    with pytest.raises(InputError, match="missing or wrong"):
        load_liquid(tmp_path / "b.npz")
    save_liquid(replace(trained, model=replace(trained.model, limit=0.0)), tmp_path / "c.npz", made_from=MADE)
    with pytest.raises(InputError, match="its limit or its length is none"):
        load_liquid(tmp_path / "c.npz")


def test_what_cannot_be_learned_from_or_judged(monkeypatch: pytest.MonkeyPatch) -> None:
    few = [stir(water_kg=0.0, seconds=12, seed=k) for k in range(2)]
    with pytest.raises(InputError, match=r"99 are needed, which last for 9.9 min; record more, or learn a false alarm of 0.2 or more"):
        train_liquid(few)
    with pytest.raises(InputError, match="says that it holds a liquid"):
        train_liquid([*few, stir(water_kg=0.1)])
    with pytest.raises(InputError, match="record all at one rate"):
        train_liquid([few[0], replace(few[1], time=few[1].time / 2)])
    with pytest.raises(InputError, match="give at least two"):
        train_liquid([stir(water_kg=0.0, seconds=24)], false_alarm=0.25)
    model = LiquidModel(0.001, 0.01, 6.0, 200.0, 100)
    with pytest.raises(InputError, match="train a model with --seconds 5"):
        model.judge(stir(water_kg=0.0, seconds=5.5))
    with pytest.raises(InputError, match="learned at 200"):
        model.judge(replace(few[0], time=few[0].time / 2))
    nothing = np.full(3, np.nan)
    swinging = Stirred(True, False, 0.0, 1.0, 0.3, np.zeros(1), np.zeros((1, 3)), nothing)
    monkeypatch.setattr(liquid_model, "stirred", lambda part: swinging)
    with pytest.raises(RefusedError, match="no liquid would stand out"):
        train_liquid(few, false_alarm=0.25)
