"""As-rigid-as-possible steps: against libigl's, towards the least d, harmless where they flip."""

import numpy as np
import pytest
import shapes

import skinfab.flatten.disk as disk
from skinfab.flatten.bff import flatten_scaled
from skinfab.flatten.classic import arap
from skinfab.flatten.distortion import measure
from skinfab.flatten.isometric import rest_triangles
from skinfab.flatten.laplacian import intrinsic
from skinfab.flatten.rigid_start import _cotangents, rigid_steps


def test_many_steps_are_libigl_s_arap() -> None:
    V, F = shapes.cap(8, 1.0)
    ours = rigid_steps(V, F, flatten_scaled(V, F), steps=400)
    assert measure(V, F, ours).mean == pytest.approx(measure(V, F, arap(V, F)).mean, abs=2e-4)


def test_weights_are_the_cotangents() -> None:
    V, F = shapes.random_disk(7, 40)
    np.testing.assert_allclose(_cotangents(rest_triangles(V, F)), intrinsic(V, F).cotangent, rtol=1e-7, atol=1e-9)


def test_a_sheet_comes_back_to_its_shape() -> None:
    V, F = shapes.grid(8, 5)
    flat = rigid_steps(V, F, V[:, :2] * [1.3, 0.8], steps=200)
    assert measure(V, F, flat).mean == pytest.approx(4, abs=1e-6)
    np.testing.assert_allclose(flat.mean(axis=0), (V[:, :2] * [1.3, 0.8]).mean(axis=0), atol=1e-3)  # it stays where it was


@pytest.mark.parametrize("angle", [0.8, 1.4])
def test_two_steps_bring_bff_near(angle: float) -> None:
    V, F = shapes.cap(14, angle)
    start = flatten_scaled(V, F)
    least = measure(V, F, disk.flatten_isometric(V, F)).mean
    assert measure(V, F, rigid_steps(V, F, start, steps=2)).mean - least < 0.25 * (measure(V, F, start).mean - least)


def test_the_end_is_the_same_with_and_without(monkeypatch: pytest.MonkeyPatch) -> None:
    V, F = shapes.cap(12, 1.2)
    without = measure(V, F, disk.flatten_isometric(V, F)).mean
    monkeypatch.setattr(disk, "_RIGID_FROM", 0)
    assert measure(V, F, disk.flatten_isometric(V, F)).mean == pytest.approx(without, abs=1e-5)


def test_steps_that_flip_are_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    V, F = shapes.random_disk(5, 100, 1.0)
    monkeypatch.setattr(disk, "_RIGID_FROM", 0)
    assert measure(V, F, rigid_steps(V, F, flatten_scaled(V, F), steps=2)).flipped > 0
    assert measure(V, F, disk.flatten_isometric(V, F)).flipped == 0
