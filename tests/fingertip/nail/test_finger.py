"""The finger's dynamics against closed forms: a body that nothing holds, the direct integration of what holds it, and symmetry."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from skinfab.fingertip.nail.finger import GRAVITY, TANGENTIAL, Finger, contact_matrix, cross_matrix, motor_force, respond
from skinfab.fingertip.nail.simulator import participant

W = 2 * np.pi * 169.0
NOTHING = np.zeros((1, 6, 6))


@pytest.fixture(scope="module")
def finger() -> Finger:
    return participant(np.random.default_rng(3))


def answer(finger: Finger, contact: np.ndarray = NOTHING) -> np.ndarray:
    omega = np.array([W])
    return respond(finger, contact, np.ones(1), omega, motor_force(finger, omega))[0]


def test_cross_matrix_is_the_cross_product() -> None:
    p, q = np.random.default_rng(0).normal(size=(2, 5, 3))
    np.testing.assert_allclose(np.einsum("nij,nj->ni", cross_matrix(p), q), np.cross(p, q), atol=1e-12)


def test_a_body_that_nothing_holds_answers_as_newton_says(finger: Finger) -> None:
    free = replace(finger, stiffness=np.zeros(6), imu_mm=np.zeros(3))
    force = motor_force(free, np.array([W]))[0]
    got = answer(free)
    np.testing.assert_allclose(got[:3] * GRAVITY, force[:3] / free.mass_kg, rtol=1e-12)
    np.testing.assert_allclose(np.radians(1) * got[3:] * 1j * W, force[3:] / free.inertia_kgm2, rtol=1e-12)


def test_the_answer_is_that_of_the_equations_of_motion(finger: Finger) -> None:
    """M x" + C x' + K x = F, integrated over time until what it began with is gone."""
    contact = contact_matrix(np.array([[[1.0, 4.0, -6.0], [-2.0, 3.0, -6.0]]]), np.array([[0.3, 0.7]]))
    touched = finger.contact_n_per_m * contact[0]
    M = np.append(np.full(3, finger.mass_kg), finger.inertia_kgm2)
    C = np.diag(2 * finger.damping_ratio * np.sqrt(finger.stiffness * M)) + finger.contact_delay_s * touched
    K = np.diag(finger.stiffness) + touched
    force = motor_force(finger, np.array([W]))[0]

    def motion(t: float, state: np.ndarray) -> np.ndarray:
        x, v = state[:6], state[6:]
        return np.concatenate([v, ((force * np.exp(1j * W * t)).real - C @ v - K @ x) / M])

    end = 0.2
    solved = solve_ivp(motion, (0, end), np.zeros(12), rtol=1e-9, atol=1e-14)
    speed, pushed = solved.y[6:, -1], motion(end, solved.y[:, -1])[6:]
    got = (answer(finger, contact) * np.exp(1j * W * end)).real
    np.testing.assert_allclose(np.radians(got[3:]), speed[3:], rtol=1e-4, atol=1e-5)
    moved = pushed[:3] + np.cross(pushed[3:], finger.imu_mm / 1e3)
    np.testing.assert_allclose(got[:3] * GRAVITY, moved, rtol=1e-4, atol=1e-4)


def test_a_contact_below_the_middle_adds_what_a_spring_there_would() -> None:
    K = contact_matrix(np.array([[[0.0, 0.0, -6.0]]]), np.ones((1, 1)))[0]
    np.testing.assert_allclose(np.diag(K), [TANGENTIAL, TANGENTIAL, 1.0, TANGENTIAL * 36e-6, TANGENTIAL * 36e-6, 0.0], atol=1e-15)
    np.testing.assert_allclose(K, K.T, atol=1e-15)


def test_a_line_across_holds_the_roll_and_a_line_along_holds_the_pitch(finger: Finger) -> None:
    """The paper's argument of figure 1: a lateral edge stops the sway about y, and leaves that about x."""
    reach = np.linspace(-6.0, 6.0, 7)
    zero, below = np.zeros(7), np.full(7, -6.0)
    lines = np.stack([np.stack([reach, zero, below], axis=-1), np.stack([zero, reach, below], axis=-1)])
    across, along = contact_matrix(lines, np.full((2, 7), 1 / 7))
    assert across[4, 4] > 1.5 * along[4, 4]
    assert along[3, 3] > 1.5 * across[3, 3]


def test_a_harder_press_quietens_the_finger(finger: Finger) -> None:
    """Figure 3: the scatter diagram shrinks; twice the stiffness is eight times the force."""
    contact = np.repeat(contact_matrix(np.array([[[0.0, 5.0, -6.0]]]), np.ones((1, 1))), 3, axis=0)
    omega = np.full(3, W)
    each = respond(finger, contact, np.array([0.5, 1.0, 2.0]), omega, motor_force(finger, omega))
    assert np.all(np.diff(np.abs(each[:, 3:]).max(axis=1)) < 0)
