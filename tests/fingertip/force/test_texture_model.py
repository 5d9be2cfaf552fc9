"""Textures: better than published on specimens never felt, saved and loaded to the same decisions, and what is new is called unknown."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.force.simulator import MATERIALS, Material, slide, texture_logs
from skinfab.fingertip.force.texture import Slide, sliding_part
from skinfab.fingertip.force.texture_model import UNKNOWN, Trained, load_texture, save_texture, train_texture
from skinfab.fingertip.saved import load_model, save_model

Data = tuple[list[Slide], list[str], list[str]]


@pytest.fixture(scope="module")
def data() -> Data:
    logs = texture_logs(specimens=12, slides=2, seed=11)
    return [sliding_part(log) for log in logs], [log.label for log in logs], [log.group for log in logs]


@pytest.fixture(scope="module")
def trained(data: Data) -> Trained:
    return train_texture(*data)


def made_from(labels: Sequence[str]) -> list[dict[str, object]]:
    return [{"file": f"{k}.csv", "label": each, "simulated": True} for k, each in enumerate(labels)]


def test_bands_tell_more_than_the_published_features(data: Data, trained: Trained) -> None:
    published = train_texture(*data, features="published")
    assert trained.accuracy.value > 0.85 > 1 / 6 and trained.accuracy.value > published.accuracy.value
    assert trained.accuracy.low < trained.accuracy.value < trained.accuracy.high
    assert trained.confusion.counts.sum() == 144 and trained.groups == 72


def test_nothing_is_learned_where_labels_are_drawn_by_lot(data: Data) -> None:
    slides, labels, groups = data
    lots = np.random.default_rng(0).permutation(sorted(set(groups)))
    name_of = dict(zip(lots.tolist(), [name for name in sorted(set(labels)) for _ in range(12)], strict=True))
    drawn = train_texture(slides, [name_of[group] for group in groups], groups)
    # One of six by chance: no specimen is on both sides.
    assert drawn.accuracy.low < 1 / 6 and drawn.accuracy.high < 0.3


def test_a_saved_model_decides_as_before(trained: Trained, data: Data, tmp_path: Path) -> None:
    save_texture(trained, tmp_path / "model.npz", made_from=made_from(data[1]))
    model, simulated = load_texture(tmp_path / "model.npz")
    assert simulated
    for part in data[0][::7]:
        assert model.decide(part) == trained.model.decide(part)


def test_a_material_that_was_never_felt_is_unknown(trained: Trained) -> None:
    rubber = slide(Material(friction=0.9, pitch_mm=3.0, ripple=0.2), seed=1)
    decision = trained.model.decide(sliding_part(rubber))
    assert decision.name == UNKNOWN and decision.nearest in MATERIALS
    assert sum(decision.probabilities.values()) == pytest.approx(1)


def test_known_materials_are_hardly_ever_unknown(trained: Trained, data: Data) -> None:
    assert np.mean([trained.model.decide(part).known for part in data[0]]) > 0.95


def test_a_shorter_slide_of_a_known_material_is_known_and_said_to_be_short(trained: Trained, data: Data) -> None:
    whole = trained.model.decide(data[0][0])
    assert not whole.short and whole.windows == 3 and whole.right == trained.model.lengths[-1].right
    fresh = [sliding_part(log) for log in texture_logs(specimens=2, slides=1, seed=12)]
    for n in (300, 520, 700):
        cut = [replace(p, tangential=p.tangential[:n], normal=p.normal[:n], inclination=p.inclination[:n]) for p in fresh]
        found = [trained.model.decide(part) for part in cut]
        # By the limit of whole slides a third of them was unknown.
        assert np.mean([each.known for each in found]) > 0.9 and all(each.short and each.windows == 1 for each in found)
    rubber = slide(Material(friction=0.9, pitch_mm=3.0, ripple=0.2), seed=1)
    short = replace(rubber, time=rubber.time[:700], force=rubber.force[:700], moment=rubber.moment[:700])
    assert trained.model.decide(sliding_part(short)).name == UNKNOWN


def test_another_rate_is_refused(trained: Trained, data: Data) -> None:
    with pytest.raises(InputError, match=r"100 samples a second and the model was learned at 200"):
        trained.model.decide(replace(data[0][0], rate_hz=100.0))


def test_too_little_to_learn_from(data: Data) -> None:
    slides, labels, groups = data
    with pytest.raises(InputError, match="one specimen"):
        train_texture(slides, labels, labels)
    with pytest.raises(InputError, match="two materials"):
        train_texture(slides[:24], labels[:24], groups[:24])
    with pytest.raises(InputError, match="record all at one rate"):
        train_texture([replace(slides[0], rate_hz=100.0), *slides[1:]], labels, groups)


def test_a_model_whose_parts_do_not_fit_is_refused(trained: Trained, data: Data, tmp_path: Path) -> None:
    save_texture(trained, tmp_path / "model.npz", made_from=made_from(data[1]))
    saved = load_model(tmp_path / "model.npz", kind="force texture")
    arrays = dict(saved.arrays) | {"means": saved.arrays["means"][:-1]}
    save_model(tmp_path / "a.npz", kind="force texture", facts=saved.facts, arrays=arrays)
    with pytest.raises(InputError, match="means has the shape"):
        load_texture(tmp_path / "a.npz")
    save_model(tmp_path / "b.npz", kind="force texture", facts={"names": ["a"]}, arrays=dict(saved.arrays))
    with pytest.raises(InputError, match="missing or wrong"):
        load_texture(tmp_path / "b.npz")
    save_model(tmp_path / "c.npz", kind="nail phasors", facts=saved.facts, arrays=dict(saved.arrays))
    with pytest.raises(InputError, match="another kind"):
        load_texture(tmp_path / "c.npz")
