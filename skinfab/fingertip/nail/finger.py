"""The last joint of a finger as a rigid body on springs, shaken by a motor on its nail: six degrees of freedom, one frequency.

(-w^2 M + i w C + K) X = F, with X the body's translation and rotation, F the force and the moment of the motor's eccentric mass,
and M, C, K of the finger. What the pad touches adds springs and dampers where it touches: sum_k w_k J^T diag(t, t, 1) J with
J = [I, -p^], the motion of the point p of the pad; t is the ratio of tangential to normal stiffness.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

#: Standard gravity, m/s^2: the accelerometer's channels are in G.
GRAVITY = 9.80665

#: Of a sphere between flat and round (Mindlin): 2 (1 - nu) / (2 - nu) is 0.67 for the incompressible pulp; skin that slips a little
#: gives less.
TANGENTIAL = 0.6
#: An edge is a row of so many points.
EDGE_POINTS = 13


@dataclass(frozen=True, eq=False)
class Finger:
    """A finger with the device on its nail.

    Parameters
    ----------
    mass_kg : float
    inertia_kgm2 : (3,) float
        About x, y and z.
    stiffness : (6,) float
        Of what holds it: along x, y, z in N/m, about x, y, z in N m/rad.
    damping_ratio : float
        Of each of the six alone.
    contact_n_per_m : float
        Of all that touches the pad, at the wanted force.
    contact_delay_s : float
        Damping over stiffness of what touches the pad.
    motor_mm, imu_mm : (3,) float
        From the middle of the body.
    imbalance_kgm : float
        Eccentric mass times its radius.
    """

    mass_kg: float
    inertia_kgm2: FloatArray
    stiffness: FloatArray
    damping_ratio: float
    contact_n_per_m: float
    contact_delay_s: float
    motor_mm: FloatArray
    imu_mm: FloatArray
    imbalance_kgm: float


def cross_matrix(p: FloatArray) -> FloatArray:
    """[p]x with [p]x q = p x q; (..., 3) to (..., 3, 3).

    Examples
    --------
    >>> cross_matrix(np.array([0.0, 0.0, 1.0])) @ np.array([1.0, 0.0, 0.0])
    array([0., 1., 0.])
    """
    p = np.asarray(p, dtype=float)
    out = np.zeros((*p.shape[:-1], 3, 3))
    out[..., 2, 1], out[..., 0, 2], out[..., 1, 0] = p[..., 0], p[..., 1], p[..., 2]
    return out - np.swapaxes(out, -1, -2)


def contact_matrix(points_mm: FloatArray, weights: FloatArray) -> FloatArray:
    """Stiffness of a contact of 1 N/m in all, on the body's six coordinates.

    Parameters
    ----------
    points_mm : (n, k, 3) float
        Where it touches, from the middle of the body.
    weights : (n, k) float
        How much of it at each point; they add up to 1, or to 0 where nothing is touched.

    Returns
    -------
    (n, 6, 6) float
        N/m, N, N m.
    """
    J = np.concatenate([np.broadcast_to(np.eye(3), (*points_mm.shape, 3)), -cross_matrix(points_mm / 1e3)], axis=-1)
    spread = weights[..., None] * np.array([TANGENTIAL, TANGENTIAL, 1.0])
    out: FloatArray = np.einsum("nkai,nka,nkaj->nij", J, spread, J, optimize=True)
    return out


def motor_force(finger: Finger, omega: FloatArray) -> ComplexArray:
    """Force and moment of the eccentric mass, which turns about z; (n, 6) for n angular frequencies in rad/s."""
    force = np.array([1.0, -1.0j, 0.0])
    direction = np.concatenate([force, np.cross(finger.motor_mm / 1e3, force)])
    out: ComplexArray = (finger.imbalance_kgm * np.asarray(omega) ** 2)[:, None] * direction
    return out


def respond(finger: Finger, contact: FloatArray, stiffened: FloatArray, omega: FloatArray, force: ComplexArray) -> ComplexArray:
    """What the sensor reads of a force that turns at one frequency.

    Parameters
    ----------
    finger : Finger
    contact : (n, 6, 6) float
        From `contact_matrix`.
    stiffened : (n,) float
        Each contact's stiffness as a part of ``finger.contact_n_per_m``.
    omega : (n,) float, rad/s
    force : (n, 6) complex
        From `motor_force`.

    Returns
    -------
    (n, 6) complex
        Phasors of Ax, Ay, Az in G and Gx, Gy, Gz in deg/s: the reading is the real part of phasor times exp(i omega t).
    """
    inertia = np.append(np.full(3, finger.mass_kg), finger.inertia_kgm2)
    damping = 2 * finger.damping_ratio * np.sqrt(finger.stiffness * inertia)
    touched = (finger.contact_n_per_m * stiffened)[:, None, None] * contact
    w = np.asarray(omega)[:, None, None]
    held = np.diag(finger.stiffness) - w**2 * np.diag(inertia) + 1j * w * np.diag(damping)
    X = np.linalg.solve(held + (1 + 1j * w * finger.contact_delay_s) * touched, force[..., None])[..., 0]
    w = w[..., 0]
    # Both are small, so that the sensor stays where it is on the body, and gyroscopic terms are of second order.
    acceleration = -(w**2) * (X[:, :3] + np.cross(X[:, 3:], finger.imu_mm / 1e3))
    return np.concatenate([acceleration / GRAVITY, 1j * w * X[:, 3:] * (180 / np.pi)], axis=1)
