"""The paper's arcsine folds what is beyond a right angle, arccosine is blunt near straight; atan2 is neither."""

import numpy as np
import pytest

from calibration.mocap.angle import joint_angle


def bones(degrees: np.ndarray, noise: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    bent, rng = np.radians(degrees), np.random.default_rng(0)
    zero = np.zeros_like(bent)
    mcp = np.stack([zero - 40, zero, zero], axis=1)
    dip = 25 * np.stack([np.cos(bent), np.sin(bent), zero], axis=1)
    return tuple(each + noise * rng.standard_normal(each.shape) for each in (mcp, np.zeros_like(dip), dip))  # type: ignore[return-value]


def by_arcsine(mcp: np.ndarray, pip: np.ndarray, dip: np.ndarray) -> np.ndarray:
    first, second = pip - mcp, dip - pip
    lengths = np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1)
    return np.degrees(np.arcsin(np.clip(np.linalg.norm(np.cross(first, second), axis=1) / lengths, -1, 1)))


def test_arcsine_folds_95_to_85_degrees() -> None:
    angles = np.array([85.0, 95.0, 130.0])
    assert by_arcsine(*bones(angles)) == pytest.approx([85, 85, 50])
    assert joint_angle(*bones(angles)) == pytest.approx(angles)


def test_a_finger_bent_to_110_degrees_seems_to_open_again() -> None:
    angles = np.linspace(0, 110, 200)
    folded = by_arcsine(*bones(angles))
    assert folded[-1] == pytest.approx(70) and np.any(np.diff(folded) < 0)
    assert np.all(np.diff(joint_angle(*bones(angles))) > 0)


def test_arcsine_magnifies_noise_at_a_right_angle() -> None:
    """0.2 mm of noise: arcsine never reads 90, and is off to one side; atan2 is as good there as anywhere."""
    angles = np.full(4000, 90.0)
    naive, ours = by_arcsine(*bones(angles, 0.2)), joint_angle(*bones(angles, 0.2))
    assert naive.mean() < 89.6 and abs(ours.mean() - 90) < 0.05
    assert ours.std() == pytest.approx(joint_angle(*bones(np.full(4000, 45.0), 0.2)).std(), rel=0.2)


def test_nearly_straight_arccosine_loses_half_of_the_digits() -> None:
    mcp, pip, dip = bones(np.array([1e-6]))
    first, second = pip - mcp, dip - pip
    cosine = (first * second).sum() / np.linalg.norm(first) / np.linalg.norm(second)
    assert abs(np.degrees(np.arccos(min(cosine, 1.0))) - 1e-6) > 1e-7
    assert joint_angle(mcp, pip, dip)[0] == pytest.approx(1e-6, rel=1e-6)
