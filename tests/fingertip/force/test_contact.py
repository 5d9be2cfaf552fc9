"""A contact on the dome is found where it was, its error is the one that was reckoned, and nothing that is wrong passes unflagged."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.fingertip.force.contact import Hemisphere, locate
from skinfab.fingertip.force.wrench import SensorNoise

QUIET = SensorNoise(0.0, 0.0)


def pushed(n: int, *, size: float, lean_deg: float, seed: int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Contacts all over the dome, the forces that lean so far from the normal, and their moments."""
    rng = np.random.default_rng(seed)
    out = rng.standard_normal((n, 3))
    out[:, 2] = np.abs(out[:, 2])
    out /= np.linalg.norm(out, axis=1)[:, None]
    side = np.cross(out, rng.standard_normal((n, 3)))
    side /= np.linalg.norm(side, axis=1)[:, None]
    force = size * (np.sin(np.radians(lean_deg)) * side - np.cos(np.radians(lean_deg)) * out)
    return 20 * out, force, np.cross(20 * out, force)


@settings(deadline=None)  # the first one compiles
@given(st.integers(0, 1000), st.floats(0.31, 100), st.floats(0, 85))
def test_what_pushed_is_found_again(seed: int, size: float, lean: float) -> None:
    point, force, moment = pushed(20, size=size, lean_deg=lean, seed=seed)
    found = locate(force, moment, noise=SensorNoise())
    np.testing.assert_allclose(found.point, point, atol=1e-9)
    np.testing.assert_allclose(np.degrees(found.inclination_rad), lean, atol=1e-5)
    np.testing.assert_allclose(found.normal, -point / 20, atol=1e-9)
    assert not found.flags.any() and np.all(found.miss_mm == 0)


@settings(deadline=None)
@given(st.integers(0, 1000), st.floats(1e-3, 1e3))
def test_a_larger_finger_in_other_units_is_the_same_finger(seed: int, scale: float) -> None:
    point, force, moment = pushed(5, size=1, lean_deg=30, seed=seed)
    found = locate(force, scale * moment, Hemisphere(20 * scale), noise=QUIET)
    np.testing.assert_allclose(found.point / scale, point, atol=1e-9)


def test_a_dome_elsewhere_that_points_elsewhere() -> None:
    point, force, _ = pushed(50, size=1, lean_deg=20)
    turned = point[:, [2, 0, 1]] + [5, -7, 100]
    found = locate(force[:, [2, 0, 1]], np.cross(turned, force[:, [2, 0, 1]]), Hemisphere(20, (5, -7, 100), (3, 0, 0)))
    np.testing.assert_allclose(found.point, turned, atol=1e-9)
    assert not found.flags.any()


@pytest.mark.parametrize(("size", "lean", "median"), [(1.0, 20, 0.52), (0.1, 20, 5.0)])
def test_the_error_is_the_one_that_was_reckoned(size: float, lean: float, median: float) -> None:
    point, force, moment = pushed(20_000, size=size, lean_deg=lean)
    rng = np.random.default_rng(1)
    noise = SensorNoise(0.02, 0.2)
    found = locate(force + 0.02 * rng.standard_normal(force.shape), moment + 0.2 * rng.standard_normal(force.shape), least_force=0)
    error = np.linalg.norm(found.point - point, axis=1)
    assert np.median(error) == pytest.approx(median, rel=0.03)  # measured before, on a program of its own
    if size == 1.0:
        exact = locate(force, moment, noise=noise).sd_mm
        assert np.sqrt(np.mean(error**2)) == pytest.approx(np.sqrt(np.mean(exact**2)), rel=0.02)


def test_the_mean_of_many_samples_is_so_much_better() -> None:
    _, force, moment = pushed(2, size=1, lean_deg=20)
    one, many = (locate(force, moment, noise=SensorNoise().averaged(k)).sd_mm for k in (1, 16))
    np.testing.assert_allclose(one, 4 * many)


@pytest.mark.parametrize(
    ("force", "moment", "flags"),
    [
        ((0, 0, 0), (0, 0, 0), 2),
        ((0, 0, -0.1), (0, 0, 0), 2),
        ((np.nan, 0, -1), (0, 0, 0), 3),
        ((0, 0, -1), (0, np.inf, 0), 3),
        ((1e200, 0, 1e200), (0, 0, 0), 3),  # its square is no number
        ((0, 0, -1), (0, 30, 0), 4),  # 30 mm beside a dome of 20
        ((0, 0, 1), (0, 0, 0), 4),  # pulls: it would enter from below
        ((0, 0, -1), (0, 0, 2), 8),
        ((0, 0, -1), (0, 30, 6), 12),
    ],
)
def test_what_is_wrong_is_flagged_and_no_number_is_missing(force: tuple[float, ...], moment: tuple[float, ...], flags: int) -> None:
    found = locate([force], [moment])
    assert found.flags[0] == flags and (found.words(0) != "") and not found.trusted[0]
    for value in (found.point, found.normal, found.force_n, found.inclination_rad, found.torsion_nmm, found.miss_mm, found.sd_mm):
        assert np.isfinite(value).all()
    assert np.linalg.norm(found.point[0]) == pytest.approx(20) and found.point[0, 2] >= 0
    assert found.touching[0] == (flags & 3 == 0)


def test_a_line_that_misses_gives_the_nearest_point_and_how_far_that_is() -> None:
    found = locate([[0, 0, -1.0]], [[0, -30.0, 0]])  # the line x = -30
    assert found.point[0].tolist() == pytest.approx([-20, 0, 0]) and found.miss_mm[0] == pytest.approx(10) and found.missed[0]
    under = locate([[-1.0, 0, 0]], [[0, 6.0, 0]])  # 6 mm below the rim, along -x
    assert under.point[0].tolist() == pytest.approx([20, 0, 0], abs=1e-5) and under.miss_mm[0] == pytest.approx(6)


def test_twist_is_the_moment_about_the_line_wherever_the_line_is() -> None:
    point, force, moment = pushed(50, size=2, lean_deg=25)
    found = locate(force, moment + 3 * force / 2)  # 3 N mm about each
    np.testing.assert_allclose(found.torsion_nmm, 3)
    np.testing.assert_allclose(found.point, point, atol=1e-9)
    assert found.twisted.all()


def test_noise_alone_is_hardly_ever_taken_for_a_twist() -> None:
    _, force, moment = pushed(200_000, size=1, lean_deg=20)
    rng = np.random.default_rng(2)
    found = locate(force + 0.02 * rng.standard_normal(force.shape), moment + 0.2 * rng.standard_normal(force.shape))
    assert 2 < found.twisted.sum() < 30  # 6.3e-5 of them are expected: 13


@pytest.mark.parametrize(
    ("force", "moment", "says"),
    [
        ([1, 2, 3], [[1, 2, 3]], r"shape \(3,\)"),
        ([[1, 2]], [[1, 2]], r"shape \(1, 2\)"),
        ([[1, 2, 3]], [[1, 2, 3], [1, 2, 3]], "1 forces and 2 moments"),
        ([["a", 2, 3]], [[1, 2, 3]], "no number"),
    ],
)
def test_what_are_no_forces_and_moments(force: list, moment: list, says: str) -> None:
    with pytest.raises(InputError, match=says):
        locate(force, moment)


def test_domes_and_gates_that_are_none() -> None:
    for wrong in ({"radius": 0.0}, {"radius": np.nan}, {"axis": (0, 0, 0)}, {"centre": (0, np.inf, 0)}, {"axis": (1, 2)}):
        with pytest.raises(InputError, match="give"):
            Hemisphere(**wrong)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="least force"):
        locate([[0, 0, -1]], [[0, 0, 0]], least_force=-1)


def test_no_sample_is_no_contact() -> None:
    assert len(locate(np.empty((0, 3)), np.empty((0, 3)))) == 0


def test_a_line_that_misses_is_as_far_off_as_a_search_over_the_dome_says() -> None:
    polar, around = np.meshgrid(np.arccos(np.linspace(0, 1, 150)), np.linspace(0, 2 * np.pi, 500))
    dome = 20 * np.stack([np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)], axis=-1).reshape(-1, 3)
    rng = np.random.default_rng(5)
    force = rng.normal(size=(120, 3))
    force /= np.linalg.norm(force, axis=1)[:, None]
    moment = np.cross(rng.uniform(-35, 35, (120, 3)), force)
    found = locate(force, moment)
    assert found.missed.sum() > 50
    for k in np.flatnonzero(found.missed):
        off = dome[dome @ force[k] <= 0] - np.cross(force[k], moment[k])  # where it can push
        least = np.sqrt(np.maximum((off**2).sum(axis=1) - (off @ force[k]) ** 2, 0).min())
        own = found.point[k] - np.cross(force[k], moment[k])
        assert found.miss_mm[k] == pytest.approx(np.linalg.norm(own - own @ force[k] * force[k]), abs=1e-4)
        assert least - 0.25 < found.miss_mm[k] < least + 1e-6 and found.point[k, 2] > -1e-9
        assert np.linalg.norm(found.point[k]) == pytest.approx(20)
