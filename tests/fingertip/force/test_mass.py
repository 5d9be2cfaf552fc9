"""Masses against truth, with their uncertainty, and refused where the poses lie in a plane."""

import numpy as np
import pytest

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.gravity import GRAVITY
from skinfab.fingertip.force.gravity_simulator import directions
from skinfab.fingertip.force.mass import fit_mass


def test_mass_and_offset_are_exact_without_noise() -> None:
    force = 0.17 * GRAVITY * directions(8, 60, np.random.default_rng(0)) + [0.2, -0.1, 0.3]
    found = fit_mass(force)
    assert found.kg == pytest.approx(0.17) and found.offset_n == pytest.approx([0.2, -0.1, 0.3])


def test_errors_are_as_large_as_stated() -> None:
    errors = []
    for seed in range(300):
        rng = np.random.default_rng(seed)
        force = 0.17 * GRAVITY * directions(10, 90, rng) + 0.1 + 0.01 * rng.standard_normal((10, 3))
        found = fit_mass(force, 0.01**2 * np.eye(3))
        errors.append((found.kg - 0.17) / found.sd_kg)
    assert np.std(errors) == pytest.approx(1, abs=0.12) and abs(np.mean(errors)) < 0.2


def test_a_plane_of_poses_gives_no_mass() -> None:
    angle = np.linspace(0, 2, 8)
    force = np.column_stack([np.sin(angle), np.zeros(8), -np.cos(angle)])
    with pytest.raises(RefusedError, match="one plane"):
        fit_mass(force)
    narrow = 1.67 * directions(10, 2, np.random.default_rng(0)) + 0.02 * np.random.default_rng(1).standard_normal((10, 3))
    with pytest.raises(RefusedError, match="turn the hand farther"):
        fit_mass(narrow)


def test_wrong_shapes_are_told() -> None:
    with pytest.raises(InputError, match="four poses"):
        fit_mass(np.ones((3, 3)))
    with pytest.raises(InputError, match="does not fit"):
        fit_mass(directions(5, 90, np.random.default_rng(0)), np.eye(6))
