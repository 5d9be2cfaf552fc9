"""The network: its slope is the slope of its loss, it learns what no line parts, and what does not fit together is refused."""

import numpy as np
import pytest
from scipy.optimize import check_grad

from skinfab.errors import InputError
from skinfab.fingertip.force.network import Network, fit_network


def rings(n: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    y = rng.integers(0, 3, n)
    angle, far = rng.uniform(0, 2 * np.pi, n), y + 0.2 * rng.standard_normal(n)
    return np.column_stack([far * np.cos(angle), far * np.sin(angle)]), y


def test_rings_that_no_line_parts_are_learned() -> None:
    X, y = rings(600, 0)
    net = fit_network(X, y, classes=3, hidden=20, decay=1e-4)
    new, truth = rings(300, 1)
    out = net.probability(new)
    np.testing.assert_allclose(out.sum(axis=1), 1)
    assert (out.argmax(axis=1) == truth).mean() > 0.95


def test_the_slope_is_the_slope(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = {}

    def minimize(loss, start, **options):
        seen["error"] = check_grad(lambda w: loss(w)[0], lambda w: loss(w)[1], start)
        seen["size"] = np.linalg.norm(loss(start)[1])
        return type("Found", (), {"x": start})

    monkeypatch.setattr("scipy.optimize.minimize", minimize)
    fit_network(*rings(30, 2), classes=3, hidden=4, decay=0.1)
    assert seen["error"] < 1e-5 * max(seen["size"], 1)


def test_the_same_seed_learns_the_same_and_units_do_not_matter() -> None:
    X, y = rings(100, 3)
    one, again = (fit_network(X * s, y, classes=3, hidden=5, decay=1e-3) for s in (1, 1000))
    np.testing.assert_allclose(one.probability(X), again.probability(X * 1000), atol=1e-3)
    constant = fit_network(np.column_stack([X, np.full(100, 7.0)]), y, classes=3, hidden=5)
    assert np.isfinite(constant.probability(np.column_stack([X, np.full(100, 7.0)]))).all()


def test_features_far_out_are_no_overflow() -> None:
    net = fit_network(*rings(50, 4), classes=3, hidden=5)
    with np.errstate(all="raise", under="ignore"):
        assert np.isfinite(net.probability(np.array([[1e8, -1e8]]))).all()


@pytest.mark.parametrize(
    ("X", "y"), [(np.empty((0, 2)), np.empty(0, int)), (np.full((2, 2), np.nan), np.zeros(2, int)), (np.ones((2, 2)), np.array([0, 3]))]
)
def test_what_cannot_be_learned_from(X: np.ndarray, y: np.ndarray) -> None:
    with pytest.raises(InputError):
        fit_network(X, y, classes=3)


def test_weights_that_do_not_fit_together() -> None:
    with pytest.raises(InputError, match="fit together"):
        Network(np.zeros(3), np.ones(3), np.zeros((3, 5)), np.zeros((6, 3)))
