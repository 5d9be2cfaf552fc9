"""One window at a time: the very decisions that the model makes on many, with gaps and without."""

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.nail.improved import asked, label_of, learn
from skinfab.fingertip.nail.protocol import Protocol, Session, session
from skinfab.fingertip.nail.reader import Reader
from skinfab.fingertip.nail.regress import Regression, continuous_of, targets_of
from skinfab.fingertip.nail.simulator import Scene


@pytest.fixture(scope="module")
def one() -> Session:
    return session("edges12", 1, protocol=Protocol(training=4, rounds=2, estimates=1, samples=256), seed=4)


@pytest.mark.parametrize("samples", [8, 33, 256])
def test_it_decides_as_the_model_does(one: Session, samples: int) -> None:
    model, windows = learn(one), asked(one, samples)
    regression = Regression(model, targets_of([label_of(touch) for touch in one.training.touches]))
    reader, together = Reader(model, samples, regression=regression), model.decide(windows, drive_hz=169.0)
    for k, window in enumerate(windows):
        found = reader.decide(window, drive_hz=169.0)
        assert (found.label, found.contact, found.strange) == (model.names[together.classes[k]], together.contact[k], together.strange[k])
        assert found.confidence == pytest.approx(together.confidence[k], abs=1e-9)
        assert 0 <= found.continuous.angle_deg < 180 and np.hypot(found.continuous.x_mm, found.continuous.y_mm) < 15


def test_a_gap_here_and_there(one: Session) -> None:
    model, windows = learn(one), asked(one, 64)
    reader = Reader(model, 64)
    rng = np.random.default_rng(0)
    same = []
    for window in windows:
        holed = np.where(rng.uniform(size=window.shape) < 0.3, np.nan, window)
        same.append(reader.decide(holed).label == reader.decide(window).label)
        assert reader.decide(holed).missing == ()
    assert np.mean(same) > 0.8


def test_a_channel_that_is_gone_is_left_out_and_counted(one: Session) -> None:
    model, windows = learn(one), asked(one, 33)
    regression = Regression(model, targets_of([label_of(touch) for touch in one.training.touches]))
    reader = Reader(model, 33, regression=regression)
    windows[..., [1, 4]] = np.nan
    smaller = model.without(np.array([False, True, False, False, True, False]))
    expected = smaller.decide(windows)
    for k, window in enumerate(windows):
        found = reader.decide(window)
        assert found.missing == ("Ay", "Gy") and found.label == smaller.names[expected.classes[k]]
        own = regression.of(smaller).estimate(smaller.features(smaller_phasors(smaller, window)))[0]
        assert found.continuous.angle_deg == pytest.approx(continuous_of(own).angle_deg, abs=0.01)  # frequencies lie on a grid


def smaller_phasors(model, window: np.ndarray) -> np.ndarray:  # type: ignore[no-untyped-def]
    from skinfab.fingertip.nail.phasors import turned_phasors

    return turned_phasors(window[None], model.rate_hz, model.drive_hz, model.reference)[0]


def test_too_little_of_everything(one: Session) -> None:
    reader = Reader(learn(one), 33)
    with pytest.raises(InputError, match="0 of the six channels are left"):
        reader.decide(np.full((33, 6), np.nan))
    with pytest.raises(InputError, match="8 are needed"):
        Reader(learn(one), 7)


def test_none_is_as_sure_as_it_is_far_from_a_touch() -> None:
    """Touches lighter than any that were learned are taken for none at times: then it is not sure, and says that it is like neither."""
    settings = Protocol(training=4, rounds=4, estimates=1, samples=256)
    usual = session("pins6", 1, protocol=settings, seed=4)
    light = session("pins6", 1, protocol=settings, scene=Scene(force_n=(0.01, 0.05)), seed=4)
    model = learn(usual)
    reader = Reader(model, 33)
    at_rest = usual.training.readings[usual.training.classes == model.names.index("none"), 0]
    told = [reader.decide(each[k : k + 33]) for each in at_rest for k in range(0, 224, 33)]
    assert len(told) > 20 and all(each.label == "none" and each.confidence > 0.97 and not each.strange for each in told)
    missed = [found for window in asked(light, 33) if not (found := reader.decide(window)).contact]
    assert len(missed) > 1
    assert all(each.strange and each.confidence < 0.95 for each in missed)
    sure = [model.none_at(part * model.gate, 10**6)[0] for part in (0.0, 0.5, 1.0)]
    assert sure[0] > 0.98 and sure[0] > sure[1] > sure[2] == pytest.approx(0.5)
