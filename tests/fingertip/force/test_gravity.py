"""Centres of gravity against truth: exact without noise, invariant, and as uncertain as they say."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.gravity import (
    Centre,
    centre_of_gravity,
    lines,
    pose_span,
    published_centre,
    require_certain,
)
from skinfab.fingertip.force.gravity_simulator import PAPER_TRUTH, HandScene, directions, hold
from skinfab.fingertip.force.poses import poses_of
from skinfab.rates import wilson

WEIGHT_N, TRUE = 1.67, np.array([10.0, -20.0, 150.0])
#: As of a mean of a hundred samples.
NOISE = np.diag([0.004**2] * 3 + [0.1**2] * 3)
#: 95 % of three Gaussian numbers have a sum of squares below this.
ELLIPSOID = 7.814727903251179


def poses(n: int = 10, *, span: float = 60.0, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    force = WEIGHT_N * directions(n, span, np.random.default_rng(seed))
    return force, np.cross(TRUE, force)


@given(seed=st.integers(0, 1000), n=st.integers(5, 12), offset=st.lists(st.floats(-20, 20), min_size=6, max_size=6))
@settings(max_examples=30, deadline=None)
def test_exact_whatever_the_offsets(seed: int, n: int, offset: list[float]) -> None:
    force, moment = poses(n, seed=seed)
    found = centre_of_gravity(force + 0.01 * np.array(offset[:3]), moment + np.array(offset[3:]))
    assert found.point == pytest.approx(TRUE, abs=1e-5)
    assert found.residual_mm.max() < 1e-4
    assert published_centre(force, moment).point == pytest.approx(TRUE, abs=1e-6)  # without offsets it is exact too


def test_turning_the_frame_turns_the_point() -> None:
    force, moment = poses()
    force, moment = (
        force + np.random.default_rng(1).normal(0, 0.01, force.shape),
        moment + np.random.default_rng(2).normal(0, 1, moment.shape),
    )
    turned = Rotation.from_rotvec([0.3, -0.5, 0.7]).as_matrix()
    spread = np.kron(np.eye(2), turned) @ NOISE @ np.kron(np.eye(2), turned).T
    for find in (centre_of_gravity, published_centre):
        plain, other = find(force, moment, NOISE), find(force @ turned.T, moment @ turned.T, spread)
        assert other.point == pytest.approx(turned @ plain.point, abs=1e-5)
        assert other.covariance == pytest.approx(turned @ plain.covariance @ turned.T, abs=1e-5)


def test_moving_the_origin_moves_the_point() -> None:
    force, moment = poses()
    moment = moment + np.random.default_rng(2).normal(0, 1, moment.shape)
    move = np.array([30.0, -40.0, 50.0])
    shift = np.eye(6)
    shift[3:, :3] = np.array([[0, -50, -40], [50, 0, -30], [40, 30, 0]], dtype=float)
    assert shift[3:, :3] @ force[0] == pytest.approx(np.cross(move, force[0]))
    plain = centre_of_gravity(force, moment, NOISE)
    other = centre_of_gravity(force, moment + np.cross(move, force), shift @ NOISE @ shift.T)
    assert other.point == pytest.approx(plain.point + move, abs=1e-4)
    assert other.covariance == pytest.approx(plain.covariance, rel=1e-4)


def covered(find: object, *, offset: float, trials: int = 500) -> tuple[float, float, float]:
    """How often the truth lies within the stated 95 %, with the interval of that count."""
    inside = []
    for seed in range(trials):
        rng = np.random.default_rng([seed, 1])
        force, moment = poses(seed=seed)
        read_force = force + 0.004 * rng.standard_normal(force.shape) + 0.01 * offset * rng.standard_normal(3)
        read_moment = moment + 0.1 * rng.standard_normal(moment.shape) + offset * rng.standard_normal(3)
        found: Centre = find(read_force, read_moment, NOISE)  # type: ignore[operator]
        apart = found.point - TRUE
        inside.append(apart @ np.linalg.solve(found.covariance, apart) <= ELLIPSOID)
    rate = wilson(sum(inside), trials)
    return rate.low, rate.value, rate.high


def test_the_truth_lies_within_the_stated_95_percent_in_95_percent() -> None:
    low, _, high = covered(centre_of_gravity, offset=3.0)
    assert low < 0.95 < high
    low, _, high = covered(published_centre, offset=0.0)
    assert low < 0.95 < high


def test_lines_meet_by_their_noise_and_not_by_chance() -> None:
    chances = []
    for seed in range(300):
        rng = np.random.default_rng([seed, 1])
        force, moment = poses(seed=seed)
        read = force + 0.004 * rng.standard_normal(force.shape), moment + 0.1 * rng.standard_normal(moment.shape) + 4.0
        chances.append(centre_of_gravity(*read, NOISE).chance)
    counts = np.histogram(chances, bins=5, range=(0, 1))[0]
    assert counts.sum() == 300 and counts.min() > 35 and counts.max() < 85  # 60 each, by chance alone


def test_an_object_that_slips_is_told_and_widens_the_uncertainty() -> None:
    force, moment = poses()
    slipped = moment.copy()
    slipped[5:] = np.cross(TRUE + np.array([5, 0, 0]), force[5:])
    whole, broken = centre_of_gravity(force, moment, NOISE), centre_of_gravity(force, slipped, NOISE)
    assert whole.meets and not broken.meets and broken.misfit > 10
    assert broken.sd_mm > 3 * whole.sd_mm


def test_the_propagated_line_is_the_papers() -> None:
    # J_M = F^ / |F|^2 and J_F = -M^ / |F|^2 - 2 q F^T / |F|^2, against differences.
    force, moment = poses(1)
    q = lines(force, moment)[0][0]
    step, F, M = 1e-6, force[0], moment[0]

    def hat(v: np.ndarray) -> np.ndarray:
        return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])

    by_force = -hat(M) / (F @ F) - 2 * np.outer(q, F) / (F @ F)
    by_moment = hat(F) / (F @ F)
    for k, unit in enumerate(np.eye(3)):
        assert (lines(force + step * unit, moment)[0][0] - q) / step == pytest.approx(by_force[:, k], rel=1e-4, abs=1e-3)
        assert (lines(force, moment + step * unit)[0][0] - q) / step == pytest.approx(by_moment[:, k], rel=1e-4, abs=1e-5)


def test_the_papers_errors_come_out_as_published_and_are_beaten() -> None:
    theirs: list[float] = []
    ours: list[float] = []
    for k, place in enumerate(PAPER_TRUTH):
        for trial in range(6):
            held = hold(place, seed=[k, trial])
            p = poses_of(held.log)
            for find, errors in ((published_centre, theirs), (centre_of_gravity, ours)):
                errors.append(float(np.linalg.norm(find(p.force, p.moment, p.covariance).point - held.centre)))
    assert 1.5 < np.median(theirs) < 5.2  # table 3: 3.1 to 5.2 mm
    assert np.median(ours) < 0.6 and np.max(ours) < 1.5


def test_poor_poses_are_refused_in_a_sentence() -> None:
    held = hold(seed=1, scene=HandScene(span_deg=1.0))
    p = poses_of(held.log)
    with pytest.raises(RefusedError, match=r"uncertain by .* mm .* within \d degrees; turn the hand farther|do not tell"):
        require_certain(centre_of_gravity(p.force, p.moment, p.covariance), p.force)
    wide = poses_of(hold(seed=1).log)
    require_certain(centre_of_gravity(wide.force, wide.moment, wide.covariance), wide.force)


def test_poses_that_say_nothing() -> None:
    force, moment = poses(3)
    with pytest.raises(InputError, match="1 pose, and 2 are needed"):
        published_centre(force[:1], moment[:1])
    with pytest.raises(InputError, match="2 poses, and 3 are needed"):
        centre_of_gravity(force[:2], moment[:2])
    same = np.tile(force[0], (4, 1))
    with pytest.raises(RefusedError, match="one direction in all 4 poses"):
        published_centre(same, np.cross(TRUE, same))
    with pytest.raises(RefusedError, match="do not tell the centre"):
        centre_of_gravity(same, np.cross(TRUE, same))
    for broken, says in ((np.nan, "not a number"), (0.0, "pose 2 has no force")):
        bad = force.copy()
        bad[1] = broken
        with pytest.raises(InputError, match=says):
            centre_of_gravity(bad, moment)
    with pytest.raises(InputError, match=r"shape \(3, 3\) and moments \(2, 3\)"):
        centre_of_gravity(force, moment[:2])
    with pytest.raises(InputError, match=r"\(5, 5\) does not fit"):
        centre_of_gravity(force, moment, np.eye(5))
    with pytest.raises(InputError, match="not positive"):
        centre_of_gravity(force, moment, np.zeros((6, 6)))


def test_the_span_is_the_widest_angle() -> None:
    assert pose_span([[0, 0, -1.0], [0, np.sin(0.5), -np.cos(0.5)]]) == pytest.approx(np.degrees(0.5))


def test_the_stated_uncertainty_holds_where_the_noise_is_estimated_from_few_samples() -> None:
    rng = np.random.default_rng(1)
    t, inside, meets, free = np.array([5.0, -8.0, 140.0]), 0, 0, 10 * 4 - 10
    for _ in range(200):
        turned = rng.normal(size=(10, 3)) * 0.4 + [0, 0, -1.0]
        F = 1.667 * turned / np.linalg.norm(turned, axis=1)[:, None]
        read = np.concatenate([F, np.cross(t, F)], axis=1)[:, None] + rng.normal(size=(10, 4, 6)) * [0.04, 0.04, 0.04, 1, 1, 1]
        mean = read.mean(axis=1)
        apart = (read - mean[:, None]).reshape(-1, 6)
        found = centre_of_gravity(mean[:, :3], mean[:, 3:], apart.T @ apart / free / 4, freedom=free)
        off = found.point - t
        inside += off @ np.linalg.solve(found.covariance, off) < 7.815  # 95 % of chi-square of three
        meets += found.meets
    # As if the noise were known, 9 of 200 would be said not to meet.
    assert inside >= 184 and meets >= 199
