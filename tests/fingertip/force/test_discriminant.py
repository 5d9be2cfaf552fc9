"""The classifier against one that is known, and where there is too little to learn from."""

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.force.discriminant import fit_discriminant


def blobs(n: int = 60, seed: int = 0) -> tuple[np.ndarray, list[str]]:
    rng = np.random.default_rng(seed)
    shape = np.array([[1.0, 0.8, 0.0], [0.0, 0.5, 0.2], [0.0, 0.0, 2.0]])
    means = {"a": [0, 0, 0], "b": [2, 0, 0], "c": [0, 2, 4]}
    return np.concatenate([mean + rng.standard_normal((n, 3)) @ shape for mean in means.values()]), [k for k in means for _ in range(n)]


def test_it_decides_as_scikit_learn_does() -> None:
    from sklearn.discriminant_analysis import LinearDiscriminantAnalysis

    X, y = blobs()
    new, _ = blobs(seed=1)
    ours = fit_discriminant(X, y)
    theirs = LinearDiscriminantAnalysis(solver="lsqr", shrinkage="auto", priors=[1 / 3] * 3).fit(X, y)
    agreed = np.mean([a == b for a, b in zip(ours.says(new), theirs.predict(new), strict=True)])
    # Its covariances are of n samples and shrunk class by class, ours of n - c and together: nearly the same.
    assert agreed > 0.98
    assert np.abs(ours.probabilities(new) - theirs.predict_proba(new)).mean() < 0.02


def test_scaling_a_feature_changes_nothing() -> None:
    X, y = blobs()
    other = X * np.array([1e-6, 1.0, 1e6]) + 5
    assert fit_discriminant(X, y).says(X) == fit_discriminant(other, y).says(other)


def test_more_features_than_samples_and_a_constant_one() -> None:
    rng = np.random.default_rng(0)
    X = np.column_stack([rng.standard_normal((8, 20)), np.ones(8)])
    X[4:, 0] += 8
    model = fit_discriminant(X, ["a"] * 4 + ["b"] * 4)
    assert model.says(X) == ["a"] * 4 + ["b"] * 4


@pytest.mark.parametrize(
    ("X", "y", "says"),
    [
        (np.zeros((3, 2)), ["a"] * 3, "two materials"),
        (np.zeros((3, 2)), ["a", "a", "b"], "one log of b"),
        (np.full((4, 2), np.nan), ["a", "a", "b", "b"], "not finite"),
    ],
)
def test_too_little_to_learn_from(X: np.ndarray, y: list[str], says: str) -> None:
    with pytest.raises(InputError, match=says):
        fit_discriminant(X, y)
