"""An edge's pose is learned from images, says how sure it is, and is saved and read back as it was."""

import math
from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.optical.edge import Edge
from skinfab.fingertip.optical.judge import errors, guessed, held_out, off_by, said
from skinfab.fingertip.optical.labelled import FOLLOWED_MM, labelled
from skinfab.fingertip.optical.model_file import load_edge, save_edge
from skinfab.fingertip.optical.plates import HalfPlane
from skinfab.fingertip.optical.regress import EdgeModel, Examples, learn, train
from skinfab.fingertip.optical.simulator import Fingertip
from skinfab.fingertip.saved import load_model, save_model

TIP = Fingertip()


@pytest.fixture(scope="module")
def seen() -> Examples:
    each = list(labelled(TIP, 250, reach_mm=4, depths_mm=FOLLOWED_MM, shear_mm=0.1, seed=1))
    return Examples.of([one.image for one in each], [one.edge for one in each], rest=TIP.image(TIP.rest))


@pytest.fixture(scope="module")
def other(seen: Examples) -> Examples:
    each = list(labelled(TIP, 60, reach_mm=3, depths_mm=FOLLOWED_MM, shear_mm=0.1, seed=2))
    return Examples.of([one.image for one in each], [one.edge for one in each], pins=seen.pins)


@pytest.fixture(scope="module")
def model(seen: Examples) -> EdgeModel:
    return learn(seen)


def test_new_edges_are_read(model: EdgeModel, other: Examples) -> None:
    off = np.abs(off_by(said(model, other), other.truth)).mean(axis=0)
    assert off[0] < 0.4 and off[1] < 0.08 and off[2] < 6
    # Beside what one would say without looking:
    assert off[0] < np.abs(other.truth[:, 0] - other.truth[:, 0].mean()).mean() / 3


def test_an_image_and_its_pins_tell_the_same(model: EdgeModel) -> None:
    [one] = labelled(TIP, 1, reach_mm=1, seed=9)
    assert model.edge(one.image) == model.edge_of(model.pins.track(one.image))


def test_what_was_not_learned_is_not_sure(model: EdgeModel, other: Examples) -> None:
    """Sheared by much more than in any training image, an edge is read worse, and the confidence tells it."""
    usual = [edge.confidence for edge in said(model, other)]
    assert np.quantile(usual, 0.1) > 0.6
    rng = np.random.default_rng(0)
    strange = [
        TIP.frame(HalfPlane(0.0, a), rng=rng, shear_mm=(1.2 * math.cos(a + 2), 1.2 * math.sin(a + 2))) for a in np.linspace(-3, 3, 12)
    ]
    felt = [model.edge(image) for image in strange]
    assert np.median([abs(edge.offset_mm) for edge in felt]) > 1.5 * np.median(np.abs(off_by(said(model, other), other.truth)[:, 0]))
    assert np.median([edge.confidence for edge in felt]) < 0.4
    assert model.edge(np.zeros((240, 240), np.uint8)).confidence == 0


def test_held_out_errors_are_no_smaller_than_those_on_what_was_learned(seen: Examples, model: EdgeModel) -> None:
    groups = [k // 10 for k in range(len(seen))]
    felt, guess = held_out(seen, groups), guessed(seen.truth, seen.truth)
    off, confidence = off_by(felt, seen.truth), [edge.confidence for edge in felt]
    known = off_by(said(model, seen), seen.truth)
    assert np.abs(off[:, 0]).mean() > np.abs(known[:, 0]).mean()
    for each in errors(off, groups, guess=guess, confidence=confidence):
        assert each.low < each.mean < each.high and each.p95 > each.mean and each.images == len(seen)
        assert each.sure is not None and each.sure <= each.mean < each.guess / 2 and not each.chance
    for each in errors(np.roll(off, 1, axis=0), groups, guess=off, confidence=[0.0] * len(off)):
        assert each.sure is None and each.chance and each.guess == pytest.approx(each.mean)


def test_depth_is_left_out_where_it_is_not_known() -> None:
    each = list(labelled(TIP, 30, reach_mm=2, seed=4))
    made = train([one.image for one in each], [Edge(one.edge.offset_mm, one.edge.angle_rad) for one in each])
    felt = made.edge(each[0].image)
    assert math.isnan(felt.depth_mm) and math.isfinite(felt.offset_mm)
    off = off_by([felt], np.array([[0.0, 1.0, 0.0]]))
    assert [e.quantity for e in errors(np.r_[off, off], ["a", "b"], guess=np.r_[off, off], confidence=[1.0, 1.0])] == ["offset", "angle"]


def test_a_model_is_the_same_when_it_is_read_back(model: EdgeModel, tmp_path: Path) -> None:
    path = tmp_path / "model.npz"
    save_edge(path, model, {"simulated": True})
    loaded, made_from = load_edge(path)
    [one] = labelled(TIP, 1, reach_mm=1, seed=9)
    first, again = (np.array([*vars(each.edge(one.image)).values()]) for each in (model, loaded))
    np.testing.assert_allclose(again, first, rtol=1e-9)
    assert made_from == {"simulated": True}
    saved = load_model(path, kind="optical edge")
    for facts, arrays in (
        (saved.facts, {**saved.arrays, "mean": saved.arrays["mean"][1:]}),
        (saved.facts, {k: v for k, v in saved.arrays.items() if k != "usual"}),
        (saved.facts, {**saved.arrays, "spacing": -saved.arrays["spacing"]}),
        ({**saved.facts, "gamma": -3.0}, saved.arrays),  # it would be surest of what is unlike all that was learned
    ):
        save_model(path, kind="optical edge", facts=facts, arrays=arrays)
        with pytest.raises(InputError, match="train it again"):
            load_edge(path)


def test_what_cannot_be_learned_from_is_refused() -> None:
    image, edge = TIP.image(TIP.rest), Edge(0.0, 0.0, 2.0)
    for images, edges, words in (
        ([image] * 5, [edge] * 5, "5 images; 20 or more"),
        ([image] * 25, [edge] * 24, "25 images and 24 edges"),
        ([image] * 25, [edge] * 25, "the same places in all images"),
        ([image] * 24 + [image[:200]], [edge] * 25, "image 25 is of"),
        ([image] * 25, [Edge(math.nan, 0.0)] * 25, "not a number"),
    ):
        with pytest.raises(InputError, match=words):
            train(images, edges)
